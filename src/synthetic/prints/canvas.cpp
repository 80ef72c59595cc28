#include "cairn/synthetic/prints/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn {
namespace {

constexpr int kShift = 4;  // coordinates are drawn in sixteenths of a texel
// A book cover then has two texels a millimetre, as a camera does from a quarter of a metre.
constexpr int kMostTexels = 1 << 17;

cv::Scalar bgr(const Colour& colour) {
  const auto encoded = [](float c) {
    const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
    return std::clamp(255.0 * double(s), 0.0, 255.0);
  };
  return {encoded(colour.z()), encoded(colour.y()), encoded(colour.x())};
}

cv::Point fixed(const cv::Point2f& p) {
  return {int(std::lround(p.x * (1 << kShift))), int(std::lround(p.y * (1 << kShift)))};
}

}  // namespace

Canvas::Canvas(float width, float height, float texels_per_metre, const Colour& background)
    : width_(width),
      height_(height),
      scale_(std::min(texels_per_metre, std::sqrt(float(kMostTexels) / (width * height)))) {
  const int columns = std::max(4, int(std::lround(width * scale_)));
  const int rows = std::max(4, int(std::lround(height * scale_)));
  picture_ = cv::Mat(rows, columns, CV_8UC3, bgr(background));
}

// Texel centres are half a texel away from the picture's edge.
cv::Point2f Canvas::texel(float x, float y) const { return {x * scale_ - 0.5f, y * scale_ - 0.5f}; }

void Canvas::rectangle(float x, float y, float width, float height, const Colour& colour) {
  polygon({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, colour);
}

void Canvas::disc(float x, float y, float radius, const Colour& colour) {
  cv::circle(picture_, fixed(texel(x, y)), int(std::lround(radius * scale_ * (1 << kShift))),
             bgr(colour), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::line(float x0, float y0, float x1, float y1, float thickness, const Colour& colour) {
  cv::line(picture_, fixed(texel(x0, y0)), fixed(texel(x1, y1)), bgr(colour),
           std::max(1, int(std::lround(thickness * scale_))), cv::LINE_AA, kShift);
}

void Canvas::polygon(const std::vector<Eigen::Vector2f>& corners, const Colour& colour) {
  std::vector<cv::Point> points;
  for (const Eigen::Vector2f& p : corners) points.push_back(fixed(texel(p.x(), p.y())));
  cv::fillPoly(picture_, std::vector<std::vector<cv::Point>>{points}, bgr(colour), cv::LINE_AA,
               kShift);
}

void Canvas::text(const std::string& text, float x, float y, float height, const Colour& colour,
                  const Lettering& lettering) {
  constexpr double kLetterHeight = 21;  // texels of Hershey's capitals at scale 1
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  double size = double(height * scale_) / kLetterHeight;
  const auto thick = [&] {
    return std::max(1, int(std::lround(size * kLetterHeight * double(lettering.thickness))));
  };
  const double room = double(lettering.max_width * scale_);
  double wide = cv::getTextSize(text, kFont, size, thick(), nullptr).width;
  if (wide > room) {
    size *= room / wide;
    wide = room;
  }
  const cv::Point2f at = texel(x, y);
  const double left = double(at.x) - (lettering.centred ? wide / 2 : 0);
  cv::putText(picture_, text, {int(std::lround(left)), int(std::lround(at.y))}, kFont, size,
              bgr(colour), thick(), cv::LINE_AA);
}

void Canvas::grain(float strength, float size_x, float size_y, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat1f noise(picture_.size(), 0.0f);
  float weight = 1, total = 0;
  for (float octave = 1; octave > 0.1f; octave /= 2) {
    const cv::Size cells(std::max(2, int(width_ / (size_x * octave))),
                         std::max(2, int(height_ / (size_y * octave))));
    if (cells.width > picture_.cols && cells.height > picture_.rows) break;
    cv::Mat1f grid(cells), fine;
    random.fill(grid, cv::RNG::UNIFORM, -1.0, 1.0);
    cv::resize(grid, fine, picture_.size(), 0, 0, cv::INTER_LINEAR);
    noise += weight * fine;
    total += weight;
    weight *= 0.7f;
  }
  if (total > 0) noise *= strength / total;
  for (int y = 0; y < picture_.rows; ++y)
    for (int x = 0; x < picture_.cols; ++x)
      for (int c = 0; c < 3; ++c) {
        uchar& value = picture_.at<cv::Vec3b>(y, x)[c];
        value = cv::saturate_cast<uchar>(float(value) * (1 + noise(y, x)));
      }
}

void Canvas::paint(const std::function<Colour(float x, float y)>& colour_at) {
  for (int row = 0; row < picture_.rows; ++row) {
    for (int column = 0; column < picture_.cols; ++column) {
      const cv::Scalar colour =
          bgr(colour_at((float(column) + 0.5f) / scale_, (float(row) + 0.5f) / scale_));
      for (int c = 0; c < 3; ++c)
        picture_.at<cv::Vec3b>(row, column)[c] = cv::saturate_cast<uchar>(colour[c]);
    }
  }
}

std::shared_ptr<const Texture> Canvas::texture() const {
  return std::make_shared<Texture>(Texture{picture_.clone(), scale_});
}

}  // namespace cairn
