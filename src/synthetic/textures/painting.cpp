#include "cairn/synthetic/textures/painting.h"

#include <opencv2/imgproc.hpp>

namespace cairn::painting {

cv::Mat1f noise(const cv::Size& size, int cells_x, int cells_y, int octaves, double gain,
                cv::RNG& random) {
  constexpr int kBorder = 2;  // cells that cubic interpolation looks at
  cv::Mat1f sum = cv::Mat1f::zeros(size);
  double weight = 1, total = 0;
  for (int i = 0; i < octaves; ++i, cells_x *= 2, cells_y *= 2, weight *= gain) {
    const int cell_x = size.width / cells_x, cell_y = size.height / cells_y;
    if (cell_x < 1 || cell_y < 1) break;
    cv::Mat1f grid(cells_y, cells_x), wide, octave;
    random.fill(grid, cv::RNG::UNIFORM, -1.0, 1.0);
    cv::copyMakeBorder(grid, wide, kBorder, kBorder, kBorder, kBorder, cv::BORDER_WRAP);
    cv::resize(wide, octave, {wide.cols * cell_x, wide.rows * cell_y}, 0, 0, cv::INTER_CUBIC);
    sum += weight * octave(cv::Rect({kBorder * cell_x, kBorder * cell_y}, size));
    total += weight * weight;
  }
  return sum / std::sqrt(std::max(total, 1e-9));
}

Canvas tinted(const cv::Mat1f& noise, const cv::Vec3f& colour, float strength) {
  Canvas canvas(noise.size(), colour);
  darken(canvas, noise, strength);
  return canvas;
}

void darken(Canvas& canvas, const cv::Mat1f& noise, float strength) {
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) canvas(y, x) *= 1 + strength * noise(y, x);
  }
}

float uniform(cv::RNG& random, float low, float high) { return random.uniform(low, high); }

cv::Vec3f muted(cv::RNG& random, float low, float high, float colourful) {
  const float grey = random.uniform(low, high);
  cv::Vec3f colour;
  for (int c = 0; c < 3; ++c) colour[c] = grey * (1 + random.uniform(-colourful, colourful));
  return colour;
}

cv::Vec3f vivid(cv::RNG& random) {
  cv::Mat3b colour(1, 1,
                   cv::Vec3b(uchar(random.uniform(0, 180)), uchar(random.uniform(60, 220)),
                             uchar(random.uniform(70, 245))));
  cv::cvtColor(colour, colour, cv::COLOR_HSV2BGR);
  return colour(0, 0);
}

void fill(Canvas& canvas, const cv::Rect& where, const cv::Vec3f& colour) {
  const cv::Rect inside = where & cv::Rect({0, 0}, canvas.size());
  if (inside.area() > 0) canvas(inside).setTo(cv::Scalar(colour[0], colour[1], colour[2]));
}

std::string word(cv::RNG& random) {
  static constexpr const char* kVowels = "aeiou";
  static constexpr const char* kConsonants = "bcdfghklmnprstvw";
  std::string text;
  for (int i = random.uniform(2, 9); i > 0; --i) {
    text += i % 2 != 0 ? kVowels[random.uniform(0, 5)] : kConsonants[random.uniform(0, 16)];
  }
  return text;
}

void write_text(Canvas& canvas, const cv::Rect& where, int height, const cv::Vec3f& ink,
                cv::RNG& random) {
  const double scale = height / 21.0;
  const int thickness = std::max(1, height / 9);
  const cv::Scalar colour(ink[0], ink[1], ink[2]);
  for (int y = where.y + height; y <= where.y + where.height; y += height * 17 / 10) {
    int x = where.x;
    while (true) {
      const std::string text = word(random);
      const int width =
          cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, thickness, nullptr).width;
      if (x + width > where.x + where.width) break;
      // Drawn on eight bits, because only there lines are smooth.
      const cv::Rect box = cv::Rect(x - 2, y - height - 4, width + 6, height * 2 + 4) &
                           cv::Rect({0, 0}, canvas.size());
      if (box.area() > 0) {
        cv::Mat patch;
        canvas(box).convertTo(patch, CV_8UC3);
        cv::putText(patch, text, cv::Point(x, y) - box.tl(), cv::FONT_HERSHEY_SIMPLEX, scale,
                    colour, thickness, cv::LINE_AA);
        patch.convertTo(canvas(box), CV_32FC3);
      }
      x += width + height * 7 / 10;
      if (random.uniform(0, 12) == 0) break;
    }
  }
}

cv::Mat finished(const Canvas& canvas) {
  cv::Mat picture;
  canvas.convertTo(picture, CV_8UC3);
  return picture;
}

}  // namespace cairn::painting
