#include "cairn/synthetic/truth_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace cairn {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kNear = 0.02;  // metres; nothing is projected from nearer
// Rays a side that measure how much of an object is seen: one a pixel within these bounds.
constexpr int kFewest = 12, kMost = 48;

// Far beyond the border a lens polynomial may fold back; there the ideal camera serves.
class WideCamera {
 public:
  explicit WideCamera(const Camera& camera) : camera_(camera) {}

  Vector2d project(const Vector3d& X_c) const {
    const Vector2d ideal = camera_.pinhole().project(X_c);
    return is_near(ideal) ? camera_.project(X_c) : ideal;
  }
  Vector3d unproject(const Vector2d& pixel) const {
    return is_near(pixel) ? camera_.unproject(pixel)
                          : camera_.pinhole().unproject(pixel).normalized();
  }
  bool is_in_picture(const Vector2d& pixel) const {
    return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() <= camera_.width() - 0.5 &&
           pixel.y() <= camera_.height() - 0.5;
  }
  int width() const { return camera_.width(); }
  int height() const { return camera_.height(); }

 private:
  bool is_near(const Vector2d& pixel) const {
    const double x = pixel.x() / camera_.width(), y = pixel.y() / camera_.height();
    return x > -0.25 && y > -0.25 && x < 1.25 && y < 1.25;
  }
  const Camera& camera_;
};

struct Growing {
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
  int count = 0;
  void add(double left, double top, double right, double bottom) {
    x0 = std::min(x0, left), y0 = std::min(y0, top);
    x1 = std::max(x1, right), y1 = std::max(y1, bottom);
    ++count;
  }
  Box2 box() const { return {x0, y0, x1, y1}; }
};

Box2 projected_box(const WorldThing& thing, const WideCamera& camera, const SE3& T_cw) {
  const SE3 T_co = T_cw * thing.T_wo;
  const Mesh& mesh = thing.model.mesh;
  std::vector<Vector3d> X;
  X.reserve(mesh.vertices.size());
  for (const auto& vertex : mesh.vertices) X.push_back(T_co * vertex.position.cast<double>());
  Growing grown;
  auto add = [&](const Vector3d& X_c) {
    const Vector2d p = camera.project(X_c);
    grown.add(p.x(), p.y(), p.x(), p.y());
  };
  bool all_in_front = true;
  for (const Vector3d& X_c : X) {
    if (X_c.z() >= kNear) add(X_c);
    all_in_front &= X_c.z() >= kNear;
  }
  for (const auto& t : mesh.triangles) {
    if (all_in_front) break;
    const std::uint32_t corner[3] = {t.a, t.b, t.c};
    for (int i = 0; i < 3; ++i) {
      const Vector3d &a = X[corner[i]], &b = X[corner[(i + 1) % 3]];
      if ((a.z() < kNear) != (b.z() < kNear)) {
        add(a + (b - a) * ((kNear - a.z()) / (b.z() - a.z())));
      }
    }
  }
  // Beyond this nobody cares how far.
  const double far_x = 4.0 * camera.width(), far_y = 4.0 * camera.height();
  return {std::clamp(grown.x0, -far_x, far_x), std::clamp(grown.y0, -far_y, far_y),
          std::clamp(grown.x1, -far_x, far_x), std::clamp(grown.y1, -far_y, far_y)};
}

// Of the rays that would meet the object if it were alone, the share that does meet it, in the
// picture.
double visible_share(const RayCaster& caster, int thing, const Box2& box, const WideCamera& camera,
                     const SE3& T_wc) {
  const Vector3f origin = T_wc.translation().cast<float>();
  const double width = box.x1 - box.x0, height = box.y1 - box.y0;
  const int columns = std::clamp(int(width), kFewest, kMost);
  const int rows = std::clamp(int(height), kFewest, kMost);
  int all = 0, seen = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vector2d pixel(box.x0 + width * (column + 0.5) / columns,
                           box.y0 + height * (row + 0.5) / rows);
      const Vector3f ray = (T_wc.rotation() * camera.unproject(pixel)).cast<float>();
      const bool first = camera.is_in_picture(pixel) && caster.cast(origin, ray).thing == thing;
      seen += first;
      all += first || caster.cast_at(thing, origin, ray).found();
    }
  }
  return all > 0 ? double(seen) / all : 0;
}

void cast_pictures(const TruthSources& world, const RayTable& rays, const SE3& T_wc,
                   FrameTruth& truth) {
  const Matrix3f R_wc = T_wc.matrix3().cast<float>();
  const Vector3f origin = T_wc.translation().cast<float>();
  tbb::parallel_for(0, truth.depth.rows, [&](int y) {
    for (int x = 0; x < truth.depth.cols; ++x) {
      const Vector3f& ray = rays.centre(x, y);
      const Vector3f direction = R_wc * ray;
      const RayHit hit = world.caster.cast(origin, direction);
      if (!hit.found()) continue;
      truth.depth.at<float>(y, x) = hit.distance * ray.z();
      const Vector3f normal = R_wc.transpose() * world.shading.normal(hit, direction);
      truth.normals.at<cv::Vec3f>(y, x) = {normal.x(), normal.y(), normal.z()};
      truth.labels.at<std::uint8_t>(y, x) = world.label_of[std::size_t(hit.thing)];
      truth.instances.at<std::uint16_t>(y, x) = std::uint16_t(hit.thing + 1);
      truth.planes.at<std::uint16_t>(y, x) = std::uint16_t(world.planes.plane_of(hit) + 1);
    }
  });
}

}  // namespace

FrameTruth render_truth(const TruthSources& world, const Camera& camera, const RayTable& rays,
                        const SE3& T_wc) {
  const cv::Size size(camera.width(), camera.height());
  FrameTruth truth{cv::Mat::zeros(size, CV_32F),
                   cv::Mat::zeros(size, CV_32FC3),
                   cv::Mat::zeros(size, CV_8U),
                   cv::Mat::zeros(size, CV_16U),
                   cv::Mat::zeros(size, CV_16U),
                   {},
                   {}};
  cast_pictures(world, rays, T_wc, truth);

  std::map<int, Growing> seen_things;
  std::map<int, int> seen_planes;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int thing = truth.instances.at<std::uint16_t>(y, x) - 1;
      const int plane = truth.planes.at<std::uint16_t>(y, x) - 1;
      if (thing >= 0 && world.scene.things[std::size_t(thing)].is_object) {
        seen_things[thing].add(x - 0.5, y - 0.5, x + 0.5, y + 0.5);
      }
      if (plane >= 0) ++seen_planes[plane];
    }
  }
  const WideCamera wide(camera);
  const SE3 T_cw = T_wc.inverse();
  for (const auto& [thing, grown] : seen_things) {
    ObjectView view;
    view.thing = thing;
    view.pixels = grown.count;
    view.visible_box = grown.box();
    view.amodal_box = projected_box(world.scene.things[std::size_t(thing)], wide, T_cw);
    const Box2& box = view.amodal_box;
    view.truncated = !wide.is_in_picture({box.x0, box.y0}) || !wide.is_in_picture({box.x1, box.y1});
    truth.objects.push_back(view);
  }
  tbb::parallel_for(std::size_t(0), truth.objects.size(), [&](std::size_t i) {
    ObjectView& view = truth.objects[i];
    view.visible = visible_share(world.caster, view.thing, view.amodal_box, wide, T_wc);
  });
  for (const auto& [index, pixels] : seen_planes) {
    const WorldPlane& plane = world.scene.planes[std::size_t(index)];
    PlaneView view;
    view.plane = index;
    view.parameters.head<3>() = T_cw.rotation() * plane.normal;
    view.parameters[3] = plane.d + plane.normal.dot(T_wc.translation());
    view.pixels = pixels;
    truth.visible_planes.push_back(view);
  }
  return truth;
}

}  // namespace cairn
