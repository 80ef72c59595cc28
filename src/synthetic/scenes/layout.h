#pragma once

#include <string>

#include "cairn/geometry/sampler.h"
#include "cairn/synthetic/scene.h"

namespace cairn {

/// Builds a scene: draws random numbers from its seed, keeps things, planes and lights in order.
class Layout {
 public:
  Layout(const std::string& name, std::uint64_t seed);

  float uniform(float low, float high);
  int below(int n) { return sampler_.below(n); }
  bool chance(float probability) { return uniform(0, 1) < probability; }
  /// A seed for something that draws numbers of its own.
  std::uint64_t seed() { return sampler_.next(); }
  template <typename T>
  T one_of(std::initializer_list<T> choices) {
    return choices.begin()[below(int(choices.size()))];
  }

  /// A plane through the corners, counter-clockwise as seen from its open side. Returns its index.
  int add_plane(const std::string& label, const std::vector<Eigen::Vector3f>& outline);
  /// Part of a building, or furniture that no detector knows.
  int add_surface(const std::string& label, Mesh mesh, const SE3& T_wo = SE3(),
                  std::optional<int> supported_by = {});
  /// A model; an object if its class is one of COCO's, and else a surface with a name.
  int add_object(Model model, const SE3& T_wo, std::optional<int> supported_by);
  /// A rectangle that shines and can be seen shining. `u x v` points to where it shines.
  void add_lamp(const Eigen::Vector3f& centre, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
                const Colour& radiance, const Colour& looks);
  /// The flat top of something that was added, as a plane to put things on. Returns its index.
  int add_top(int thing, const std::string& label);

  /// Would the model stand clear of all that stands already? Boxes along x and y decide.
  bool is_free(const Model& model, const SE3& T_wo) const;

  const WorldThing& thing(int index) const { return scene_.things[std::size_t(index)]; }
  const WorldPlane& plane(int index) const { return scene_.planes[std::size_t(index)]; }
  Scene& scene() { return scene_; }
  Scene finish() && { return std::move(scene_); }

 private:
  Scene scene_;
  Sampler sampler_;
};

/// The extent of a model in its own frame.
Eigen::AlignedBox3f extent(const Model& model);

/// The extent of a model that is placed, along the axes of the world.
Eigen::AlignedBox3f extent(const Model& model, const SE3& T_wo);

/// Upright at a place, turned about the vertical axis.
SE3 standing(const Eigen::Vector3f& at, float yaw);

/// Puts things onto a rectangle side by side without overlap.
class Tray {
 public:
  /// `corner` + a * `u` + b * `v` with a, b in [0, 1]; horizontal.
  Tray(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v)
      : corner_(corner), u_(u), v_(v) {}

  /// Reserves the place where a model would stand; false if it is taken or sticks out.
  bool claim(const Model& model, const SE3& T_wo, float margin = 0.01f);
  /// Tries random places; none if there is no room.
  std::optional<SE3> find(const Model& model, Layout& layout, float yaw_low, float yaw_high);

 private:
  struct Footprint {
    Eigen::Vector2f centre, axis;  // axis: of unit length, along half.x()
    Eigen::Vector2f half;
  };
  static Footprint footprint(const Model& model, const SE3& T_wo, float margin);
  static bool overlap(const Footprint& a, const Footprint& b);

  Eigen::Vector3f corner_, u_, v_;
  std::vector<Footprint> taken_;
};

}  // namespace cairn
