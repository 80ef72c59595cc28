#include "cairn/mapping/plane_mapping.h"

#include <gmock/gmock.h>

#include "mapping/planes_of_pictures.h"

namespace cairn {
namespace {

using testing::broken_planes;
using testing::disturbed;
using testing::IsNearPlane;
using testing::keyframes_of;
using testing::kScale;
using testing::MapPlanesOfPictures;
using testing::perceive;
using testing::planes_of;
using testing::rectangle;
using testing::seen_from;
using ::testing::SizeIs;
using testing::wall_corners;

const Plane kWall(Eigen::Vector3d::UnitZ(), -4);

TEST_F(MapPlanesOfPictures, OnePlaneInTwoPicturesIsOneLandmarkWithItsPoints) {
  const auto keyframes = keyframes_of(map);
  for (int i : {0, 1}) {
    KeyframePerception seen = perceive(map, keyframes[i], {wall_corners()}, 36, 5, 0.04);
    for (std::uint32_t k = 72; k < 78; ++k) {  // in front
      seen.planes[0].keypoints.push_back(k);
      seen.planes[0].inner.push_back(k);
    }
    show_picture(keyframes[i], seen);
  }
  ASSERT_THAT(planes_of(map), SizeIs(1));
  const PlaneId id = planes_of(map)[0];
  const PlaneLandmark& landmark = map.planes()[id];
  EXPECT_THAT(map.plane_in_world(id), IsNearPlane(kWall, 1, 0.04)) << "as the points say";
  EXPECT_THAT(landmark.points, SizeIs(36)) << "all of the wall, none in front of it";
  EXPECT_EQ(landmark.sightings, 2u);
  ASSERT_THAT(landmark.observations, SizeIs(2));
  for (const PlaneObservation& o : landmark.observations) {  // as the pictures say
    const SE3& T_wc = map.keyframes()[o.keyframe].T_wc;
    const SeenPlane said = disturbed(seen_from(T_wc, wall_corners()), 5, 0.04);
    EXPECT_LT((o.centroid - said.centroid).norm(), 1e-9);
    EXPECT_THAT(Plane::through(o.centroid, o.normal), IsNearPlane(said.plane, 1e-3, 1e-6));
  }
  EXPECT_EQ(broken_planes(map), "");
}

// A keyframe that has lost half of its points: on the wall, and in front of it.
TEST_F(MapPlanesOfPictures, WhereMeasuredPointsAreFewPlaneAndPredictedDepthGiveThem) {
  const KeyframeId keyframe = keyframes_of(map)[1];
  KeyframePerception seen = perceive(map, keyframe, {wall_corners()}, 36, 0, 0);
  const SE3 T_cw = map.keyframes()[keyframe].T_wc.inverse();
  std::vector<std::uint32_t> freed;
  for (std::uint32_t k = 0; k < 78; k += 2) {
    if (k >= 36 && k < 72) continue;  // the floor stays
    const PointId p = map.keyframes()[keyframe].points[k];
    const double z = (T_cw * map.points()[p].position).z();
    seen.depth[k] = k < 36 ? 0 : float(z / kScale);  // beside the wall, the network says
    map.erase_point(p);
    freed.push_back(k);
  }
  options.few_points = 10;  // more are measured: nothing is assumed
  EXPECT_TRUE(show_picture(keyframe, seen).empty());
  options.few_points = 100;
  const auto assumed = show_picture(keyframe, seen);
  EXPECT_EQ(assumed.size(), freed.size());
  for (const PointId p : assumed) {
    const MapPoint& point = map.points()[p];
    EXPECT_TRUE(point.assumed);
    const std::uint32_t k = point.observations.front().keypoint;
    EXPECT_LT((point.position - points[k]).norm(), 0.05) << k;
    EXPECT_EQ(point.plane.valid(), k < 36) << k;
  }
  EXPECT_EQ(broken_planes(map), "");
}

// The second picture has the wall 36 degrees off, and none of its points.
TEST_F(MapPlanesOfPictures, WhereMeasuredPointsAreFewAnUnsureNormalIsThatOfTheKnownWall) {
  const auto landmarks_with = [&](int few_points) {
    map = testing::map_of(points, testing::few_poses(3));
    const auto keyframes = keyframes_of(map);
    show(keyframes[0], {wall_corners()});
    KeyframePerception seen = perceive(map, keyframes[1], {wall_corners()}, 0, 36, 0.04);
    seen.planes[0].sigma_angle = 0.25;
    options.few_points = few_points;
    show_picture(keyframes[1], seen);
    return planes_of(map).size();
  };
  EXPECT_EQ(landmarks_with(1000), 1u);
  EXPECT_EQ(landmarks_with(0), 2u);
}

// What 0.3 units are from far away says nothing of shelves that are near.
TEST_F(MapPlanesOfPictures, ShelvesStayTwoWhenAFarWallIsInThePicture) {
  const KeyframeId id = map.first();
  map.add_plane(id, seen_from(SE3(), rectangle({-0.5, 0.3, 1}, {1, 0, 0}, {0, 0, 0.5})));
  map.add_plane(id, seen_from(SE3(), rectangle({-0.5, 0.6, 1}, {1, 0, 0}, {0, 0, 0.5})));
  show(id, {wall_corners()});
  EXPECT_THAT(planes_of(map), SizeIs(3));
}

TEST_F(MapPlanesOfPictures, WhatAdjustmentsBringTogetherIsOneLandmark) {
  const SeenPlane table = seen_from(SE3(), rectangle({-0.5, 0.6, 1}, {1, 0, 0}, {0, 0, 0.5}));
  const PlaneId a = map.add_plane(map.first(), table);
  const PlaneId b = map.add_plane(
      map.first(), seen_from(SE3(), rectangle({-0.5, 0.3, 1}, {1, 0, 0}, {0, 0, 0.5})));
  fuse_planes(map, options.association);
  EXPECT_THAT(planes_of(map), SizeIs(2)) << "one stands above the other";
  for (const PlaneId id : {a, b}) {
    map.planes()[id].plane = table.plane;
    map.planes()[id].outline = table.outline;
    map.planes()[id].sigma_tilt = 0.02;
  }
  fuse_planes(map, options.association);
  EXPECT_THAT(planes_of(map), SizeIs(1));
  EXPECT_EQ(broken_planes(map), "");
}

}  // namespace
}  // namespace cairn
