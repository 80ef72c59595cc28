#pragma once

#include "cairn/synthetic/frame_truth.h"
#include "cairn/synthetic/ray_table.h"
#include "cairn/synthetic/shading.h"
#include "cairn/synthetic/surface_planes.h"

namespace cairn {

/// What truth is rendered from; the parts of a World.
struct TruthSources {
  const Scene& scene;
  const RayCaster& caster;
  const Shading& shading;
  const SurfacePlanes& planes;
  const std::vector<std::uint8_t>& label_of;  ///< of thing
};

/// The truth about a picture from `T_wc`, one ray through the centre of each pixel.
FrameTruth render_truth(const TruthSources& world, const Camera& camera, const RayTable& rays,
                        const SE3& T_wc);

}  // namespace cairn
