#include "cairn/output/summary.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "cairn/output/atomic_file.h"

namespace cairn {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<StageTime> stage_time(std::vector<double> ms) {
  if (ms.empty()) return std::nullopt;
  std::sort(ms.begin(), ms.end());
  const std::size_t n = ms.size();
  const auto rank = std::size_t(std::ceil(0.95 * double(n)));  // nearest rank
  return StageTime{0.5 * (ms[(n - 1) / 2] + ms[n / 2]), ms[std::max<std::size_t>(rank, 1) - 1]};
}

Json gaps_json(const std::vector<RunSummary::Gap>& gaps) {
  Json list = Json::array();
  for (const auto& gap : gaps) {
    list.push_back({{"lost", gap.lost}, {"recovered", number(gap.recovered)}});
  }
  return list;
}

Json scale_json(const RunSummary::Scale& scale) {
  Json parts = Json::array();
  for (const auto& part : scale.parts) {
    parts.push_back(
        {{"how", part.how}, {"value", part.value}, {"sigma", part.sigma}, {"count", part.count}});
  }
  return {
      {"how", scale.how}, {"value", scale.value}, {"sigma", number(scale.sigma)}, {"parts", parts}};
}

Json stages_json(const std::map<std::string, StageTime>& stages) {
  Json json = Json::object();
  for (const auto& [name, time] : stages) {
    json[name] = {{"median_ms", time.median_ms}, {"p95_ms", time.p95_ms}};
  }
  return json;
}

}  // namespace

std::map<std::string, StageTime> stage_times(std::span<const FrameRecord> frames) {
  constexpr std::pair<const char*, double FrameRecord::*> kStages[] = {
      {"extract", &FrameRecord::extract_ms},
      {"predict", &FrameRecord::predict_ms},
      {"local_map", &FrameRecord::local_map_ms},
      {"total", &FrameRecord::total_ms}};
  std::map<std::string, StageTime> result;
  for (const auto& [name, member] : kStages) {
    std::vector<double> ms;
    for (const FrameRecord& frame : frames) {
      const bool processed =
          frame.state != FrameState::kSkipped && frame.state != FrameState::kDropped;
      if (processed && frame.*member > 0) ms.push_back(frame.*member);
    }
    if (const auto time = stage_time(std::move(ms))) result[name] = *time;
  }
  return result;
}

std::map<std::string, StageTime> stage_times(const KeyframeTimes& times) {
  std::map<std::string, StageTime> result;
  for (const auto& [name, ms] :
       {std::pair{"perception", &times.perception}, std::pair{"insertion", &times.insertion},
        std::pair{"planes", &times.planes}, std::pair{"objects", &times.objects},
        std::pair{"adjustment", &times.adjustment}}) {
    if (const auto time = stage_time(*ms)) result[name] = *time;
  }
  return result;
}

std::map<std::string, std::size_t> frames_by_state(std::span<const FrameRecord> frames) {
  std::map<std::string, std::size_t> counts;
  for (const FrameState state :
       {FrameState::kWaiting, FrameState::kInitialising, FrameState::kTracked, FrameState::kLost,
        FrameState::kSkipped, FrameState::kDropped}) {
    counts[std::string(to_string(state))] = 0;
  }
  for (const FrameRecord& frame : frames) ++counts[std::string(to_string(frame.state))];
  return counts;
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

Json to_json(const RunSummary& summary) {
  const auto states = frames_by_state(summary.frames);
  const std::size_t tracked = states.at("tracked");
  std::optional<double> coverage = summary.coverage;
  if (!coverage && !summary.frames.empty()) {
    coverage = double(tracked) / double(summary.frames.size());
  }
  return {{"version", summary.version},
          {"command", summary.command},
          {"options", summary.options},
          {"seed", summary.seed},
          {"sequence", summary.sequence},
          {"layout", summary.layout},
          {"groundtruth", summary.groundtruth.empty() ? Json(nullptr) : Json(summary.groundtruth)},
          {"camera", summary.camera},
          {"outcome", summary.outcome},
          {"frames", summary.frames.size()},
          {"tracked", tracked},
          {"states", states},
          {"coverage", number(coverage)},
          {"losses", gaps_json(summary.gaps)},
          {"restarts", summary.restarts},
          {"keyframes", summary.keyframes},
          {"points", summary.points},
          {"planes", summary.planes},
          {"objects", summary.objects},
          {"readout_s", summary.readout},
          {"reprojection",
           {{"median_px", summary.reprojection.median_px},
            {"p75_px", summary.reprojection.p75_px},
            {"p95_px", summary.reprojection.p95_px},
            {"observations", summary.reprojection.observations}}},
          {"scale", scale_json(summary.scale)},
          {"stages", stages_json(stage_times(summary.frames))},
          {"keyframe_stages", stages_json(stage_times(summary.keyframe_times))},
          {"duration_s", summary.duration_s},
          {"peak_memory_mib", peak_memory_mib()},
          {"refusals", summary.refusals},
          {"object_refusals", summary.object_refusals},
          {"problems", summary.problems}};
}

void write_summary(const std::filesystem::path& file, const RunSummary& summary) {
  // File names need not be UTF-8; a summary with a replaced character is better than none.
  write_file(file, to_json(summary).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace cairn
