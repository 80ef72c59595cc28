#include <cstdio>
#include <filesystem>

#include "cairn/geometry/error.h"
#include "cairn/perception/recorded_perception.h"
#include "cairn/synthetic/perception_simulator.h"
#include "cairn/synthetic/truth_json.h"
#include "cairn/synthetic/world.h"
#include "commands.h"
#include "interrupt.h"
#include "output_folder.h"
#include "progress.h"
#include "sequence_folder.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

constexpr double kBaseline = 0.54;  // metres, KITTI's
constexpr int kCoarse = 4;          // of pictures that only tell what is visible

struct Arguments {
  std::string out, scene = "desk", sensor = "mono", truth = "all", perception;
  int frames = -1, width = 640, height = 480, samples = 4;
  std::uint64_t seed = 0;
  double readout_ms = -1;  // the scene's
  bool force = false, no_progress = false;
  bool no_blur = false, no_distortion = false, no_vignetting = false, no_exposure = false,
       no_noise = false, no_mosaic = false;
};

SynthSensor sensor_of(const std::string& name) {
  if (name == "stereo") return SynthSensor::kStereo;
  return name == "rgbd" ? SynthSensor::kRgbd : SynthSensor::kMono;
}

RenderOptions render_options(const Arguments& arguments, SceneKind kind) {
  RenderOptions options = default_options(kind);
  options.samples = arguments.samples;
  if (arguments.readout_ms >= 0) options.readout = arguments.readout_ms / 1000;
  if (arguments.no_blur) options.exposure = 0;
  if (arguments.no_vignetting) options.sensor.vignetting = 0;
  if (arguments.no_exposure) options.sensor.auto_exposure = 0;
  if (arguments.no_noise) options.sensor.full_well = options.sensor.read_noise = 0;
  options.sensor.mosaic = !arguments.no_mosaic;
  return options;
}

// What networks would say, if it is wanted: beside the whole truth, or by name.
std::optional<PerceptionSimulator> perception_of(const Arguments& arguments, const World& world,
                                                 const Camera& camera) {
  const std::string kind = !arguments.perception.empty() ? arguments.perception
                           : arguments.truth == "all"    ? "simulated"
                                                         : "none";
  if (kind == "none") return std::nullopt;
  return std::optional<PerceptionSimulator>(
      std::in_place, world.scene(), camera,
      kind == "exact" ? PerceptionNoise::none() : PerceptionNoise(), arguments.seed);
}

// Returns how many frames are rendered: all, if it was not interrupted.
int render_frames(const Arguments& arguments, const World& world, const Camera& camera, int frames,
                  SequenceFolder& folder, VisibilityCount& visible) {
  const SynthSensor sensor = sensor_of(arguments.sensor);
  const RenderOptions options = render_options(arguments, parse_scene_kind(arguments.scene));
  RenderOptions right = options;
  right.T_bc = SE3(Eigen::Quaterniond::Identity(), {kBaseline, 0, 0});
  const bool all = arguments.truth == "all", deep = sensor == SynthSensor::kRgbd;
  const Camera coarse = camera.resized(std::max(16, camera.width() / kCoarse),
                                       std::max(16, camera.height() / kCoarse));
  std::optional<PerceptionSimulator> perception = perception_of(arguments, world, camera);
  Progress progress(!arguments.no_progress, std::size_t(frames));
  for (int i = 0; i < frames; ++i) {
    if (interrupted()) return i;
    const double t = i / world.scene().fps;
    const SE3 T_wc = world.scene().path(t);
    const bool whole = all || deep || perception;
    const FrameTruth truth = world.truth(whole ? camera : coarse, T_wc);
    visible.add(truth, T_wc.translation(), whole ? 1 : kCoarse * kCoarse);
    folder.add(T_wc, world.render(camera, t, options),
               sensor == SynthSensor::kStereo ? world.render(camera, t, right) : cv::Mat(),
               truth.depth);
    if (all) folder.add_truth(truth, world.scene());
    if (perception) {
      const double timestamp = folder.timestamp(i);
      folder.add_detections(to_json_line(perception->detect(truth, timestamp)));
    }
    progress.show("rendered");
  }
  return frames;
}

int synthesize(const Arguments& arguments) {
  const SceneKind kind = parse_scene_kind(arguments.scene);
  const bool stereo = arguments.sensor == "stereo";
  const Camera camera =
      default_camera(kind, arguments.width, arguments.height, !arguments.no_distortion && !stereo);
  const fs::path out = prepare_output_folder(arguments.out, "", arguments.force);
  remember_interrupts();
  Scene scene = make_scene(kind, arguments.seed);
  const int frames =
      arguments.frames > 0 ? arguments.frames : int(std::lround(scene.duration * scene.fps));
  SequenceFolder folder(out, sensor_of(arguments.sensor), camera, scene.fps, kBaseline);
  const World world(std::move(scene));
  VisibilityCount visible;
  const int rendered = render_frames(arguments, world, camera, frames, folder, visible);
  if (rendered < frames) {
    std::printf(
        "interrupted: %d of %d pictures are left in %s, without the list, the poses and the "
        "world that would make them a sequence.\n",
        rendered, frames, out.c_str());
    return kInterrupted;
  }
  folder.finish(world_json(world, visible));
  std::printf("%d frames with ground truth are in %s; `cairn run %s` takes them.\n", frames,
              out.c_str(), out.c_str());
  return kDone;
}

void add_switches(CLI::App& command, Arguments& arguments) {
  command.add_flag("--no-blur", arguments.no_blur, "no motion blur: the shutter opens for no time");
  command.add_flag("--no-distortion", arguments.no_distortion,
                   "an ideal lens (that of a stereo rig always is: its pictures are rectified)");
  command.add_flag("--no-vignetting", arguments.no_vignetting, "corners as bright as the middle");
  command.add_flag("--no-auto-exposure", arguments.no_exposure, "one exposure for all pictures");
  command.add_flag("--no-noise", arguments.no_noise, "a sensor without noise");
  command.add_flag("--no-mosaic", arguments.no_mosaic, "a sensor that sees all colours everywhere");
  command
      .add_option("--rolling-shutter", arguments.readout_ms,
                  "milliseconds from the first row to the last [25, in the street 0]")
      ->check(CLI::Range(0.0, 100.0));
}

}  // namespace

Action add_synth(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "synth", "Renders a sequence of a synthetic world with its whole ground truth");
  command->add_option("out", arguments->out, "the folder to write")->required()->type_name("OUT");
  command->add_option("--scene", arguments->scene, "desk, room, corridor or street")
      ->capture_default_str();
  command
      ->add_option("--frames", arguments->frames,
                   "pictures to render; without it the whole path of the scene")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", arguments->seed, "another seed gives another world and path")
      ->capture_default_str();
  command
      ->add_option("--sensor", arguments->sensor,
                   "mono, stereo (KITTI's layout) or rgbd (with depth.txt)")
      ->check(CLI::IsMember({"mono", "stereo", "rgbd"}))
      ->capture_default_str();
  command->add_option("--width", arguments->width, "pixels")
      ->check(CLI::Range(32, 4096))
      ->capture_default_str();
  command->add_option("--height", arguments->height, "pixels")
      ->check(CLI::Range(32, 4096))
      ->capture_default_str();
  command->add_option("--samples", arguments->samples, "rays a pixel")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      ->add_option("--truth", arguments->truth,
                   "all: truth.jsonl, depth, normals, labels and instances of each frame; "
                   "poses: only poses and world.json")
      ->check(CLI::IsMember({"all", "poses"}))
      ->capture_default_str();
  command
      ->add_option(
          "--perception", arguments->perception,
          "perception.jsonl. simulated: what networks would say, with their errors; exact: "
          "the truth; none: no such file. Default: simulated with --truth all, else none")
      ->check(CLI::IsMember({"simulated", "exact", "none"}));
  add_switches(*command, *arguments);
  command->add_flag("--no-progress", arguments->no_progress, "no progress bar");
  command->add_flag("--force", arguments->force, "write into a folder that is not empty");
  return [arguments] { return synthesize(*arguments); };
}

}  // namespace cairn::app
