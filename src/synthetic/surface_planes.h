#pragma once

#include <vector>

#include "cairn/synthetic/ray_caster.h"
#include "cairn/synthetic/scene.h"

namespace cairn {

/// Which triangles of a world lie on which of its planes.
class SurfacePlanes {
 public:
  /// A triangle is on a plane if it is within a tenth of a millimetre of it, faces its open side
  /// and lies in its outline. `meshes`: of the things, world frame.
  SurfacePlanes(const Scene& scene, const std::vector<Mesh>& meshes);

  /// Index into Scene::planes; -1: none.
  int plane_of(const RayHit& hit) const {
    return hit.found() ? plane_[std::size_t(hit.thing)][hit.triangle] : -1;
  }

 private:
  std::vector<std::vector<std::int16_t>> plane_;  // of thing and triangle
};

}  // namespace cairn
