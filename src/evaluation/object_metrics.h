#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cairn/evaluation/found_landmarks.h"
#include "cairn/evaluation/world_truth.h"

namespace cairn {

struct ObjectMetricsOptions {
  /// A true object that is well seen in fewer frames can not be missed. (world.json counts frames
  /// in which at least 200 pixels and a quarter of the object are seen.)
  int min_visible_frames = 10;
  /// Nor one that is well seen from directions which differ by less than this.
  double min_visible_span_deg = 15;
  /// Metres. A found and a true object of one class can be the same if their centres are not
  /// farther apart than this or the true one's longest semi-axis, whichever is more ...
  double max_centre_distance = 0.1;
  /// ... and objects of different classes if, besides, their 3D IoU is not below this: a cup on a
  /// table is near the table's centre, but is no table of a wrong class.
  double min_iou_across_classes = 0.1;
};

/// A true object and the one of the map that stands for it.
struct ObjectMatch {
  std::size_t truth = 0, found = 0;  ///< indices into the two lists
  bool wrong_class = false;
  double centre_error = 0;                 ///< metres
  double iou = 0;                          ///< of the two ellipsoids
  std::optional<double> outline_iou = {};  ///< with the ellipsoid that has the true one's outlines
  double axis_error = 0;  ///< mean of |s_found − s_true| / s_true over the three semi-axes
  double rotation = 0;    ///< radians; see compare_shapes
};

/// How many objects are right, and how right they are. Every found object is counted once: as
/// found, ignored, duplicated or false. Every true one that is seen often enough: found or missed.
struct ObjectMetrics {
  std::size_t found = 0;        ///< true objects that have a match, whatever its class
  std::size_t wrong_class = 0;  ///< of those, with another class than the match
  std::size_t missed = 0;       ///< true objects that are seen often enough and have no match
  std::size_t ignored = 0;      ///< matches of true objects that are not seen often enough
  /// Found objects without a match that could be the same as some true object: that one has a
  /// better match already.
  std::size_t duplicated = 0;
  std::size_t false_objects = 0;  ///< found objects that could be no true object
  /// Medians over the found ones, as in ObjectMatch; none where nothing is found.
  std::optional<double> centre_error, iou, outline_iou, axis_error, rotation_deg;
  std::vector<ObjectMatch> matches;  ///< of all true objects, in their order, the ignored ones too
};

/// `found` is aligned with the truth. The one-to-one assignment prefers pairs that are near,
/// overlap and have one class: it minimises the sum of (1 − IoU) + distance / largest distance
/// allowed + [classes differ] over pairs that can be the same; the rest costs 3 a pair.
ObjectMetrics object_metrics(std::span<const TrueObject> truth, std::span<const FoundObject> found,
                             const ObjectMetricsOptions& options = {});

struct ShapeDifference {
  double axis_error = 0;  ///< mean of |s_found − s_true| / s_true over the three semi-axes
  double rotation = 0;    ///< radians
};

/// The axes of an ellipsoid have no names and no signs, so those of the found one are renamed (24
/// ways) and the true object is turned about its axis of symmetry (by what does not change its
/// class) such that axis error + rotation in radians is least; for an object that is the same for
/// any turn, the rotation is that of the axis of symmetry.
ShapeDifference compare_shapes(const TrueObject& truth, const Ellipsoid& found);

}  // namespace cairn
