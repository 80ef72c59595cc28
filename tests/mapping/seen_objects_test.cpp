#include "cairn/mapping/seen_objects.h"

#include <gmock/gmock.h>

#include <limits>

#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::kCamera;
using ::testing::SizeIs;

const Camera kStraight(Camera::Model::kRadialTangential, 640, 480, kCamera);

DetectedObject cup(const Box2& box) {
  DetectedObject object;
  object.box = box;
  object.class_name = "cup";
  object.score = 0.7;
  return object;
}

std::vector<SeenObject> see(const DetectedObject& object, const Camera& camera = kStraight) {
  const auto frame = testing::frame_at({{110, 110}, {300, 300}}, 1);
  const View view(camera, 8, 1.2, 1.0);
  return see_objects(std::vector<DetectedObject>{object}, *frame, camera, view);
}

TEST(SeenObjects, HaveTheirBoxAndItsKeypointsWhereTheLensIsStraight) {
  const auto seen = see(cup({100, 90, 160, 150}));
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_TRUE(seen[0].box.edges().isApprox(Eigen::Vector4d(100, 90, 160, 150), 1e-9));
  EXPECT_THAT(seen[0].keypoints, ::testing::ElementsAre(0u));
  EXPECT_THAT(seen[0].cut, ::testing::Each(false));
  EXPECT_EQ(seen[0].class_name, "cup");
}

TEST(SeenObjects, AreCutWhereTheirBoxTouchesTheBorder) {
  const auto seen = see(cup({-0.5, 90, 160, 479.5}));
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_THAT(seen[0].cut, ::testing::ElementsAre(true, false, false, true));
}

TEST(SeenObjects, AreCutWhereTheirBoxEndsBeforeTheBorderByNoMoreThanItsEdgesErr) {
  const auto wide = see(cup({200, 200, 632, 470})), small = see(cup({600, 430, 632, 470}));
  ASSERT_THAT(wide, SizeIs(1));
  ASSERT_THAT(small, SizeIs(1));
  EXPECT_THAT(wide[0].cut, ::testing::ElementsAre(false, false, true, true));
  EXPECT_THAT(small[0].cut, ::testing::Each(false));
}

TEST(SeenObjects, OfABentPictureAreWhereThePinholeWouldSeeThem) {
  const Camera bent(Camera::Model::kRadialTangential, 640, 480, kCamera, {-0.25, 0.05, 0, 0, 0});
  const Box2 box{500, 60, 600, 140};
  const auto seen = see(cup(box), bent);
  ASSERT_THAT(seen, SizeIs(1));
  for (const double x : {box.x0, box.x1}) {
    for (const double y : {box.y0, box.y1}) {
      const Eigen::Vector2d uv = bent.undistort({x, y});
      EXPECT_GE(uv.x(), seen[0].box.x0 - 1e-9);
      EXPECT_LE(uv.x(), seen[0].box.x1 + 1e-9);
      EXPECT_GE(uv.y(), seen[0].box.y0 - 1e-9);
      EXPECT_LE(uv.y(), seen[0].box.y1 + 1e-9);
    }
  }
  EXPECT_GT(seen[0].box.x1, box.x1) << "a barrel's corner lies farther out";
}

TEST(SeenObjects, ThatCannotBeAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(see(cup({nan, 1, 2, 3})), SizeIs(0));
  EXPECT_THAT(see(cup({10, 10, 10, 30})), SizeIs(0));
  DetectedObject nothing = cup({10, 10, 20, 30});
  nothing.score = 0;
  EXPECT_THAT(see(nothing), SizeIs(0));
}

}  // namespace
}  // namespace cairn
