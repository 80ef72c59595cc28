#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/se3.h"
#include "cairn/synthetic/model.h"

namespace cairn {

/// A rectangle that shines on the side that `u x v` points to.
struct AreaLight {
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  Eigen::Vector3f u = Eigen::Vector3f::UnitX(), v = Eigen::Vector3f::UnitY();  ///< half edges
  Colour radiance = Colour::Ones();
};

/// A flat surface that a map should find: `normal · X_w + d = 0`, the normal towards the open side.
struct WorldPlane {
  std::string label;  ///< floor, wall, ceiling, table, ...
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double d = 0;
  std::vector<Eigen::Vector3d> outline;  ///< corners, counter-clockwise seen from the open side
};

/// One thing in the world. Surfaces of the building (floor, walls) are things as well, but no
/// objects.
struct WorldThing {
  Model model;
  SE3 T_wo;                         ///< the model's frame to the world
  bool is_object = false;           ///< a thing that a detector has a class for
  std::optional<int> supported_by;  ///< index of the plane that it stands on
};

/// A world that does not move. World frame: z up, the ground at z = 0. Metres.
struct Scene {
  std::string name;
  std::uint64_t seed = 0;
  std::vector<WorldThing> things;
  std::vector<WorldPlane> planes;
  std::vector<AreaLight> lights;
  Colour sky = Colour::Zero();      ///< light from where no surface is
  Colour ambient = Colour::Zero();  ///< light that has bounced often, times how open a place is
  std::function<SE3(double)> path;  ///< T_wc at t seconds, smooth; no two views are the same
  double fps = 30;                  ///< pictures a second that suit the path
  double duration = 10;             ///< seconds until the path is at its end
};

/// The meshes of all things, in the world frame.
std::vector<Mesh> placed_meshes(const Scene& scene);

enum class SceneKind { kDesk, kRoom, kCorridor, kStreet };

/// Layout, sizes, colours, textures, lights and path follow from the seed.
Scene make_scene(SceneKind kind, std::uint64_t seed);

/// "desk", "room", "corridor", "street"; anything else throws Error(kUsage).
SceneKind parse_scene_kind(const std::string& name);

}  // namespace cairn
