#include "cairn/synthetic/models/wheel.h"

#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"

namespace cairn {

void add_wheel(Assembly& car, const WheelLook& look, const Eigen::Vector3f& centre, float outer) {
  // Built lying, its outer side up.
  const float r = look.radius, h = look.width / 2, rim = 0.66f * r;
  const ProfilePoint tyre[] = {{0, -h, 0},
                               {0.9f * r, -h, 0},
                               {0.98f * r, -0.8f * h, 0},
                               {r, -0.4f * h, 0},
                               {r, 0.4f * h, 0},
                               {0.98f * r, 0.8f * h, 0},
                               {0.9f * r, h, 0},
                               {rim * 1.06f, h, 1},
                               {rim, 0.96f * h, 1},
                               {0.92f * rim, 0.9f * h, 2},
                               {0.88f * rim, 0.35f * h, 2},
                               {0, 0.35f * h, 2}};
  const auto place = at(centre.x(), centre.y(), centre.z()) *
                     turned(Eigen::Vector3f::UnitX(), outer > 0 ? -90 : 90);
  car.add(lathe(tyre, 28), {look.rubber, look.rim, look.dark}, place);
  for (int i = 0; i < look.spokes; ++i) {
    const auto spoke = turned(Eigen::Vector3f::UnitZ(), 360 * float(i) / float(look.spokes)) *
                       at(0.46f * rim, 0, 0.4f * h);
    const float wide = rim * (look.spokes > 7 ? 0.14f : 0.26f);
    car.add(tapered_box({0.94f * rim, wide}, {0.94f * rim, 0.7f * wide}, 0.42f * h), look.rim,
            place * spoke);
  }
  const ProfilePoint hub[] = {{0, 0.36f * h},
                              {0.22f * rim, 0.36f * h},
                              {0.2f * rim, 0.9f * h},
                              {0.08f * rim, 0.96f * h},
                              {0, 0.96f * h}};
  car.add(lathe(hub, 12), look.rim, place);
}

}  // namespace cairn
