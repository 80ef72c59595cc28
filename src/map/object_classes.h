#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

namespace cairn {

/// Things of a class as one meets them. Detectors confuse the classes of one family.
struct ObjectClass {
  const char* name;     ///< of COCO
  const char* family;   ///< classes that detectors confuse share one
  double semi_axes[3];  ///< of the ellipsoid that shows the boxes of a thing of median size, metres
  double sigma;         ///< of the logarithm of the size between things of the class
};

/// All 80 classes of COCO. Sources: docs/objects.md, "Sizes".
std::span<const ObjectClass> object_classes();
/// Null for a class that is not COCO's.
const ObjectClass* find_object_class(const std::string& name);
/// Are both the same, or of one family?
bool may_be_one_class(const std::string& a, const std::string& b);
/// Logarithms of the semi-axes of an ellipsoid with the outlines of such a thing, around their
/// mean: length, height, width.
Eigen::Vector3d class_shape(const ObjectClass& c);
/// Geometric mean of the semi-axes, metres.
double usual_size(const ObjectClass& c);

}  // namespace cairn
