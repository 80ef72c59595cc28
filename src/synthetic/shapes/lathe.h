#pragma once

#include <span>
#include <vector>

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// A point of the profile that turns about the z axis. Metres.
struct ProfilePoint {
  float r = 0, z = 0;
  std::uint32_t material = 0;  ///< of the surface from here to the next point
};
using Profile = std::vector<ProfilePoint>;

/// A surface of revolution. The profile runs with the inside of the body on its left: from the axis
/// at the bottom outwards, up, and back to the axis. Shading is smooth where it bends by less than
/// `crease_deg`. Texture: each run of one material is unrolled, u around at its widest radius with
/// the middle of the picture in front, v along the profile from the end of the run.
Mesh lathe(std::span<const ProfilePoint> profile, int segments = 32, float crease_deg = 40);

/// The profile with each of its inner corners rounded where it bends by more than `crease_deg`.
Profile round_profile(std::span<const ProfilePoint> profile, float radius, int steps = 3,
                      float crease_deg = 30);

/// A smooth profile through the points (Catmull-Rom); materials stay with their pieces.
Profile smooth_profile(std::span<const ProfilePoint> profile, int steps);

/// A ball around (0, 0, radius).
Mesh ball(float radius, int segments = 24);

}  // namespace cairn
