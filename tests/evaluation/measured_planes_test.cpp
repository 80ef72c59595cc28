#include "cairn/evaluation/measured_planes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

const Camera kCamera(Camera::Model::kRadialTangential, 160, 120, {150, 150, 80, 60},
                     {0.1, -0.1, 0, 0, 0});

// A floor, z = 0, and on it a carton 0.2 m high, 0.5 m square, around (0.3, 0, 0).
double height_along(const Vector3d& origin, const Vector3d& direction) {
  const double at_top = (0.2 - origin.z()) / direction.z();
  const Vector3d top = origin + at_top * direction;
  const bool carton = std::abs(top.x() - 0.3) < 0.25 && std::abs(top.y()) < 0.25;
  return carton ? at_top : -origin.z() / direction.z();
}

// What the camera measures, looking down from (x, y, 2).
cv::Mat depth_from(const SE3& T_wc) {
  cv::Mat_<float> depth(kCamera.height(), kCamera.width());
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Vector3d ray = kCamera.unproject({double(u), double(v)});
      depth(v, u) = float(height_along(T_wc.translation(), T_wc.rotation() * (ray / ray.z())));
    }
  }
  depth(10, 10) = 0;
  depth(12, 12) = std::nanf("");
  return depth;
}

// Half a metre around (x, y, z), tilted about the x axis.
FoundPlane map_plane(const Vector3d& centre, double half, double tilt_deg) {
  const double a = tilt_deg * M_PI / 180;
  FoundPlane plane;
  plane.id = 7;
  plane.label = "floor";
  plane.normal = {0, -std::sin(a), std::cos(a)};
  plane.d = -plane.normal.dot(centre);
  for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
    plane.outline.push_back(centre + Vector3d(x, y * std::cos(a), y * std::sin(a)));
  }
  return plane;
}

MeasuredPlaneReport measure(const std::vector<FoundPlane>& planes) {
  MeasuredPlanes measured(planes, {.pixel_step = 2});
  for (const double x : {-0.3, 0.0, 0.3}) {
    const SE3 T_wc(Eigen::Quaterniond(0, 1, 0, 0), {x, 0.1, 2});  // looking down
    measured.add(depth_from(T_wc), kCamera, T_wc);
  }
  return measured.report();
}

TEST(MeasuredPlanes, SayHowFarPlanesOfTheMapAreFromWhatWasMeasured) {
  const MeasuredPlaneReport report = measure({map_plane({0, 0, 0.04}, 0.6, 3)});
  EXPECT_EQ(report.pictures, 3U);
  ASSERT_EQ(report.planes.size(), 1U);
  const MeasuredPlane& plane = report.planes[0];
  EXPECT_EQ(plane.id, 7);
  EXPECT_NEAR(plane.angle_deg.value(), 3, 1e-3);
  EXPECT_NEAR(plane.offset.value(), 0.04, 1e-5);
  EXPECT_GT(plane.points, 1000U);
  EXPECT_GT(plane.share, 0.6) << "the carton is no part of the floor";
  EXPECT_LT(plane.share, 0.95);
  EXPECT_EQ(report.angle_deg, plane.angle_deg);
  EXPECT_EQ(report.offset, plane.offset);
}

TEST(MeasuredPlanes, TakeWhatLiesWithinTheOutline) {
  // As large as the carton: floor all around, but not within.
  const MeasuredPlaneReport report = measure({map_plane({0.3, 0, 0.15}, 0.25, 0)});
  EXPECT_NEAR(report.offset.value(), 0.05, 1e-5);
  EXPECT_GT(report.planes[0].share, 0.95);
}

TEST(MeasuredPlanes, LeaveOutPlanesWhereNothingWasMeasured) {
  const MeasuredPlaneReport report =
      measure({map_plane({0, 0, 0.01}, 0.5, 0), map_plane({0, 0, 1}, 0.5, 0)});
  EXPECT_TRUE(report.planes[0].offset.has_value());
  EXPECT_FALSE(report.planes[1].offset.has_value());
  EXPECT_NEAR(report.offset.value(), 0.01, 1e-5);
  const auto json = to_json(report).at("measured_planes");
  EXPECT_EQ(json.at("measured"), 1);
  EXPECT_TRUE(json.at("planes").at(1).at("offset").is_null());
  EXPECT_THAT(to_table(report), HasSubstr("not measured"));
  EXPECT_FALSE(measure({map_plane({0, 0, 1}, 0.5, 0)}).offset.has_value());
  EXPECT_FALSE(measure({map_plane({0, 0, 0}, 0.5, 80)}).offset.has_value())
      << "it does not face so";
}

}  // namespace
}  // namespace cairn
