#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/trajectory.h"
#include "cairn/system/slam.h"
#include "film.h"
#include "playback.h"

namespace cairn::app {

struct GroundTruth {
  std::filesystem::path file;
  Trajectory trajectory;
};

/// What was run, for summary.json.
struct RunDescription {
  std::filesystem::path folder;  ///< where results go
  std::string command;           ///< as typed
  std::string sequence, name;    ///< as given, and short
  std::string layout, calibration;
  Camera camera;
  Options options;
  std::optional<GroundTruth> groundtruth;
};

/// Collects what a run leaves behind and writes it.
class RunRecorder {
 public:
  /// `run` must outlive the recorder; `video`: also an annotated video, played at `fps`.
  RunRecorder(const RunDescription& run, bool video, double fps);

  /// For the annotated video; `image` is empty where the frame could not be used.
  void add(const cv::Mat& image, const FrameResult& result, const Slam& slam);
  /// All files. Throws Error(kOutput).
  void write(const std::vector<FrameRecord>& frames, const SlamResult& result,
             const Playback& playback);

 private:
  const RunDescription& run_;
  std::chrono::steady_clock::time_point start_;
  std::unique_ptr<Film> film_;
};

/// The short table at the end, on standard output.
void print_outcome(const RunDescription& description, const std::vector<FrameRecord>& frames,
                   const SlamResult& result);

}  // namespace cairn::app
