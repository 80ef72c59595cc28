#pragma once

// The simplest meshes, of which rooms and furniture are made.

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// A parallelogram with corners `corner`, `+u`, `+u+v`, `+v`; its outside is where `u x v` points.
/// Texture coordinates are metres along u and v, from `uv` at `corner` on.
void add_quad(Mesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
              const Eigen::Vector3f& v, std::uint32_t material,
              const Eigen::Vector2f& uv = Eigen::Vector2f::Zero());

/// A picture that faces the reader: its texture starts at `left_top`, u along `right`, v along
/// `down`.
void add_picture(Mesh& mesh, const Eigen::Vector3f& left_top, const Eigen::Vector3f& right,
                 const Eigen::Vector3f& down, std::uint32_t material,
                 const Eigen::Vector2f& uv = Eigen::Vector2f::Zero());

/// An axis-parallel box. The texture runs along the longer edge of each face (as the grain of a
/// board does), and the faces show different parts of it.
void add_box(Mesh& mesh, const Eigen::Vector3f& centre, const Eigen::Vector3f& size,
             std::uint32_t material, const Eigen::Vector2f& uv = Eigen::Vector2f::Zero());

/// An upright cylinder or frustum from `base` on, closed above, smooth around.
void add_cylinder(Mesh& mesh, const Eigen::Vector3f& base, float radius, float top_radius,
                  float height, int sides, std::uint32_t material);

}  // namespace cairn
