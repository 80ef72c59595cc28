#include "cairn/evaluation/evaluation.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cairn/datasets/groundtruth.h"
#include "cairn/geometry/error.h"
#include "cairn/output/frames_csv.h"
#include "commands.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string run, groundtruth, align = "sim3";
  EvaluationOptions options;
  bool json = false;
};

// The ground truth that the run knew of.
std::string remembered_groundtruth(const fs::path& run) {
  std::ifstream file(run / "summary.json");
  const auto summary = nlohmann::json::parse(file, nullptr, false);
  const auto value = summary.is_object() ? summary.value("groundtruth", nlohmann::json()) : nullptr;
  if (value.is_string()) return value.get<std::string>();
  throw Error(Error::Kind::kUsage,
              run.string() + ": this run knows of no ground truth; give --groundtruth FILE");
}

// The times of all pictures, for the coverage; nothing if the run left no record of them.
std::vector<double> frame_times(const fs::path& run) {
  const fs::path file = run / "frames.csv";
  return fs::exists(file) ? read_frame_times(file) : std::vector<double>();
}

int evaluate_run(const Arguments& arguments) {
  const fs::path run = arguments.run;
  if (!fs::exists(run)) {
    throw Error(Error::Kind::kInput,
                run.string() + ": there is no such folder; give the folder that `cairn run` wrote");
  }
  const bool folder = fs::is_directory(run);  // else a trajectory, of cairn or of anything else
  EvaluationOptions options = arguments.options;
  options.alignment = parse_alignment(arguments.align);
  if (!folder && arguments.groundtruth.empty()) {
    throw Error(Error::Kind::kUsage,
                run.string() + ": a trajectory alone needs --groundtruth FILE");
  }
  const std::string truth =
      arguments.groundtruth.empty() ? remembered_groundtruth(run) : arguments.groundtruth;
  const Trajectory estimate = read_groundtruth(folder ? run / "trajectory.txt" : run, "tum");
  const auto times = folder ? frame_times(run) : std::vector<double>();
  const EvaluationReport report = evaluate(read_groundtruth(truth), estimate, options, times);
  if (arguments.json) {
    std::printf("%s\n", to_json(report).dump(2).c_str());
  } else {
    std::printf("%s against %s\n%s", run.c_str(), truth.c_str(), to_table(report).c_str());
  }
  return kDone;
}

}  // namespace

Action add_evaluate(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "evaluate", "Says how far a run is from ground truth: ATE, RPE, coverage, scale");
  command
      ->add_option("run", arguments->run, "the folder that `cairn run` wrote, or a TUM trajectory")
      ->required()
      ->type_name("RUN_DIR");
  command
      ->add_option("--groundtruth", arguments->groundtruth,
                   "true poses; default: those of the sequence")
      ->type_name("FILE");
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
  command->add_flag("--json", arguments->json, "one JSON object in place of the table");
  return [arguments] { return evaluate_run(*arguments); };
}

}  // namespace cairn::app
