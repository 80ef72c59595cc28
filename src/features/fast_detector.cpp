#include "cairn/features/fast_detector.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

#include "cairn/features/multiversion.h"

namespace cairn {
namespace {

constexpr std::ptrdiff_t kBlock = 32;        // pixels scored together: one AVX2 register
constexpr std::ptrdiff_t kNarrowBlock = 16;  // where few are needed

// The circle of radius 3, clockwise from the top.
constexpr std::array<std::pair<int, int>, 16> kCircle = {{{0, -3},
                                                          {1, -3},
                                                          {2, -2},
                                                          {3, -1},
                                                          {3, 0},
                                                          {3, 1},
                                                          {2, 2},
                                                          {1, 3},
                                                          {0, 3},
                                                          {-1, 3},
                                                          {-2, 2},
                                                          {-3, 1},
                                                          {-3, 0},
                                                          {-3, -1},
                                                          {-2, -2},
                                                          {-1, -3}}};

struct Circle {
  std::array<std::ptrdiff_t, 16> offset;
  explicit Circle(std::ptrdiff_t step) {
    for (int k = 0; k < 16; ++k) offset[k] = kCircle[k].second * step + kCircle[k].first;
  }
};

using Byte = std::uint8_t;

#define CAIRN_INLINE inline __attribute__((always_inline))

CAIRN_INLINE Byte least(Byte a, Byte b) { return a < b ? a : b; }
CAIRN_INLINE Byte most(Byte a, Byte b) { return a > b ? a : b; }

/// The minimum of the brightest arc of 9 pixels. Each run of 8 pixels that starts at an odd one
/// serves the two arcs that extend it by a pixel before or behind, so 8 runs do for 16 arcs.
template <class Min, class Max>
CAIRN_INLINE Byte best_arc(Byte p0, Byte p1, Byte p2, Byte p3, Byte p4, Byte p5, Byte p6, Byte p7,
                           Byte p8, Byte p9, Byte p10, Byte p11, Byte p12, Byte p13, Byte p14,
                           Byte p15, Min min, Max max) {
  const Byte a1 = min(p1, p2), a3 = min(p3, p4), a5 = min(p5, p6), a7 = min(p7, p8);
  const Byte a9 = min(p9, p10), a11 = min(p11, p12), a13 = min(p13, p14), a15 = min(p15, p0);
  const Byte b1 = min(a1, a3), b3 = min(a3, a5), b5 = min(a5, a7), b7 = min(a7, a9);
  const Byte b9 = min(a9, a11), b11 = min(a11, a13), b13 = min(a13, a15), b15 = min(a15, a1);
  const Byte c1 = min(min(b1, b5), max(p0, p9));
  const Byte c3 = min(min(b3, b7), max(p2, p11));
  const Byte c5 = min(min(b5, b9), max(p4, p13));
  const Byte c7 = min(min(b7, b11), max(p6, p15));
  const Byte c9 = min(min(b9, b13), max(p8, p1));
  const Byte c11 = min(min(b11, b15), max(p10, p3));
  const Byte c13 = min(min(b13, b1), max(p12, p5));
  const Byte c15 = min(min(b15, b3), max(p14, p7));
  return max(max(max(c1, c3), max(c5, c7)), max(max(c9, c11), max(c13, c15)));
}

/// Whether any of the 32 pixels can be a corner: an arc of 9 holds one of each two opposite pixels.
CAIRN_INLINE bool may_hold_corner(const Byte* center, const Circle& circle, Byte threshold) {
  const Byte* const p0 = center + circle.offset[0];
  const Byte* const p4 = center + circle.offset[4];
  const Byte* const p8 = center + circle.offset[8];
  const Byte* const p12 = center + circle.offset[12];
  Byte best = 0;
  for (int i = 0; i < kBlock; ++i) {
    const Byte c = center[i];
    const Byte bright = least(most(p0[i], p8[i]), most(p4[i], p12[i]));
    const Byte dark = most(least(p0[i], p8[i]), least(p4[i], p12[i]));
    const Byte difference =
        most(static_cast<Byte>(most(bright, c) - c), static_cast<Byte>(c - least(dark, c)));
    best = most(best, difference);
  }
  return best > threshold;
}

template <std::ptrdiff_t size>
CAIRN_INLINE void score_block(const Byte* __restrict center, const Circle& circle,
                              Byte* __restrict score) {
  const auto& o = circle.offset;
  for (int i = 0; i < size; ++i) {
    const Byte* const q = center + i;
    const Byte c = *q;
    const Byte bright =
        best_arc(q[o[0]], q[o[1]], q[o[2]], q[o[3]], q[o[4]], q[o[5]], q[o[6]], q[o[7]], q[o[8]],
                 q[o[9]], q[o[10]], q[o[11]], q[o[12]], q[o[13]], q[o[14]], q[o[15]], least, most);
    const Byte dark =
        best_arc(q[o[0]], q[o[1]], q[o[2]], q[o[3]], q[o[4]], q[o[5]], q[o[6]], q[o[7]], q[o[8]],
                 q[o[9]], q[o[10]], q[o[11]], q[o[12]], q[o[13]], q[o[14]], q[o[15]], most, least);
    score[i] = most(static_cast<Byte>(most(bright, c) - c), static_cast<Byte>(c - least(dark, c)));
  }
}

/// Contrast of the best arc at each pixel of a row (one above FAST's score), or zero where no pixel
/// of the block passes `threshold`. Returns whether any block did. Writes up to a block too far.
CAIRN_MULTIVERSION
bool score_row(const Byte* row, const Circle& circle, int width, Byte threshold, Byte* score) {
  bool any = false;
  for (int x = 0; x < width; x += kBlock) {
    if (may_hold_corner(row + x, circle, threshold)) {
      score_block<kBlock>(row + x, circle, score + x);
      any = true;
    } else {
      std::memset(score + x, 0, kBlock);
    }
  }
  return any;
}

/// Of equal neighbours the first in reading order stays.
CAIRN_MULTIVERSION
void suppress_row(const Byte* __restrict above, const Byte* __restrict row,
                  const Byte* __restrict below, int width, Byte threshold, Byte* __restrict kept) {
  for (int x = 0; x < width; ++x) {
    const Byte before = most(most(above[x - 1], above[x]), most(above[x + 1], row[x - 1]));
    const Byte after = most(most(below[x - 1], below[x]), most(below[x + 1], row[x + 1]));
    const Byte score = row[x];
    kept[x] = most(before, threshold) < score && after <= score ? score : 0;
  }
}

CAIRN_MULTIVERSION
void score_three_rows(const Byte* first, const Circle& circle, std::ptrdiff_t step, Byte* scores) {
  for (int row = 0; row < 3; ++row) {
    score_block<kNarrowBlock>(first + row * step, circle, scores + row * kNarrowBlock);
  }
}

void append_kept(const Byte* kept, int width, int x0, int y, std::vector<FastCorner>& corners) {
  for (int x = 0; x < width; x += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, kept + x, 8);
    while (eight != 0) {
      const int byte = std::countr_zero(eight) / 8;
      if (x + byte >= width) return;
      corners.push_back({static_cast<std::uint16_t>(x0 + x + byte), static_cast<std::uint16_t>(y),
                         static_cast<std::uint16_t>(kept[x + byte] - 1)});
      eight &= ~(std::uint64_t{0xff} << (8 * byte));
    }
  }
}

}  // namespace

void FastDetector::detect(const cv::Mat& image, int first_row, int last_row, int margin,
                          int threshold, std::vector<FastCorner>& corners) {
  assert(image.type() == CV_8UC1 && margin >= kMinMargin);
  assert(image.cols >= kBlock && first_row >= margin && last_row <= image.rows - margin);
  const int width = image.cols - 2 * margin;
  if (width <= 0 || first_row >= last_row) return;

  // Three rows of scores, used in turn; each has a pixel before it and a block behind it.
  const std::size_t stride = static_cast<std::size_t>(width) + 3 * kBlock;
  buffer_.resize(4 * stride);
  std::array<Byte*, 3> rows;
  for (int i = 0; i < 3; ++i) rows[i] = buffer_.data() + i * stride + kBlock;
  Byte* const kept = buffer_.data() + 3 * stride;

  const Circle circle(static_cast<std::ptrdiff_t>(image.step));
  const auto weakest = static_cast<Byte>(std::clamp(threshold, 1, 254));
  std::array<bool, 3> any = {};
  for (int y = first_row - 1; y <= last_row; ++y) {
    // One pixel more on each side: the neighbours of the first and of the last.
    any[(y + 1) % 3] =
        score_row(image.ptr(y) + margin - 1, circle, width + 2, weakest, rows[(y + 1) % 3] - 1);
    if (y <= first_row || !any[y % 3]) continue;
    suppress_row(rows[(y - 1) % 3], rows[y % 3], rows[(y + 1) % 3], width, weakest, kept);
    append_kept(kept, width, margin, y - 1, corners);
  }
}

std::array<std::uint8_t, 9> fast_contrast_3x3(const std::uint8_t* center, std::ptrdiff_t step) {
  std::array<Byte, std::size_t{3} * kNarrowBlock> scores;
  score_three_rows(center - step - 1, Circle(step), step, scores.data());
  std::array<Byte, 9> contrast;
  for (int i = 0; i < 9; ++i) contrast[i] = scores[i / 3 * kNarrowBlock + i % 3];
  return contrast;
}

}  // namespace cairn
