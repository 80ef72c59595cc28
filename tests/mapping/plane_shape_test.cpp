#include "cairn/mapping/plane_shape.h"

#include <gtest/gtest.h>

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

// A wall z = 4 of which each keyframe of a walk sees the next of these parts, and again.
class SeenWall {
 public:
  explicit SeenWall(const std::vector<Polygon>& parts, int pictures = 12)
      : map(map_of(grid_on(wall_corners(), 3), few_poses(pictures))) {
    const std::vector<KeyframeId> keyframes = keyframes_of(map);
    for (std::size_t i = 0; i < keyframes.size(); ++i) see(keyframes[i], parts[i % parts.size()]);
  }

  void see(KeyframeId keyframe, const Polygon& part) {
    const SeenPlane seen = seen_from(map.keyframes()[keyframe].T_wc, part);
    if (id.valid()) {
      map.observe_plane(id, keyframe, seen);
    } else {
      id = map.add_plane(keyframe, seen);
    }
  }

  Polygon shape() const { return plane_shape(map, id); }

  Map map;
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

TEST(PlaneShape, LeavesOutWhatHardlyAnyPictureShows) {
  std::vector<Polygon> parts(19, kLow);
  parts.push_back(kLeft);
  const SeenWall wall(parts, 20);
  EXPECT_NEAR(area(wall.shape()), 1.5, 0.08);
}

TEST(PlaneShape, GoesOnBehindWhatCutsItInTwo) {
  const Polygon left = rectangle({-1.5, -1, 4}, {1.4, 0, 0}, {0, 2, 0});
  const Polygon right = rectangle({0.1, -1, 4}, {1.4, 0, 0}, {0, 2, 0});
  EXPECT_NEAR(area(SeenWall({left, right}).shape()), 6, 0.15);
}

TEST(PlaneShape, OfPartsThatAreFarApartIsTheConvexOutline) {
  const SeenWall wall({kLeft, kRight});
  EXPECT_NEAR(area(wall.shape()), 6, 1e-9);
}

TEST(PlaneShape, KnowsTwoPartsInOnePicture) {
  SeenWall wall({kLow}, 4);
  for (const KeyframeId keyframe : keyframes_of(wall.map)) wall.see(keyframe, kLeft);
  EXPECT_NEAR(area(wall.shape()), 2.25, 0.1);
}

TEST(PlaneShape, OfAPlaneWithoutOutlineIsNone) {
  SeenWall wall({kLow});
  wall.map.planes()[wall.id].outline.clear();
  EXPECT_TRUE(wall.shape().empty());
}

TEST(PlaneShape, SurvivesTheKeyframesThatSawIt) {
  SeenWall wall({kLow, kLeft});
  const std::vector<KeyframeId> keyframes = keyframes_of(wall.map);
  for (std::size_t i = 0; i + 2 < keyframes.size(); ++i) wall.map.erase_keyframe(keyframes[i]);
  EXPECT_NEAR(area(wall.shape()), 2.25, 0.1);
}

}  // namespace
}  // namespace cairn
