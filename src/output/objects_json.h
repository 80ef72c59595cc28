#pragma once

#include <filesystem>
#include <span>

#include "cairn/map/mapped_object.h"

namespace cairn {

/// objects.json: {"objects": [{"id", "class", "score", "center", "rotation", "semi_axes",
/// "covariance", "reference": {"time", "center", "rotation", "semi_axes"}, "points", "sightings",
/// "keyframes", "support"}]}, in the world of the trajectory; rotations [qx, qy, qz, qw] take the
/// ellipsoid's axes to the world, or to the reference keyframe; covariance of the centre, three
/// rows; keyframes as timestamps; support: id in planes.json, or null. Throws Error(kOutput).
void write_objects(const std::filesystem::path& file, std::span<const MappedObject> objects);

}  // namespace cairn
