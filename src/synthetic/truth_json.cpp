#include "cairn/synthetic/truth_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cairn/geometry/parallax.h"
#include "cairn/synthetic/object_truth.h"

namespace cairn {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

constexpr double kEnoughPlane = 0.02;  // of the picture
constexpr int kEnoughPixels = 200;
constexpr double kEnoughShare = 0.25;
constexpr double kAngle = 1e-6;  // of normals that count as parallel or perpendicular

// Six decimals (a micrometre) are enough and keep the file short.
double rounded(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }
Json vector_json(const Vector3d& v) { return {rounded(v.x()), rounded(v.y()), rounded(v.z())}; }

Json points_json(const std::vector<Vector3d>& points) {
  Json list = Json::array();
  for (const Vector3d& X : points) list.push_back(vector_json(X));
  return list;
}

Json box_json(const Box2& box) {
  auto hundredth = [](double value) { return std::round(value * 100) / 100 + 0.0; };
  return {hundredth(box.x0), hundredth(box.y0), hundredth(box.x1), hundredth(box.y1)};
}

const char* name_of(Symmetry symmetry) {
  switch (symmetry) {
    case Symmetry::kHalfTurn:
      return "half_turn";
    case Symmetry::kQuarterTurn:
      return "quarter_turn";
    case Symmetry::kAnyTurn:
      return "any_turn";
    case Symmetry::kNone:
      break;
  }
  return "none";
}

Json planes_json(const Scene& scene, const VisibilityCount& visible) {
  Json list = Json::array();
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const WorldPlane& plane = scene.planes[i];
    list.push_back({{"id", i},
                    {"label", plane.label},
                    {"normal", {plane.normal.x(), plane.normal.y(), plane.normal.z()}},
                    {"d", plane.d},
                    {"visible_frames", visible.of_plane(int(i))},
                    {"outline", points_json(plane.outline)}});
  }
  return list;
}

Json objects_json(const Scene& scene, const VisibilityCount& visible) {
  Json list = Json::array();
  for (const ObjectTruth& truth : object_truths(scene)) {
    const WorldThing& thing = scene.things[std::size_t(truth.thing)];
    Eigen::Quaterniond q = truth.ellipsoid.rotation;
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    Json supported_by = nullptr;
    if (thing.supported_by) supported_by = *thing.supported_by;
    const std::vector<Vector3d>& eyes = visible.of(truth.thing);
    const double span = largest_parallax(eyes, truth.ellipsoid.centre);
    list.push_back({{"id", truth.thing},
                    {"class", thing.model.class_name},
                    {"center", vector_json(truth.ellipsoid.centre)},
                    {"rotation", {q.x(), q.y(), q.z(), q.w()}},
                    {"semi_axes", vector_json(truth.ellipsoid.semi_axes)},
                    {"symmetry", name_of(thing.model.symmetry)},
                    {"axis", vector_json(truth.up)},
                    {"visible_frames", eyes.size()},
                    {"visible_span_deg", std::round(span * 1800 / M_PI) / 10},
                    {"surface_points", points_json(truth.surface_points)},
                    {"supported_by", supported_by}});
  }
  return list;
}

// Pairs of planes whose normals have this cosine, up to sign.
Json pairs_json(const Scene& scene, double cosine) {
  Json list = Json::array();
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.planes.size(); ++j) {
      const double c = std::abs(scene.planes[i].normal.dot(scene.planes[j].normal));
      if (std::abs(c - cosine) < kAngle) list.push_back({i, j});
    }
  }
  return list;
}

}  // namespace

void VisibilityCount::add(const FrameTruth& truth, const Vector3d& eye, double scale) {
  for (const ObjectView& view : truth.objects) {
    if (view.pixels * scale >= kEnoughPixels && view.visible >= kEnoughShare) {
      eyes_[view.thing].push_back(eye);
    }
  }
  for (const PlaneView& view : truth.visible_planes) {
    if (view.pixels >= kEnoughPlane * double(truth.depth.total())) ++plane_frames_[view.plane];
  }
}

int VisibilityCount::of_plane(int plane) const {
  const auto found = plane_frames_.find(plane);
  return found == plane_frames_.end() ? 0 : found->second;
}

const std::vector<Vector3d>& VisibilityCount::of(int thing) const {
  static const std::vector<Vector3d> kNone;
  const auto found = eyes_.find(thing);
  return found == eyes_.end() ? kNone : found->second;
}

std::string world_json(const World& world, const VisibilityCount& visible) {
  const Scene& scene = world.scene();
  Json labels = Json::array();
  for (const std::string& label : world.labels()) labels.push_back(label);
  const Json json = {{"format", "cairn world"},
                     {"version", 1},
                     {"scene", scene.name},
                     {"seed", scene.seed},
                     {"labels", labels},
                     {"planes", planes_json(scene, visible)},
                     {"objects", objects_json(scene, visible)},
                     {"parallel", pairs_json(scene, 1)},
                     {"perpendicular", pairs_json(scene, 0)}};
  return json.dump() + "\n";
}

std::string frame_json(double timestamp, const FrameTruth& truth, const Scene& scene) {
  Json objects = Json::array(), planes = Json::array();
  for (const ObjectView& view : truth.objects) {
    objects.push_back({{"id", view.thing},
                       {"class", scene.things[std::size_t(view.thing)].model.class_name},
                       {"box", box_json(view.visible_box)},
                       {"amodal_box", box_json(view.amodal_box)},
                       {"visible", std::round(view.visible * 1e4) / 1e4},
                       {"truncated", view.truncated}});
  }
  for (const PlaneView& view : truth.visible_planes) {
    const auto& p = view.parameters;
    planes.push_back(
        {{"id", view.plane}, {"plane", {p[0], p[1], p[2], p[3]}}, {"pixels", view.pixels}});
  }
  return Json{{"timestamp", timestamp}, {"objects", objects}, {"planes", planes}}.dump();
}

}  // namespace cairn
