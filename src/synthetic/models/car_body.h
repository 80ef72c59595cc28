#pragma once

#include "cairn/synthetic/models/dice.h"
#include "cairn/synthetic/shapes/loft.h"

namespace cairn {

enum class BodyType { kSaloon, kHatchback, kEstate, kVan };

/// The shape of a car's body. Metres; `s` is the way from the foremost point to the rear.
struct BodyShape {
  BodyType type = BodyType::kSaloon;
  float length = 4.5f, width = 1.8f, height = 1.45f, clearance = 0.2f;
  float wheel_radius = 0.32f, front_axle = 0.85f, rear_axle = 3.5f;
  float nose_z = 0.68f, cowl_z = 0.95f, belt_z = 0.95f, tail_z = 0.98f;  ///< heights of the deck
  // Where the windscreen starts and ends, and the rear window, along s.
  float cowl = 1.25f, roof_from = 1.9f, roof_to = 3.1f, rear_glass_to = 3.8f;
  float tumblehome = 0.76f;  ///< half width of the roof by that of the body

  float half_width(float s) const;
  float deck(float s) const;  ///< bonnet, belt line, boot
  float top(float s) const;   ///< bonnet, windscreen, roof, rear window, boot
  float bottom(float s) const;

  /// The section at s, half of it (y >= 0) from the bottom's middle to the top's: kPoints points.
  std::vector<Eigen::Vector2f> half_section(float s) const;
  /// Points of a half section that details hold on to.
  enum Point {
    kBottom,
    kFloorEdge,
    kSill,
    kDoor,
    kWaist,
    kShoulder,
    kBelt,
    kGlassFoot,
    kGlassTop,
    kRail,
    kRoofSide,
    kRoof,
    kPoints
  };
  /// A point of the half section in the car's frame, x forward from its middle.
  Eigen::Vector3f at(float s, Point point) const;
  /// On the side, at a height: from the sill to the shoulder.
  Eigen::Vector3f side(float s, float z) const;
};

BodyShape make_body_shape(BodyType type, Dice& dice);

/// The body's surface. Materials: 0 paint, 1 glass, 2 underside, 3 trim around the windows, 4
/// sills, 5 and 6 the front and rear lamps' share of the sides.
Mesh make_body(const BodyShape& shape);

}  // namespace cairn
