#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "cairn/synthetic/world.h"

namespace cairn {

/// Counts, over the frames of a sequence, how often each object and plane is seen well enough to be
/// mapped.
class VisibilityCount {
 public:
  /// `eye`: where the frame was taken; `scale`: how many pixels of the real picture one of the
  /// truth's stands for.
  void add(const FrameTruth& truth, const Eigen::Vector3d& eye, double scale = 1);
  /// From where a thing is well seen, a frame each.
  const std::vector<Eigen::Vector3d>& of(int thing) const;
  /// Frames of which a plane fills a fiftieth at least.
  int of_plane(int plane) const;

 private:
  std::map<int, std::vector<Eigen::Vector3d>> eyes_;
  std::map<int, int> plane_frames_;
};

/// world.json: the schema is in docs/synthetic.md.
std::string world_json(const World& world, const VisibilityCount& visible);
/// A line of truth.jsonl, without its end.
std::string frame_json(double timestamp, const FrameTruth& truth, const Scene& scene);

}  // namespace cairn
