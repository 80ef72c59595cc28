#include "cairn/features/gaussian_blur.h"

#include <array>
#include <cassert>

#include "cairn/features/multiversion.h"

namespace cairn {
namespace {

// exp(-x^2 / 8), scaled to sum up to 256: the largest sum of seven products fits 16 bits.
constexpr std::uint16_t kCenter = 54, kNear = 49, kMiddle = 34, kFar = 18;

int mirror(int i, int size) { return i < 0 ? -i : i < size ? i : 2 * size - 2 - i; }

CAIRN_MULTIVERSION
void blur_seven(const std::uint8_t* __restrict a, const std::uint8_t* __restrict b,
                const std::uint8_t* __restrict c, const std::uint8_t* __restrict d,
                const std::uint8_t* __restrict e, const std::uint8_t* __restrict f,
                const std::uint8_t* __restrict g, int width, std::uint8_t* __restrict out) {
  for (int x = 0; x < width; ++x) {
    const auto far = static_cast<std::uint16_t>(kFar * static_cast<std::uint16_t>(a[x] + g[x]));
    const auto middle =
        static_cast<std::uint16_t>(kMiddle * static_cast<std::uint16_t>(b[x] + f[x]));
    const auto near = static_cast<std::uint16_t>(kNear * static_cast<std::uint16_t>(c[x] + e[x]));
    const auto center = static_cast<std::uint16_t>(kCenter * d[x] + 128);
    out[x] = static_cast<std::uint16_t>(far + middle + near + center) >> 8;
  }
}

}  // namespace

void GaussianBlur7::blur(const cv::Mat& image, int first_row, int last_row, cv::Mat& blurred) {
  assert(image.size() == blurred.size() && image.cols >= 4 && image.rows >= 4);
  const int width = image.cols;
  buffer_.resize(width + 6);
  std::uint8_t* const row = buffer_.data() + 3;
  for (int y = first_row; y < last_row; ++y) {
    std::array<const std::uint8_t*, 7> in;
    for (int k = 0; k < 7; ++k) in[k] = image.ptr(mirror(y + k - 3, image.rows));
    blur_seven(in[0], in[1], in[2], in[3], in[4], in[5], in[6], width, row);
    for (int k = 1; k <= 3; ++k) {
      row[-k] = row[k];
      row[width - 1 + k] = row[width - 1 - k];
    }
    blur_seven(row - 3, row - 2, row - 1, row, row + 1, row + 2, row + 3, width, blurred.ptr(y));
  }
}

}  // namespace cairn
