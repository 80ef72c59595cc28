#include "cairn/synthetic/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "cairn/synthetic/mip_map.h"

namespace cairn {
namespace {

std::uint64_t scrambled(std::uint64_t x) {  // splitmix64, as a hash
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

// The count of 64 fair bits is all but normal: mean 32, deviation 4. A fraction of a step on top
// makes it smooth.
float normal_deviate(std::uint64_t bits) {
  return (float(std::popcount(bits) - 32) + float(bits >> 40) * 0x1p-24f - 0.5f) * 0.25f;
}

constexpr int kWhite = 65535;  // of 16 bits, in which colours are filled in

// sRGB of each 16-bit level of linear light.
std::vector<std::uint8_t> encoding() {
  std::vector<std::uint8_t> table(kWhite + 1);
  for (int i = 0; i <= kWhite; ++i) {
    table[std::size_t(i)] =
        std::uint8_t(std::lround(255 * srgb_from_linear(float(i) / float(kWhite))));
  }
  return table;
}

}  // namespace

cv::Mat develop(const cv::Mat& light, double gain, const SensorOptions& options,
                std::uint64_t noise_seed) {
  static const std::vector<std::uint8_t> encode = encoding();
  cv::Mat exposed = light;
  if (options.blur_px > 0) {
    cv::GaussianBlur(light, exposed, {0, 0}, options.blur_px, 0, cv::BORDER_REPLICATE);
  }
  const float middle_x = 0.5f * float(light.cols - 1), middle_y = 0.5f * float(light.rows - 1);
  const float corner = middle_x * middle_x + middle_y * middle_y;
  const float shot = options.full_well > 0 ? float(1 / options.full_well) : 0;
  const auto read = float(options.read_noise * options.read_noise);
  const std::uint64_t stream = scrambled(noise_seed);
  // What the pixels count: one colour each, or, without a mosaic, blue, green and red.
  cv::Mat counts(light.size(), options.mosaic ? CV_16UC1 : CV_16UC3);
  const int channels = counts.channels();
  tbb::parallel_for(tbb::blocked_range<int>(0, light.rows, 16), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) {
      const auto* from = exposed.ptr<cv::Vec3f>(y);
      auto* to = counts.ptr<std::uint16_t>(y);
      for (int x = 0; x < light.cols; ++x) {
        const float dx = float(x) - middle_x, dy = float(y) - middle_y;
        const float shade =
            float(gain) * (1 - float(options.vignetting) * (dx * dx + dy * dy) / corner);
        std::uint64_t bits =
            stream + 3 * (std::uint64_t(y) * std::uint64_t(light.cols) + std::uint64_t(x));
        for (int c = 0; c < channels; ++c) {
          const float value = shade * from[x][options.mosaic ? (y & 1) + (x & 1) : 2 - c];
          const float deviation = std::sqrt(shot * value + read);
          const float noisy = value + deviation * normal_deviate(scrambled(bits++));
          *to++ = std::uint16_t(std::clamp(noisy, 0.f, 1.f) * kWhite + 0.5f);
        }
      }
    }
  });
  if (options.mosaic) cv::demosaicing(counts, counts, cv::COLOR_BayerRGGB2BGR);
  cv::Mat picture(light.size(), CV_8UC3);
  std::transform(
      counts.begin<cv::Vec3w>(), counts.end<cv::Vec3w>(), picture.begin<cv::Vec3b>(),
      [](const cv::Vec3w& c) { return cv::Vec3b(encode[c[0]], encode[c[1]], encode[c[2]]); });
  return picture;
}

}  // namespace cairn
