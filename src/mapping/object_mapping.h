#pragma once

#include <map>
#include <string>

#include "cairn/association/object_association.h"
#include "cairn/map/map.h"
#include "cairn/mapping/keyframe_perception.h"
#include "cairn/mapping/object_birth.h"

namespace cairn {

struct ObjectMappingOptions {
  bool supports = false;  ///< what stands on which plane is found and bound
  int min_sightings = 5;  ///< pictures that agree with an object of the final map
  double probation = 8;   ///< seconds after its last sighting within which a guess must be born
  int max_missed = 6;     ///< pictures that should have shown an object and did not, until it goes
  double max_gap = 0.05;  ///< metres between a thing and the plane that it stands on
  ObjectAssociationOptions association;
  ObjectBirthOptions birth;
};

/// Takes the things of a keyframe's picture into the map: decides which they are, lets guesses be
/// born once their boxes say where and how large they are, fuses, lets die. `refusals` counts by
/// reason what could not be born.
void map_objects(Map& map, KeyframeId keyframe, const KeyframePerception& seen,
                 const ObjectMappingOptions& options, std::map<std::string, int>& refusals);

/// At the end: objects are fitted anew to all their boxes, and those that do not hold go. What they
/// stand on is to be found anew (find_supports).
void settle_objects(Map& map, const ObjectMappingOptions& options);

}  // namespace cairn
