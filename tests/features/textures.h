#pragma once

// Pictures rendered for the tests of this folder.

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

namespace cairn {

/// Overlapping rectangles and discs of random grey on grey, at `factor` times the size.
inline cv::Mat render_shapes(cv::Size size, unsigned seed, int factor = 1) {
  std::mt19937 engine(seed);
  const auto number = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(engine);
  };
  cv::Mat picture(size * factor, CV_8UC1, cv::Scalar(128));
  const int shapes = size.area() / 300;
  for (int i = 0; i < shapes; ++i) {
    const cv::Point center(number(0, picture.cols), number(0, picture.rows));
    const cv::Size half(number(3 * factor, 24 * factor), number(3 * factor, 24 * factor));
    const cv::Scalar grey(number(0, 255));
    if (number(0, 3) == 0) {
      cv::circle(picture, center, half.width / 2, grey, cv::FILLED);
    } else {
      const cv::RotatedRect box(center, half, static_cast<float>(number(0, 179)));
      cv::Point2f corners[4];
      box.points(corners);
      const std::vector<cv::Point> polygon(corners, corners + 4);
      cv::fillConvexPoly(picture, polygon, grey);
    }
  }
  return picture;
}

/// The same, anti-aliased, with a little noise.
inline cv::Mat random_texture(cv::Size size, unsigned seed) {
  const cv::Mat large = render_shapes(size, seed, 4);
  cv::Mat picture, noise(size, CV_16SC1);
  cv::resize(large, picture, size, 0, 0, cv::INTER_AREA);
  cv::RNG rng(seed);
  rng.fill(noise, cv::RNG::NORMAL, 0, 2);
  cv::add(picture, noise, picture, cv::noArray(), CV_8U);
  return picture;
}

}  // namespace cairn
