#include "quick_scene/quick_texture.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn {
namespace {

// Noise octaves in [-1, 1], each twice as fine as the one before and `gain` as strong.
cv::Mat1f fractal_noise(const cv::Size& size, int coarsest_px, double gain, cv::RNG& random) {
  cv::Mat1f sum = cv::Mat1f::zeros(size);
  double weight = 1, total = 0;
  for (int cell = coarsest_px; cell >= 2; cell /= 2) {
    cv::Mat1f grid(size.height / cell + 2, size.width / cell + 2), octave;
    random.fill(grid, cv::RNG::UNIFORM, -1.0, 1.0);
    cv::resize(grid, octave, {grid.cols * cell, grid.rows * cell}, 0, 0, cv::INTER_CUBIC);
    sum += weight * octave(cv::Rect({0, 0}, size));
    total += weight;
    weight *= gain;
  }
  return sum / total;
}

cv::Scalar random_colour(cv::RNG& random, int low, int high) {
  return {double(random.uniform(low, high)), double(random.uniform(low, high)),
          double(random.uniform(low, high))};
}

cv::Mat tinted(const cv::Mat1f& brightness, const cv::Scalar& colour) {
  cv::Mat grey, texture;
  brightness.convertTo(grey, CV_32F, 1.0 / 255);
  cv::merge(std::vector<cv::Mat>{grey * colour[0], grey * colour[1], grey * colour[2]}, texture);
  texture.convertTo(texture, CV_8UC3);
  return texture;
}

// Sharp marks, dark on light and light on dark: what corner detectors live on.
void print_marks(cv::Mat& texture, int count, int smallest, int largest, cv::RNG& random) {
  for (int i = 0; i < count; ++i) {
    const cv::Point at(random.uniform(0, texture.cols), random.uniform(0, texture.rows));
    // Small marks are commoner than large ones.
    const double u = random.uniform(0.0, 1.0);
    const int size = int(smallest * std::pow(double(largest) / smallest, u * u));
    const bool dark = random.uniform(0, 2) == 0;
    const cv::Scalar colour =
        dark ? random_colour(random, 10, 90) : random_colour(random, 160, 250);
    switch (random.uniform(0, 4)) {
      case 0:
        cv::rectangle(texture, {at.x, at.y, size, std::max(2, size * random.uniform(3, 10) / 8)},
                      colour, cv::FILLED);
        break;
      case 1:
        cv::circle(texture, at, std::max(2, size / 2), colour, cv::FILLED, cv::LINE_AA);
        break;
      case 2: {
        const double angle = random.uniform(0.0, 2 * CV_PI);
        const cv::Point to =
            at + cv::Point(int(size * std::cos(angle)), int(size * std::sin(angle)));
        cv::line(texture, at, to, colour, std::max(2, size / 6), cv::LINE_AA);
        break;
      }
      default: {
        const std::string letter(1, char('A' + random.uniform(0, 26)));
        cv::putText(texture, letter, at, cv::FONT_HERSHEY_SIMPLEX, size / 22.0, colour,
                    std::max(1, size / 10), cv::LINE_AA);
      }
    }
  }
}

cv::Mat wood(const cv::Size& size, cv::RNG& random) {
  const cv::Mat1f warp = fractal_noise(size, 128, 0.5, random);
  const cv::Mat1f grain = fractal_noise(size, 32, 0.95, random);
  cv::Mat1f brightness(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float stripe = std::sin(0.16f * float(y) + 9.0f * warp(y, x));
      brightness(y, x) = 165 + 22 * stripe + 110 * grain(y, x);
    }
  }
  cv::Mat texture = tinted(brightness, {120, 175, 225});
  print_marks(texture, size.area() / 500, 3, 26, random);
  return texture;
}

cv::Mat tiles(const cv::Size& size, cv::RNG& random) {
  constexpr int kTile = 60, kJoint = 3;
  cv::Mat1f brightness = 150 + 120 * fractal_noise(size, 64, 0.9, random);
  for (int y = 0; y < size.height; y += kTile) {
    for (int x = 0; x < size.width; x += kTile) {
      const cv::Rect tile = cv::Rect(x, y, kTile, kTile) & cv::Rect({0, 0}, size);
      brightness(tile) += random.uniform(-45.0f, 45.0f);
    }
  }
  cv::Mat texture = tinted(brightness, {215, 220, 220});
  print_marks(texture, size.area() / 330, 3, 24, random);
  for (int y = 0; y < size.height; y += kTile)
    texture.rowRange(y, std::min(y + kJoint, size.height)) = cv::Scalar(60, 60, 65);
  for (int x = 0; x < size.width; x += kTile)
    texture.colRange(x, std::min(x + kJoint, size.width)) = cv::Scalar(60, 60, 65);
  return texture;
}

cv::Mat wallpaper(const cv::Size& size, cv::RNG& random) {
  cv::Mat texture = tinted(175 + 130 * fractal_noise(size, 128, 0.9, random), {205, 225, 235});
  print_marks(texture, size.area() / 330, 3, 34, random);
  // Posters.
  for (int i = 0; i < 9; ++i) {
    const cv::Size poster(random.uniform(70, 150), random.uniform(70, 150));
    const cv::Rect at({random.uniform(0, size.width - poster.width),
                       random.uniform(0, size.height - poster.height)},
                      poster);
    texture(at) = random_colour(random, 60, 230);
    cv::Mat inside = texture(at);
    print_marks(inside, at.area() / 160, 3, 40, random);
    cv::rectangle(texture, at, cv::Scalar(25, 25, 25), 3);
  }
  return texture;
}

cv::Mat print(const cv::Size& size, cv::RNG& random) {
  const cv::Mat1f noise = fractal_noise(size, 64, 0.9, random);
  cv::Mat texture = tinted(190 + 110 * noise, random_colour(random, 110, 240));
  print_marks(texture, size.area() / 220, 4, 60, random);
  return texture;
}

}  // namespace

cv::Mat make_quick_texture(QuickSurface surface, const cv::Size& size, std::uint64_t seed) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ull + 0x632BE59BD9B4E019ull);
  switch (surface) {
    case QuickSurface::kWood:
      return wood(size, random);
    case QuickSurface::kTiles:
      return tiles(size, random);
    case QuickSurface::kWallpaper:
      return wallpaper(size, random);
    case QuickSurface::kPrint:
      break;
  }
  return print(size, random);
}

}  // namespace cairn
