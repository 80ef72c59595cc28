#include "cairn/perception/mask_rle.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using testing::ElementsAre;

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::countNonZero(a != b) == 0;
}

cv::Mat through_text(const cv::Mat& mask) {
  return decode_runs(runs_from_text(runs_to_text(encode_runs(mask))), mask.size());
}

TEST(MaskRle, RunsDownTheColumnsAndBeginsOutside) {
  cv::Mat mask = (cv::Mat_<std::uint8_t>(2, 3) << 0, 255, 0,  //
                  255, 255, 0);
  EXPECT_THAT(encode_runs(mask), ElementsAre(1, 3, 2));
  mask.at<std::uint8_t>(0, 0) = 255;
  EXPECT_THAT(encode_runs(mask), ElementsAre(0, 4, 2));
}

// Computed by hand from the description in the header.
TEST(MaskRle, WritesTheTextOfCoco) {
  EXPECT_EQ(runs_to_text({0, 4}), "04");
  EXPECT_EQ(runs_to_text({31}), "o0");            // 31 has the sign bit: one more character
  EXPECT_EQ(runs_to_text({5, 7, 2, 3}), "572L");  // 3 is written as 3 − 7
  EXPECT_EQ(runs_to_text({1000}), "Xo0");         // 1000 = 31 · 32 + 8
  EXPECT_THAT(runs_from_text("572L"), ElementsAre(5, 7, 2, 3));
  EXPECT_THAT(runs_from_text("Xo0"), ElementsAre(1000));
}

TEST(MaskRle, GivesBackEveryMask) {
  Sampler sampler(1);
  for (int trial = 0; trial < 50; ++trial) {
    cv::Mat mask(1 + sampler.below(40), 1 + sampler.below(60), CV_8U, cv::Scalar(0));
    for (int i = sampler.below(6); i > 0; --i) {
      const cv::Point a(sampler.below(mask.cols), sampler.below(mask.rows));
      const cv::Point b(sampler.below(mask.cols), sampler.below(mask.rows));
      mask(cv::Rect(a, b)) = trial % 3 ? 255 : 0;
    }
    if (trial % 3 == 0) {
      for (auto& pixel : cv::Mat_<std::uint8_t>(mask)) pixel = sampler.below(2) ? 255 : 0;
    }
    EXPECT_TRUE(same(through_text(mask), mask));
  }
  const cv::Mat empty(480, 640, CV_8U, cv::Scalar(0)), full(480, 640, CV_8U, cv::Scalar(255));
  EXPECT_TRUE(same(through_text(empty), empty));
  EXPECT_TRUE(same(through_text(full), full));
  EXPECT_THAT(encode_runs(empty), ElementsAre(480 * 640));
  EXPECT_THAT(encode_runs(full), ElementsAre(0, 480 * 640));
}

TEST(MaskRle, RefusesRunsThatAreNoMask) {
  EXPECT_THROW(decode_runs({3}, {2, 2}), std::invalid_argument);
  EXPECT_THROW(decode_runs({3, 2}, {2, 2}), std::invalid_argument);
  EXPECT_THROW(runs_from_text("o"), std::invalid_argument);     // breaks off
  EXPECT_THROW(runs_from_text("\n"), std::invalid_argument);    // below the alphabet
  EXPECT_THROW(runs_from_text("222A"), std::invalid_argument);  // a run of 2 − 15 pixels
  EXPECT_THROW(runs_from_text(std::string(20, 'o')), std::invalid_argument);
}

}  // namespace
}  // namespace cairn
