#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "cairn/geometry/error.h"
#include "cairn/synthetic/demo_scene.h"
#include "commands.h"
#include "interrupt.h"
#include "output_folder.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

constexpr double kFps = 30;
constexpr double kFirstTimestamp = 1000;  // as a clock would give it, not zero

struct Arguments {
  std::string out;
  int frames = 600;
  std::uint64_t seed = 0;
  bool force = false;
};

// Buffers a text file and says whether it reached the disk.
void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  if (!(file << text << std::flush)) {
    throw Error(Error::Kind::kOutput,
                path.string() + ": this file cannot be written; is the disk full?");
  }
}

std::string calibration_yaml(const Camera& camera) {
  const Pinhole& p = camera.pinhole();
  char text[512];
  std::snprintf(text, sizeof text,
                "color:\n  model: pinhole\n  width: %d\n  height: %d\n  fps: %g\n  fx: %.6f\n"
                "  fy: %.6f\n  cx: %.6f\n  cy: %.6f\n"
                "  distortion: [0, 0, 0, 0, 0]   # k1 k2 p1 p2 k3\n",
                camera.width(), camera.height(), kFps, p.fx, p.fy, p.cx, p.cy);
  return text;
}

std::string tum_line(const std::string& timestamp, const SE3& T_wc) {
  const auto& t = T_wc.translation();
  const auto& q = T_wc.rotation();
  char text[256];
  std::snprintf(text, sizeof text, "%s %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", timestamp.c_str(),
                t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  return text;
}

int synthesize(const Arguments& arguments) {
  const fs::path out = prepare_output_folder(arguments.out, "", arguments.force);
  fs::create_directories(out / "rgb");
  remember_interrupts();
  const DemoScene scene(arguments.seed);
  std::string list = "# timestamp filename\n";
  std::string poses = "# timestamp tx ty tz qx qy qz qw (camera to world)\n";
  for (int i = 0; i < arguments.frames && !interrupted(); ++i) {
    const double t = i / kFps;
    char timestamp[32];
    std::snprintf(timestamp, sizeof timestamp, "%.6f", kFirstTimestamp + t);
    const std::string name = std::string("rgb/") + timestamp + ".png";
    // The quickest compression: the pictures are noisy and hardly compress anyway.
    if (!cv::imwrite((out / name).string(), scene.render(t), {cv::IMWRITE_PNG_COMPRESSION, 1})) {
      throw Error(Error::Kind::kOutput,
                  (out / name).string() + ": this picture cannot be written; is the disk full?");
    }
    list += std::string(timestamp) + " " + name + "\n";
    poses += tum_line(timestamp, scene.T_wc(t));
  }
  // Last, because they make the folder a sequence.
  write_text(out / "groundtruth.txt", poses);
  write_text(out / "calibration.yaml", calibration_yaml(scene.camera()));
  write_text(out / "rgb.txt", list);
  if (interrupted()) return kInterrupted;
  std::printf("%d frames with ground truth are in %s; `cairn run %s` takes them.\n",
              arguments.frames, out.c_str(), out.c_str());
  return kDone;
}

}  // namespace

Action add_synth(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "synth", "Renders a sequence of a synthetic desk with ground truth, in TUM layout");
  command->add_option("out", arguments->out, "the folder to write")->required()->type_name("OUT");
  command->add_option("--frames", arguments->frames, "pictures to render, 30 a second")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "another seed gives other prints and another path")
      ->capture_default_str();
  command->add_flag("--force", arguments->force, "write into a folder that is not empty");
  return [arguments] { return synthesize(*arguments); };
}

}  // namespace cairn::app
