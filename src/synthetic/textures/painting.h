#pragma once

// How textures are painted: noise that repeats without a seam, tints, marks.

#include <opencv2/core.hpp>
#include <string>

namespace cairn::painting {

/// BGR, 0 to 255, while it is being painted.
using Canvas = cv::Mat3f;

/// Noise in about [-1, 1] that repeats: `octaves` grids, the first of cells_x x cells_y cells, each
/// following one twice as fine and `gain` as strong. Sides must be multiples of the finest cells.
cv::Mat1f noise(const cv::Size& size, int cells_x, int cells_y, int octaves, double gain,
                cv::RNG& random);

/// A colour times 1 + `strength` * noise.
Canvas tinted(const cv::Mat1f& noise, const cv::Vec3f& colour, float strength);
void darken(Canvas& canvas, const cv::Mat1f& noise, float strength);

/// Grey with a hint of colour, `low` to `high`.
cv::Vec3f muted(cv::RNG& random, float low, float high, float colourful);
/// Any colour that ink can have.
cv::Vec3f vivid(cv::RNG& random);
float uniform(cv::RNG& random, float low, float high);

void fill(Canvas& canvas, const cv::Rect& where, const cv::Vec3f& colour);
/// Lines of meaningless words in `where`, letters `height` pixels tall.
void write_text(Canvas& canvas, const cv::Rect& where, int height, const cv::Vec3f& ink,
                cv::RNG& random);
std::string word(cv::RNG& random);

cv::Mat finished(const Canvas& canvas);

}  // namespace cairn::painting
