#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "cairn/geometry/trajectory.h"

namespace cairn {

/// Red, green, blue.
using Rgb = Eigen::Matrix<unsigned char, 3, 1>;

/// A coloured model in the world frame, metres, for MeshLab, CloudCompare and Blender. Lines are
/// drawn as rows of points, which all of them show.
class PlyModel {
 public:
  void add_point(const Eigen::Vector3d& position, const Rgb& colour);
  /// A line from camera to camera, with a point at least every `step` metres.
  void add_path(const Trajectory& trajectory, const Rgb& colour, double step);
  /// The pyramid that a camera sees, `depth` metres deep, half as wide as that.
  void add_camera(const SE3& T_wc, double depth, const Rgb& colour);
  /// Corners in order; filled. May be concave.
  void add_polygon(std::span<const Eigen::Vector3d> corners, const Rgb& colour);
  /// A closed surface, of triangles of indices into `vertices`.
  void add_mesh(std::span<const Eigen::Vector3d> vertices,
                std::span<const Eigen::Vector3i> triangles, const Rgb& colour);

  std::size_t vertex_count() const { return vertices_.size(); }
  std::size_t face_count() const { return faces_.size(); }

  /// Binary PLY, little endian. Throws Error(kOutput).
  void write(const std::filesystem::path& file) const;

 private:
  struct Vertex {
    Eigen::Vector3f position;
    Rgb colour;
  };
  void add_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Rgb& colour,
                int points);

  std::vector<Vertex> vertices_;
  std::vector<Eigen::Vector3i> faces_;  // triangles
};

}  // namespace cairn
