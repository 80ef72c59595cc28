#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/features2d.hpp>

#include "bench_ellipsoids.h"
#include "bench_landmarks.h"
#include "bench_memory.h"
#include "cairn/datasets/sequence.h"
#include "cairn/geometry/error.h"
#include "cairn/geometry/median.h"
#include "cairn/map/stopwatch.h"
#include "cairn/output/summary.h"
#include "commands.h"
#include "interrupt.h"
#include "playback.h"
#include "table_name.h"
#include "world_frames.h"

namespace cairn::app {
namespace {

constexpr int kWidePicture = 1000;  // pixels; wider ones get twice the features

struct Arguments {
  std::string subject;
  std::vector<std::string> data;
  std::string groundtruth, planes;
  int seeds = 1;
  bool json = false;
};

// Times of the tracked frames of one sequence.
struct Times {
  std::string sequence;
  int features = 0;
  std::size_t frames = 0;
  std::vector<FrameRecord> tracked;
  std::vector<double> orb_ms;

  StageTime stage(const std::string& name) const {
    const auto stages = stage_times(tracked);
    const auto found = stages.find(name);
    return found == stages.end() ? StageTime{} : found->second;
  }
  double orb_median() const {
    std::vector<double> times = orb_ms;
    return times.empty() ? 0 : median(times);
  }
  double ratio() const { return orb_ms.empty() ? 0 : stage("total").median_ms / orb_median(); }
};

// OpenCV's own ORB on the same picture, on one thread, as the yardstick of this machine.
double time_orb(cv::ORB& orb, const cv::Mat& image) {
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  const Stopwatch watch;
  orb.detectAndCompute(image, cv::noArray(), keypoints, descriptors);
  const double ms = watch.milliseconds();
  cv::setNumThreads(threads);
  return ms;
}

void time_tracking(FrameSource& source, const Camera& camera, std::uint64_t seed, Times& times) {
  Options options;
  options.pace = Pace::kLockstep;
  options.seed = seed;
  options.features.count = times.features = camera.width() > kWidePicture ? 2000 : 1000;
  const auto orb = cv::ORB::create(times.features);
  Slam slam(camera, options);
  play(source, slam, options.pace, [&](const cv::Mat& image, const FrameResult& result) {
    ++times.frames;
    const FrameRecord& record = result.record;
    if (record.state != FrameState::kTracked) return;
    times.tracked.push_back(record);
    times.orb_ms.push_back(time_orb(*orb, image));
  });
}

Times time_sequence(const std::string& data, int seeds) {
  Times times;
  times.sequence = data.empty() ? "synthetic desk" : data;
  for (int seed = 0; seed < seeds && !interrupted(); ++seed) {
    if (data.empty()) {
      const World world(make_scene(SceneKind::kDesk, 0));
      const Camera camera = default_camera(SceneKind::kDesk, 640, 480, true);
      RenderOptions options;
      options.samples = 1;  // one ray a pixel is enough to track on
      WorldFrames frames(world, camera, options);
      time_tracking(frames, camera, std::uint64_t(seed), times);
    } else {
      const Sequence sequence = open_sequence(data);
      time_tracking(*sequence.frames, camera_of(sequence, data), std::uint64_t(seed), times);
    }
  }
  return times;
}

nlohmann::json to_json(const Times& times) {
  nlohmann::json stages;
  for (const auto& [name, time] : stage_times(times.tracked)) {
    stages[name] = {{"median_ms", time.median_ms}, {"p95_ms", time.p95_ms}};
  }
  return {{"sequence", times.sequence},
          {"features", times.features},
          {"frames", times.frames},
          {"tracked", times.tracked.size()},
          {"tracking_median_ms", times.stage("total").median_ms},
          {"tracking_p95_ms", times.stage("total").p95_ms},
          {"orb_median_ms", times.orb_median()},
          {"ratio", times.ratio()},
          {"stages", stages}};
}

void print_table(const std::vector<Times>& rows) {
  std::printf(
      "milliseconds a tracked frame, median / 95th percentile; ratio: tracking over "
      "cv::ORB on one thread\n\n");
  std::printf("%-24s %9s  %13s  %13s  %13s  %13s  %8s  %5s\n", "sequence", "tracked", "extract",
              "predict", "local map", "tracking", "cv::ORB", "ratio");
  for (const Times& t : rows) {
    auto cell = [&](const char* stage) {
      char text[32];
      const StageTime time = t.stage(stage);
      std::snprintf(text, sizeof text, "%.2f / %.2f", time.median_ms, time.p95_ms);
      return std::string(text);
    };
    const std::string tracked = std::to_string(t.tracked.size()) + "/" + std::to_string(t.frames);
    std::printf("%-24s %9s  %13s  %13s  %13s  %13s  %8.2f  %5.2f\n", table_name(t.sequence).c_str(),
                tracked.c_str(), cell("extract").c_str(), cell("predict").c_str(),
                cell("local_map").c_str(), cell("total").c_str(), t.orb_median(), t.ratio());
  }
}

int bench_tracking(const Arguments& arguments) {
  const auto data = arguments.data.empty() ? std::vector<std::string>{""} : arguments.data;
  std::vector<Times> rows;
  for (const auto& sequence : data) {
    if (!interrupted()) rows.push_back(time_sequence(sequence, arguments.seeds));
  }
  if (arguments.json) {
    nlohmann::json json{{"subject", "tracking"}, {"rows", nlohmann::json::array()}};
    for (const Times& times : rows) json["rows"].push_back(to_json(times));
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(rows);
  }
  if (interrupted()) return kInterrupted;
  const bool tracked =
      std::all_of(rows.begin(), rows.end(), [](auto& t) { return !t.tracked.empty(); });
  if (!tracked) std::fprintf(stderr, "cairn: a sequence gave no map, so its row is empty\n");
  return tracked ? kDone : kNoMap;
}

}  // namespace

Action add_bench(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "bench", "Prints repeatable tables of speed, memory and sets of landmarks");
  command->add_option("subject", arguments->subject, "what to measure")
      ->required()
      ->check(CLI::IsMember({"tracking", "memory", "landmarks", "ellipsoids"}));
  command
      ->add_option("--data", arguments->data, "a sequence, repeatable; default: the synthetic desk")
      ->type_name("PATH")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--groundtruth", arguments->groundtruth,
                   "of landmarks: true poses in place of those of the sequence")
      ->type_name("FILE");
  command
      ->add_option("--planes", arguments->planes,
                   "of landmarks: where planes of the sequences come from; default: recorded where "
                   "there is a recording, else network")
      ->check(CLI::IsMember({"network", "rgbd", "recorded"}));
  const CLI::Option* given_seeds =
      command
          ->add_option("--seeds", arguments->seeds,
                       "runs a sequence, each with another seed; of ellipsoids trials a row, " +
                           std::to_string(kEllipsoidTrials) + " where not given")
          ->check(CLI::Range(1, 1000))
          ->capture_default_str();
  command->add_flag("--json", arguments->json, "one JSON object in place of the table");
  return [arguments, given_seeds] {
    const auto& [subject, data, groundtruth, planes, seeds, json] = *arguments;
    remember_interrupts();
    if (!groundtruth.empty() && (subject != "landmarks" || data.size() != 1)) {
      throw Error(Error::Kind::kUsage,
                  "--groundtruth: is for `bench landmarks` of one sequence, --data PATH");
    }
    if (!planes.empty() && (subject != "landmarks" || data.empty())) {
      throw Error(
          Error::Kind::kUsage,
          "--planes: is for `bench landmarks` of sequences, --data PATH; those of synthetic "
          "worlds are simulated");
    }
    if (subject == "ellipsoids") {
      if (!data.empty()) {
        throw Error(Error::Kind::kUsage,
                    "--data: `bench ellipsoids` is a simulation; leave it out");
      }
      return bench_ellipsoids(given_seeds->count() > 0 ? seeds : kEllipsoidTrials, json);
    }
    if (subject == "tracking") return bench_tracking(*arguments);
    if (subject == "landmarks") return bench_landmarks(data, groundtruth, planes, seeds, json);
    if (data.empty()) {
      throw Error(Error::Kind::kUsage, "bench memory: which sequence? Give --data PATH");
    }
    return bench_memory(data, seeds, json);
  };
}

}  // namespace cairn::app
