#include "cairn/mapping/surface_normals.h"

#include <gtest/gtest.h>

#include "geometry/scene.h"
#include "map/point_world.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b)))) * 180 / M_PI;
}

// A keyframe that sees points of which `depth_at(ray)` says the depth. Every `surer`th was seen
// from far aside too, and errs by 1 %; the others from `aside` with an error of `error`.
class Sight {
 public:
  template <class DepthAt>
  Sight(std::uint64_t seed, int count, const SE3& T_wc, const DepthAt& depth_at, int surer = 1,
        double aside = 0, double error = 0)
      : map(testing::point_view()) {
    Random random(seed);
    auto frame = std::make_shared<Frame>();
    std::vector<Eigen::Vector3d> positions;
    for (int i = 0; i < count; ++i) {
      const double x = random.uniform(20, 620), y = random.uniform(20, 460);
      const Eigen::Vector3d ray = kCamera.unproject({x, y});
      const double off = (i % surer == 0 ? 0.01 : error) * random.gaussian();
      positions.push_back(T_wc * (depth_at(ray) * (1 + off) * ray));
      frame->features.keypoints.push_back({static_cast<float>(x), static_cast<float>(y)});
      frame->features.descriptors.emplace_back();
    }
    frame->grid.build(frame->features.keypoints);
    const auto keyframe_aside = [&](double distance) {
      return map.add_keyframe(frame, T_wc * SE3::exp({distance, 0, 0, 0, 0, 0}));
    };
    id = keyframe_aside(0);
    const KeyframeId far = keyframe_aside(0.2), near = keyframe_aside(aside);
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      const PointId point = map.add_point(positions[i]);
      map.add_observation(point, id, i);
      map.add_observation(point, i % surer == 0 ? far : near, i);
    }
  }

  Map map;
  KeyframeId id;
};

TEST(SurfaceNormals, AreThoseOfThePlaneThatThePointsLieOn) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SE3 T_wc = Random(seed).motion(1, 1);
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2, 0.6, -0.7).normalized();
    const Sight sight(seed, 500, T_wc,
                      [&](const Eigen::Vector3d& ray) { return -2 / normal.dot(ray); });
    const Keyframe& keyframe = sight.map.keyframes()[sight.id];
    const SurfaceNormals normals(sight.map, keyframe);
    std::vector<double> off;
    for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
      off.push_back(degrees_between(normals.at(i), T_wc.matrix3() * normal));
    }
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() / 2], 8);
    EXPECT_LT(off[off.size() * 9 / 10], 25);
  }
}

// As of houses beside a street.
TEST(SurfaceNormals, AreThoseOfAWallThatIsSeenAlong) {
  const Sight sight(5, 400, SE3(), [](const Eigen::Vector3d& ray) {
    return 1 / std::max(0.1, std::abs(ray.x()));
  });
  const Keyframe& keyframe = sight.map.keyframes()[sight.id];
  const SurfaceNormals normals(sight.map, keyframe);
  std::vector<double> off;
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    const double x = std::abs(kCamera.unproject(keyframe.frame->pixel(i)).x());
    if (x < 0.12 || x > 0.3) continue;
    off.push_back(degrees_between(normals.at(i), Eigen::Vector3d::UnitX()));
  }
  ASSERT_GT(off.size(), 50U);
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 5);
  EXPECT_LT(off[off.size() * 9 / 10], 15);
}

TEST(SurfaceNormals, PointsWhoseDepthIsHardlyKnownSayLittle) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, 0.6, -0.7).normalized();
  const Sight sight(
      9, 800, SE3(), [&](const Eigen::Vector3d& ray) { return -2 / normal.dot(ray); }, 4, 0.002,
      0.3);
  const Keyframe& keyframe = sight.map.keyframes()[sight.id];
  const SurfaceNormals normals(sight.map, keyframe);
  std::vector<double> off;
  for (std::uint32_t i = 0; i < keyframe.points.size(); i += 4) {
    off.push_back(degrees_between(normals.at(i), normal));
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() * 9 / 10], 12);
}

TEST(SurfaceNormals, DoNotLeanTowardsWhatStandsBehind) {
  // A board that faces the camera at depth 1, before a wall at 4.
  const Sight sight(7, 800, SE3(),
                    [](const Eigen::Vector3d& ray) { return ray.x() < 0 ? 1.0 : 4.0; });
  const Keyframe& keyframe = sight.map.keyframes()[sight.id];
  const SurfaceNormals normals(sight.map, keyframe);
  int near = 0, right = 0;
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    const double x = kCamera.unproject(keyframe.frame->pixel(i)).x();
    if (x > 0 || x < -0.06) continue;
    ++near;
    right += degrees_between(normals.at(i), Eigen::Vector3d::UnitZ()) < 20;
  }
  ASSERT_GT(near, 10);
  EXPECT_GT(right, 0.9 * near);
}

TEST(SurfaceNormals, WithoutNeighboursTheyFaceTheCamera) {
  const SE3 T_wc = Random(3).motion(1, 1);
  const Sight sight(4, 1, T_wc, [](const Eigen::Vector3d&) { return 2.0; });
  const SurfaceNormals normals(sight.map, sight.map.keyframes()[sight.id]);
  const Eigen::Vector3d ray =
      sight.map.points()[sight.map.keyframes()[sight.id].points[0]].position - T_wc.translation();
  EXPECT_LT(degrees_between(normals.at(0), ray.normalized()), 40);
  EXPECT_NEAR(degrees_between(normals.at(0), T_wc.matrix3().col(2)), 0, 1e-3);
}

}  // namespace
}  // namespace cairn
