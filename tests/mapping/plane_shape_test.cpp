#include "cairn/mapping/plane_shape.h"

#include <gtest/gtest.h>

#include <array>

#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::few_poses;
using testing::grid_on;
using testing::keyframes_of;
using testing::map_of;
using testing::rectangle;
using testing::seen_from;
using testing::wall_corners;

using Polygon = std::vector<Eigen::Vector3d>;
using Parts = std::vector<Polygon>;

// The wall z = 4. All keyframes of a short walk have all of it in their pictures.
class SeenWall {
 public:
  explicit SeenWall(std::vector<SE3> poses = few_poses(12))
      : map(map_of(grid_on(wall_corners(), 3), poses)), keyframes(keyframes_of(map)) {}
  // In whose masks all of these parts are.
  explicit SeenWall(const Parts& parts) : SeenWall() {
    for (const KeyframeId keyframe : keyframes) see(keyframe, parts);
  }

  void see(KeyframeId keyframe, const Parts& parts) {
    for (const Polygon& part : parts) {
      const SeenPlane seen = seen_from(map.keyframes()[keyframe].T_wc, part);
      if (id.valid()) {
        map.observe_plane(id, keyframe, seen);
      } else {
        id = map.add_plane(keyframe, seen);
      }
    }
  }

  Polygon shape() const { return plane_shape(map, id); }

  Map map;
  std::vector<KeyframeId> keyframes;
  PlaneId id;
};

// Signed, seen from where the wall's normal points: from the cameras, against z.
double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice -= polygon[i].cross(polygon[(i + 1) % polygon.size()]).z();
  }
  return twice / 2;
}

const Polygon kLow = rectangle({-1.5, 0.5, 4}, {3, 0, 0}, {0, 0.5, 0});
const Polygon kLeft = rectangle({-1.5, -1, 4}, {0.5, 0, 0}, {0, 2, 0});
const Polygon kRight = rectangle({1, -1, 4}, {0.5, 0, 0}, {0, 2, 0});

TEST(PlaneShape, OfAnLIsAnL) {
  const SeenWall wall({kLow, kLeft});
  EXPECT_NEAR(area(wall.map.outline_in_world(wall.id)), 3.0 + 0.5 * 2.5 * 1.5 - 0.75, 0.5)
      << "the notch is cut off in a straight line";
  EXPECT_NEAR(area(wall.shape()), 2.25, 0.1);
  for (const Eigen::Vector3d& corner : wall.shape()) EXPECT_NEAR(corner.z(), 4, 1e-9);
}

TEST(PlaneShape, LiesOnThePlaneAsItIsNow) {
  SeenWall wall({kLow, kLeft});
  PlaneLandmark& landmark = wall.map.planes()[wall.id];
  landmark.plane = Plane::through({0, 0, 8}, landmark.plane.normal());
  for (const Eigen::Vector3d& corner : wall.shape()) EXPECT_NEAR(corner.z(), 8, 1e-9);
}

TEST(PlaneShape, HasNoHoles) {
  const Polygon high = rectangle({-1.5, -1, 4}, {3, 0, 0}, {0, 0.5, 0});
  EXPECT_NEAR(area(SeenWall({kLow, kLeft, kRight, high}).shape()), 6, 0.15);
}

TEST(PlaneShape, LeavesOutWhatMostPicturesDoNotShow) {
  SeenWall wall;
  for (std::size_t i = 0; i < wall.keyframes.size(); ++i) {
    wall.see(wall.keyframes[i], i % 4 == 0 ? Parts{kLow, kLeft} : Parts{kLow});
  }
  EXPECT_NEAR(area(wall.shape()), 1.5, 0.08);
}

TEST(PlaneShape, BelievesPicturesFromNearMoreThanThoseFromAfar) {
  std::vector<SE3> poses = few_poses(5);
  for (int i = 0; i < 3; ++i) {
    poses.emplace_back(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.5 + 0.2 * i, 0, 2));
  }
  SeenWall wall(poses);
  for (std::size_t i = 0; i < wall.keyframes.size(); ++i) {
    wall.see(wall.keyframes[i], i < 5 ? Parts{kLow, kLeft} : Parts{kLow});
  }
  EXPECT_NEAR(area(wall.shape()), 1.5, 0.08);
}

TEST(PlaneShape, KeepsWhatOthersDoNotLookAt) {
  const Polygon left = rectangle({-3.5, -1, 4}, {3.2, 0, 0}, {0, 2, 0});
  const Polygon right = rectangle({0.3, -1, 4}, {3.2, 0, 0}, {0, 2, 0});
  std::vector<SE3> poses;
  for (int i = 0; i < 12; ++i) {
    const double turn = i < 3 ? -0.5 : 0.5;  // to the left, to the right
    poses.emplace_back(so3_exp(Eigen::Vector3d(0, turn, 0)), Eigen::Vector3d(0.05 * i, 0, 0));
  }
  SeenWall wall(poses);
  for (std::size_t i = 0; i < 12; ++i) wall.see(wall.keyframes[i], Parts{i < 3 ? left : right});
  EXPECT_NEAR(area(wall.shape()), 14, 0.5);
}

// Those that look elsewhere do not deny it.
TEST(PlaneShape, LeavesOutWhatASinglePictureShowsBesideAllOthers) {
  std::vector<SE3> poses(12, SE3(so3_exp(Eigen::Vector3d(0, 0.5, 0)), Eigen::Vector3d::Zero()));
  poses[0] = SE3(so3_exp(Eigen::Vector3d(0, -0.5, 0)), Eigen::Vector3d::Zero());
  SeenWall wall(poses);
  const Polygon left = rectangle({-2, -1, 4}, {1.7, 0, 0}, {0, 2, 0});
  const Polygon right = rectangle({0.3, -1, 4}, {3.2, 0, 0}, {0, 2, 0});
  for (std::size_t i = 0; i < 12; ++i) wall.see(wall.keyframes[i], Parts{i == 0 ? left : right});
  EXPECT_NEAR(area(wall.shape()), 6.4, 0.3);
}

TEST(PlaneShape, OfWhatEachPictureShowsAThirdIsAllOfIt) {
  SeenWall wall;
  const Polygon middle = rectangle({-0.5, -1, 4}, {1, 0, 0}, {0, 2, 0});
  const Polygon left = rectangle({-1.5, -1, 4}, {1, 0, 0}, {0, 2, 0});
  const Polygon right = rectangle({0.5, -1, 4}, {1, 0, 0}, {0, 2, 0});
  const std::array<Polygon, 3> thirds = {left, middle, right};
  for (std::size_t i = 0; i < 12; ++i) wall.see(wall.keyframes[i], Parts{thirds[i % 3]});
  EXPECT_NEAR(area(wall.shape()), 6, 0.2);
}

TEST(PlaneShape, GoesOnBehindWhatCutsItInTwo) {
  const Polygon left = rectangle({-1.5, -1, 4}, {1.4, 0, 0}, {0, 2, 0});
  const Polygon right = rectangle({0.1, -1, 4}, {1.4, 0, 0}, {0, 2, 0});
  EXPECT_NEAR(area(SeenWall({left, right}).shape()), 6, 0.15);
}

TEST(PlaneShape, OfPartsThatAreFarApartIsConvex) {
  const SeenWall wall({kLeft, kRight});
  EXPECT_NEAR(area(wall.shape()), 6, 0.15);
}

TEST(PlaneShape, LeavesOutPartsWithoutPointsWhereOthersAreFullOfThem) {
  SeenWall wall({kLeft, kRight});
  const auto add_points = [&](int count) {
    for (int i = 0; i < count; ++i) {
      wall.map.set_plane_of(wall.map.add_point({-1.2, -0.5 + 0.01 * i, 4}), wall.id);
    }
  };
  add_points(20);
  EXPECT_NEAR(area(wall.shape()), 6, 0.15) << "a bare wall";
  add_points(80);
  EXPECT_NEAR(area(wall.shape()), 1, 0.05);
}

TEST(PlaneShape, OfAPlaneWithoutOutlineIsNone) {
  SeenWall wall(Parts{kLow});
  wall.map.planes()[wall.id].outline.clear();
  EXPECT_TRUE(wall.shape().empty());
}

TEST(PlaneShape, SurvivesTheKeyframesThatSawIt) {
  SeenWall wall({kLow, kLeft});
  for (std::size_t i = 0; i < 10; ++i) wall.map.erase_keyframe(wall.keyframes[i]);
  EXPECT_NEAR(area(wall.shape()), 2.25, 0.1);
}

}  // namespace
}  // namespace cairn
