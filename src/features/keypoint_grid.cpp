#include "cairn/features/keypoint_grid.h"

#include <cassert>
#include <limits>

namespace cairn {
namespace {

constexpr float kMostCells = 256;  // along x or y, also if a stray point is very far away

}  // namespace

void KeypointGrid::build(std::span<const Keypoint> keypoints, float cell) {
  assert(keypoints.size() <= std::numeric_limits<std::uint16_t>::max());
  x0_ = y0_ = 0;
  float x1 = 0, y1 = 0;
  if (!keypoints.empty()) {
    x0_ = x1 = keypoints[0].x;
    y0_ = y1 = keypoints[0].y;
  }
  for (const Keypoint& keypoint : keypoints) {
    x0_ = std::min(x0_, keypoint.x);
    y0_ = std::min(y0_, keypoint.y);
    x1 = std::max(x1, keypoint.x);
    y1 = std::max(y1, keypoint.y);
  }
  cell = std::max({cell, (x1 - x0_) / kMostCells, (y1 - y0_) / kMostCells});
  per_pixel_ = 1 / cell;
  columns_ = 1 + static_cast<int>((x1 - x0_) * per_pixel_);
  rows_ = 1 + static_cast<int>((y1 - y0_) * per_pixel_);

  // Counting sort: begin_[c + 1] counts, then runs, so that it ends as the beginning of cell c + 1.
  begin_.assign(static_cast<std::size_t>(columns_) * rows_ + 2, 0);
  const auto cell_of_keypoint = [&](const Keypoint& keypoint) {
    return row(keypoint.y) * columns_ + column(keypoint.x);
  };
  for (const Keypoint& keypoint : keypoints) ++begin_[cell_of_keypoint(keypoint) + 2];
  for (std::size_t c = 2; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  index_.resize(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    index_[begin_[cell_of_keypoint(keypoints[i]) + 1]++] = static_cast<std::uint16_t>(i);
  }
}

}  // namespace cairn
