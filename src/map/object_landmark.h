#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/box.h"
#include "cairn/geometry/ellipsoid.h"
#include "cairn/map/ids.h"

namespace cairn {

/// A thing as one picture shows it, at pixels of the ideal pinhole camera.
struct SeenObject {
  Box2 box;
  /// Left, top, right, bottom: the picture's border cuts the thing off there, so that the edge of
  /// the box is not one of the thing.
  std::array<bool, 4> cut{};
  double sigma = 2;  ///< of an edge, pixels
  std::string class_name;
  double score = 1;                      ///< 0 to 1
  std::vector<std::uint32_t> keypoints;  ///< of the keyframe, inside the box
  std::optional<int> thing;              ///< which it is in truth; only a simulator knows

  bool is_cut() const { return cut[0] || cut[1] || cut[2] || cut[3]; }
};

/// A picture's view of an object, as the factors need it.
struct ObjectObservation {
  KeyframeId keyframe;
  Box2 box;
  std::array<bool, 4> cut{};
  double sigma = 2;  ///< of an edge, pixels
  double score = 1;
  double time = 0;  ///< seconds
  /// The keyframe that saw it is gone; the camera of its picture hangs on another one.
  bool buried = false;
  SE3 T_kc = {};  ///< of the picture's camera to the keyframe
};

/// What a thing shares with others of its class, as far as its boxes agree. Nothing: the name is a
/// mistake, or only a part of it is seen (of a chair behind a table its back).
enum class Likeness { kNothing, kSize, kSizeAndShape };

/// A thing of the map: a bounded dual quadric, relative to the keyframe that saw it first (the
/// paper, sections III.A and III.C).
struct ObjectLandmark {
  KeyframeId reference;
  Ellipsoid ellipsoid;                               ///< in the reference's frame, map units
  std::map<std::string, double> votes = {};          ///< for each class: sum of scores
  std::map<int, int> things = {};                    ///< how often it was which in truth
  std::vector<ObjectObservation> observations = {};  ///< one a picture, the oldest first
  std::vector<PointId> points = {};                  ///< of the map, inside of it
  std::uint32_t sightings = 0;                       ///< pictures that showed it, ever
  std::uint32_t last_seen = 0;  ///< sequence number of the last of them to come
  double last_time = 0;         ///< seconds: when that was
  int missed = 0;  ///< pictures lately that should have shown it and did not, less those that did
  /// It has a place and a size of its own: only then do factors hold it, and it them. Until then it
  /// is a guess, which only says what to look for.
  bool born = false;
  bool confirmed = false;  ///< it belongs into the final map
  Likeness likeness = Likeness::kSize;
  PlaneId support = {};  ///< the plane that it stands on
  /// What its observations are worth: pictures that follow each other err alike.
  double independent = 1;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the centre, reference's frame

  /// Observations that are kept: more say the same again.
  static constexpr std::size_t kMostObservations = 60;

  bool seen_by(KeyframeId keyframe) const;  ///< by its own picture
  /// Takes one more, and lets that one go, of too many, without which those left are most apart in
  /// time: what pictures err that follow each other is alike, and they show one side of the thing.
  void observe(const ObjectObservation& seen);
  /// What `other` has seen is of this one, too; of one picture's two boxes its own stays.
  void take_sightings(const ObjectLandmark& other);
  /// The class that has most votes; of equal ones the first by name.
  const std::string& class_name() const;
  double score() const;  ///< mean of the observations'
};

}  // namespace cairn
