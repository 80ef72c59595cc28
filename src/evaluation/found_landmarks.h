#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cairn/evaluation/alignment.h"
#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// An object of a run's map.
struct FoundObject {
  int id = 0;
  std::string class_name;
  double score = 1;
  Ellipsoid ellipsoid;
};

/// A plane of a run's map, `normal · x + d = 0`.
struct FoundPlane {
  int id = 0;
  std::string label;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double d = 0;
  std::vector<Eigen::Vector3d> outline;  ///< corners of a polygon, at least three
};

/// Read what `cairn run` writes, objects.json and planes.json, in the run's world. Throw
/// Error(kInput) where the file cannot be read or holds what cannot be.
std::vector<FoundObject> read_found_objects(const std::filesystem::path& file);
std::vector<FoundPlane> read_found_planes(const std::filesystem::path& file);

/// Into the world of the truth, by the alignment that the trajectory got.
FoundObject aligned(const FoundObject& object, const TrajectoryAlignment& alignment);
FoundPlane aligned(const FoundPlane& plane, const TrajectoryAlignment& alignment);
template <typename Landmark>
std::vector<Landmark> aligned(std::vector<Landmark> landmarks,
                              const TrajectoryAlignment& alignment) {
  for (Landmark& landmark : landmarks) landmark = aligned(landmark, alignment);
  return landmarks;
}

}  // namespace cairn
