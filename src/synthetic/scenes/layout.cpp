#include "cairn/synthetic/scenes/layout.h"

#include <opencv2/imgproc.hpp>

#include "cairn/synthetic/primitives.h"

namespace cairn {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

// FNV-1a (Fowler, Noll, Vo).
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325ull;
  for (const char c : text) hash = (hash ^ std::uint8_t(c)) * 0x100000001B3ull;
  return hash;
}

}  // namespace

// The first draw of a seed is far from that of the next one, or neighbours would share a stream.
Layout::Layout(const std::string& name, std::uint64_t seed)
    : sampler_(Sampler(seed).next() ^ hash_of(name)) {
  scene_.name = name;
  scene_.seed = seed;
}

float Layout::uniform(float low, float high) {
  return low + (high - low) * float(sampler_.uniform());
}

int Layout::add_plane(const std::string& label, const std::vector<Vector3f>& outline) {
  WorldPlane plane;
  plane.label = label;
  // Newell's method: right for any polygon.
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    plane.outline.push_back(outline[i].cast<double>());
    normal += outline[i].cast<double>().cross(outline[(i + 1) % outline.size()].cast<double>());
  }
  plane.normal = normal.normalized();
  plane.d = -plane.normal.dot(plane.outline[0]);
  scene_.planes.push_back(std::move(plane));
  return int(scene_.planes.size()) - 1;
}

int Layout::add_surface(const std::string& label, Mesh mesh, const SE3& T_wo,
                        std::optional<int> supported_by) {
  scene_.things.push_back({{label, Symmetry::kNone, std::move(mesh)}, T_wo, false, supported_by});
  return int(scene_.things.size()) - 1;
}

int Layout::add_object(Model model, const SE3& T_wo, std::optional<int> supported_by) {
  static constexpr std::string_view kNoCocoClass[] = {"shelf",  "cabinet", "tree", "door",
                                                      "window", "poster",  "lamp", "floor lamp"};
  const bool known = std::ranges::count(kNoCocoClass, std::string_view(model.class_name)) == 0;
  scene_.things.push_back({std::move(model), T_wo, known, supported_by});
  return int(scene_.things.size()) - 1;
}

void Layout::add_lamp(const Vector3f& centre, const Vector3f& u, const Vector3f& v,
                      const Colour& radiance, const Colour& looks) {
  Mesh mesh;
  Material material;
  material.colour = Colour::Zero();
  material.emission = looks;
  add_quad(mesh, centre - u - v, 2 * u, 2 * v, mesh.add(material));
  add_surface("lamp", std::move(mesh));
  // In front of what is seen, or it would be shaded by it.
  const Vector3f front = u.cross(v).normalized();
  scene_.lights.push_back({centre + 0.02f * front, u, v, radiance});
}

int Layout::add_top(int thing, const std::string& label) {
  const WorldThing& body = scene_.things[std::size_t(thing)];
  float top = -1e9f;
  for (const auto& vertex : body.model.mesh.vertices) top = std::max(top, vertex.position.z());
  std::vector<cv::Point2f> points, hull;
  for (const auto& vertex : body.model.mesh.vertices) {
    if (vertex.position.z() > top - 1e-4f) {
      points.emplace_back(vertex.position.x(), vertex.position.y());
    }
  }
  cv::convexHull(points, hull, false);
  std::vector<Vector3f> outline;
  for (const auto& corner : hull) {
    outline.push_back(
        (body.T_wo * Vector3d(double(corner.x), double(corner.y), double(top))).cast<float>());
  }
  int plane = add_plane(label, outline);
  if (scene_.planes.back().normal.z() < 0) {
    std::reverse(outline.begin(), outline.end());
    scene_.planes.pop_back();
    plane = add_plane(label, outline);
  }
  // Level, not nearly level.
  WorldPlane& level = scene_.planes.back();
  level.normal = Vector3d::UnitZ();
  level.d = -level.outline[0].z();
  return plane;
}

bool Layout::is_free(const Model& model, const SE3& T_wo) const {
  const Eigen::AlignedBox3f wanted = extent(model, T_wo);
  return std::none_of(scene_.things.begin(), scene_.things.end(), [&](const WorldThing& thing) {
    return thing.supported_by && extent(thing.model, thing.T_wo).intersects(wanted);
  });
}

Eigen::AlignedBox3f extent(const Model& model) { return extent(model, SE3()); }

Eigen::AlignedBox3f extent(const Model& model, const SE3& T_wo) {
  Eigen::AlignedBox3f box;
  for (const auto& vertex : model.mesh.vertices) {
    box.extend((T_wo * vertex.position.cast<double>()).cast<float>());
  }
  return box;
}

SE3 standing(const Vector3f& at, float yaw) {
  return SE3(so3_exp(Vector3d(0, 0, double(yaw))), at.cast<double>());
}

Tray::Footprint Tray::footprint(const Model& model, const SE3& T_wo, float margin) {
  Eigen::AlignedBox2f box;
  for (const auto& vertex : model.mesh.vertices) box.extend(vertex.position.head<2>().eval());
  const Vector2f middle = box.center();
  const Vector3d centre = T_wo * Vector3d(double(middle.x()), double(middle.y()), 0);
  const Vector3d axis = T_wo.rotation() * Vector3d::UnitX();
  return {centre.head<2>().cast<float>(), axis.head<2>().cast<float>().normalized(),
          0.5f * box.sizes() + Vector2f::Constant(margin)};
}

// Separating axes: two rectangles are apart if one of their four edge directions shows a gap.
bool Tray::overlap(const Footprint& a, const Footprint& b) {
  const Vector2f between = b.centre - a.centre;
  auto across = [](const Vector2f& axis) { return Vector2f(-axis.y(), axis.x()); };
  auto reach = [&](const Footprint& f, const Vector2f& n) {
    return f.half.x() * std::abs(f.axis.dot(n)) + f.half.y() * std::abs(across(f.axis).dot(n));
  };
  for (const Vector2f& n : {a.axis, across(a.axis), b.axis, across(b.axis)}) {
    if (std::abs(between.dot(n)) > reach(a, n) + reach(b, n)) return false;
  }
  return true;
}

bool Tray::claim(const Model& model, const SE3& T_wo, float margin) {
  const Footprint wanted = footprint(model, T_wo, margin);
  const Vector2f side(-wanted.axis.y(), wanted.axis.x());
  for (int i = 0; i < 4; ++i) {
    const Vector2f corner = wanted.centre + (i & 1 ? 1.f : -1.f) * wanted.half.x() * wanted.axis +
                            (i & 2 ? 1.f : -1.f) * wanted.half.y() * side;
    const Vector2f from = corner - corner_.head<2>();
    const float a = from.dot(u_.head<2>()) / u_.squaredNorm();
    const float b = from.dot(v_.head<2>()) / v_.squaredNorm();
    if (a < 0 || b < 0 || a > 1 || b > 1) return false;
  }
  for (const Footprint& other : taken_) {
    if (overlap(wanted, other)) return false;
  }
  taken_.push_back(wanted);
  return true;
}

std::optional<SE3> Tray::find(const Model& model, Layout& layout, float yaw_low, float yaw_high) {
  for (int i = 0; i < 60; ++i) {
    const Vector3f at = corner_ + layout.uniform(0, 1) * u_ + layout.uniform(0, 1) * v_;
    const SE3 T_wo = standing(at, layout.uniform(yaw_low, yaw_high));
    if (claim(model, T_wo)) return T_wo;
  }
  return std::nullopt;
}

}  // namespace cairn
