#pragma once

// A world that is ready to be looked at: a scene, its light and its rays. Pictures and their ground
// truth come from here; whoever needs them in a test needs no file.

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/synthetic/frame_truth.h"
#include "cairn/synthetic/light_baking.h"
#include "cairn/synthetic/ray_caster.h"
#include "cairn/synthetic/scene.h"
#include "cairn/synthetic/sensor.h"

namespace cairn {

struct RenderOptions {
  int samples = 4;          ///< rays a pixel
  double exposure = 0.008;  ///< seconds that the shutter is open, around t: motion blur
  double readout = 0;       ///< seconds from the first to the last row: rolling shutter
  SE3 T_bc;                 ///< the camera in the frame that follows the path (of a stereo rig)
  SensorOptions sensor;
};

/// Thread-safe: many may look at one world at once. The same scene, camera and options give the
/// same bytes, with any number of threads.
class World {
 public:
  /// Lights the scene, which takes some seconds; with options of one's own perhaps less.
  explicit World(Scene scene, const std::optional<BakeOptions>& baking = {});
  ~World();
  World(World&&) noexcept;

  /// A picture taken around `t` seconds: CV_8UC3, BGR.
  cv::Mat render(const Camera& camera, double t, const RenderOptions& options = {}) const;
  /// The same without the sensor: linear light, CV_32FC3, red green blue.
  cv::Mat render_light(const Camera& camera, double t, const RenderOptions& options = {}) const;
  /// What is in the picture of an ideal shutter at this pose.
  FrameTruth truth(const Camera& camera, const SE3& T_wc) const;

  const Scene& scene() const;
  const RayCaster& caster() const;
  /// Of all things, refined, in the world frame; what the caster's hits refer to.
  const std::vector<Mesh>& meshes() const;
  /// The plane of a hit, an index into scene().planes; -1: none.
  int plane_of(const RayHit& hit) const;
  /// Names of surfaces in label pictures; 0 is "void".
  const std::vector<std::string>& labels() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// A camera that suits a scene: a wide lens in rooms, KITTI's in the street; slightly distorted if
/// wished.
Camera default_camera(SceneKind kind, int width, int height, bool distorted);

/// How such a camera takes pictures: slowly and row by row in the hand, at once on a car.
RenderOptions default_options(SceneKind kind);

}  // namespace cairn
