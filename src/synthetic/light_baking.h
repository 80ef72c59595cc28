#pragma once

// Worlds do not move, so the light that falls on them is worked out once: soft shadows, one bounce
// and ambient occlusion per vertex of a mesh that is refined where the light changes. A picture
// then costs rays to the first surface only, and has no noise but the camera's.

#include <vector>

#include "cairn/synthetic/mip_map.h"
#include "cairn/synthetic/scene.h"

namespace cairn {

struct BakeOptions {
  float cell = 0.16f;          ///< metres, the longest edge before refinement
  float finest_cell = 0.012f;  ///< metres, no edge is split into shorter ones
  float contrast = 0.07f;      ///< share of the light by which the ends of an edge may differ
  float openness = 0.5f;  ///< metres to the next surface at which half the ambient light is left
};

/// Meshes in the world frame and the light that falls on their vertices: irradiance over pi, so
/// that times the albedo it is what a diffuse surface sends to the eye.
struct LitMeshes {
  std::vector<Mesh> meshes;
  std::vector<std::vector<Colour>> light;  ///< of mesh and vertex
};

/// Lights a scene. `meshes`: of its things, in the world frame. Parallel; the result does not
/// depend on the number of threads.
LitMeshes bake_light(const Scene& scene, std::vector<Mesh> meshes, const BakeOptions& options);

}  // namespace cairn
