#include "bench_landmarks.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cairn/datasets/groundtruth.h"
#include "cairn/datasets/sequence.h"
#include "cairn/evaluation/evaluation.h"
#include "cairn/geometry/error.h"
#include "cairn/geometry/median.h"
#include "cairn/perception/combined_detector.h"
#include "cairn/perception/network_card.h"
#include "cairn/perception/object_detectors.h"
#include "cairn/perception/plane_detectors.h"
#include "cairn/synthetic/perception_simulator.h"
#include "commands.h"
#include "interrupt.h"
#include "perception_choice.h"
#include "playback.h"
#include "progress.h"
#include "table_name.h"
#include "world_frames.h"

namespace cairn::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Set {
  const char* name;
  Landmarks landmarks;
};
constexpr Set kSets[] = {{"points", Landmarks::kPoints},
                         {"pp", Landmarks::kPp},
                         {"ppm", Landmarks::kPpm},
                         {"po", Landmarks::kPo},
                         {"full", Landmarks::kFull}};

std::vector<Set> chosen_sets(bool objects) {
  std::vector<Set> chosen;
  for (const Set& set : kSets) {
    if (objects || !has_objects(set.landmarks)) chosen.push_back(set);
  }
  return chosen;
}

// One set on one sequence: a figure a seed.
struct Row {
  std::string sequence, set;
  std::vector<double> ate, coverage, scale_error;  // NaN where there is none
  // On the frames that both this set and the first one of the sequence (`points`) track: a set that
  // keeps the camera where the other loses it is to be compared where both have it.
  std::vector<double> common_ate, first_ate;
};

// Of those that there are; NaN without any.
double median_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values.empty() ? kNone : median(values);
}

// Of the error of points alone, what is left with the set.
double over_points(const Row& row) { return median_of(row.common_ate) / median_of(row.first_ate); }

double over_points(const std::vector<Row>& rows, const std::string& set) {
  std::vector<double> ratios;
  for (const Row& row : rows) {
    if (row.set == set) ratios.push_back(over_points(row));
  }
  return median_of(ratios);
}

double worst_of(const std::vector<double>& values) {
  double worst = kNone;
  for (const double value : values) worst = std::fmax(worst, value);
  return worst;
}

Trajectory truth_of(const World& world, std::size_t frames) {
  Trajectory truth;
  for (std::size_t i = 0; i < frames; ++i) {
    const double t = double(i) / world.scene().fps;
    truth.push_back({t, world.scene().path(t)});
  }
  return truth;
}

// What networks would say of the world's pictures.
class SimulatedPerception : public PlaneDetector {
 public:
  SimulatedPerception(const World& world, const Camera& camera, std::uint64_t seed)
      : world_(world),
        camera_(camera),
        simulator_(world.scene(), camera, PerceptionNoise(), seed) {}
  DetectedFrame detect(const PerceptionInput& input) override {
    const double t = input.timestamp;
    return simulator_.detect(world_.truth(camera_, world_.scene().path(t)), t);
  }

 private:
  const World& world_;
  const Camera& camera_;
  PerceptionSimulator simulator_;
};

// NaN where too little was tracked to compare.
double ate_of(const Trajectory& truth, const Trajectory& estimate) {
  try {
    return evaluate(truth, estimate).ate.rmse;
  } catch (const Error&) {
    return kNone;
  }
}

// `first`: the path of the first set on the same frames.
void add_figures(const SlamResult& result, const Trajectory& first, const Trajectory& truth,
                 const std::vector<double>& times, Row& row) {
  row.ate.push_back(kNone), row.coverage.push_back(0), row.scale_error.push_back(kNone);
  row.common_ate.push_back(ate_of(truth, common_poses(result.trajectory, first)));
  row.first_ate.push_back(ate_of(truth, common_poses(first, result.trajectory)));
  try {
    const EvaluationReport report = evaluate(truth, result.trajectory, {}, times);
    row.ate.back() = report.ate.rmse;
    row.coverage.back() = report.coverage;
    if (result.scale.how != "none") row.scale_error.back() = report.scale_error.value_or(kNone);
  } catch (const Error&) {  // too little was tracked to compare
  }
}

// All sets see the same frames, one after the other, so that these are made once.
template <class MakeDetector>
void run_sets(const std::vector<Set>& sets, FrameSource& frames, const Camera& camera,
              const Trajectory& truth, std::uint64_t seed, MakeDetector&& detector,
              Progress& progress, std::span<Row> rows) {
  std::vector<std::unique_ptr<Slam>> systems;
  for (const Set& set : sets) {
    Options options;
    options.pace = Pace::kLockstep;
    options.seed = seed;
    options.landmarks = set.landmarks;
    systems.push_back(std::make_unique<Slam>(
        camera, options, set.landmarks == Landmarks::kPoints ? nullptr : detector(set.landmarks)));
  }
  std::vector<double> times;
  SourceFrame frame;
  while (!interrupted() && frames.next(frame)) {
    times.push_back(frame.timestamp);
    for (const auto& slam : systems) {
      if (frame.problem.empty()) {
        slam->process(frame.image, frame.timestamp, frame.depth);
      } else {
        slam->skip(frame.timestamp);
      }
    }
    progress.show(rows[0].sequence + ", seed " + std::to_string(seed));
  }
  if (interrupted()) return;  // half a run is no figure
  Trajectory first;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const SlamResult result = systems[i]->finish();
    if (i == 0) first = result.trajectory;
    add_figures(result, first, truth, times, rows[i]);
  }
}

std::vector<Row> new_rows(const std::string& sequence, const std::vector<Set>& sets) {
  std::vector<Row> rows;
  for (const Set& set : sets) {
    Row& row = rows.emplace_back();
    row.sequence = sequence, row.set = set.name;
  }
  return rows;
}

std::vector<Row> bench_world(SceneKind kind, const std::string& scene, int seeds, bool quiet) {
  const std::vector<Set> all = chosen_sets(true);
  std::vector<Row> rows = new_rows("synthetic " + scene, all);
  const Camera camera = default_camera(kind, 640, 480, true);
  for (int i = 0; i < seeds && !interrupted(); ++i) {
    const auto seed = std::uint64_t(i);
    const World world(make_scene(kind, seed));
    WorldFrames frames(world, camera, default_options(kind));
    Progress progress(!quiet, frames.size());
    run_sets(
        all, frames, camera, truth_of(world, *frames.size()), seed,
        [&](Landmarks) { return std::make_unique<SimulatedPerception>(world, camera, seed); },
        progress, rows);
  }
  return rows;
}

// What a set has need of, from where it is.
class SequencePerception {
 public:
  SequencePerception(const std::string& data, const std::string& planes) {
    planes_.recorded = std::filesystem::path(data) / "perception.jsonl";
    const bool recorded = std::filesystem::exists(planes_.recorded);
    plane_source_ = !planes.empty() ? planes : recorded ? "recorded" : "network";
    if (recorded) {
      object_source_ = "recorded";
    } else if (!find_models(find_card(kObjectsCard)).empty()) {
      object_source_ = kObjectsCard;
    }
  }
  bool has_depth() const { return plane_source_ == "rgbd"; }
  bool has_objects() const { return !object_source_.empty(); }

  std::unique_ptr<PlaneDetector> detector(Landmarks landmarks, const Camera& camera) const {
    std::unique_ptr<PlaneDetector> planes;
    if (has_planes(landmarks)) planes = make_plane_detector(plane_source_, camera, planes_);
    if (!cairn::has_objects(landmarks)) return planes;
    ObjectDetectorSources objects;
    objects.recorded = planes_.recorded;
    return std::make_unique<CombinedDetector>(std::move(planes),
                                              make_object_detector(object_source_, objects));
  }

 private:
  PlaneDetectorSources planes_;
  std::string plane_source_, object_source_;  // of objects: empty where there is none
};

std::vector<Row> bench_data(const std::string& data, const std::string& groundtruth,
                            const std::string& planes, int seeds, bool quiet) {
  const SequencePerception perception(data, planes);
  const std::vector<Set> chosen = chosen_sets(perception.has_objects());
  if (!perception.has_objects()) {
    std::fprintf(stderr,
                 "cairn: %s: no networks are given (CAIRN_MODELS), so po and full are left out\n",
                 data.c_str());
  }
  std::vector<Row> rows = new_rows(data, chosen);
  OpenOptions options;
  options.depth = perception.has_depth();
  for (int seed = 0; seed < seeds && !interrupted(); ++seed) {
    const Sequence sequence = open_sequence(data, options);
    const Camera& camera = camera_of(sequence, data);
    if (groundtruth.empty() && !sequence.groundtruth) {
      throw Error(Error::Kind::kUsage, data + ": has no ground truth; give --groundtruth FILE");
    }
    const Trajectory truth =
        read_groundtruth(groundtruth.empty() ? sequence.groundtruth->string() : groundtruth);
    Progress progress(!quiet, sequence.frames->size());
    run_sets(
        chosen, *sequence.frames, camera, truth, std::uint64_t(seed),
        [&](Landmarks landmarks) { return perception.detector(landmarks, camera); }, progress,
        rows);
  }
  return rows;
}

nlohmann::json to_json(const Row& row) {
  return {{"sequence", row.sequence},
          {"set", row.set},
          {"ate", row.ate},  // NaN is written as null
          {"ate_median", median_of(row.ate)},
          {"over_points", over_points(row)},
          {"coverage", median_of(row.coverage)},
          {"scale_error", median_of(row.scale_error)}};
}

void print_table(const std::vector<Row>& rows) {
  std::printf(
      "ATE in metres after Sim3, median [worst] of the seeds; coverage and error of scale: "
      "median;\nover points: the ratio of the medians, on the frames that points track, too\n\n");
  std::printf("%-24s %-8s %18s %12s %10s %12s\n", "sequence", "set", "ATE", "over points",
              "coverage", "scale error");
  for (const Row& row : rows) {
    char ate[40], ratio[20] = "-", scale[20] = "-";
    std::snprintf(ate, sizeof ate, "%.4f [%.4f]", median_of(row.ate), worst_of(row.ate));
    const double over = over_points(row), error = median_of(row.scale_error);
    if (!std::isnan(over)) std::snprintf(ratio, sizeof ratio, "%.2f", over);
    if (!std::isnan(error)) std::snprintf(scale, sizeof scale, "%.1f %%", 100 * error);
    std::printf("%-24s %-8s %18s %12s %8.1f %% %12s\n", table_name(row.sequence).c_str(),
                row.set.c_str(), ate, ratio, 100 * median_of(row.coverage), scale);
  }
  if (rows.empty() || rows.front().sequence == rows.back().sequence) return;
  std::printf("\n");
  for (const Set& set : kSets) {
    const double ratio = over_points(rows, set.name);
    if (std::isnan(ratio)) continue;
    std::printf("%-24s %-8s %18s %12.2f\n", "median of the sequences", set.name, "", ratio);
  }
}

}  // namespace

int bench_landmarks(const std::vector<std::string>& data, const std::string& groundtruth,
                    const std::string& planes, int seeds, bool json) {
  std::vector<Row> rows;
  const auto add = [&](std::vector<Row> more) {
    rows.insert(rows.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
  };
  if (data.empty()) {
    for (const char* scene : {"desk", "room", "corridor"}) {
      add(bench_world(parse_scene_kind(scene), scene, seeds, json));
    }
  }
  for (const std::string& sequence : data) {
    add(bench_data(sequence, groundtruth, planes, seeds, json));
  }
  std::erase_if(rows, [](const Row& row) { return row.ate.empty(); });  // interrupted before
  if (json) {
    nlohmann::json object{{"subject", "landmarks"}, {"rows", nlohmann::json::array()}};
    for (const Row& row : rows) object["rows"].push_back(to_json(row));
    std::printf("%s\n", object.dump(2).c_str());
  } else {
    print_table(rows);
  }
  return interrupted() ? kInterrupted : kDone;
}

}  // namespace cairn::app
