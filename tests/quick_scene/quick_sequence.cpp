#include "quick_scene/quick_sequence.h"

#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>

#include "quick_scene/quick_scene.h"

namespace cairn {

void write_quick_sequence(const std::filesystem::path& folder, int frames) {
  const QuickScene scene(0);
  std::filesystem::create_directories(folder / "rgb");
  std::ofstream list(folder / "rgb.txt"), truth(folder / "groundtruth.txt");
  list << std::fixed << std::setprecision(6);
  truth << std::fixed << std::setprecision(9);
  for (int i = 0; i < frames; ++i) {
    const double t = i / 30.0, timestamp = 1000 + t;  // as a clock would give it, not zero
    const std::string name = "rgb/" + std::to_string(i) + ".png";
    cv::imwrite((folder / name).string(), scene.render(t), {cv::IMWRITE_PNG_COMPRESSION, 1});
    list << timestamp << ' ' << name << '\n';
    const SE3 T_wc = scene.T_wc(t);
    truth << timestamp << ' ' << T_wc.translation().transpose() << ' '
          << T_wc.rotation().coeffs().transpose() << '\n';
  }
  const Pinhole& p = scene.camera().pinhole();
  std::ofstream(folder / "calibration.yaml")
      << "color: {model: pinhole, width: 640, height: 480, fps: 30, fx: " << p.fx
      << ", fy: " << p.fy << ", cx: " << p.cx << ", cy: " << p.cy << "}\n";
}

}  // namespace cairn
