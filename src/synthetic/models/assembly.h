#pragma once

#include <initializer_list>
#include <string_view>

#include "cairn/synthetic/model.h"

namespace cairn {

/// A place of a part: moved by (x, y, z), metres.
Eigen::Isometry3f at(float x, float y, float z);
/// Turned about an axis through the origin, by degrees.
Eigen::Isometry3f turned(const Eigen::Vector3f& axis, float degrees);

/// Puts a thing together from parts, in any convenient frame whose z is up and x to the front.
class Assembly {
 public:
  explicit Assembly(std::string_view class_name, Symmetry symmetry = Symmetry::kNone);

  std::uint32_t material(const Material& material);
  /// Adds a part; material i of the part becomes materials[i].
  void add(const Mesh& part, std::initializer_list<std::uint32_t> materials,
           const Eigen::Isometry3f& place = Eigen::Isometry3f::Identity());
  void add(const Mesh& part, std::uint32_t material,
           const Eigen::Isometry3f& place = Eigen::Isometry3f::Identity());

  /// The thing, moved to where its class wants it: on the ground, its footprint's middle at the
  /// origin.
  Model finish() &&;

 private:
  Model model_;
};

}  // namespace cairn
