#pragma once

#include <map>
#include <string>

#include "cairn/synthetic/world.h"

namespace cairn {

/// Counts, over the frames of a sequence, how often each object and plane is seen well enough to be
/// mapped.
class VisibilityCount {
 public:
  /// `scale`: how many pixels of the real picture one of the truth's stands for.
  void add(const FrameTruth& truth, double scale = 1);
  int of(int thing) const;
  /// Frames of which a plane fills a fiftieth at least.
  int of_plane(int plane) const;

 private:
  std::map<int, int> frames_, plane_frames_;
};

/// world.json: the schema is in docs/synthetic.md.
std::string world_json(const World& world, const VisibilityCount& visible);
/// A line of truth.jsonl, without its end.
std::string frame_json(double timestamp, const FrameTruth& truth, const Scene& scene);

}  // namespace cairn
