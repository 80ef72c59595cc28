#include "cairn/map/object_classes.h"

#include <cmath>
#include <string_view>

namespace cairn {
namespace {

// Length, height and width in metres become semi-axes. The ellipsoid whose outlines fill the same
// boxes as a cuboid is larger than the one inside of it: by 4/π, the mean over directions of the
// sum of a cuboid's projected edges over the projected diameter of its inscribed ellipsoid.
constexpr ObjectClass thing(const char* name, const char* family, double length, double height,
                            double width, double sigma) {
  constexpr double k = 0.5 * 4 / 3.14159265358979323846;
  return {name, family, {k * length, k * height, k * width}, sigma};
}

// That ellipsoid is rounder than the cuboid, too: by this in the logarithms of its semi-axes,
// around their mean (class_shape).
constexpr double kRounder = 0.9;

constexpr ObjectClass kClasses[] = {
    thing("person", "person", 0.5, 1.7, 0.35, 0.2),
    thing("bicycle", "cycle", 1.7, 1.05, 0.5, 0.2),
    thing("car", "vehicle", 4.3, 1.5, 1.8, 0.15),
    thing("motorcycle", "cycle", 2.1, 1.2, 0.75, 0.2),
    thing("airplane", "airplane", 40, 12, 35, 0.7),
    thing("bus", "vehicle", 11, 3.1, 2.5, 0.25),
    thing("train", "vehicle", 25, 4, 3, 0.7),
    thing("truck", "vehicle", 6.5, 2.6, 2.2, 0.4),
    thing("boat", "boat", 6, 2, 2.2, 0.7),
    thing("traffic light", "traffic light", 0.35, 0.95, 0.35, 0.25),
    thing("fire hydrant", "fire hydrant", 0.35, 0.75, 0.35, 0.2),
    thing("stop sign", "stop sign", 0.75, 0.75, 0.05, 0.2),
    thing("parking meter", "parking meter", 0.25, 1.3, 0.2, 0.3),
    thing("bench", "seat", 1.5, 0.85, 0.6, 0.3),
    thing("bird", "bird", 0.25, 0.2, 0.15, 0.6),
    thing("cat", "pet", 0.45, 0.3, 0.18, 0.25),
    thing("dog", "pet", 0.8, 0.6, 0.3, 0.4),
    thing("horse", "large animal", 2.3, 1.7, 0.6, 0.2),
    thing("sheep", "large animal", 1.2, 0.9, 0.45, 0.25),
    thing("cow", "large animal", 2.3, 1.5, 0.7, 0.25),
    thing("elephant", "elephant", 5, 3, 2, 0.3),
    thing("bear", "large animal", 1.8, 1.1, 0.8, 0.3),
    thing("zebra", "large animal", 2.2, 1.6, 0.6, 0.2),
    thing("giraffe", "giraffe", 2.5, 4.5, 0.9, 0.3),
    thing("backpack", "bag", 0.32, 0.46, 0.2, 0.25),
    thing("umbrella", "umbrella", 1.0, 0.8, 1.0, 0.4),
    thing("handbag", "bag", 0.33, 0.3, 0.15, 0.3),
    thing("tie", "tie", 0.1, 0.5, 0.03, 0.3),
    thing("suitcase", "bag", 0.45, 0.65, 0.25, 0.25),
    thing("frisbee", "frisbee", 0.27, 0.03, 0.27, 0.15),
    thing("skis", "skis", 1.7, 0.1, 0.2, 0.3),
    thing("snowboard", "board", 1.5, 0.1, 0.3, 0.2),
    thing("sports ball", "ball", 0.2, 0.2, 0.2, 0.35),
    thing("kite", "kite", 1.2, 0.8, 0.3, 0.5),
    thing("baseball bat", "bat", 0.85, 0.07, 0.07, 0.2),
    thing("baseball glove", "baseball glove", 0.3, 0.25, 0.12, 0.2),
    thing("skateboard", "board", 0.8, 0.14, 0.2, 0.2),
    thing("surfboard", "board", 2.0, 0.1, 0.5, 0.25),
    thing("tennis racket", "tennis racket", 0.69, 0.05, 0.27, 0.15),
    thing("bottle", "bottle", 0.075, 0.25, 0.075, 0.25),
    thing("wine glass", "glass", 0.08, 0.19, 0.08, 0.2),
    thing("cup", "vessel", 0.11, 0.1, 0.085, 0.2),
    thing("fork", "cutlery", 0.2, 0.02, 0.025, 0.2),
    thing("knife", "cutlery", 0.22, 0.02, 0.025, 0.25),
    thing("spoon", "cutlery", 0.18, 0.02, 0.04, 0.25),
    thing("bowl", "vessel", 0.17, 0.08, 0.17, 0.25),
    thing("banana", "fruit", 0.19, 0.06, 0.05, 0.2),
    thing("apple", "fruit", 0.08, 0.075, 0.08, 0.15),
    thing("sandwich", "food", 0.16, 0.07, 0.11, 0.3),
    thing("orange", "fruit", 0.08, 0.08, 0.08, 0.15),
    thing("broccoli", "food", 0.13, 0.13, 0.13, 0.3),
    thing("carrot", "fruit", 0.18, 0.03, 0.03, 0.25),
    thing("hot dog", "food", 0.17, 0.06, 0.06, 0.25),
    thing("pizza", "food", 0.3, 0.03, 0.3, 0.3),
    thing("donut", "food", 0.1, 0.04, 0.1, 0.2),
    thing("cake", "food", 0.24, 0.12, 0.24, 0.35),
    thing("chair", "seat", 0.55, 0.9, 0.55, 0.15),
    thing("couch", "seat", 2.0, 0.85, 0.9, 0.2),
    thing("potted plant", "plant", 0.35, 0.5, 0.35, 0.5),
    thing("bed", "bed", 2.0, 0.6, 1.5, 0.2),
    thing("dining table", "table", 1.5, 0.74, 0.85, 0.25),
    thing("toilet", "toilet", 0.68, 0.76, 0.38, 0.12),
    thing("tv", "screen", 0.65, 0.42, 0.12, 0.35),
    thing("laptop", "screen", 0.34, 0.22, 0.26, 0.15),
    thing("mouse", "mouse", 0.11, 0.038, 0.063, 0.12),
    thing("remote", "hand-held", 0.18, 0.025, 0.05, 0.2),
    thing("keyboard", "keyboard", 0.43, 0.03, 0.14, 0.15),
    thing("cell phone", "hand-held", 0.15, 0.01, 0.073, 0.12),
    thing("microwave", "kitchen box", 0.5, 0.3, 0.38, 0.15),
    thing("oven", "kitchen box", 0.6, 0.75, 0.6, 0.2),
    thing("toaster", "kitchen box", 0.3, 0.2, 0.18, 0.2),
    thing("sink", "sink", 0.55, 0.2, 0.45, 0.25),
    thing("refrigerator", "refrigerator", 0.65, 1.65, 0.65, 0.2),
    thing("book", "book", 0.23, 0.025, 0.16, 0.3),
    thing("clock", "clock", 0.28, 0.28, 0.05, 0.35),
    thing("vase", "vessel", 0.14, 0.26, 0.14, 0.35),
    thing("scissors", "scissors", 0.18, 0.012, 0.075, 0.2),
    thing("teddy bear", "teddy bear", 0.28, 0.35, 0.2, 0.4),
    thing("hair drier", "hand-held", 0.22, 0.23, 0.09, 0.2),
    thing("toothbrush", "hand-held", 0.19, 0.018, 0.014, 0.15),
};

}  // namespace

std::span<const ObjectClass> object_classes() { return kClasses; }

const ObjectClass* find_object_class(const std::string& name) {
  for (const ObjectClass& c : kClasses) {
    if (name == c.name) return &c;
  }
  return nullptr;
}

bool may_be_one_class(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const ObjectClass *of_a = find_object_class(a), *of_b = find_object_class(b);
  return of_a != nullptr && of_b != nullptr &&
         std::string_view(of_a->family) == std::string_view(of_b->family);
}

Eigen::Vector3d class_shape(const ObjectClass& c) {
  const Eigen::Vector3d logs = Eigen::Vector3d(c.semi_axes).array().log();
  return kRounder * (logs.array() - logs.mean());
}

double usual_size(const ObjectClass& c) {
  return std::cbrt(c.semi_axes[0] * c.semi_axes[1] * c.semi_axes[2]);
}

}  // namespace cairn
