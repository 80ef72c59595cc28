#include "cairn/system/options.h"

#include "cairn/system/option_table.h"

namespace cairn {

// One line a key, in the order in which `cairn config` prints them; keys of one group stand
// together.
OptionTable::OptionTable(Options& o) {
  // clang-format off
  add("pace", o.pace, {{"realtime", Pace::kRealtime}, {"lockstep", Pace::kLockstep}}, "realtime: frames at their own rate; lockstep: repeatable to the byte");
  add("landmarks", o.landmarks, {{"ppm", Landmarks::kPpm}, {"pp", Landmarks::kPp}, {"points", Landmarks::kPoints}, {"po", Landmarks::kPo}, {"full", Landmarks::kFull}}, "points; pp: points and planes; ppm: and parallel and perpendicular planes; po: points and objects; full: all, and what stands on what");
  add("threads", o.threads, "threads", {0, 1024}, "threads to work with; 0: all cores");
  add("seed", o.seed, "what all random choices are drawn from");
  add("scale", o.scale, "", {0, 1e9}, "true lengths over those that come out without it; 0: not known");

  add("features.count", o.features.count, "keypoints", {0, 20000}, "keypoints a picture, about; 0: by its size, 1000 for each 640 pixels of width");
  add("features.levels", o.features.levels, "levels", {1, 16}, "levels of the image pyramid");
  add("features.scale", o.features.scale, "", {1.01, 2.0}, "size ratio between two levels of the pyramid");
  add("features.threshold", o.features.threshold, "grey levels", {1, 254}, "FAST: difference that makes a good corner");
  add("features.weak_threshold", o.features.weak_threshold, "grey levels", {1, 254}, "FAST: accepted where a region has no good corner");
  add("features.subpixel", o.features.subpixel, "refine keypoints below the pixel");

  add("initialization.min_matches", o.initialization.min_matches, "keypoints", {20, 5000}, "found in both of the first two pictures of a map");
  add("initialization.min_points", o.initialization.min_points, "points", {20, 5000}, "that a map starts with, at least");
  add("initialization.min_parallax_deg", o.initialization.min_parallax_deg, "degrees", {0.1, 30}, "between the rays to a point of the first two pictures");
  add("initialization.search_radius", o.initialization.search_radius, "pixels", {5, 500}, "how far a keypoint may move from frame to frame");
  add("initialization.max_wait", o.initialization.max_wait, "seconds", {0.1, 60}, "how long a first picture waits for its partner");

  add("tracking.sigma_px", o.tracking.sigma_px, "pixels", {0.1, 10}, "standard deviation of a keypoint of the finest octave");
  add("tracking.min_inliers", o.tracking.min_inliers, "points", {6, 1000}, "that must agree with a pose; with fewer the camera is lost");
  add("tracking.min_prediction_inliers", o.tracking.min_prediction_inliers, "points", {4, 1000}, "of the last frame that must agree with the predicted motion");
  add("tracking.align", o.tracking.align, "move keypoints to where the picture looks as their points did; else they stay where corners were found");
  add("tracking.search_radius", o.tracking.search_radius, "pixels", {2, 200}, "around the place that the motion predicts");
  add("mapping.readout", o.mapping.readout, "seconds", {-0.1, 0.1}, "that the shutter takes from the first row of a picture to the last");
  add("mapping.estimate_readout", o.mapping.adjustment.estimate_readout, "find out how the shutter rolls; else mapping.readout holds");
  add("tracking.relocalize_by_objects", o.tracking.relocalize_by_objects, "find a lost camera by three or more objects of the map where points do not");

  add("mapping.neighbours", o.mapping.neighbours, "keyframes", {1, 100}, "that new points are triangulated with");
  add("mapping.min_parallax_deg", o.mapping.min_parallax_deg, "degrees", {0.1, 30}, "between the rays of a new point");
  add("mapping.match_ratio", o.mapping.match_ratio, "", {0.3, 1}, "of a new point: distance of its descriptor over that of the next best");
  add("mapping.redundancy", o.mapping.redundancy, "", {0.5, 1}, "a keyframe goes when this share of its points is seen by three others");
  add("mapping.refine_lens", o.mapping.refine_lens, "correct at last what the calibration got wrong, where pictures clearly show it");
  add("mapping.window", o.mapping.adjustment.window, "keyframes", {3, 200}, "that a local adjustment moves");
  add("mapping.fixed", o.mapping.adjustment.fixed, "keyframes", {2, 500}, "around them that hold it, at most");
  add("mapping.local_iterations", o.mapping.adjustment.local_iterations, "steps", {1, 100}, "of a local adjustment, at most");
  add("mapping.full_iterations", o.mapping.adjustment.full_iterations, "steps", {1, 500}, "of the full adjustment, at most");
  add("mapping.weigh_landmarks", o.mapping.adjustment.weigh_landmarks, "what lies on planes and things, by how exactly each is seen, in the full adjustment");

  add("perception.every_frame", o.look_at_every_frame, "look at every picture, not only at those of keyframes; tracking waits for the detector");

  PlaneMappingOptions& planes = o.mapping.planes;
  add("planes.th_high", planes.association.th_high, "keypoints", {1, 1000}, "shared by a detected plane and one of the map that make them one");
  add("planes.th_low", planes.association.th_low, "keypoints", {0, 1000}, "shared with none: fewer make a detected plane a new one");
  add("planes.max_angle_deg", planes.association.max_angle_deg, "degrees", {1, 60}, "between the normals of two planes that are one");
  add("planes.max_offset", planes.association.max_offset, "", {0.005, 1}, "between two planes that are one, as a share of the viewing distance");
  add("planes.min_sightings", planes.min_sightings, "pictures", {1, 100}, "that a plane of the final map must have");
  add("planes.point_sigma", planes.association.point_sigma, "", {0.001, 0.2}, "distance of a point that lies on a plane, as a share of the viewing distance");
  add("planes.min_points", planes.min_points, "points", {0, 1000}, "of the map that must lie on it");
  add("planes.max_tilt_sigma_deg", planes.max_tilt_sigma_deg, "degrees", {0.5, 45}, "how sure its normal must be");
  add("planes.min_detected", planes.min_detected, "", {0, 1}, "of the keyframes that see the points of a confirmed plane, share in which it was detected");
  add("planes.min_share", planes.min_share, "", {0, 1}, "of the points in its masks that lie on a confirmed plane");
  add("planes.max_spread", planes.max_spread, "", {0.001, 1}, "of its points off it, as a share of the viewing distance");
  add("planes.few_points", planes.few_points, "points", {0, 10000}, "measured; a keyframe with fewer takes points from planes and predicted depth");
  add("planes.probation", planes.probation, "s", {0.1, 1000}, "after its last sighting within which all this must be reached");

  ObjectMappingOptions& objects = o.mapping.objects;
  add("objects.min_score", o.object_detector.min_score, "", {0, 1}, "of a detection; 0: as the detector's card says");
  add("objects.classes", o.object_detector.classes, "of things that are mapped, by commas; empty: all");
  add("objects.th_high", objects.association.th_high, "points", {1, 1000}, "of an object inside a box that make the two one");
  add("objects.th_low", objects.association.th_low, "points", {0, 1000}, "of any object inside a box: fewer make it a new one");
  add("objects.min_overlap", objects.association.min_overlap, "", {0.05, 0.95}, "IoU of a box and an object's projection where too few points tell");
  add("objects.max_centre", objects.association.max_centre, "", {0.1, 2}, "between a box and an object's projected centre, in half diagonals");
  add("objects.min_views", objects.birth.min_views, "keyframes", {2, 100}, "that show an object before it is born");
  add("objects.min_span_deg", objects.birth.min_span_deg, "degrees", {0.5, 90}, "between directions in which boxes show it that agree");
  add("objects.min_agreeing", objects.birth.min_agreeing, "", {0, 1}, "of its boxes, that its ellipsoid explains");
  add("objects.max_sigma_place", objects.birth.max_sigma_place, "", {0.005, 1}, "of its centre, as a share of its distance");
  add("objects.max_sigma_size", objects.birth.max_sigma_size, "", {0.01, 5}, "of the logarithm of its size");
  add("objects.min_sightings", objects.min_sightings, "pictures", {1, double(ObjectLandmark::kMostObservations)}, "that agree with an object of the final map");
  add("objects.max_missed", objects.max_missed, "pictures", {1, 1000}, "that should have shown an object and did not, at most");
  add("objects.probation", objects.probation, "s", {0.1, 1000}, "after its last sighting that a guess of an object is kept");
  add("objects.max_gap", objects.max_gap, "metres", {0.005, 1}, "between an object and the plane that it stands on");

  PlaneFactorOptions& factors = o.mapping.adjustment.planes;
  add_factor("predicted_depth", factors.predicted_depth, "", {0.01, 100}, "what a picture says of the depth of points, times the sigma that pictures show");
  add_factor("plane_observation", factors.observation, "", {0.01, 100}, "what a picture says of a plane, times the detector's own sigma");
  add_factor("point_on_plane", factors.point_on_plane, "", {0.0005, 0.5}, "a point's distance from its plane, as a share of the viewing distance");
  add_factor("parallel", factors.parallel, "degrees", {0.05, 45}, "angle between two planes that are parallel");
  add_factor("perpendicular", factors.perpendicular, "degrees", {0.05, 45}, "angle between two planes that are perpendicular, from 90");
  add_factor("coplanar", factors.coplanar, "", {0.0005, 0.5}, "distance between two floors that are one, as a share of the viewing distance");
  ObjectFactorOptions& of_objects = o.mapping.adjustment.objects;
  add_factor("object_observation", of_objects.observation, "", {0.01, 100}, "a box and the projection of its object, times the sigma of the box's edges");
  add_factor("object_size", of_objects.size, "", {0.01, 100}, "shape and size of an object, times the sigma of its class");
  add_factor("support", of_objects.support, "metres", {0.001, 1}, "between an object and the plane that it stands on");
  // clang-format on
}

// The three settings that each factor has.
void OptionTable::add_factor(const std::string& name, FactorOptions& factor, const char* unit,
                             Range range, const char* meaning) {
  const std::string group = "factors." + name + ".";
  add((group + "use").c_str(), factor.use, "switches the factor on");
  add((group + "form").c_str(), factor.form,
      {{"robust", FactorForm::kRobust}, {"paper", FactorForm::kPaper}},
      "the residual as the paper has it, or in units of its own");
  add((group + "sigma").c_str(), factor.sigma, unit, range, meaning);
}

}  // namespace cairn
