#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// Turned by which angle about its z axis a thing looks the same.
enum class Symmetry { kNone, kHalfTurn, kQuarterTurn, kAnyTurn };

/// A thing that stands in the world. Its frame: z up, the ground that it stands on at z = 0, the
/// middle of its footprint at the origin, its front towards +x. Metres.
struct Model {
  std::string class_name;  ///< as COCO has it ("cup", "dining table"), or a label of a surface
  Symmetry symmetry = Symmetry::kNone;
  Mesh mesh;
};

/// The classes that make_model knows.
std::span<const std::string_view> model_classes();

/// A thing of a class: shape, proportions, colours and prints follow from the seed, so no two cups
/// are alike. Throws Error(kUsage) for a class that it does not know.
Model make_model(std::string_view class_name, std::uint64_t seed);

}  // namespace cairn
