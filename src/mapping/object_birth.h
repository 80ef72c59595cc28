#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/object_fit.h"

namespace cairn {

struct ObjectBirthOptions {
  int min_views = 4;
  double min_span_deg = 4;    ///< between directions from which boxes show it that agree
  double min_agreeing = 0.6;  ///< share of the views that the fit explains, to be born
  /// Of the centre, as a share of its distance from the cameras; twice as much where points lie.
  double max_sigma_place = 0.15;
  double max_sigma_size = 0.5;  ///< of the logarithm of its size
};

/// What single pictures say of a thing's place: in the keyframe's frame, as far away as the map's
/// points inside of its box, else as its predicted depth, else as a thing of its class and of this
/// size in the picture, else as what else the keyframe sees.
Ellipsoid guess_ellipsoid(const Map& map, const Keyframe& keyframe, const SeenObject& seen);

struct BoxFit {
  ObjectFit fit;  ///< in the reference's frame
  Likeness likeness = Likeness::kSize;
};

/// The fit of all boxes of an object, cameras as the map has them; starts from where it is. Few
/// pictures show all sides of a thing: so it is fitted as a thing of its class that stands or lies
/// as usual, too, and is one if its boxes do not deny it. What was born, and whose boxes then deny
/// even the size of its class, is fitted as something that stands; unless that is somewhat large,
/// which things of its class may be.
BoxFit fit_to_boxes(const Map& map, const ObjectLandmark& landmark);

/// Why a fit is no object; empty if it is one. What was born may have a few more boxes that
/// disagree.
std::string refusal(const Map& map, const ObjectLandmark& landmark, const ObjectFit& fit,
                    const ObjectBirthOptions& options);

/// Takes a fit over, with its covariance.
void accept(ObjectLandmark& landmark, const BoxFit& found);

}  // namespace cairn
