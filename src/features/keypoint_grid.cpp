#include "cairn/features/keypoint_grid.h"

#include <cassert>

namespace cairn {
namespace {

constexpr float kMostCells = 256;  // along x or y, also if a stray point is very far away

}  // namespace

void KeypointGrid::build(std::span<const cv::Point2f> points, std::span<const std::int32_t> octaves,
                         float cell) {
  assert(octaves.empty() || octaves.size() == points.size());
  static thread_local std::vector<Entry> unsorted;
  unsorted.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    unsorted[i] = {points[i].x, points[i].y, octaves.empty() ? 0 : octaves[i], i};
  }
  sort_entries(unsorted, cell);
}

void KeypointGrid::build(const Features& features, float cell) {
  static thread_local std::vector<Entry> unsorted;
  unsorted.resize(features.size());
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const Keypoint& keypoint = features.keypoints[i];
    unsorted[i] = {keypoint.x, keypoint.y, keypoint.octave, i};
  }
  sort_entries(unsorted, cell);
}

void KeypointGrid::sort_entries(std::span<const Entry> unsorted, float cell) {
  x0_ = y0_ = 0;
  float x1 = 0, y1 = 0;
  if (!unsorted.empty()) {
    x0_ = x1 = unsorted[0].x;
    y0_ = y1 = unsorted[0].y;
  }
  for (const Entry& entry : unsorted) {
    x0_ = std::min(x0_, entry.x);
    y0_ = std::min(y0_, entry.y);
    x1 = std::max(x1, entry.x);
    y1 = std::max(y1, entry.y);
  }
  cell = std::max({cell, (x1 - x0_) / kMostCells, (y1 - y0_) / kMostCells});
  per_pixel_ = 1 / cell;
  columns_ = 1 + static_cast<int>((x1 - x0_) * per_pixel_);
  rows_ = 1 + static_cast<int>((y1 - y0_) * per_pixel_);

  // Counting sort: begin_[c + 1] counts, then runs, so that it ends as the beginning of cell c + 1.
  begin_.assign(static_cast<std::size_t>(columns_) * rows_ + 2, 0);
  const auto cell_of_entry = [&](const Entry& entry) {
    return row(entry.y) * columns_ + column(entry.x);
  };
  for (const Entry& entry : unsorted) ++begin_[cell_of_entry(entry) + 2];
  for (std::size_t c = 2; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  entries_.resize(unsorted.size());
  for (const Entry& entry : unsorted) entries_[begin_[cell_of_entry(entry) + 1]++] = entry;
}

void KeypointGrid::query(cv::Point2f center, float radius, int min_octave, int max_octave,
                         std::vector<std::uint32_t>& found) const {
  found.clear();
  for_each(center, radius, min_octave, max_octave,
           [&](std::uint32_t index) { found.push_back(index); });
}

}  // namespace cairn
