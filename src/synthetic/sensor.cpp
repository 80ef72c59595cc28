#include "cairn/synthetic/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

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

class Encoding {
 public:
  static constexpr int kSteps = 8192;
  Encoding() {
    for (int i = 0; i <= kSteps; ++i) {
      // Finer in the dark: the table is over the square root.
      const float root = float(i) / kSteps;
      table_[std::size_t(i)] = std::uint8_t(std::lround(255 * srgb_from_linear(root * root)));
    }
  }
  std::uint8_t operator()(float linear) const {
    const float root = std::sqrt(std::clamp(linear, 0.f, 1.f));
    return table_[std::size_t(root * kSteps + 0.5f)];
  }

 private:
  std::array<std::uint8_t, kSteps + 1> table_{};
};

}  // namespace

cv::Mat develop(const cv::Mat& light, double gain, const SensorOptions& options,
                std::uint64_t noise_seed) {
  static const Encoding encode;
  cv::Mat exposed = light;
  if (options.blur_px > 0) {
    cv::GaussianBlur(light, exposed, {0, 0}, options.blur_px, 0, cv::BORDER_REPLICATE);
  }
  cv::Mat picture(light.size(), CV_8UC3);
  const float middle_x = 0.5f * float(light.cols - 1), middle_y = 0.5f * float(light.rows - 1);
  const float corner = middle_x * middle_x + middle_y * middle_y;
  const float shot = options.full_well > 0 ? float(1 / options.full_well) : 0;
  const auto read = float(options.read_noise * options.read_noise);
  const std::uint64_t stream = scrambled(noise_seed);
  tbb::parallel_for(tbb::blocked_range<int>(0, light.rows, 16), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) {
      const auto* from = exposed.ptr<cv::Vec3f>(y);
      auto* to = picture.ptr<cv::Vec3b>(y);
      for (int x = 0; x < light.cols; ++x) {
        const float dx = float(x) - middle_x, dy = float(y) - middle_y;
        const float shade =
            float(gain) * (1 - float(options.vignetting) * (dx * dx + dy * dy) / corner);
        std::uint64_t bits =
            stream + 3 * (std::uint64_t(y) * std::uint64_t(light.cols) + std::uint64_t(x));
        for (int c = 0; c < 3; ++c) {
          const float value = shade * from[x][c];
          const float deviation = std::sqrt(shot * value + read);
          to[x][2 - c] = encode(value + deviation * normal_deviate(scrambled(bits++)));
        }
      }
    }
  });
  return picture;
}

}  // namespace cairn
