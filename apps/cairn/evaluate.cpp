#include "cairn/evaluation/evaluation.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cairn/datasets/groundtruth.h"
#include "cairn/evaluation/world_report.h"
#include "cairn/geometry/error.h"
#include "cairn/output/frames_csv.h"
#include "commands.h"
#include "evaluate_depth.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string run, groundtruth, common, world, depth, align = "sim3";
  EvaluationOptions options;
  WorldEvaluationOptions world_options;
  bool json = false;
};

// What the run says of itself; empty if it says nothing.
nlohmann::json read_summary(const fs::path& run) {
  std::ifstream file(run / "summary.json");
  const auto summary = nlohmann::json::parse(file, nullptr, false);
  return summary.is_object() ? summary : nlohmann::json::object();
}

// The ground truth that the user names, or else the run knew of, or else is that of the world.
std::string find_groundtruth(const Arguments& arguments, const nlohmann::json& summary) {
  if (!arguments.groundtruth.empty()) return arguments.groundtruth;
  const fs::path run = arguments.run;
  const auto value = summary.value("groundtruth", nlohmann::json());
  if (value.is_string()) return value.get<std::string>();
  const fs::path beside_world = fs::path(arguments.world).parent_path() / "groundtruth.txt";
  if (!arguments.world.empty() && fs::exists(beside_world)) return beside_world.string();
  throw Error(Error::Kind::kUsage,
              run.string() + ": this run knows of no ground truth; give --groundtruth FILE");
}

// The times of all pictures, for the coverage; nothing if the run left no record of them.
std::vector<double> frame_times(const fs::path& run) {
  const fs::path file = run / "frames.csv";
  return fs::exists(file) ? read_frame_times(file) : std::vector<double>();
}

// What the run says of its own scale. A unit that nobody claims to be a metre cannot be wrong.
void add_claims(const nlohmann::json& summary, EvaluationReport& report) {
  const nlohmann::json scale = summary.value("scale", nlohmann::json());
  if (!scale.is_object()) return;
  if (scale.value("how", "") == "none") report.scale_error.reset();
  const nlohmann::json sigma = scale.value("sigma", nlohmann::json());
  if (sigma.is_number()) report.scale_sigma = sigma.get<double>();
}

// Of a folder that `cairn run` wrote, or of a file by cairn or by anything else.
Trajectory read_estimate(const fs::path& run) {
  return read_groundtruth(fs::is_directory(run) ? run / "trajectory.txt" : run, "tum");
}

Trajectory estimate_of(const Arguments& arguments) {
  Trajectory estimate = read_estimate(arguments.run);
  if (arguments.common.empty()) return estimate;
  estimate = common_poses(estimate, read_estimate(arguments.common));
  if (estimate.empty()) {
    throw Error(Error::Kind::kInput, arguments.common + ": has no frame in common with " +
                                         arguments.run + "; give a run of the same sequence");
  }
  return estimate;
}

int evaluate_run(const Arguments& arguments) {
  const fs::path run = arguments.run;
  if (!fs::exists(run)) {
    throw Error(Error::Kind::kInput,
                run.string() + ": there is no such folder; give the folder that `cairn run` wrote");
  }
  const bool folder = fs::is_directory(run);
  EvaluationOptions options = arguments.options;
  options.alignment = parse_alignment(arguments.align);
  if (!folder && arguments.groundtruth.empty()) {
    throw Error(Error::Kind::kUsage,
                run.string() + ": a trajectory alone needs --groundtruth FILE");
  }
  if (!folder && (!arguments.world.empty() || !arguments.depth.empty())) {
    throw Error(Error::Kind::kUsage,
                run.string() + (arguments.world.empty() ? ": --depth" : ": --world") +
                    " judges what a run mapped; give the folder that `cairn run` wrote");
  }
  const nlohmann::json summary = read_summary(run);
  const std::string truth_file = find_groundtruth(arguments, summary);
  const Trajectory truth = read_groundtruth(truth_file);
  const Trajectory estimate = estimate_of(arguments);
  const auto times = folder ? frame_times(run) : std::vector<double>();
  EvaluationReport report = evaluate(truth, estimate, options, times);
  add_claims(summary, report);
  std::optional<WorldReport> world;
  if (!arguments.world.empty()) {
    WorldEvaluationOptions world_options = arguments.world_options;
    world_options.planes.min_visible_frames = world_options.objects.min_visible_frames;
    world = evaluate_world(arguments.world, run, report.landmark_alignment, world_options);
  }
  std::optional<MeasuredPlaneReport> measured;
  if (!arguments.depth.empty()) {
    measured = evaluate_depth(
        arguments.depth, aligned(read_found_planes(run / "planes.json"), report.landmark_alignment),
        truth, options);
  }
  if (arguments.json) {
    nlohmann::json json = to_json(report);
    if (world) json.update(to_json(*world));
    if (measured) json.update(to_json(*measured));
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    std::printf("%s against %s\n%s", run.c_str(), truth_file.c_str(), to_table(report).c_str());
    if (measured) std::printf("%s", to_table(*measured).c_str());
    if (world) std::printf("%s", to_table(*world).c_str());
  }
  return kDone;
}

void add_world_options(CLI::App& command, Arguments& arguments) {
  command
      .add_option(
          "--world", arguments.world,
          "true objects and planes (world.json of `cairn synth`), to judge those of the run")
      ->type_name("FILE");
  ObjectMetricsOptions& objects = arguments.world_options.objects;
  PlaneMetricsOptions& planes = arguments.world_options.planes;
  const CLI::Validator positive(
      [](std::string& text) {
        double number = 0;
        const bool good = CLI::detail::lexical_cast(text, number) && number > 0;
        return good ? std::string() : text + " is not more than 0";
      },
      "POSITIVE");
  const auto add = [&](const char* name, auto& value, const char* meaning) {
    command.add_option(name, value, meaning)
        ->check(positive)
        ->capture_default_str()
        ->group("With --world");
  };
  add("--min-visible-frames", objects.min_visible_frames,
      "what is well seen in fewer frames cannot be missed");
  add("--min-visible-span", objects.min_visible_span_deg,
      "degrees; an object that is well seen over fewer cannot be missed");
  add("--object-distance", objects.max_centre_distance,
      "metres between the centres of a found and a true object, or its longest semi-axis");
  add("--plane-angle", planes.max_angle_deg, "degrees between a found plane and a true one");
  add("--plane-offset", planes.max_offset,
      "metres from the middle of a found plane to the true one");
  add("--plane-outside", planes.max_outside,
      "metres around the true outline in which half of the found area must lie");
}

}  // namespace

Action add_evaluate(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "evaluate",
      "Says how far a run is from ground truth: ATE, RPE, coverage, scale, objects, planes");
  command
      ->add_option("run", arguments->run, "the folder that `cairn run` wrote, or a TUM trajectory")
      ->required()
      ->type_name("RUN_DIR");
  command
      ->add_option("--groundtruth", arguments->groundtruth,
                   "true poses; default: those of the sequence")
      ->type_name("FILE");
  command
      ->add_option("--common", arguments->common,
                   "another run (or TUM trajectory): judge only the frames that it has, too")
      ->type_name("RUN_DIR");
  command->add_option("--align", arguments->align, "sim3 (default), se3 or none")
      ->check(CLI::IsMember({"sim3", "se3", "none"}));
  command
      ->add_option("--max-difference", arguments->options.max_difference,
                   "seconds between a pose and its ground truth")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--offset", arguments->options.offset, "seconds, added to the run's timestamps")
      ->capture_default_str();
  command
      ->add_option(
          "--depth", arguments->depth,
          "the sequence of the run, of an RGB-D camera, to judge planes by measured depth; "
          "true poses must be those of the colour camera")
      ->type_name("SEQUENCE");
  add_world_options(*command, *arguments);
  command->add_flag("--json", arguments->json, "one JSON object in place of the table");
  return [arguments] { return evaluate_run(*arguments); };
}

}  // namespace cairn::app
