#include "cairn/map/plane_labels.h"

#include <gtest/gtest.h>

namespace cairn {
namespace {

TEST(PlaneLabels, LevelOnesAreParallelAndSquareToUprightOnes) {
  EXPECT_EQ(implied_relation("floor", "table"), PlaneRelation::kParallel);
  EXPECT_EQ(implied_relation("ceiling", "floor"), PlaneRelation::kParallel);
  EXPECT_EQ(implied_relation("floor", "floor"), PlaneRelation::kParallel);
  EXPECT_EQ(implied_relation("wall", "table"), PlaneRelation::kPerpendicular);
  EXPECT_EQ(implied_relation("table", "door"), PlaneRelation::kPerpendicular);
}

TEST(PlaneLabels, WallsMeetAtAnyAngleAndOtherThingsStandAsTheyLike) {
  EXPECT_EQ(implied_relation("wall", "wall"), std::nullopt);
  EXPECT_EQ(implied_relation("wall", "door"), std::nullopt);
  EXPECT_EQ(implied_relation("floor", "cabinet"), std::nullopt);
  EXPECT_EQ(implied_relation("plane", "plane"), std::nullopt);
  EXPECT_EQ(implied_relation("", "floor"), std::nullopt);
}

TEST(PlaneLabels, WallsAreUprightAndFloorsAreNot) {
  EXPECT_TRUE(is_upright("wall"));
  EXPECT_TRUE(is_upright("door"));
  EXPECT_FALSE(is_upright("floor"));
  EXPECT_FALSE(is_upright("cabinet"));
}

TEST(PlaneLabels, WallsEndFloorsAndCeilingsButNoTables) {
  EXPECT_TRUE(is_ended_by_walls("floor"));
  EXPECT_TRUE(is_ended_by_walls("ceiling"));
  EXPECT_FALSE(is_ended_by_walls("table"));
  EXPECT_FALSE(is_ended_by_walls("wall"));
}

}  // namespace
}  // namespace cairn
