#include "cairn/geometry/lens_correction.h"

#include <gtest/gtest.h>

namespace cairn {
namespace {

TEST(LensCorrection, TellsWhereAnIdealCameraHasAPixel) {
  const Pinhole pinhole{525, 525, 319.5, 239.5};
  const LensCorrection lens{{0.01, -0.04, 0.02, 3, -2}};
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), Eigen::Vector2d(639, 479),
                                       Eigen::Vector2d(319.5, 20), Eigen::Vector2d(300, 250)}) {
    const Eigen::Vector2d ideal = lens.ideal(pinhole, pixel);
    EXPECT_LT((lens.project(pinhole, pinhole.unproject(ideal)) - pixel).norm(), 0.01);
  }
  EXPECT_EQ(LensCorrection{}.ideal(pinhole, {10, 20}), Eigen::Vector2d(10, 20));
}

}  // namespace
}  // namespace cairn
