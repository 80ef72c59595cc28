#include "cairn/perception/plane_hypotheses.h"

#include <gmock/gmock.h>

#include <set>

#include "cairn/geometry/sampler.h"
#include "cairn/perception/normals.h"
#include "cairn/perception/plane_agreement.h"
#include "room_maps.h"

namespace cairn {
namespace {

using testing::angle_deg;
using testing::kRoomCamera;
using testing::nearest_plane;
using testing::RoomMaps;

const cv::Size kGrid(128, 96);

struct Room {
  cv::Mat_<cv::Vec3f> rays = viewing_rays(kRoomCamera, kGrid);
  RoomMaps maps{rays};
  PlaneHypothesisOptions options;
  OrganizedCloud cloud{rays, maps.depth, normals_from_depth(rays, maps.depth, options.noise, {})};
};

void expect_all_planes(const RoomMaps& room, const std::vector<PlaneHypothesis>& found,
                       double max_angle_deg, double max_offset) {
  std::set<std::size_t> which;
  for (const PlaneHypothesis& plane : found) {
    const std::size_t i = nearest_plane(room, plane.plane);
    EXPECT_LT(angle_deg(plane.plane, room.planes[i]), max_angle_deg);
    EXPECT_NEAR(plane.plane[3] / room.planes[i][3], 1, max_offset);
    which.insert(i);
  }
  EXPECT_EQ(which.size(), room.planes.size());
}

TEST(Normals, AreExactOnPlanesThroughALens) {
  const Room room;
  int right = 0, known = 0;
  for (int v = 0; v < kGrid.height; ++v) {
    for (int u = 0; u < kGrid.width; ++u) {
      if (!room.cloud.known(v, u)) continue;
      ++known;
      const Eigen::Vector4d& plane = room.maps.planes[room.maps.owner(v, u) - 1u];
      right += room.cloud.normal(v, u).dot(plane.head<3>()) > std::cos(0.5 * M_PI / 180);
    }
  }
  EXPECT_GT(known, 0.98 * kGrid.area());
  EXPECT_GT(right, 0.7 * kGrid.area());  // the others have an edge in their window
}

TEST(Normals, AreUnknownWhereDepthIs) {
  Room room;
  room.maps.depth(cv::Rect(20, 20, 40, 40)) = 0;
  const auto normals =
      normals_from_depth(room.rays, room.maps.depth, room.options.noise, NormalOptions());
  EXPECT_EQ(normals(40, 40), cv::Vec3f());
  EXPECT_EQ(normals(40, 21), cv::Vec3f());
  EXPECT_NE(normals(40, 10), cv::Vec3f());
}

TEST(PlaneHypotheses, ComponentsAreTheRoomsPlanes) {
  const Room room;
  expect_all_planes(room.maps, planes_of_components(room.cloud, room.options), 1, 0.01);
}

TEST(PlaneHypotheses, ARegionOfSeveralWallsIsSplit) {
  const Room room;
  LabelledRegion everything{region_of_mask(room.maps.owner), "wall"};
  const auto found = planes_of_regions(room.cloud, {everything}, room.options);
  expect_all_planes(room.maps, found, 3, 0.09);
  for (const PlaneHypothesis& plane : found) EXPECT_EQ(plane.label, "wall");
}

TEST(PlaneHypotheses, DoNotDependOnTheScaleOfDepth) {
  const Room room;
  OrganizedCloud large{room.rays, {}, {}};
  large.depth = 7 * room.cloud.depth.clone();
  large.normals = normals_from_depth(large.rays, large.depth, room.options.noise, {});
  const auto small_planes = planes_of_components(room.cloud, room.options);
  const auto large_planes = planes_of_components(large, room.options);
  ASSERT_EQ(small_planes.size(), large_planes.size());
  for (std::size_t i = 0; i < small_planes.size(); ++i) {
    EXPECT_NEAR(large_planes[i].plane[3], 7 * small_planes[i].plane[3], 1e-3);
    EXPECT_LT(angle_deg(large_planes[i].plane, small_planes[i].plane), 0.01);
  }
}

TEST(PlaneHypotheses, AFitBearsOutliers) {
  Room room;
  GridRegion wall;
  for (const cv::Point& p : region_of_mask(room.maps.owner)) {
    if (room.maps.owner(p) == 1) wall.push_back(p);
  }
  Sampler sampler(3);
  for (const cv::Point& p : wall) {
    if (sampler.below(10) < 2) room.cloud.depth(p) *= float(1.2 + sampler.uniform());
  }
  const auto fit = fit_region(room.cloud, wall, room.options);
  ASSERT_TRUE(fit.has_value());
  EXPECT_LT(angle_deg(fit->plane, room.maps.planes[0]), 0.5);
  EXPECT_NEAR(fit->inlier_share, 0.8, 0.03);
  EXPECT_FALSE(fit_region(room.cloud, {{3, 3}, {3, 3}}, room.options).has_value());
  EXPECT_FALSE(fit_region(room.cloud, {}, room.options).has_value());
}

TEST(PlaneAgreement, AcceptsOnlyWhereBothAgree) {
  const Room room;
  const auto components = planes_of_components(room.cloud, room.options);
  const auto agreed = [&](double turn_deg, double offset) {
    std::vector<PlaneHypothesis> others = components;
    for (PlaneHypothesis& plane : others) {
      const Eigen::Vector3d axis = plane.plane.head<3>().unitOrthogonal();
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const cv::Point& p : plane.pixels) middle += room.cloud.point(p.y, p.x);
      middle *= offset / double(plane.pixels.size());
      plane.plane.head<3>() =
          Eigen::AngleAxisd(turn_deg * M_PI / 180, axis) * plane.plane.head<3>();
      plane.plane[3] = -plane.plane.head<3>().dot(middle);
      plane.label = "wall";
    }
    return agreeing_planes(room.cloud, others, components, room.options, {});
  };
  EXPECT_EQ(agreed(0, 1).size(), components.size());
  EXPECT_EQ(agreed(3, 1.01).size(), components.size());
  EXPECT_TRUE(agreed(25, 1).empty());
  EXPECT_TRUE(agreed(0, 1.3).empty());
  EXPECT_TRUE(agreed(0, 0.75).empty());
  EXPECT_GT(agreed(0, 1)[0].agreement, agreed(10, 1)[0].agreement);
}

TEST(PlaneAgreement, PiecesOfOneSurfaceAreMerged) {
  const Room room;
  std::vector<AgreedPlane> pieces(3);
  for (const cv::Point& p : region_of_mask(room.maps.owner)) {
    if (room.maps.owner(p) == 1) pieces[p.x < 60 ? 0 : 1].plane.pixels.push_back(p);
    if (room.maps.owner(p) == 2) pieces[2].plane.pixels.push_back(p);
  }
  pieces[0].plane.plane = pieces[1].plane.plane = room.maps.planes[0];
  pieces[2].plane.plane = room.maps.planes[1];
  auto labelled = pieces;
  labelled[1].plane.label = "door";
  merge_pieces(room.cloud, room.options, {}, pieces);
  EXPECT_EQ(pieces.size(), 2u);
  merge_pieces(room.cloud, room.options, {}, labelled);
  EXPECT_EQ(labelled.size(), 3u);
}

TEST(GridRegions, FillOnlySmallHoles) {
  cv::Mat_<uchar> mask(40, 40, uchar(0));
  mask(cv::Rect(5, 5, 30, 30)) = 255;
  mask(cv::Rect(8, 8, 2, 2)) = 0;
  mask(cv::Rect(15, 15, 12, 12)) = 0;
  fill_small_holes(mask, 0.02);
  EXPECT_EQ(cv::countNonZero(mask), 900 - 144);
}

}  // namespace
}  // namespace cairn
