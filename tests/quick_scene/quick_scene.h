#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// A desk in a corner of a room, filmed by hand: floor, two walls, a table, and boxes on and beside
/// it, all printed on richly enough for corners to be found. Small and quick; rendered on the CPU
/// by casting rays. World frame: z up, metres, the floor at z = 0. The same seed gives the same
/// bytes, with any number of threads.
class QuickScene {
 public:
  struct Options {
    double noise = 2.0;       ///< grey levels, standard deviation of the sensor noise
    double vignetting = 0.2;  ///< how much darker the corners of the picture are, 0 to 1
  };

  explicit QuickScene(std::uint64_t seed) : QuickScene(seed, Options()) {}
  QuickScene(std::uint64_t seed, const Options& options);
  ~QuickScene();

  /// What the camera sees at `t` seconds: CV_8UC3 (BGR), 640x480.
  cv::Mat render(double t) const;
  /// Where the camera is at `t` seconds (camera to world): a smooth path around the desk, as of a
  /// hand, that repeats no view exactly.
  SE3 T_wc(double t) const;
  const Camera& camera() const { return camera_; }

  /// The first surface on the ray from `origin` along `direction` (both world frame): how many
  /// lengths of `direction` away it is; none where the ray leaves the scene.
  std::optional<double> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

 private:
  struct World;
  std::uint64_t seed_;
  Options options_;
  Camera camera_;
  std::unique_ptr<const World> world_;
};

}  // namespace cairn
