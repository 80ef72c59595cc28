#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "cairn/features/features.h"

namespace cairn {

/// Keypoints of a picture by place: which of them lie in a window. They may lie anywhere, also
/// outside the picture (undistorted keypoints do). Made to be kept beside them, so it holds no more
/// than their numbers.
class KeypointGrid {
 public:
  /// Side of a cell, in pixels, that suits search windows of 5 to 50 pixels.
  static constexpr float kCell = 24;

  KeypointGrid() = default;
  /// At most 65535 keypoints.
  void build(std::span<const Keypoint> keypoints, float cell = kCell);

  /// Calls visit(index) for every keypoint with |x - center.x| <= radius, |y - center.y| <= radius
  /// and min_octave <= octave <= max_octave; cell by cell, in a cell by index. `keypoints`: those
  /// that the grid was built from.
  template <class Visit>
  void for_each(std::span<const Keypoint> keypoints, cv::Point2f center, float radius,
                int min_octave, int max_octave, Visit&& visit) const {
    const int column0 = column(center.x - radius), column1 = column(center.x + radius);
    const int row0 = row(center.y - radius), row1 = row(center.y + radius);
    for (int y = row0; y <= row1; ++y) {
      // Cells beside each other are beside each other in memory, too.
      const std::uint32_t begin = begin_[y * columns_ + column0];
      const std::uint32_t end = begin_[y * columns_ + column1 + 1];
      for (std::uint32_t i = begin; i < end; ++i) {
        const Keypoint& keypoint = keypoints[index_[i]];
        if (std::abs(keypoint.x - center.x) <= radius &&
            std::abs(keypoint.y - center.y) <= radius && keypoint.octave >= min_octave &&
            keypoint.octave <= max_octave) {
          visit(std::uint32_t{index_[i]});
        }
      }
    }
  }

  std::size_t size() const { return index_.size(); }

 private:
  // The clamp comes before the conversion: far or NaN coordinates must not overflow an int.
  int column(float x) const { return cell_of(x - x0_, columns_); }
  int row(float y) const { return cell_of(y - y0_, rows_); }
  int cell_of(float distance, int cells) const {
    return static_cast<int>(
        std::clamp(std::fmax(distance, 0.0F) * per_pixel_, 0.0F, static_cast<float>(cells - 1)));
  }

  float x0_ = 0, y0_ = 0, per_pixel_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<std::uint16_t> begin_ = {0, 0};  ///< of each cell's keypoints, and the end
  std::vector<std::uint16_t> index_;
};

}  // namespace cairn
