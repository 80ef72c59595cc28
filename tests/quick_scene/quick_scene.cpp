#include "quick_scene/quick_scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "quick_scene/quick_texture.h"

namespace cairn {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kWidth = 640, kHeight = 480;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A box turned about the vertical axis, with one texture that its six faces cut different parts of.
struct Box {
  Vector3f centre, half;
  Matrix3f R_bw;  // world to box
  cv::Mat texture;
  float texels_per_metre = 500;
};

struct Hit {
  float distance = kInfinity;  // in lengths of the direction
  int box = -1, axis = 0;
  bool far_side = false;  // the face on the positive side of the axis
};

// The slab test. `origin` is outside of the box.
void intersect(const Box& box, int index, const Vector3f& o, const Vector3f& d, Hit& best) {
  float enter = 0, leave = best.distance;
  int axis = -1;
  for (int i = 0; i < 3; ++i) {
    const float inverse = 1.0f / d[i];
    const float a = (-box.half[i] - o[i]) * inverse, b = (box.half[i] - o[i]) * inverse;
    const float first = std::min(a, b), last = std::max(a, b);
    if (first > enter) enter = first, axis = i;
    leave = std::min(leave, last);
    if (enter > leave) return;
  }
  if (axis >= 0) best = {enter, index, axis, d[axis] < 0};
}

Vector3f sample(const Box& box, const Hit& hit, const Vector3f& at) {
  const int u_axis = (hit.axis + 1) % 3, v_axis = (hit.axis + 2) % 3;
  const float face = float(2 * hit.axis + hit.far_side);
  float u = (at[u_axis] + box.half[u_axis]) * box.texels_per_metre + face * 97;
  float v = (at[v_axis] + box.half[v_axis]) * box.texels_per_metre + face * 61;
  const int x = int(std::floor(u)), y = int(std::floor(v));
  u -= float(x), v -= float(y);
  const int W = box.texture.cols, H = box.texture.rows;
  const int x0 = ((x % W) + W) % W, x1 = x0 + 1 == W ? 0 : x0 + 1;
  const int y0 = ((y % H) + H) % H, y1 = y0 + 1 == H ? 0 : y0 + 1;
  const auto *top = box.texture.ptr<cv::Vec3b>(y0), *bottom = box.texture.ptr<cv::Vec3b>(y1);
  Vector3f colour;
  for (int c = 0; c < 3; ++c) {
    colour[c] = (1 - v) * ((1 - u) * top[x0][c] + u * top[x1][c]) +
                v * ((1 - u) * bottom[x0][c] + u * bottom[x1][c]);
  }
  // Light from above and from one side, so that edges show on any print.
  constexpr float kShade[6] = {0.72f, 0.88f, 0.66f, 0.80f, 0.6f, 1.0f};
  return colour * kShade[2 * hit.axis + hit.far_side];
}

std::uint64_t scrambled(std::uint64_t x) {  // splitmix64
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

}  // namespace

struct QuickScene::World {
  std::vector<Box> boxes;

  // A scene is quick to cast because of what is done once a picture: the camera in each box's
  // frame, and the rows and columns that a box can cover.
  struct View {
    std::vector<Vector3f> origin;
    std::vector<Matrix3f> R_bc;
    std::vector<cv::Rect> window;
  };

  void add(const Vector3f& centre, const Vector3f& size, float yaw_deg, QuickSurface surface,
           float texels_per_metre, const cv::Size& texture, std::uint64_t seed) {
    const Matrix3f R_wb =
        Eigen::AngleAxisf(yaw_deg * float(M_PI) / 180, Vector3f::UnitZ()).toRotationMatrix();
    boxes.push_back({centre, 0.5f * size, R_wb.transpose(),
                     make_quick_texture(surface, texture, seed * 64 + boxes.size()),
                     texels_per_metre});
  }

  View seen_from(const SE3& T_wc, const Camera& camera) const {
    View view;
    const SE3 T_cw = T_wc.inverse();
    const Matrix3f R_wc = T_wc.matrix3().cast<float>();
    for (const Box& box : boxes) {
      view.origin.push_back(box.R_bw * (T_wc.translation().cast<float>() - box.centre));
      view.R_bc.push_back(box.R_bw * R_wc);
      double x0 = kWidth, y0 = kHeight, x1 = 0, y1 = 0;
      bool behind = false;
      for (int i = 0; i < 8; ++i) {
        const Vector3f sign(i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f);
        const Vector3f corner = box.R_bw.transpose() * sign.cwiseProduct(box.half) + box.centre;
        const Vector3d X_c = T_cw * corner.cast<double>();
        behind |= X_c.z() < 0.05;
        const auto pixel = camera.pinhole().project(X_c);
        x0 = std::min(x0, pixel.x()), x1 = std::max(x1, pixel.x());
        y0 = std::min(y0, pixel.y()), y1 = std::max(y1, pixel.y());
      }
      const cv::Rect whole(0, 0, kWidth, kHeight);
      if (behind || x0 > x1) {
        view.window.push_back(behind ? whole : cv::Rect());
      } else {
        const cv::Point low(int(std::max(x0 - 1, -1.0)), int(std::max(y0 - 1, -1.0)));
        const cv::Point high(int(std::min(x1 + 3, kWidth + 1.0)),
                             int(std::min(y1 + 3, kHeight + 1.0)));
        view.window.push_back(cv::Rect(low, high) & whole);
      }
    }
    return view;
  }

  Vector3f shade(const View& view, const std::vector<int>& candidates, int x,
                 const Vector3f& direction_c) const {
    Hit hit;
    for (const int i : candidates) {
      if (x < view.window[i].x || x >= view.window[i].x + view.window[i].width) continue;
      intersect(boxes[i], i, view.origin[i], view.R_bc[i] * direction_c, hit);
    }
    if (hit.box < 0) return Vector3f(150, 140, 130);  // out of the window: an even sky
    const Vector3f at = view.origin[hit.box] + hit.distance * (view.R_bc[hit.box] * direction_c);
    return sample(boxes[hit.box], hit, at);
  }
};

QuickScene::QuickScene(std::uint64_t seed, const Options& options)
    : seed_(seed),
      options_(options),
      camera_(Camera::Model::kRadialTangential, kWidth, kHeight, {525, 525, 320, 240}) {
  auto world = std::make_unique<World>();
  using enum QuickSurface;
  // The corner of the room.
  world->add({0.6f, 0.6f, -0.05f}, {4.6f, 4.6f, 0.1f}, 0, kTiles, 240, {1100, 1100}, seed);
  world->add({-1.3f, 0.9f, 1.3f}, {0.1f, 4.6f, 2.7f}, 0, kWallpaper, 240, {1100, 700}, seed);
  world->add({0.9f, -1.3f, 1.3f}, {4.6f, 0.1f, 2.7f}, 0, kWallpaper, 240, {700, 1100}, seed);
  // The table and its pedestal.
  world->add({-0.2f, -0.2f, 0.72f}, {1.5f, 1.2f, 0.05f}, 8, kWood, 420, {640, 512}, seed);
  world->add({-0.2f, -0.2f, 0.35f}, {0.5f, 0.4f, 0.69f}, 8, kPrint, 300, {400, 400}, seed);
  // On the table.
  world->add({-0.45f, -0.40f, 0.905f}, {0.36f, 0.24f, 0.32f}, 25, kPrint, 460, {512, 512}, seed);
  world->add({0.05f, -0.45f, 0.845f}, {0.22f, 0.30f, 0.20f}, -20, kPrint, 460, {512, 512}, seed);
  world->add({-0.10f, -0.02f, 0.795f}, {0.30f, 0.21f, 0.10f}, 40, kPrint, 480, {512, 512}, seed);
  world->add({-0.60f, 0.10f, 0.875f}, {0.16f, 0.16f, 0.26f}, 10, kPrint, 480, {512, 512}, seed);
  world->add({0.28f, -0.12f, 0.785f}, {0.14f, 0.20f, 0.08f}, -35, kPrint, 480, {512, 512}, seed);
  // On the floor.
  world->add({0.95f, -0.75f, 0.25f}, {0.50f, 0.45f, 0.50f}, 15, kPrint, 320, {512, 512}, seed);
  world->add({-0.85f, 0.95f, 0.30f}, {0.45f, 0.55f, 0.60f}, -12, kPrint, 320, {512, 512}, seed);
  world_ = std::move(world);
}

QuickScene::~QuickScene() = default;

SE3 QuickScene::T_wc(double t) const {
  // Periods that share no multiple within minutes; a phase of its own a seed.
  const double phase = 0.37 * double(seed_ % 17);
  auto wave = [&](double amplitude, double period, double shift) {
    return amplitude * std::sin(2 * M_PI * t / period + shift + phase);
  };
  const double azimuth = 0.80 + wave(0.42, 10.0, 0.0) + wave(0.08, 3.7, 1.0);
  const double elevation = 0.40 + wave(0.16, 7.3, 0.5) + wave(0.03, 2.3, 2.0);
  const double radius = 1.75 + wave(0.22, 8.9, 1.3) + wave(0.03, 2.9, 0.2);
  const Vector3d target(-0.15 + wave(0.12, 6.1, 2.2), -0.15 + wave(0.12, 5.3, 0.9),
                        0.78 + wave(0.08, 4.7, 0.1));
  const Vector3d position =
      Vector3d(-0.15, -0.15, 0.75) + radius * Vector3d(std::cos(azimuth) * std::cos(elevation),
                                                       std::sin(azimuth) * std::cos(elevation),
                                                       std::sin(elevation));
  const Vector3d z = (target - position).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R_wc;
  R_wc << x, z.cross(x), z;
  const double roll = wave(0.06, 5.9, 0.7) + wave(0.01, 1.1, 0.0);
  return SE3(Eigen::Quaterniond(R_wc) * so3_exp(Vector3d(0, 0, roll)), position);
}

cv::Mat QuickScene::render(double t) const {
  const World::View view = world_->seen_from(T_wc(t), camera_);
  const Pinhole pinhole = camera_.pinhole();
  const std::uint64_t stream = scrambled(seed_ ^ scrambled(std::bit_cast<std::uint64_t>(t)));
  cv::Mat picture(kHeight, kWidth, CV_8UC3);
  tbb::parallel_for(tbb::blocked_range<int>(0, kHeight, 8), [&](const auto& rows) {
    std::vector<int> candidates;
    for (int y = rows.begin(); y != rows.end(); ++y) {
      candidates.clear();
      for (int i = 0; i < int(world_->boxes.size()); ++i) {
        const cv::Rect& window = view.window[i];
        if (y >= window.y && y < window.y + window.height) candidates.push_back(i);
      }
      auto* row = picture.ptr<cv::Vec3b>(y);
      for (int x = 0; x < kWidth; ++x) {
        Vector3f colour = Vector3f::Zero();
        for (int i = 0; i < 4; ++i) {  // 2x2 rays a pixel
          const Eigen::Vector2d pixel(x + (i & 1 ? 0.25 : -0.25), y + (i & 2 ? 0.25 : -0.25));
          colour += world_->shade(view, candidates, x, pinhole.unproject(pixel).cast<float>());
        }
        const float dx = (float(x) - 320) / 400, dy = (float(y) - 240) / 400;
        const float light = 0.25f * (1 - float(options_.vignetting) * (dx * dx + dy * dy));
        // The count of 64 fair bits is all but normal: mean 32, deviation 4.
        const auto bits = std::popcount(scrambled(stream + std::uint64_t(y) * kWidth + x));
        const float noise = float(options_.noise) * float(bits - 32) / 4;
        for (int c = 0; c < 3; ++c) row[x][c] = cv::saturate_cast<uchar>(colour[c] * light + noise);
      }
    }
  });
  return picture;
}

std::optional<double> QuickScene::cast(const Vector3d& origin, const Vector3d& direction) const {
  Hit hit;
  for (int i = 0; i < int(world_->boxes.size()); ++i) {
    const Box& box = world_->boxes[i];
    intersect(box, i, box.R_bw * (origin.cast<float>() - box.centre),
              box.R_bw * direction.cast<float>(), hit);
  }
  return hit.box < 0 ? std::nullopt : std::optional<double>(hit.distance);
}

}  // namespace cairn
