#include "cairn/mapping/mapper.h"

#include <gtest/gtest.h>

#include "cairn/geometry/median.h"
#include "map/flat_map.h"
#include "map/links.h"
#include "map/painted_wall.h"
#include "mapping/drive.h"

namespace cairn {
namespace {

using testing::along;
using testing::broken_links;
using testing::errors_of;
using testing::point_view;

struct MapperTest : public ::testing::Test {
  bool start() {
    if (!mapper.initialize(drive.initial(along(0), along(0.3)))) return false;
    truth[map().first()] = along(0);
    truth[map().newest()] = along(0.3);
    return true;
  }
  KeyframeId insert(double s) {
    const KeyframeId id = mapper.insert(drive.candidate(along(s), *mapper.view()));
    truth[id] = along(s);
    return id;
  }
  const Map& map() const { return mapper.map(); }

  testing::PointWorld world{61};
  testing::Drive drive{world};
  Mapper mapper{point_view(), {}};
  std::map<KeyframeId, SE3> truth;  // of all keyframes ever
};

TEST_F(MapperTest, StartsAMapWithItsMedianDepthAsUnit) {
  ASSERT_TRUE(start());
  ASSERT_EQ(map().keyframes().size(), 2u);
  EXPECT_LT(map().keyframes()[map().first()].T_wc.log().norm(), 1e-12)
      << "the world is the first keyframe";
  EXPECT_NEAR(map().depth_quantile(map().first(), 0.5), 1, 0.02);
  EXPECT_EQ(broken_links(map()), "");
  const auto errors = errors_of(map(), world);
  EXPECT_EQ(errors.mixed, 0);
  EXPECT_GT(errors.points, 200);
  ASSERT_NE(mapper.view(), nullptr);
  EXPECT_EQ(mapper.view()->reference, map().newest());
  EXPECT_EQ(mapper.view()->points.size(), map().points().size());
}

TEST(MapperStart, IsNearTheTruthInMostWorlds) {
  std::vector<double> errors;
  for (std::uint64_t seed = 61; seed < 70; ++seed) {
    testing::PointWorld world(seed);
    testing::Drive drive(world);
    Mapper mapper(point_view(), {});
    ASSERT_TRUE(mapper.initialize(drive.initial(along(0), along(0.3)))) << seed;
    errors.push_back(errors_of(mapper.map(), world).camera);
    EXPECT_LT(errors.back(), 0.25) << seed;
  }
  EXPECT_LT(median(errors), 0.12);
}

// The corners of the second picture are up to half a pixel off.
TEST(MapperStart, SeesItsPointsInBothPicturesWhereTheyLookAlike) {
  const testing::PaintedWall wall;
  testing::Random random(65);
  const SE3 T_12(so3_exp({0.01, 0, 0.01}), Eigen::Vector3d(0.2, 0.03, 0.05));
  const std::vector<Eigen::Vector3d> points = testing::grid_on(
      testing::rectangle({-0.6, -0.4, testing::PaintedWall::kZ}, {1.2, 0, 0}, {0, 0.8, 0}), 11);
  const auto see = [&](const SE3& T_wc, double off) {
    std::vector<Eigen::Vector2d> pixels;
    pixels.reserve(points.size());
    for (const Eigen::Vector3d& point : points) {
      const double du = random.uniform(-off, off), dv = random.uniform(-off, off);
      pixels.push_back(wall.pixel(T_wc, point) + Eigen::Vector2d(du, dv));
    }
    return testing::frame_at(pixels, T_wc.translation().x());
  };
  InitialPair pair{see(SE3(), 0), see(T_12, 0.5), T_12.inverse(), {}};
  for (std::uint32_t i = 0; i < points.size(); ++i) pair.points.push_back({i, i, points[i]});
  pair.picture1 = std::make_shared<Picture>(wall.show(SE3()));
  pair.picture2 = std::make_shared<Picture>(wall.show(T_12));
  Mapper mapper(View(wall.camera(), 4, 1.2, 1), {});
  ASSERT_TRUE(mapper.initialize(pair));
  const Keyframe& second = mapper.map().keyframes()[mapper.map().newest()];
  std::size_t aligned = 0;
  double worst = 0;
  mapper.map().points().for_each([&](PointId, const MapPoint& p) {
    if (!p.observations.front().aligned() || !p.observations.back().aligned()) return;
    const std::uint32_t keypoint = p.observations.back().keypoint;
    worst = std::max(worst,
                     (wall.pixel(T_12, points[keypoint]) - second.frame->pixel(keypoint)).norm());
    ++aligned;
  });
  EXPECT_GT(aligned, 0.8 * double(points.size()));
  EXPECT_LT(worst, 0.2);
}

TEST_F(MapperTest, RefusesToStartFromAFewPoints) {
  InitialPair pair = drive.initial(along(0), along(0.3));
  pair.points.resize(15);
  EXPECT_FALSE(mapper.initialize(pair));
}

TEST_F(MapperTest, GrowsAMapThatIsNearTheTruth) {
  ASSERT_TRUE(start());
  const std::size_t initial_points = map().points().size();
  std::uint64_t version = mapper.view()->version;
  for (int i = 2; i <= 10; ++i) {
    const KeyframeId id = insert(0.25 * i);
    EXPECT_EQ(mapper.view()->reference, id);
    EXPECT_GT(mapper.view()->version, version) << "an insertion is published";
    version = mapper.view()->version;
    mapper.adjust(nullptr);
    EXPECT_GT(mapper.view()->version, version) << "an adjustment is published";
    version = mapper.view()->version;
    ASSERT_EQ(broken_links(map()), "") << "after keyframe " << i;
  }
  EXPECT_GT(map().points().size(), initial_points + 100) << "new points were made on the way";
  const auto errors = errors_of(map(), world);
  EXPECT_LT(errors.mixed, errors.points / 50);
  EXPECT_LT(errors.median, 0.1);
  EXPECT_LT(errors.camera, 0.15);
  EXPECT_LT(errors.rotation_deg, 1.5);

  const AdjustmentSummary summary = mapper.finish(nullptr);
  EXPECT_TRUE(summary.usable) << summary.to_string();
  EXPECT_LT(errors_of(map(), world).camera, 0.15);
  EXPECT_EQ(broken_links(map()), "");
}

TEST_F(MapperTest, PublishesWhatTheMapHolds) {
  ASSERT_TRUE(start());
  insert(0.5);
  mapper.adjust(nullptr);
  const MapView& view = *mapper.view();
  EXPECT_EQ(view.map_keyframes, map().keyframes().size());
  for (const MapView::Point& p : view.points) {
    ASSERT_TRUE(map().points().contains(p.id));
    EXPECT_EQ(p.position, map().points()[p.id].position);
  }
  for (const auto& k : view.keyframes) {
    EXPECT_EQ((map().keyframes()[k.id].T_wc.matrix() - k.T_wc.matrix()).norm(), 0);
  }
}

TEST_F(MapperTest, BuriesRedundantKeyframesWhereTheyWereFromTheirParents) {
  ASSERT_TRUE(start());
  for (int i = 1; i <= 14; ++i) {
    insert(0.3 + 0.03 * i);
    mapper.adjust(nullptr);
    ASSERT_EQ(broken_links(map()), "") << i;
  }
  EXPECT_EQ(map().keyframes().size() + mapper.buried().size(), 16u);
  ASSERT_GT(mapper.buried().size(), 2u);
  EXPECT_TRUE(map().keyframes().contains(map().first()));
  const double unit = errors_of(map(), world).to_world.scale();
  for (const BuriedKeyframe& b : mapper.buried()) {
    EXPECT_FALSE(map().keyframes().contains(b.id));
    const SE3 expected = truth.at(b.parent).inverse() * truth.at(b.id);
    EXPECT_LT((unit * b.T_pk.translation() - expected.translation()).norm(), 0.05);
    EXPECT_LT(testing::rotation_error_deg(b.T_pk, expected), 0.5);
  }
  for (const KeyframeId id : mapper.similar_keyframes(world.show(along(0.5), 99)->features, 20)) {
    EXPECT_TRUE(map().keyframes().contains(id)) << "what is buried is no candidate";
  }
}

TEST_F(MapperTest, TakesAKeyframeWhoseReferenceWasBuriedMeanwhile) {
  ASSERT_TRUE(start());
  for (int i = 1; i <= 14 && mapper.buried().empty(); ++i) {
    insert(0.3 + 0.03 * i);
    mapper.adjust(nullptr);
  }
  ASSERT_FALSE(mapper.buried().empty());
  const KeyframeId gone = mapper.buried().front().id;
  KeyframeCandidate candidate = drive.candidate(along(0.9), *mapper.view());
  const double unit = errors_of(map(), world).to_world.scale();
  const SE3 T_rc = truth[gone].inverse() * along(0.9);
  candidate.reference = gone;
  candidate.T_rc = SE3(T_rc.rotation(), T_rc.translation() / unit);
  mapper.insert(candidate);
  mapper.adjust(nullptr);
  EXPECT_EQ(broken_links(map()), "");
  EXPECT_LT(errors_of(map(), world).camera, 0.15);
}

TEST_F(MapperTest, DropsNewPointsThatAreNotFoundWhereTheyShouldBe) {
  ASSERT_TRUE(start());
  const auto before = mapper.view();
  insert(0.55);
  mapper.adjust(nullptr);
  std::vector<PointId> fresh;
  for (const MapView::Point& p : mapper.view()->points) {
    if (before->index_of(p.id) == MapView::kNone) fresh.push_back(p.id);
  }
  ASSERT_GT(fresh.size(), 10u);
  fresh.resize(fresh.size() / 2);
  for (int i = 0; i < 30; ++i) mapper.count_visible(fresh, {});
  insert(0.8);
  for (const PointId p : fresh) EXPECT_FALSE(map().points().contains(p));
}

TEST_F(MapperTest, AnAdjustmentThatIsToldToStopStillPublishes) {
  ASSERT_TRUE(start());
  insert(0.55);
  const std::uint64_t version = mapper.view()->version;
  mapper.adjust([] { return true; });
  EXPECT_GT(mapper.view()->version, version);
  EXPECT_EQ(broken_links(map()), "");
  insert(0.8);
  mapper.adjust(nullptr);
  EXPECT_LT(errors_of(map(), world).camera, 0.15);
}

TEST_F(MapperTest, AKeyframeThatFollowsTheLastAdjustmentAtOnceWaitsForTheNext) {
  ASSERT_TRUE(start());
  std::vector<bool> adjusted;
  drive.step = 0.05;
  for (int i = 1; i <= 32; ++i) {
    insert(0.3 + 0.1 * i);
    const std::uint64_t version = mapper.view()->version;
    mapper.adjust(nullptr);
    adjusted.push_back(mapper.view()->version > version);
  }
  const auto old = adjusted.begin() + 20;
  EXPECT_EQ(std::count(adjusted.begin(), old - 2, true), 18) << "a young map is adjusted to each";
  EXPECT_EQ(std::count(old, adjusted.end(), true), 4);
  EXPECT_LT(errors_of(map(), world).camera, 0.15);
}

TEST_F(MapperTest, FindsItsKeyframesByAppearance) {
  ASSERT_TRUE(start());
  for (int i = 2; i <= 16; ++i) {  // the first ones are old enough to be in the index
    insert(0.35 * i);
    mapper.adjust(nullptr);
  }
  const auto frame = world.show(along(0.36 * 3), 100);
  const auto candidates = mapper.similar_keyframes(frame->features, 3);
  ASSERT_FALSE(candidates.empty());
  ASSERT_TRUE(map().keyframes().contains(candidates[0]));
  const auto distance = [&](const Keyframe& keyframe) {
    return (world.truth(*keyframe.frame).translation() - along(0.36 * 3).translation()).norm();
  };
  double nearest = 1e9;
  map().keyframes().for_each(
      [&](KeyframeId, const Keyframe& k) { nearest = std::min(nearest, distance(k)); });
  EXPECT_LT(distance(map().keyframes()[candidates[0]]), nearest + 0.8);
}

TEST(Mapper, SameKeyframesSameBytes) {
  auto run = [] {
    testing::PointWorld world(62);
    testing::Drive drive(world);
    Mapper mapper(point_view(), {});
    EXPECT_TRUE(mapper.initialize(drive.initial(along(0), along(0.3))));
    for (int i = 2; i <= 6; ++i) {
      mapper.insert(drive.candidate(along(0.25 * i), *mapper.view()));
      mapper.adjust(nullptr);
    }
    mapper.finish(nullptr);
    std::vector<double> numbers;
    mapper.map().points().for_each([&](PointId id, const MapPoint& p) {
      numbers.insert(numbers.end(), {double(id.slot), p.position.x(), p.position.y()});
    });
    return numbers;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace cairn
