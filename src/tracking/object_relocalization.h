#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cairn/geometry/ellipsoid.h"
#include "cairn/geometry/se3.h"
#include "cairn/map/frame.h"
#include "cairn/map/object_landmark.h"

namespace cairn {

/// A thing whose place is known.
struct KnownObject {
  Ellipsoid ellipsoid;  ///< world
  std::string class_name;
};

struct ObjectRelocalizationOptions {
  int max_triples = 4000;     ///< threes of detections as threes of things that are tried, at most
  double min_overlap = 0.3;   ///< IoU of a detection and the projection of what it shows
  double different_deg = 15;  ///< poses are two answers if they differ by so much,
  double different_share = 0.2;  ///< or by this share of the distance of the things
  double rival = 0.9;  ///< of the best answer's overlap, with which another one makes both unsure
  double loss = 4;     ///< of a box, in σ (Cauchy)
  int max_steps = 20;  ///< of the refinement
};

/// Where a camera is that sees known things.
struct ObjectRelocalization {
  SE3 T_cw;
  std::vector<int> thing;  ///< a detection: index into the known ones, or -1
  int agreeing = 0;        ///< detections that show a known thing
  double overlap = 0;      ///< sum of their IoU
  /// More than chance could bring about: four things agree, or three closely that can be no others.
  bool certain = false;
};

/// The pose of a camera from the boxes of three or more known things: P3P on the centres of three
/// whole boxes, for all threes that the classes allow; the one by which most boxes are where
/// they should be, one thing a box; Levenberg and Marquardt's method on their edges. None where too
/// few agree, where most of what should be in the picture is not seen, and where a different pose
/// explains it nearly as well. Deterministic. Reference: docs/objects.md, "Relocalisation by
/// objects".
std::optional<ObjectRelocalization> relocalize_by_objects(
    std::span<const SeenObject> seen, std::span<const KnownObject> known, const View& view,
    const ObjectRelocalizationOptions& options = {});

}  // namespace cairn
