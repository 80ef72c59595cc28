#pragma once

#include <span>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

struct ObjectAssociationOptions {
  int th_high = 4;           ///< of an object's points inside a box that make the two one
  int th_low = 2;            ///< fewer make a detection a new object
  double min_overlap = 0.3;  ///< IoU of box and projection where too few points tell
  double max_centre = 0.5;   ///< between box and projected centre, in half diagonals of the box
};

/// What a detected thing is: an object of the map, a new one, or neither for certain.
struct ObjectDecision {
  enum class Kind { kKnown, kNew, kUnclear };
  Kind kind = Kind::kNew;
  ObjectId object = {};  ///< where it is known
};

/// One decision a detected thing. The paper's assignment problem (section V.A): c_ij = K - p(b_i,
/// q_j), with p the points of object j that the camera sees inside of box i and K the largest of
/// them; equal costs are told apart by overlap. A pair is accepted from th_high on, where classes
/// are of one family and box and projected centre agree. What is left is assigned by overlap alone,
/// which is how things without texture are known again, and where a box and a thing of any class
/// fill the same place they are one. What is still left is new below th_low, and unclear above, or
/// where it is a part of what the border cuts: a cut box inside of the projection of a known thing
/// of its family, or any inside of a cut one of its family.
std::vector<ObjectDecision> associate_objects(const Map& map, KeyframeId keyframe,
                                              std::span<const SeenObject> seen,
                                              const ObjectAssociationOptions& options);

}  // namespace cairn
