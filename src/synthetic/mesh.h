#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "cairn/synthetic/material.h"

namespace cairn {

/// Triangles with shading normals, texture coordinates and materials. Metres.
struct Mesh {
  struct Vertex {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit, outward
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();       ///< metres on the surface
  };
  /// Counter-clockwise as seen from outside.
  struct Triangle {
    std::uint32_t a = 0, b = 0, c = 0;
    std::uint32_t material = 0;
  };

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Material> materials;

  /// Adds a material and gives its index.
  std::uint32_t add(Material material);
  /// Adds another mesh, moved by `T`; its materials come along.
  void append(const Mesh& other, const Eigen::Isometry3f& T = Eigen::Isometry3f::Identity());
};

}  // namespace cairn
