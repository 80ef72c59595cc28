#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cairn/map/frame_record.h"

namespace cairn {

/// Milliseconds of one stage over the frames that ran it.
struct StageTime {
  double median_ms = 0, p95_ms = 0;
};

/// The stages extract, predict, local_map and total, over the frames that were processed (not
/// skipped or dropped). A stage that never ran is left out.
std::map<std::string, StageTime> stage_times(std::span<const FrameRecord> frames);

/// The stages perception, insertion, landmarks and adjustment of keyframes, likewise.
std::map<std::string, StageTime> stage_times(const KeyframeTimes& times);

/// Number of frames in each state, under its name; all states are there.
std::map<std::string, std::size_t> frames_by_state(std::span<const FrameRecord> frames);

/// Most memory that the process has held so far, MiB.
double peak_memory_mib();

/// What summary.json says of a run.
struct RunSummary {
  struct Gap {
    double lost = 0;                  ///< seconds: time of the first lost frame
    std::optional<double> recovered;  ///< seconds; none if never
  };
  struct ScalePart {
    std::string how;   ///< predicted depth, object sizes, ...
    double value = 1;  ///< metres a map unit, by this alone
    double sigma = 0;  ///< relative
    int count = 0;     ///< of the pictures or objects that say so
  };
  struct Scale {
    std::string how = "none";      ///< none (free), predicted depth, given, ...
    double value = 1;              ///< metres a map unit
    std::optional<double> sigma;   ///< relative; none where nothing is known of it
    std::vector<ScalePart> parts;  ///< what each source said, where there are several
  };

  struct Reprojection {
    double median_px = 0, p75_px = 0, p95_px = 0;
    std::size_t observations = 0;
  };

  std::string version;
  std::string command;                                ///< as typed
  nlohmann::json options = nlohmann::json::object();  ///< every key with its value
  std::uint64_t seed = 0;
  std::string sequence, layout;
  std::string groundtruth;  ///< file, empty if there is none
  std::string camera;       ///< one line
  std::string outcome;      ///< done, interrupted, or why no map was initialised
  std::vector<FrameRecord> frames;
  KeyframeTimes keyframe_times;
  std::optional<double> coverage;  ///< tracked / with ground truth, or / all where there is none
  std::vector<Gap> gaps;
  int restarts = 0;
  std::size_t keyframes = 0, points = 0, planes = 0, objects = 0;
  double readout = 0;         ///< of a rolling shutter, seconds; 0: it does not roll
  Reprojection reprojection;  ///< of the keyframes' keypoints in the final map
  Scale scale;
  double duration_s = 0;                        ///< wall time of the run, seconds
  std::map<std::string, std::size_t> refusals;  ///< how often, by reason
  std::map<std::string, int> object_refusals;   ///< births of objects that were refused, likewise
  std::vector<std::string> problems;            ///< the first sentences about frames not used
};

nlohmann::ordered_json to_json(const RunSummary& summary);

/// Throws Error(kOutput).
void write_summary(const std::filesystem::path& file, const RunSummary& summary);

}  // namespace cairn
