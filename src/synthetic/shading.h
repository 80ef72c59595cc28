#pragma once

#include <map>
#include <vector>

#include "cairn/synthetic/light_baking.h"
#include "cairn/synthetic/mip_map.h"
#include "cairn/synthetic/ray_caster.h"

namespace cairn {

/// What a surface mirrors at one place, for others next to it.
struct Highlight {
  std::int32_t thing = RayHit::kNothing;
  std::uint32_t material = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Colour colour = Colour::Zero();
};

/// The colour of what a ray meets: the baked light times the texture, and what shiny surfaces
/// mirror of lamps and sky.
class Shading {
 public:
  /// Both must live as long as this.
  Shading(const Scene& scene, const LitMeshes& lit);

  /// `direction`: unit, world frame. `pixel`: what a sample covers at a distance of one, in metres.
  /// `nearby`: of another sample of this pixel, and then of this one: highlights are slow, and
  /// smooth within a pixel.
  Colour colour(const RayHit& hit, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                float pixel, Highlight& nearby) const;
  Colour sky(const Eigen::Vector3f& direction) const;
  /// The smooth normal at a hit, unit, on the side of the viewer.
  Eigen::Vector3f normal(const RayHit& hit, const Eigen::Vector3f& direction) const;

 private:
  struct Surface {
    Colour colour, emission;
    const MipMap* texture = nullptr;
    float gloss = 0, shininess = 0;
  };

  Colour mirrored(const Surface& surface, const Eigen::Vector3f& at, const Eigen::Vector3f& normal,
                  const Eigen::Vector3f& direction, const Colour& light) const;

  const Scene& scene_;
  const LitMeshes& lit_;
  std::map<const Texture*, MipMap> textures_;   // only looked up
  std::vector<std::vector<Surface>> surfaces_;  // of thing and material
  float usual_light_ = 1;                       // luminance, mean over all vertices
};

}  // namespace cairn
