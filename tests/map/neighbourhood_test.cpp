#include "cairn/map/neighbourhood.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "map/plain_frame.h"
#include "map/point_world.h"

namespace cairn {
namespace {

class Neighbourhood : public ::testing::Test {
 protected:
  KeyframeId keyframe() { return map.add_keyframe(testing::plain_frame(40), SE3()); }

  void share(int points, KeyframeId a, KeyframeId b) {
    for (int i = 0; i < points; ++i) {
      const PointId p = map.add_point({0, 0, 1});
      map.add_observation(p, a, used_[a.slot]++);
      map.add_observation(p, b, used_[b.slot]++);
    }
  }

  Map map{testing::point_view()};

 private:
  std::map<std::uint32_t, std::uint32_t> used_;  // keypoints, by slot
};

TEST_F(Neighbourhood, IsTheKeyframeItsNeighboursAndTheirsEachOnce) {
  const KeyframeId centre = keyframe(), near = keyframe(), nearest = keyframe();
  const KeyframeId beyond = keyframe(), far = keyframe();
  share(6, centre, nearest);
  share(4, centre, near);
  share(5, nearest, near);  // both see the centre and each other
  share(3, near, beyond);
  share(8, beyond, far);  // the neighbour of a neighbour's neighbour
  EXPECT_EQ(neighbourhood(map, centre, {}, {}),
            (std::vector<KeyframeId>{centre, nearest, near, beyond}));
}

TEST_F(Neighbourhood, TakesNoMoreThanAskedForAndNoneThatShareTooLittle) {
  const KeyframeId centre = keyframe(), nearest = keyframe(), near = keyframe();
  const KeyframeId beyond = keyframe(), aside = keyframe();
  share(6, centre, nearest);
  share(4, centre, near);
  share(9, nearest, beyond);
  share(7, nearest, aside);
  EXPECT_EQ(neighbourhood(map, centre, {.min_shared = 5}, {.min_shared = 8}),
            (std::vector<KeyframeId>{centre, nearest, beyond}));
  EXPECT_EQ(neighbourhood(map, centre, {.most = 1}, {.most = 1}),
            (std::vector<KeyframeId>{centre, nearest, beyond}));
  EXPECT_EQ(neighbourhood(map, centre, {.most = 0}, {}), std::vector<KeyframeId>{centre});
}

}  // namespace
}  // namespace cairn
