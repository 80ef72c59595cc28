#include "cairn/output/map_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "cairn/geometry/polygon.h"
#include "cairn/output/atomic_file.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

template <typename Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), &value, sizeof value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace

void PlyModel::add_point(const Vector3d& position, const Rgb& colour) {
  vertices_.push_back({position.cast<float>(), colour});
}

void PlyModel::add_line(const Vector3d& from, const Vector3d& to, const Rgb& colour, int points) {
  for (int i = 0; i < points; ++i) add_point(from + (to - from) * (double(i) / points), colour);
}

void PlyModel::add_path(const Trajectory& trajectory, const Rgb& colour, double step) {
  constexpr double kMost = 1000;  // points between two cameras
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Vector3d& a = trajectory[i - 1].T_wc.translation();
    const Vector3d& b = trajectory[i].T_wc.translation();
    const double points = std::ceil((b - a).norm() / std::max(step, 1e-9));
    add_line(a, b, colour, int(std::clamp(points, 1.0, kMost)));
  }
  if (!trajectory.empty()) add_point(trajectory.back().T_wc.translation(), colour);
}

void PlyModel::add_camera(const SE3& T_wc, double depth, const Rgb& colour) {
  constexpr int kPoints = 12;  // an edge
  std::array<Vector3d, 4> corners;
  const std::array<Vector3d, 4> directions = {Vector3d(-0.5, -0.375, 1), Vector3d(0.5, -0.375, 1),
                                              Vector3d(0.5, 0.375, 1), Vector3d(-0.5, 0.375, 1)};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = T_wc * (depth * directions[i]);
  for (std::size_t i = 0; i < 4; ++i) {
    add_line(T_wc.translation(), corners[i], colour, kPoints);
    add_line(corners[i], corners[(i + 1) % 4], colour, kPoints);
  }
}

void PlyModel::add_polygon(std::span<const Vector3d> corners, const Rgb& colour) {
  if (corners.size() < 3) return;
  const Vector3d normal = twice_area(corners);
  const Vector3d u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
  std::vector<Eigen::Vector2f> flat;
  for (const Vector3d& corner : corners) {
    flat.emplace_back(float(u.dot(corner - corners[0])), float(v.dot(corner - corners[0])));
  }
  // Viewers take a face for a fan.
  add_mesh(corners, polygon_triangles(flat), colour);
}

void PlyModel::add_mesh(std::span<const Vector3d> vertices,
                        std::span<const Eigen::Vector3i> triangles, const Rgb& colour) {
  const auto first = std::int32_t(vertices_.size());
  for (const Vector3d& vertex : vertices) add_point(vertex, colour);
  for (const Eigen::Vector3i& t : triangles) {
    faces_.push_back(t.array() + first);
  }
}

void PlyModel::write(const std::filesystem::path& file) const {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment cairn map, metres, world = first keyframe\n"
      "element vertex " +
      std::to_string(vertices_.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
      "green\nproperty uchar blue\n";
  // Without faces the file says so by silence: viewers then show it as a cloud.
  if (!faces_.empty()) {
    bytes += "element face " + std::to_string(faces_.size()) +
             "\nproperty list int int vertex_indices\n";
  }
  bytes += "end_header\n";
  for (const Vertex& vertex : vertices_) {
    for (const float value : vertex.position) append(bytes, value);
    for (const unsigned char value : vertex.colour) append(bytes, value);
  }
  for (const auto& face : faces_) {
    append(bytes, std::int32_t(face.size()));
    for (const int index : face) append(bytes, std::int32_t(index));
  }
  write_file(file, bytes);
}

}  // namespace cairn
