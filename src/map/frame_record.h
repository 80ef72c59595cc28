#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace cairn {

enum class FrameState { kWaiting, kInitialising, kTracked, kLost, kSkipped, kDropped };

inline std::string_view to_string(FrameState state) {
  constexpr std::array<std::string_view, 6> kNames = {"waiting", "initialising", "tracked",
                                                      "lost",    "skipped",      "dropped"};
  return kNames[static_cast<std::size_t>(state)];
}

/// What happened to one frame: a row of frames.csv. Times are milliseconds of the tracking thread.
struct FrameRecord {
  double timestamp = 0;  ///< seconds
  FrameState state = FrameState::kWaiting;
  int matches = 0;          ///< map points matched to keypoints
  int inliers = 0;          ///< of these, agreeing with the pose
  bool keyframe = false;    ///< became a keyframe
  double extract_ms = 0;    ///< features
  double predict_ms = 0;    ///< pose from the motion model or reference keyframe; initialisation
  double local_map_ms = 0;  ///< local map: search and motion-only adjustment
  double total_ms = 0;      ///< everything the frame waited for, mapping not counted
};

/// What keyframes cost beside the tracking of frames: milliseconds of each that went through a
/// stage.
struct KeyframeTimes {
  std::vector<double> perception;  ///< networks, and what is made of their answers
  std::vector<double> insertion;   ///< new points
  std::vector<double> planes;      ///< association, fits, births, fusion
  std::vector<double> objects;     ///< the same
  std::vector<double> adjustment;  ///< of the local window
};

}  // namespace cairn
