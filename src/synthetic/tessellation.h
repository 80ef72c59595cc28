#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// Splits, once, every edge for which `wanted(i, j)` (vertex indices, i < j) holds, at its middle,
/// and the triangles on it into two, three or four. Where an edge of a triangle is split, so is its
/// longest one: triangles stay as round as they were (Rivara 1984). The shape stays as it is, and
/// neighbours that share vertices stay joined. New vertices come after the old ones; returned is
/// for each the edge that it is the middle of.
std::vector<std::pair<std::uint32_t, std::uint32_t>> split_edges(
    Mesh& mesh, const std::function<bool(std::uint32_t, std::uint32_t)>& wanted);

/// Splits until no edge is longer than `cell` metres.
void tessellate(Mesh& mesh, float cell);

}  // namespace cairn
