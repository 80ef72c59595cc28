#include "cairn/optimization/map_adjustment.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "cairn/map/seen_points.h"
#include "cairn/optimization/map_problem.h"
#include "cairn/optimization/odometry_blocks.h"

namespace cairn {
namespace {

constexpr double kGate = 5.991;  // χ², 2 degrees of freedom, 95 %

// What the correction of a lens has to explain of the cost to be believed. Where calibrations are
// exact it explains 0.3 %, by the noise of tracks; where they are not, 3 to 14 %.
constexpr double kLensShare = 0.02;

// Widths of the cores of points' errors in the two fits of the full adjustment. What drifted is far
// from where its points would hold it, so the first is wide; the second trusts those most that
// agree best, as patches that straddle two things, or are smeared, err alike.
constexpr double kFirstWidth = 5, kLastWidth = 0.5;

// Keyframes outside of `free` that see the points, those that see most first.
std::vector<KeyframeId> holders(const Map& map, const std::vector<KeyframeId>& free,
                                const std::vector<PointId>& points, int limit) {
  std::vector<std::pair<int, KeyframeId>> counts;
  for (const PointId p : points) {
    for (const Observation& o : map.points()[p].observations) {
      if (!map.is_corner(o)) continue;
      if (o.keyframe.slot >= counts.size()) counts.resize(o.keyframe.slot + 1);
      ++counts[o.keyframe.slot].first;
      counts[o.keyframe.slot].second = o.keyframe;
    }
  }
  for (const KeyframeId id : free) {
    if (id.slot < counts.size()) counts[id.slot].first = 0;
  }
  std::erase_if(counts, [](const auto& c) { return c.first < 3; });
  std::sort(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  if (static_cast<int>(counts.size()) > limit) counts.resize(limit);
  std::vector<KeyframeId> result;
  result.reserve(counts.size());
  for (const auto& [count, id] : counts) result.push_back(id);
  return result;
}

// All of the map but the first keyframe, which is held; null where there is nothing to adjust.
std::unique_ptr<MapProblem> whole_map(Map& map, const AdjustmentOptions& options, double width,
                                      bool refine_lens, OdometryBlocks& path) {
  std::vector<KeyframeId> free, fixed;
  map.keyframes().for_each(
      [&](KeyframeId id, const Keyframe&) { (id == map.first() ? fixed : free).push_back(id); });
  std::vector<PointId> points;
  map.points().for_each([&](PointId id, const MapPoint&) { points.push_back(id); });
  if (free.empty() || points.empty()) return nullptr;
  auto problem = std::make_unique<MapProblem>(map, std::move(free), std::move(fixed),
                                              std::move(points), options, width, true, refine_lens);
  problem->hold_steps(path);
  return problem;
}

}  // namespace

std::string AdjustmentSummary::to_string() const {
  char text[200];
  std::snprintf(text, sizeof text,
                "%d keyframes, %d points, %d observations (%d wrong): rms %.3f -> %.3f in %d steps",
                keyframes, points, observations, outliers, initial_rms, final_rms, iterations);
  return text;
}

AdjustmentSummary adjust_locally(Map& map, KeyframeId centre, const AdjustmentOptions& options,
                                 const StopAsked& stop) {
  std::vector<KeyframeId> free = {centre};
  for (const auto& [id, shared] : map.covisible(centre, 15, std::max(options.window, 1) - 1)) {
    free.push_back(id);
  }
  std::erase_if(free, [&](KeyframeId id) { return id == map.first() && id != centre; });
  std::vector<PointId> points = points_seen_from(map, free, SeenBy::kCorners);
  std::vector<KeyframeId> fixed = holders(map, free, points, options.fixed);
  // The scale of a monocular map hangs on two poses: hold the two oldest where nothing else does.
  while (fixed.size() < 2 && free.size() > 2) {
    const auto oldest = std::min_element(free.begin(), free.end(), [&](auto a, auto b) {
      return map.keyframes()[a].sequence < map.keyframes()[b].sequence;
    });
    fixed.push_back(*oldest);
    free.erase(oldest);
  }
  MapProblem problem(map, std::move(free), std::move(fixed), std::move(points), options);
  AdjustmentSummary summary = problem.solve(options.local_iterations, 1e-4, stop);
  if (!summary.usable) return summary;
  problem.write_back();
  // A fit that was stopped is no judge of observations.
  if (!summary.stopped) summary.outliers = problem.erase_outliers(kGate);
  return summary;
}

AdjustmentSummary adjust_fully(Map& map, const AdjustmentOptions& options, const StopAsked& stop,
                               OdometryBlocks* path) {
  AdjustmentSummary summary;
  std::optional<OdometryBlocks> now;
  if (path == nullptr) path = &now.emplace(map);
  double initial_rms = 0;
  for (int round = 0; round < 2; ++round) {
    const auto problem =
        whole_map(map, options, round == 0 ? kFirstWidth : kLastWidth, false, *path);
    if (problem == nullptr) return summary;
    const int outliers = summary.outliers;
    summary = problem->solve(options.full_iterations, 1e-7, stop);
    if (round == 0) initial_rms = summary.initial_rms;
    summary.initial_rms = initial_rms;
    if (!summary.usable) return summary;
    problem->keep_unit();
    problem->write_back();
    if (summary.stopped) return summary;
    // The first fit is bent by what is wrong: only what is far off goes.
    summary.outliers = outliers + problem->erase_outliers(round == 0 ? 4 * kGate : kGate);
  }
  return summary;
}

AdjustmentSummary refine_lens(Map& map, const AdjustmentOptions& options, const StopAsked& stop,
                              OdometryBlocks* path) {
  std::optional<OdometryBlocks> now;
  if (path == nullptr) path = &now.emplace(map);
  const auto problem = whole_map(map, options, kLastWidth, true, *path);
  if (problem == nullptr) return {};
  // Mostly there is nothing to explain, and a rough fit says so.
  AdjustmentSummary summary = problem->solve(options.full_iterations, 1e-4, stop);
  const double initial_rms = summary.initial_rms;
  const auto explains = [&](double share) {
    const double left = summary.final_rms / initial_rms;
    return summary.usable && !summary.stopped && left * left < 1 - share;
  };
  if (explains(kLensShare / 2)) summary = problem->solve(options.full_iterations, 1e-7, stop);
  summary.initial_rms = initial_rms;
  summary.usable = explains(kLensShare);
  if (!summary.usable) return summary;
  problem->keep_unit();
  problem->write_back();
  summary.outliers = problem->erase_outliers(kGate);
  return summary;
}

}  // namespace cairn
