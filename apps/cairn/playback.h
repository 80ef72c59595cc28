#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cairn/datasets/frame_source.h"
#include "cairn/datasets/sequence.h"
#include "cairn/system/slam.h"

namespace cairn::app {

struct Playback {
  std::size_t frames = 0;         ///< taken from the source
  std::size_t skipped = 0;        ///< could not be used
  std::size_t dropped = 0;        ///< came too late
  std::size_t without_depth = 0;  ///< had no measured depth although it was asked for
  bool interrupted = false;
  std::vector<std::string> problems;  ///< of the first skipped frames, a sentence each
  std::string depth_problem;          ///< of the first frame without depth
};

/// Called after every frame; `image` is empty if the frame was skipped or dropped.
using FrameListener = std::function<void(const cv::Mat& image, const FrameResult& result)>;

/// Gives all frames of the source to `slam`, in lockstep or at the rate at which they were
/// recorded, until the end or an interrupt.
Playback play(FrameSource& source, Slam& slam, Pace pace, const FrameListener& listener);

/// The sequence's camera, or Error(kUsage) that says how to give one.
const Camera& camera_of(const Sequence& sequence, const std::string& what);

}  // namespace cairn::app
