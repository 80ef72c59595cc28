#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// Where a ray meets a surface first.
struct RayHit {
  static constexpr std::int32_t kNothing = -1;

  float distance = 0;             ///< in lengths of the ray's direction
  std::int32_t thing = kNothing;  ///< index of the mesh
  std::uint32_t triangle = 0;     ///< of that mesh
  float u = 0, v = 0;             ///< barycentric weights of its second and third corner
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< of the triangle; not normalised

  bool found() const { return thing != kNothing; }
};

/// Casts rays into meshes (Embree 3). Results do not depend on how rays are grouped into packets
/// beyond rounding, and never on threads. The meshes are used where they are: they must neither
/// move nor change while the caster lives.
class RayCaster {
 public:
  static constexpr int kPacket = 8;
  struct Packet {
    std::array<Eigen::Vector3f, kPacket> origin, direction;
    std::array<bool, kPacket> active{};
    float nearest = 0;
    bool coherent = true;  ///< about the same way
  };

  explicit RayCaster(std::span<const Mesh> meshes);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// The first surface along the ray, of either side; not found where the ray leaves the scene.
  RayHit cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
              float nearest = 0) const;
  /// Eight rays at once; quick where they are neighbours.
  void cast(const Packet& rays, std::array<RayHit, kPacket>& hits) const;
  /// The first surface of one mesh alone, as if there were nothing else.
  RayHit cast_at(std::int32_t thing, const Eigen::Vector3f& origin,
                 const Eigen::Vector3f& direction) const;
  /// Of the active rays those whose segment, origin to origin + direction, meets nothing.
  std::array<bool, kPacket> free(const Packet& segments) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn
