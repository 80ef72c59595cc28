#include "cairn/synthetic/world.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <mutex>

#include "cairn/synthetic/ray_table.h"
#include "cairn/synthetic/shading.h"
#include "cairn/synthetic/surface_planes.h"
#include "cairn/synthetic/truth_renderer.h"

namespace cairn {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kTile = 32;            // pixels, a side
constexpr std::size_t kCameras = 4;  // whose rays are kept
constexpr double kKey = 0.26;        // mean light of a well exposed picture
constexpr double kMemory = 0.7;      // seconds that the exposure follows behind

BakeOptions bake_options(const Scene& scene) {
  BakeOptions options;
  if (scene.sky.maxCoeff() > 0) {  // outside, where things are larger and farther away
    options.cell = 4;
    options.finest_cell = 0.2f;
    options.contrast = 0.2f;
    options.openness = 2;
  }
  return options;
}

// Where in a pixel, and when in the exposure, sample i of n is taken. Rows and columns are both
// visited evenly (a rotated grid).
Vector2f offset_in_pixel(int i, int n) {
  constexpr float kGolden = 0.61803399f;
  if (n == 1) return Vector2f::Zero();
  if (n == 4) {
    constexpr float kRotated[4] = {-0.125f, 0.375f, -0.375f, 0.125f};
    return {(float(i) + 0.5f) / 4 - 0.5f, kRotated[i]};
  }
  const float y = kGolden * float(i);
  return {(float(i) + 0.5f) / float(n) - 0.5f, y - std::floor(y) - 0.5f};
}

bool is_same_triangle(const RayHit& a, const RayHit& b) {
  return a.thing == b.thing && a.triangle == b.triangle;
}

RayHit between(const RayHit& a, const RayHit& b) {
  RayHit hit = a;
  hit.distance = 0.5f * (a.distance + b.distance);
  hit.u = 0.5f * (a.u + b.u), hit.v = 0.5f * (a.v + b.v);
  return hit;
}

struct View {
  Matrix3f R_wc;
  Vector3f origin;
};

}  // namespace

struct World::Impl {
  Scene scene;
  std::vector<std::string> labels = {"void"};
  std::vector<std::uint8_t> label_of;  // of thing
  LitMeshes lit;
  RayCaster caster;
  SurfacePlanes planes;
  Shading shading;
  double usual_light = 1;  // mean over the path
  mutable std::mutex rays_mutex;
  mutable std::vector<std::shared_ptr<const RayTable>> rays;  // of the cameras used last

  Impl(Scene given, const std::optional<BakeOptions>& baking)
      : scene(std::move(given)),
        lit(bake_light(scene, placed_meshes(scene), baking.value_or(bake_options(scene)))),
        caster(lit.meshes),
        planes(scene, lit.meshes),
        shading(scene, lit) {
    for (const WorldThing& thing : scene.things) {
      const auto& name = thing.model.class_name;
      auto at = std::find(labels.begin(), labels.end(), name);
      if (at == labels.end()) at = labels.insert(labels.end(), name);
      label_of.push_back(std::uint8_t(at - labels.begin()));
    }
    double sum = 0;
    constexpr int kViews = 24;
    for (int i = 0; i < kViews; ++i) sum += metered(scene.duration * i / kViews) / kViews;
    if (sum > 0) usual_light = sum;
  }

  std::shared_ptr<const RayTable> rays_of(const Camera& camera) const {
    const std::lock_guard lock(rays_mutex);
    for (const auto& table : rays) {
      if (table->is_of(camera)) return table;
    }
    if (rays.size() == kCameras) rays.erase(rays.begin());
    rays.push_back(std::make_shared<const RayTable>(camera));
    return rays.back();
  }

  View view_at(double t, const SE3& T_bc) const {
    const SE3 T_wc = scene.path(t) * T_bc;
    return {T_wc.matrix3().cast<float>(), T_wc.translation().cast<float>()};
  }

  // The mean light of a small picture, bright spots cut off.
  double metered(double t) const {
    const View view = view_at(t, SE3());
    double sum = 0;
    constexpr int kColumns = 16, kRows = 12;
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        const Vector3f ray((float(x) + 0.5f) / kColumns * 1.2f - 0.6f,
                           (float(y) + 0.5f) / kRows * 0.9f - 0.45f, 1);
        const Vector3f direction = view.R_wc * ray.normalized();
        Highlight highlight;
        const Colour colour = shading.colour(caster.cast(view.origin, direction), view.origin,
                                             direction, 1.2f / kColumns, highlight);
        sum += std::min(2.0, double(colour.mean()));
      }
    }
    return sum / (kColumns * kRows);
  }

  double gain(double t, double follow) const {
    double recent = 0;
    constexpr int kSteps = 5;
    for (int i = 0; i < kSteps; ++i) {
      recent += follow > 0 ? metered(t - kMemory * i / kSteps) / kSteps : usual_light / kSteps;
    }
    return kKey / usual_light * std::pow(usual_light / std::max(recent, 1e-6), follow);
  }

  void render_tile(const cv::Rect& tile, const RayTable& table, const std::vector<View>& views,
                   bool by_row, int samples, cv::Mat3f& picture) const {
    for (int y = tile.y; y < tile.y + tile.height; y += 2) {
      for (int x = tile.x; x < tile.x + tile.width; x += 4) {
        render_packet({x, y}, table, views, by_row, samples, picture);
      }
    }
  }

  // Four by two pixels, all their samples.
  void render_packet(const cv::Point& corner, const RayTable& table, const std::vector<View>& views,
                     bool by_row, int samples, cv::Mat3f& picture) const {
    const float pixel = table.pixel_angle() / std::sqrt(float(samples));
    RayCaster::Packet packet;
    std::array<RayHit, RayCaster::kPacket> hits, before;
    std::array<Highlight, RayCaster::kPacket> highlights;
    std::array<Colour, RayCaster::kPacket> sums;
    sums.fill(Colour::Zero());
    for (int s = 0; s < samples; ++s) {
      const Vector2f offset = offset_in_pixel(s, samples);
      for (int i = 0; i < RayCaster::kPacket; ++i) {
        const auto k = std::size_t(i);
        const int x = corner.x + i % 4, y = corner.y + i / 4;
        packet.active[k] = x < picture.cols && y < picture.rows;
        const int row = std::min(y, picture.rows - 1);
        const View& view = views[std::size_t(by_row ? row * samples + s : s)];
        packet.origin[k] = view.origin;
        packet.direction[k] = view.R_wc * table.ray(std::min(x, picture.cols - 1), row, offset);
      }
      caster.cast(packet, hits);
      for (std::size_t k = 0; k < RayCaster::kPacket; ++k) {
        if (!packet.active[k]) continue;
        const auto colour = [&](const RayHit& hit, float covered) {
          return shading.colour(hit, packet.origin[k], packet.direction[k], covered, highlights[k]);
        };
        // Two samples in one triangle are shaded as one between them.
        const bool first = s % 2 == 0 && s + 1 < samples;
        if (first) {
          before[k] = hits[k];
        } else if (s % 2 == 1 && is_same_triangle(before[k], hits[k])) {
          sums[k] += 2 * colour(between(before[k], hits[k]), float(M_SQRT2) * pixel);
        } else {
          sums[k] += colour(hits[k], pixel);
          if (s % 2 == 1) sums[k] += colour(before[k], pixel);
        }
      }
    }
    for (int i = 0; i < RayCaster::kPacket; ++i) {
      const auto k = std::size_t(i);
      const Colour mean = sums[k] / float(samples);
      if (packet.active[k]) {
        picture(corner.y + i / 4, corner.x + i % 4) = {mean.x(), mean.y(), mean.z()};
      }
    }
  }
};

World::World(Scene scene, const std::optional<BakeOptions>& baking)
    : impl_(std::make_unique<const Impl>(std::move(scene), baking)) {}
World::~World() = default;
World::World(World&&) noexcept = default;

const Scene& World::scene() const { return impl_->scene; }
const RayCaster& World::caster() const { return impl_->caster; }
const std::vector<Mesh>& World::meshes() const { return impl_->lit.meshes; }
int World::plane_of(const RayHit& hit) const { return impl_->planes.plane_of(hit); }
const std::vector<std::string>& World::labels() const { return impl_->labels; }

cv::Mat World::render_light(const Camera& camera, double t, const RenderOptions& options) const {
  const auto table = impl_->rays_of(camera);
  const int samples = std::max(1, options.samples);
  const bool by_row = options.readout != 0;
  std::vector<View> views;
  for (int row = 0; row < (by_row ? camera.height() : 1); ++row) {
    const double delay = by_row ? options.readout * ((row + 0.5) / camera.height() - 0.5) : 0;
    for (int s = 0; s < samples; ++s) {
      const double open = options.exposure * ((s + 0.5) / samples - 0.5);
      views.push_back(impl_->view_at(t + delay + open, options.T_bc));
    }
  }
  cv::Mat3f picture(camera.height(), camera.width(), cv::Vec3f(0, 0, 0));
  const int columns = (camera.width() + kTile - 1) / kTile;
  const int rows = (camera.height() + kTile - 1) / kTile;
  tbb::parallel_for(0, columns * rows, [&](int i) {
    const cv::Rect tile(i % columns * kTile, i / columns * kTile, kTile, kTile);
    impl_->render_tile(tile & cv::Rect({0, 0}, picture.size()), *table, views, by_row, samples,
                       picture);
  });
  return picture;
}

cv::Mat World::render(const Camera& camera, double t, const RenderOptions& options) const {
  const double gain = impl_->gain(t, options.sensor.auto_exposure);
  // Another noise for each seed, time and camera of a rig.
  const std::uint64_t noise = impl_->scene.seed * 0x9E3779B97F4A7C15ull +
                              std::bit_cast<std::uint64_t>(t) * 3 +
                              std::bit_cast<std::uint64_t>(options.T_bc.translation().x());
  return develop(render_light(camera, t, options), gain, options.sensor, noise);
}

FrameTruth World::truth(const Camera& camera, const SE3& T_wc) const {
  return render_truth({impl_->scene, impl_->caster, impl_->shading, impl_->planes, impl_->label_of},
                      camera, *impl_->rays_of(camera), T_wc);
}

Camera default_camera(SceneKind kind, int width, int height, bool distorted) {
  const bool street = kind == SceneKind::kStreet;
  const double focal = (street ? 0.58 : 525.0 / 640) * width;
  std::array<double, 5> lens{};
  if (distorted) lens = {0.06, -0.12, 0.0006, -0.0004, 0.03};
  return Camera(Camera::Model::kRadialTangential, width, height,
                {focal, focal, 0.497 * width, 0.508 * height}, lens);
}

RenderOptions default_options(SceneKind kind) {
  RenderOptions options;
  if (kind != SceneKind::kStreet) options.exposure = 0.033, options.readout = 0.025;
  return options;
}

}  // namespace cairn
