#pragma once

#include <filesystem>
#include <span>

#include "cairn/map/mapped_plane.h"

namespace cairn {

/// planes.json: {"planes": [{"id", "label", "normal", "d", "outline", "sigma_angle_deg",
/// "points", "sightings", "keyframes", "parallel", "perpendicular", "coplanar"}]}, in the world
/// of the trajectory; normal · x + d = 0; keyframes as timestamps. Throws Error(kOutput).
void write_planes(const std::filesystem::path& file, std::span<const MappedPlane> planes);

}  // namespace cairn
