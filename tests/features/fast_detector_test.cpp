#include "cairn/features/fast_detector.h"

#include <gmock/gmock.h>

#include <map>
#include <opencv2/features2d.hpp>

#include "textures.h"

namespace cairn {
namespace {

constexpr int kMargin = 5;

std::vector<FastCorner> detect(const cv::Mat& image, int threshold, int band) {
  FastDetector detector;
  std::vector<FastCorner> corners;
  for (int row = kMargin; row < image.rows - kMargin; row += band) {
    detector.detect(image, row, std::min(row + band, image.rows - kMargin), kMargin, threshold,
                    corners);
  }
  return corners;
}

TEST(FastDetector, FindsEveryCornerOfOpenCvWithTheSameScore) {
  for (const int threshold : {7, 20, 40}) {
    const cv::Mat image = random_texture({333, 211}, threshold);
    std::map<std::pair<int, int>, int> scores;
    for (const FastCorner& corner : detect(image, threshold, 1000)) {
      scores[{corner.x, corner.y}] = corner.score;
    }
    std::vector<cv::KeyPoint> expected;
    cv::FAST(image, expected, threshold, true);
    int compared = 0;
    for (const cv::KeyPoint& keypoint : expected) {
      const int x = static_cast<int>(keypoint.pt.x), y = static_cast<int>(keypoint.pt.y);
      if (std::min({x, y, image.cols - 1 - x, image.rows - 1 - y}) < kMargin) continue;
      ASSERT_TRUE(scores.contains({x, y})) << x << ' ' << y;
      EXPECT_EQ((scores[{x, y}]), static_cast<int>(keypoint.response));
      ++compared;
    }
    EXPECT_GT(compared, 100);
    // Of two equal neighbours OpenCV keeps none and cairn the first: a few more.
    EXPECT_LT(scores.size(), 1.3 * compared);
  }
}

TEST(FastDetector, FindsTheSameInBandsAsInTheWhole) {
  const cv::Mat image = random_texture({200, 150}, 3);
  const auto whole = detect(image, 7, 1000);
  const auto bands = detect(image, 7, 13);
  ASSERT_EQ(whole.size(), bands.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole[i].x, bands[i].x);
    EXPECT_EQ(whole[i].y, bands[i].y);
    EXPECT_EQ(whole[i].score, bands[i].score);
  }
}

}  // namespace
}  // namespace cairn
