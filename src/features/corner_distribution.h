#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cairn/features/fast_detector.h"

namespace cairn {

/// Chooses corners of one picture so that they are both strong and spread over it. The picture is
/// divided into about as many cells as corners are wanted; all cells may give equally many, except
/// that what cells without texture do not use is shared out among the others (water-filling). A
/// cell gives its strongest corners first, and weak ones only if it has no strong one. Buffers are
/// kept between calls.
class CornerDistribution {
 public:
  struct Region {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels, x1 and y1 exclusive
  };

  /// Replaces `chosen` by up to `count` of `corners`, all of which lie in `region`, in order of
  /// cells. Corners with a score of `threshold` or more are strong.
  void choose(std::span<const FastCorner> corners, const Region& region, int count, int threshold,
              std::vector<FastCorner>& chosen);

 private:
  struct Cell {
    std::uint32_t begin = 0;  ///< into sorted_
    std::uint32_t size = 0;   ///< corners that the cell may give
  };

  void sort_into_cells(std::span<const FastCorner> corners, const Region& region, int count);
  void keep_strong(int threshold);
  int fill_level(int count, int& left_over) const;
  void give(int quota, int left_over, std::vector<FastCorner>& chosen);

  int columns_ = 0, rows_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> cell_of_, cursor_, next_best_;
  std::vector<FastCorner> sorted_;
};

}  // namespace cairn
