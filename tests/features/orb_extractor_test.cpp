#include "cairn/features/orb_extractor.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cstring>
#include <numbers>
#include <opencv2/features2d.hpp>

#include "textures.h"

namespace cairn {
namespace {

Features extract(const cv::Mat& image, const OrbOptions& options = {}) {
  OrbExtractor extractor(options);
  Features features;
  extractor.extract(image, features);
  return features;
}

/// The pixel of its level that a keypoint was found at, when positions are whole pixels.
cv::Point level_pixel(const Keypoint& keypoint, cv::Size size, double scale) {
  const double shrink = std::pow(scale, -keypoint.octave);
  const double ratio_x = size.width / std::round(size.width * shrink);
  const double ratio_y = size.height / std::round(size.height * shrink);
  return {static_cast<int>(std::lround((keypoint.x + 0.5) / ratio_x - 0.5)),
          static_cast<int>(std::lround((keypoint.y + 0.5) / ratio_y - 0.5))};
}

/// Our keypoints as cv::ORB takes them: coordinates that it divides by the scale and rounds.
std::vector<cv::KeyPoint> to_opencv(const Features& features, const OrbOptions& options,
                                    cv::Size size) {
  std::vector<cv::KeyPoint> keypoints;
  for (const Keypoint& keypoint : features.keypoints) {
    const cv::Point pixel = level_pixel(keypoint, size, options.scale);
    const auto scale = static_cast<float>(std::pow(options.scale, keypoint.octave));
    const float degrees = keypoint.angle * 180 / std::numbers::pi_v<float>;
    keypoints.emplace_back(cv::Point2f(pixel) * scale, 31 * scale,
                           degrees < 0 ? degrees + 360 : degrees, keypoint.response,
                           keypoint.octave);
    keypoints.back().class_id = static_cast<int>(keypoints.size()) - 1;
  }
  return keypoints;
}

TEST(OrbExtractor, DescribesAsOpenCvDoesAtTheSameKeypoints) {
  const cv::Mat image = random_texture({640, 480}, 1);
  const OrbOptions options = {.subpixel = false};
  const Features features = extract(image, options);
  auto keypoints = to_opencv(features, options, image.size());
  cv::Mat descriptors;
  cv::ORB::create(1000, 1.2F, 8, 31)->compute(image, keypoints, descriptors);
  ASSERT_GT(keypoints.size(), 500U);
  double bits = 0;
  int far = 0;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    Descriptor expected;
    std::memcpy(expected.data(), descriptors.ptr(static_cast<int>(i)), sizeof(expected));
    const int distance = hamming(features.descriptors[keypoints[i].class_id], expected);
    bits += distance;
    far += distance > 16;
  }
  EXPECT_LT(bits / keypoints.size(), 4);
  EXPECT_LT(far, 0.01 * keypoints.size());
}

TEST(OrbExtractor, OrientsAsOpenCvDoes) {
  const cv::Mat image = random_texture({640, 480}, 2);
  const Features features = extract(image, {.levels = 1, .subpixel = false});
  std::vector<cv::KeyPoint> found;
  cv::ORB::create(5000, 1.2F, 1, 31)->detect(image, found);
  int compared = 0;
  for (const cv::KeyPoint& theirs : found) {
    for (const Keypoint& ours : features.keypoints) {
      if (theirs.pt != cv::Point2f(ours.x, ours.y)) continue;
      const double difference = ours.angle - theirs.angle * std::numbers::pi / 180;
      EXPECT_LT(std::abs(std::remainder(difference, 2 * std::numbers::pi)), 0.02);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(OrbExtractor, GivesTheSameFeaturesWithOneAndManyThreads) {
  const cv::Mat image = random_texture({640, 480}, 3);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return extract(image);
  };
  const Features one = with_threads(1);
  for (const std::size_t threads : {2, 4}) {
    const Features many = with_threads(threads);
    ASSERT_EQ(one.size(), many.size());
    EXPECT_EQ(one.descriptors, many.descriptors);
    EXPECT_EQ(one.keypoints, many.keypoints);
  }
}

TEST(OrbExtractor, GivesTheSameFeaturesWhenUsedAgain) {
  const cv::Mat first = random_texture({640, 480}, 4), second = random_texture({320, 240}, 5);
  OrbExtractor extractor({});
  Features features;
  extractor.extract(first, features);
  extractor.extract(second, features);
  EXPECT_EQ(extract(second).descriptors, features.descriptors);
  extractor.extract(first, features);
  EXPECT_EQ(extract(first).descriptors, features.descriptors);
}

TEST(OrbExtractor, GivesAboutAsManyAsAskedForMoreOnFinerLevels) {
  const cv::Mat image = random_texture({640, 480}, 6);
  for (const int count : {200, 1000, 2000}) {
    const Features features = extract(image, {.count = count});
    EXPECT_NEAR(static_cast<double>(features.size()), count, 0.05 * count);
    std::array<int, 8> in_level = {};
    for (const Keypoint& keypoint : features.keypoints) ++in_level.at(keypoint.octave);
    for (int level = 1; level < 8; ++level) EXPECT_GE(in_level[level - 1], in_level[level]);
  }
}

TEST(OrbExtractor, SpreadsFeaturesOverThePicture) {
  // Strong texture everywhere but in one quarter, where it is weak.
  cv::Mat image = random_texture({640, 480}, 7);
  cv::Mat weak = image(cv::Rect(0, 0, 320, 240));
  weak.convertTo(weak, CV_8U, 0.15, 100);
  const Features features = extract(image);
  cv::Mat counts = cv::Mat::zeros(6, 8, CV_32S);
  for (const Keypoint& keypoint : features.keypoints) {
    ++counts.at<int>(static_cast<int>(keypoint.y / 80), static_cast<int>(keypoint.x / 80));
  }
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 8; ++column) {
      EXPECT_GE(counts.at<int>(row, column), 3) << row << ' ' << column;
      EXPECT_LE(counts.at<int>(row, column), 80) << row << ' ' << column;
    }
  }
}

TEST(OrbExtractor, FindsNothingInABlankPicture) {
  EXPECT_EQ(extract(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))).size(), 0U);
}

TEST(OrbExtractor, TakesTinyAndOddPictures) {
  for (const cv::Size size : {cv::Size(64, 64), cv::Size(40, 40), cv::Size(39, 39), cv::Size(8, 8),
                              cv::Size(1, 1), cv::Size(641, 65), cv::Size(65, 333)}) {
    const Features features = extract(random_texture(size, 8));
    EXPECT_EQ(features.keypoints.size(), features.descriptors.size());
    for (const Keypoint& keypoint : features.keypoints) {
      EXPECT_TRUE(keypoint.x >= 0 && keypoint.x < size.width) << size;
      EXPECT_TRUE(keypoint.y >= 0 && keypoint.y < size.height) << size;
    }
  }
}

TEST(OrbExtractor, TakesARegionOfALargerPicture) {
  const cv::Mat image = random_texture({640, 480}, 9);
  const cv::Mat region = image(cv::Rect(101, 37, 320, 240));
  EXPECT_EQ(extract(region).descriptors, extract(region.clone()).descriptors);
}

/// Root mean square of how far, in pixels, the displacement of matched keypoints is from the true
/// one, over pictures of one scene that move by fractions of a pixel.
double displacement_error(bool subpixel, int octave) {
  constexpr int kFactor = 8;
  const cv::Size size(480, 360);
  const cv::Mat scene = render_shapes(size + cv::Size(4, 4), 10, kFactor);
  const auto picture = [&](int shift_x, int shift_y) {
    cv::Mat small;
    cv::resize(scene(cv::Rect(cv::Point(shift_x, shift_y), size * kFactor)), small, size, 0, 0,
               cv::INTER_AREA);
    return small;
  };
  const OrbOptions options = {.subpixel = subpixel};
  const Features reference = extract(picture(0, 0), options);
  double sum = 0;
  int matches = 0;
  for (const cv::Point shift : {cv::Point(3, 2), {5, 7}, {11, 4}, {14, 13}, {1, 6}}) {
    const Features moved = extract(picture(shift.x, shift.y), options);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const Keypoint& a = reference.keypoints[i];
      if (a.octave != octave) continue;
      for (std::size_t j = 0; j < moved.size(); ++j) {
        const Keypoint& b = moved.keypoints[j];
        const float x = b.x - a.x + static_cast<float>(shift.x) / kFactor;
        const float y = b.y - a.y + static_cast<float>(shift.y) / kFactor;
        // The same corner, not the one beside it.
        const double farthest = 1.6 * std::pow(options.scale, octave);
        if (b.octave != octave || std::hypot(x, y) > farthest) continue;
        if (hamming(reference.descriptors[i], moved.descriptors[j]) > 40) continue;
        sum += x * x + y * y;
        ++matches;
      }
    }
  }
  EXPECT_GT(matches, 100);
  return std::sqrt(sum / matches);
}

TEST(OrbExtractor, LocatesBetterBelowThePixel) {
  for (const int octave : {0, 2, 4}) {
    const double whole = displacement_error(false, octave);
    const double refined = displacement_error(true, octave);
    RecordProperty("octave_" + std::to_string(octave),
                   std::to_string(whole) + " px to " + std::to_string(refined) + " px");
    EXPECT_LT(refined, 0.75 * whole) << "octave " << octave;
  }
}

}  // namespace
}  // namespace cairn
