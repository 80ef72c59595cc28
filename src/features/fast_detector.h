#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace cairn {

/// A FAST corner in pixels of the picture it was found in.
struct FastCorner {
  std::uint16_t x = 0, y = 0;
  std::uint16_t score = 0;  ///< the largest threshold (grey levels) at which it is still a corner
};

/// FAST-9/16 (Rosten and Drummond 2006) with suppression of all but the best of 3x3 pixels. The
/// score of every pixel that may be a corner is computed directly, 32 pixels at a time, instead of
/// a yes/no test first: that is faster than deciding pixel by pixel. Buffers are kept between
/// calls.
class FastDetector {
 public:
  /// The least distance from the border of the picture that detect() can work with: blocks may read
  /// beyond the end of a row, into the next one.
  static constexpr int kMinMargin = 5;

  /// Appends to `corners`, in order of rows, those of rows [first_row, last_row) whose score is at
  /// least `threshold` and that lie `margin` pixels from the left and right border. `image`:
  /// CV_8UC1; the rows must lie `margin` from the upper and lower border. A picture may be detected
  /// in bands of rows: the union of the bands' corners does not depend on how it was cut.
  void detect(const cv::Mat& image, int first_row, int last_row, int margin, int threshold,
              std::vector<FastCorner>& corners);

 private:
  std::vector<std::uint8_t> buffer_;
};

/// FAST's score plus one, below any threshold too, of the 3x3 pixels around `center`, row by row.
/// Reads up to 19 pixels to the right. `step`: bytes a row.
std::array<std::uint8_t, 9> fast_contrast_3x3(const std::uint8_t* center, std::ptrdiff_t step);

}  // namespace cairn
