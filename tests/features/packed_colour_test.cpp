#include <gtest/gtest.h>

#include "cairn/features/features.h"

namespace cairn {
namespace {

TEST(PackedColour, KeepsBlackAndWhite) {
  EXPECT_EQ(PackedColour().rgb(), (std::array<unsigned char, 3>{0, 0, 0}));
  EXPECT_EQ(PackedColour(0, 0, 0).rgb(), (std::array<unsigned char, 3>{0, 0, 0}));
  EXPECT_EQ(PackedColour(255, 255, 255).rgb(), (std::array<unsigned char, 3>{255, 255, 255}));
}

TEST(PackedColour, GivesEachChannelBackToItsBits) {
  for (int level = 0; level < 256; ++level) {
    const auto v = static_cast<unsigned char>(level);
    EXPECT_NEAR(PackedColour(v, 10, 20).rgb()[0], level, 8);
    EXPECT_NEAR(PackedColour(10, v, 20).rgb()[1], level, 4);
    EXPECT_NEAR(PackedColour(10, 20, v).rgb()[2], level, 8);
  }
}

}  // namespace
}  // namespace cairn
