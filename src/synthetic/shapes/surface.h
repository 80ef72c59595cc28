#pragma once

#include <functional>

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// Adds a patch of rows x columns vertices, given by `vertex(row, column)`; seen from outside, with
/// columns running to the right, rows run downwards. Cells without area are left out.
void add_patch(Mesh& mesh, int rows, int columns,
               const std::function<Mesh::Vertex(int row, int column)>& vertex,
               std::uint32_t material = 0);

/// Computes shading normals: smooth over edges that bend less than `crease_deg` degrees and sharp
/// over the others (whose vertices are doubled). Vertices count as one where their positions are
/// the same to the last bit. Leaves out triangles without area.
void shade(Mesh& mesh, float crease_deg = 40);

/// Moves every vertex and shades the surface anew.
void deform(Mesh& mesh, const std::function<Eigen::Vector3f(const Eigen::Vector3f&)>& moved,
            float crease_deg = 40);

/// Texture coordinates as if a picture were projected onto the mesh from above, as read by someone
/// who stands in front (+x): its left upper corner at (x, y), u along +y, v along +x.
void print_from_above(Mesh& mesh, const Eigen::Vector2f& corner_xy);
/// The same from the front: its left upper corner at (y, z), u along +y, v downwards.
void print_from_front(Mesh& mesh, const Eigen::Vector2f& corner_yz);

}  // namespace cairn
