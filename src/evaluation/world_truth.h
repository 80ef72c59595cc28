#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// Turned by which angle about its `axis` a thing looks the same.
enum class TurnSymmetry { kNone, kHalfTurn, kQuarterTurn, kAnyTurn };

/// A true object, in the world frame of groundtruth.txt.
struct TrueObject {
  int id = 0;
  std::string class_name;
  Ellipsoid ellipsoid;  ///< the smallest that encloses it
  /// The one that has its outlines, where points of its surface are known: see outline_ellipsoid.
  std::optional<Ellipsoid> outlines = {};
  TurnSymmetry symmetry = TurnSymmetry::kNone;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, of the symmetry
  int visible_frames = 0;                           ///< in which it is well seen
  /// Largest angle between directions from which it is; without, it counts as seen from all sides.
  double visible_span_deg = 180;
};

/// A true plane, `normal · x + d = 0`.
struct TruePlane {
  int id = 0;  ///< of its first part
  std::string label;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double d = 0;
  /// Corners of polygons, at least three each: planes that go on in each other, as the fronts of a
  /// row of houses, are one.
  std::vector<std::vector<Eigen::Vector3d>> parts;
  /// In which a part of it is well seen; where world.json says nothing, it counts as always seen.
  int visible_frames = std::numeric_limits<int>::max();
};

/// What evaluation needs of world.json (docs/synthetic.md has the schema).
struct WorldTruth {
  std::vector<TrueObject> objects;
  std::vector<TruePlane> planes;
};

/// Throws Error(kInput) where the file cannot be read or holds what cannot be.
WorldTruth read_world(const std::filesystem::path& file);

}  // namespace cairn
