#include <cstdio>
#include <cstdlib>
#include <optional>

#include "cairn/datasets/groundtruth.h"
#include "cairn/datasets/sequence.h"
#include "cairn/geometry/error.h"
#include "cairn/system/option_table.h"
#include "cairn/system/slam.h"
#include "commands.h"
#include "interrupt.h"
#include "output_folder.h"
#include "perception_choice.h"
#include "playback.h"
#include "progress.h"
#include "run_results.h"

namespace cairn::app {
namespace {

struct Arguments {
  std::string sequence, layout = "auto", sensor = "mono";
  std::string recorded;  // empty: beside the sequence
  PerceptionChoice perception;
  std::string pace, threads, seed, scale, camera, calibration, config, out, groundtruth;
  std::vector<std::string> settings;
  bool force = false, no_progress = false, video = false;
};

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(Error::Kind::kUsage, sentence);
}

// What the contract names and this version does not have is refused where someone asks for it.
void check_available(const Arguments& arguments) {
  if (arguments.sensor != "mono") {
    refuse("--sensor " + arguments.sensor +
           ": this version works with one colour camera only; give "
           "--sensor mono");
  }
}

// The file first, then --set, then the options that have a name of their own.
Options read_options(const Arguments& arguments) {
  Options options;
  OptionTable table(options);
  if (!arguments.config.empty()) table.load_yaml(arguments.config);
  for (const auto& setting : arguments.settings) table.set(setting);
  if (!arguments.pace.empty()) table.set("pace", arguments.pace);
  if (!arguments.threads.empty()) table.set("threads", arguments.threads);
  if (!arguments.seed.empty()) table.set("seed", arguments.seed);
  if (!arguments.perception.landmarks.empty()) {
    table.set("landmarks", arguments.perception.landmarks);
  }
  if (!arguments.scale.empty()) {
    table.set("scale", arguments.scale);
    if (!(options.scale > 0)) {
      refuse("--scale " + arguments.scale +
             ": lengths cannot be multiplied by that; give a true length over the same length in "
             "the results of a run without --scale");
    }
  }
  return options;
}

Sequence open(const Arguments& arguments) {
  OpenOptions options;
  options.layout = arguments.layout;
  options.calibration = arguments.calibration;
  options.intrinsics = arguments.camera;
  options.depth = arguments.perception.planes == "rgbd";
  return open_sequence(arguments.sequence, options);
}

std::filesystem::path recording(const Arguments& arguments) {
  if (!arguments.recorded.empty()) return arguments.recorded;
  return std::filesystem::path(arguments.sequence) / "perception.jsonl";
}

// A ground truth that was asked for must be readable; one that lies in the sequence need not.
std::optional<GroundTruth> find_groundtruth(const Arguments& arguments, const Sequence& sequence,
                                            Progress& progress) {
  if (!arguments.groundtruth.empty()) {
    return GroundTruth{arguments.groundtruth, read_groundtruth(arguments.groundtruth)};
  }
  if (!sequence.groundtruth) return std::nullopt;
  try {
    return GroundTruth{*sequence.groundtruth, read_groundtruth(*sequence.groundtruth)};
  } catch (const Error& error) {
    progress.note(std::string("the ground truth is left out of the plots: ") + error.what());
    return std::nullopt;
  }
}

void report_problems(const Playback& playback, Progress& progress) {
  for (const auto& problem : playback.problems) progress.note("skipped " + problem);
  if (playback.skipped > playback.problems.size()) {
    progress.note(std::to_string(playback.skipped - playback.problems.size()) +
                  " more frames were skipped; see frames.csv");
  }
  if (playback.without_depth > 0) {
    progress.note(std::to_string(playback.without_depth) +
                  " frames have no measured depth; the first: " + playback.depth_problem);
  }
  if (playback.dropped > 0) {
    progress.note(std::to_string(playback.dropped) +
                  " frames came too late and were dropped; --pace lockstep takes its time for all");
  }
}

// In realtime the networks see to some keyframes only now; who cut the sequence short does not want
// to wait for that, but for a map that is adjusted. What comes from here on cuts that short, too.
SlamResult finish(Slam& slam, const Arguments& arguments, Playback& playback) {
  using Stage = Slam::Finishing::Stage;
  forget_interrupt();
  std::optional<Progress> looking, adjusting;
  const auto show = [&](const Slam::Finishing& at) {
    const bool adjusts = at.stage == Stage::kAdjusting;
    auto& progress = adjusts ? adjusting : looking;
    if (!progress) {
      progress.emplace(!arguments.no_progress, at.all, adjusts ? "steps at most" : "keyframes");
    }
    progress->show(adjusts ? "adjusting the whole map" : "looking at those that were passed over");
  };
  return slam.finish([&](const Slam::Finishing& at) {
    const bool pressed = interrupted();
    playback.interrupted = playback.interrupted || pressed;
    if (at.stage == Stage::kLooking) {
      if (pressed) forget_interrupt();
      if (playback.interrupted) return false;
    }
    show(at);
    return !pressed;
  });
}

int run(const Arguments& arguments, const std::string& typed) {
  check_available(arguments);
  RunDescription description;
  description.command = typed;
  description.options = read_options(arguments);
  settle_sources(arguments.perception, description.options.landmarks);
  const Sequence sequence = open(arguments);
  const Camera& camera = camera_of(sequence, arguments.sequence);
  description.sequence = arguments.sequence;
  description.name = sequence.name;
  description.layout = sequence.layout;
  description.calibration = sequence.calibration;
  description.camera = camera;

  Progress progress(!arguments.no_progress, sequence.frames->size());
  std::unique_ptr<PlaneDetector> detector = find_detector(
      arguments.perception, recording(arguments), camera, description.options, progress);
  description.groundtruth = find_groundtruth(arguments, sequence, progress);
  description.folder = prepare_output_folder(arguments.out, sequence.name, arguments.force);

  remember_interrupts();
  RunRecorder recorder(description, arguments.video, sequence.fps);
  Slam slam(camera, description.options, std::move(detector));
  Playback playback = play(*sequence.frames, slam, description.options.pace,
                           [&](const cv::Mat& image, const FrameResult& result) {
                             progress.show(result.record);
                             recorder.add(image, result, slam);
                           });
  report_problems(playback, progress);
  if (playback.interrupted) {
    progress.note(
        "interrupted; finishing the map and writing what there is (Ctrl-C again: without "
        "finishing it)");
  }
  const SlamResult result = finish(slam, arguments, playback);
  recorder.write(slam.frames(), result, playback);
  print_outcome(description, slam.frames(), result);
  if (playback.interrupted) return kInterrupted;
  if (!result.trajectory.empty()) return kDone;
  std::fprintf(stderr, "cairn: no map could be initialised: %s\n",
               result.refusal.empty() ? "no frame could be tracked; film textured, still things "
                                        "and move sideways at the start"
                                      : result.refusal.c_str());
  return kNoMap;
}

void add_input_options(CLI::App& command, Arguments& a) {
  command.add_option("sequence", a.sequence, "a folder, a glob of pictures, a video, or camera:0")
      ->required()
      ->type_name("SEQUENCE");
  command.add_option("--layout", a.layout, "how the sequence is laid out")
      ->check(CLI::IsMember({"auto", "tum", "euroc", "kitti", "images", "video", "camera"}))
      ->capture_default_str();
  command.add_option("--sensor", a.sensor, "what filmed it; only mono is there yet")
      ->check(CLI::IsMember({"mono", "stereo", "rgbd"}))
      ->capture_default_str();
  command.add_option("--camera", a.camera, "the lens, in pixels, in place of the layout's")
      ->type_name("fx,fy,cx,cy[,k1,k2,p1,p2[,k3]]");
  command.add_option("--calibration", a.calibration, "the lens, from a calibration file")
      ->type_name("FILE")
      ->excludes("--camera");
  command.add_option("--groundtruth", a.groundtruth, "true poses to draw into the plots")
      ->type_name("FILE");
}

void add_system_options(CLI::App& command, Arguments& a) {
  command
      .add_option("--landmarks", a.perception.landmarks,
                  "what the map is made of: points, points and planes (pp), and Manhattan edges "
                  "(ppm); points and objects (po); all of these (full)")
      ->check(CLI::IsMember({"full", "points", "pp", "ppm", "po"}));
  command
      .add_option("--planes", a.perception.planes,
                  "where planes come from; default: network where the networks are found")
      ->check(CLI::IsMember({"network", "rgbd", "planenet", "recorded", "none"}));
  command
      .add_option("--models", a.perception.models,
                  "the folder of the networks; default: $CAIRN_MODELS")
      ->type_name("DIR");
  command
      .add_option("--perception", a.recorded,
                  "recorded perception; default: perception.jsonl of the sequence")
      ->type_name("FILE");
  command
      .add_option("--record-perception", a.perception.record,
                  "write down what the detectors say, for --perception of a later run")
      ->type_name("FILE");
  command
      .add_option("--planenet-card", a.perception.planenet,
                  "the card of the network of --planes planenet")
      ->type_name("CARD");
  command
      .add_option("--objects", a.perception.objects,
                  "where objects come from: a network's card, recorded, none; default: "
                  "nanodet_plus_m where the networks are found")
      ->type_name("CARD|recorded|none");
  command
      .add_option("--pace", a.pace,
                  "realtime (default): at the sequence's own rate; lockstep: "
                  "all frames, repeatable to the byte")
      ->type_name("realtime|lockstep");
  command.add_option("--threads", a.threads, "threads to work with; default: all cores")
      ->type_name("N");
  command.add_option("--seed", a.seed, "of all random choices; default: 0")->type_name("S");
  command
      .add_option("--scale", a.scale,
                  "all lengths that come out are multiplied by it: a true length over the same one "
                  "in the results without --scale, which are metres by predicted depth or, without "
                  "planes, of a unit that is about the median depth of the first picture")
      ->type_name("FACTOR");
  command.add_option("--config", a.config, "settings, as `cairn config` prints them")
      ->type_name("FILE");
  command.add_option("--set", a.settings, "one setting, repeatable; wins over --config")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
}

void add_output_options(CLI::App& command, Arguments& a) {
  command.add_option("--out", a.out, "where results go; default: runs/<sequence>-<date>-<time>")
      ->type_name("DIR");
  command.add_flag("--force", a.force, "replace the results in a folder that is not empty");
  command.add_flag("--no-progress", a.no_progress, "no progress bar");
  command.add_flag("--video", a.video, "write an annotated video");
}

}  // namespace

Action add_run(CLI::App& program, const std::string& typed) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("run", "Pictures in, trajectory and map out");
  add_input_options(*command, *arguments);
  add_system_options(*command, *arguments);
  add_output_options(*command, *arguments);
  return [arguments, typed] { return run(*arguments, typed); };
}

}  // namespace cairn::app
