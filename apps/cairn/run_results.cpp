#include "run_results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cairn/evaluation/evaluation.h"
#include "cairn/geometry/error.h"
#include "cairn/output/atomic_file.h"
#include "cairn/output/ellipsoid_mesh.h"
#include "cairn/output/frames_csv.h"
#include "cairn/output/label_colour.h"
#include "cairn/output/map_ply.h"
#include "cairn/output/objects_json.h"
#include "cairn/output/planes_json.h"
#include "cairn/output/plots.h"
#include "cairn/output/summary.h"
#include "cairn/output/trajectory_file.h"
#include "cairn/system/option_table.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

std::size_t count(const std::vector<FrameRecord>& frames, FrameState state) {
  return std::size_t(std::count_if(frames.begin(), frames.end(),
                                   [&](const FrameRecord& frame) { return frame.state == state; }));
}

nlohmann::json options_json(Options options) {
  const OptionTable table(options);
  nlohmann::json json = nlohmann::json::object();
  for (const auto& key : table.keys()) {
    // Numbers and truth values look alike in JSON and in the table; anything else is a word.
    const auto value = nlohmann::json::parse(table.get(key), nullptr, false);
    json[key] = value.is_discarded() ? nlohmann::json(table.get(key)) : value;
  }
  return json;
}

void write_map(const fs::path& file, const SlamResult& result) {
  Eigen::AlignedBox3d space;
  for (const StampedPose& pose : result.trajectory) space.extend(pose.T_wc.translation());
  // The unit of a map of one camera is arbitrary: what is drawn goes by the size of the path.
  const double size = space.isEmpty() ? 1 : std::max(space.diagonal().norm(), 1e-6);
  PlyModel model;
  for (const auto& point : result.points) model.add_point(point.position, point.colour);
  for (const MappedPlane& plane : result.planes) {
    model.add_polygon(plane.outline, label_colour(plane.label));
  }
  for (const MappedObject& object : result.objects) {
    const TriangleMesh mesh = ellipsoid_mesh(object.ellipsoid);
    model.add_mesh(mesh.vertices, mesh.triangles, label_colour(object.class_name));
  }
  model.add_path(result.trajectory, {230, 60, 40}, 0.002 * size);
  for (const StampedPose& pose : result.keyframes) {
    model.add_camera(pose.T_wc, 0.02 * size, {40, 110, 230});
  }
  model.write(file);
}

// How the path compares with the truth, if the two can be compared.
std::optional<EvaluationReport> compare(const RunDescription& run,
                                        const std::vector<FrameRecord>& frames,
                                        const SlamResult& result) {
  if (!run.groundtruth) return std::nullopt;
  std::vector<double> times;
  times.reserve(frames.size());
  for (const FrameRecord& frame : frames) times.push_back(frame.timestamp);
  try {
    return evaluate(run.groundtruth->trajectory, result.trajectory, {}, times);
  } catch (const Error&) {
    return std::nullopt;  // too few poses; `cairn evaluate` says it
  }
}

PlotScene plot_scene(const RunDescription& run, const SlamResult& result,
                     const std::optional<EvaluationReport>& report) {
  PlotScene scene;
  // With a ground truth all is drawn in its frame and unit.
  const TrajectoryAlignment align = report ? report->alignment : TrajectoryAlignment();
  auto aligned = [&](Trajectory trajectory) {
    for (StampedPose& pose : trajectory) pose.T_wc = align * pose.T_wc;
    return trajectory;
  };
  scene.estimate = aligned(result.trajectory);
  scene.keyframes = aligned(result.keyframes);
  for (const auto& point : result.points) {
    scene.points.push_back(align * point.position);
    scene.point_colours.push_back(point.colour);
  }
  if (report) {
    scene.truth = run.groundtruth->trajectory;
    scene.view = PlanView::from_cameras(scene.truth);
  }
  scene.title = run.name;
  for (const MappedPlane& plane : result.planes) {
    scene.planes.push_back({plane.outline, plane.label, label_colour(plane.label)});
    for (Eigen::Vector3d& corner : scene.planes.back().outline) corner = align * corner;
  }
  for (const MappedObject& object : result.objects) {
    scene.objects.push_back({{align * object.ellipsoid.T, align.scale * object.ellipsoid.semi_axes},
                             object.class_name,
                             label_colour(object.class_name)});
  }
  scene.unit = report || result.scale.known() ? "m" : "map units";
  return scene;
}

void write_plots(const fs::path& folder, const RunDescription& run, const SlamResult& result,
                 const std::optional<EvaluationReport>& report) {
  if (result.trajectory.empty()) return;
  make_output_folder(folder);
  const PlotScene scene = plot_scene(run, result, report);
  write_png(folder / "trajectory.png", draw_trajectory_plot(scene));
  write_png(folder / "map.png", draw_map_plot(scene));
  if (report) {
    std::vector<double> times;
    for (const StampedPose& pose : report->truth) times.push_back(pose.timestamp);
    write_png(folder / "error.png", draw_error_plot(times, report->errors, run.name));
  }
}

RunSummary::Scale describe(const ScaleEstimate& scale) {
  RunSummary::Scale described{
      scale.how, scale.value, scale.sigma > 0 ? std::optional(scale.sigma) : std::nullopt, {}};
  for (const auto& part : scale.parts) {
    described.parts.push_back({part.how, part.value, part.sigma, part.count});
  }
  return described;
}

RunSummary summarize(const RunDescription& run, const std::vector<FrameRecord>& frames,
                     const SlamResult& result, const Playback& playback) {
  RunSummary summary;
  summary.version = CAIRN_VERSION;
  summary.command = run.command;
  summary.options = options_json(run.options);
  summary.seed = run.options.seed;
  summary.sequence = run.sequence;
  summary.layout = run.layout;
  if (run.groundtruth) summary.groundtruth = fs::absolute(run.groundtruth->file).string();
  summary.camera = run.camera.describe() + " (" + run.calibration + ")";
  summary.outcome = playback.interrupted        ? "interrupted"
                    : result.trajectory.empty() ? "no map: " + result.refusal
                                                : "done";
  summary.frames = frames;
  for (const auto& gap : result.gaps) {
    summary.gaps.push_back(
        {gap.lost, std::isnan(gap.recovered) ? std::nullopt : std::optional(gap.recovered)});
  }
  summary.restarts = result.restarts;
  summary.keyframes = result.keyframes.size();
  summary.points = result.points.size();
  summary.planes = result.planes.size();
  summary.objects = result.objects.size();
  summary.scale = describe(result.scale);
  summary.readout = result.readout;
  summary.reprojection = {result.reprojection.median_px, result.reprojection.p75_px,
                          result.reprojection.p95_px, result.reprojection.observations};
  if (!result.refusal.empty()) summary.refusals[result.refusal] = 1;
  summary.object_refusals = result.object_refusals;
  summary.keyframe_times = result.keyframe_times;
  summary.problems = playback.problems;
  return summary;
}

void print_scale(const ScaleEstimate& scale) {
  std::printf("  scale      %8.3f  metres a map unit, %s", scale.value,
              scale.how == "given" ? "as given" : ("from " + scale.how).c_str());
  if (scale.sigma > 0) std::printf(" (+- %.0f %%)", 100 * scale.sigma);
  std::printf("\n");
}

}  // namespace

RunRecorder::RunRecorder(const RunDescription& run, bool video, double fps)
    : run_(run),
      start_(std::chrono::steady_clock::now()),
      film_(video ? std::make_unique<Film>(run.folder, run.camera, fps) : nullptr) {}

void RunRecorder::add(const cv::Mat& image, const FrameResult& result, const Slam& slam) {
  if (film_ && !image.empty()) film_->add(image, result, slam.snapshot().get());
}

void RunRecorder::write(const std::vector<FrameRecord>& frames, const SlamResult& result,
                        const Playback& playback) {
  const fs::path& folder = run_.folder;
  write_trajectory(folder / "trajectory.txt", result.trajectory);
  write_trajectory(folder / "trajectory_live.txt", result.trajectory_live);
  write_trajectory(folder / "keyframes.txt", result.keyframes);
  write_frames_csv(folder / "frames.csv", frames);
  const Landmarks landmarks = run_.options.landmarks;
  if (has_planes(landmarks)) write_planes(folder / "planes.json", result.planes);
  if (has_objects(landmarks)) write_objects(folder / "objects.json", result.objects);
  write_map(folder / "map.ply", result);
  const auto report = compare(run_, frames, result);
  write_plots(folder / "plots", run_, result, report);
  if (film_) film_->finish();

  RunSummary summary = summarize(run_, frames, result, playback);
  if (report) summary.coverage = report->coverage;
  const auto duration = std::chrono::steady_clock::now() - start_;
  summary.duration_s = std::chrono::duration<double>(duration).count();
  // Last: a folder with a summary is a whole one.
  write_summary(folder / "summary.json", summary);
}

void print_outcome(const RunDescription& run, const std::vector<FrameRecord>& frames,
                   const SlamResult& result) {
  const std::size_t tracked = count(frames, FrameState::kTracked);
  const auto stages = stage_times(frames);
  const auto total = stages.find("total");
  std::printf("  frames     %8zu\n", frames.size());
  std::printf("  tracked    %8zu  (%.1f %%)\n", tracked,
              frames.empty() ? 0.0 : 100.0 * double(tracked) / double(frames.size()));
  for (const FrameState state : {FrameState::kLost, FrameState::kSkipped, FrameState::kDropped}) {
    const std::size_t n = count(frames, state);
    if (n > 0) std::printf("  %-10s %8zu\n", std::string(to_string(state)).c_str(), n);
  }
  std::printf("  keyframes  %8zu\n", result.keyframes.size());
  std::printf("  points     %8zu\n", result.points.size());
  const Landmarks landmarks = run.options.landmarks;
  if (has_planes(landmarks)) std::printf("  planes     %8zu\n", result.planes.size());
  if (has_objects(landmarks)) std::printf("  objects    %8zu\n", result.objects.size());
  if (result.scale.known()) print_scale(result.scale);
  if (result.readout != 0) {
    std::printf("  shutter    %8.1f  ms from the first row of a picture to the last\n",
                1000 * result.readout);
  }
  if (total != stages.end()) {
    std::printf("  tracking   %8.1f  ms a frame (median), %.1f ms (95th percentile)\n",
                total->second.median_ms, total->second.p95_ms);
  }
  for (const auto& [name, time] : stage_times(result.keyframe_times)) {
    std::printf("  %-10s %8.1f  ms a keyframe (median), %.1f ms (95th percentile)\n", name.c_str(),
                time.median_ms, time.p95_ms);
  }
  std::printf("  results    %s\n", run.folder.c_str());
}

}  // namespace cairn::app
