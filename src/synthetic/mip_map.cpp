#include "cairn/synthetic/mip_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn {

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

MipMap::MipMap(const Texture& texture) : texels_per_metre_(texture.texels_per_metre) {
  std::array<float, 256> linear{};
  for (int i = 0; i < 256; ++i) linear[std::size_t(i)] = linear_from_srgb(float(i) / 255);
  cv::Mat3f picture(texture.picture.size());
  for (int y = 0; y < picture.rows; ++y) {
    const auto* from = texture.picture.ptr<cv::Vec3b>(y);
    for (int x = 0; x < picture.cols; ++x) {
      picture(y, x) = {linear[from[x][2]], linear[from[x][1]], linear[from[x][0]]};
    }
  }
  const cv::Scalar mean = cv::mean(picture);
  mean_ = Colour(float(mean[0]), float(mean[1]), float(mean[2]));
  const cv::Size full = picture.size();
  while (true) {
    Level level;
    level.width = picture.cols, level.height = picture.rows;
    level.scale_x = texels_per_metre_ * float(picture.cols) / float(full.width);
    level.scale_y = texels_per_metre_ * float(picture.rows) / float(full.height);
    level.texels.resize(picture.total());
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        Texel& texel = level.texels[std::size_t(y) * std::size_t(level.width) + std::size_t(x)];
        for (int c = 0; c < 3; ++c) {
          texel[std::size_t(c)] =
              std::uint8_t(std::lround(255 * std::sqrt(std::clamp(picture(y, x)[c], 0.f, 1.f))));
        }
      }
    }
    levels_.push_back(std::move(level));
    if (picture.cols == 1 && picture.rows == 1) break;
    cv::Mat3f half;
    cv::resize(picture, half, {std::max(1, picture.cols / 2), std::max(1, picture.rows / 2)}, 0, 0,
               cv::INTER_AREA);
    picture = half;
  }
}

Colour MipMap::sample(const Eigen::Vector2f& uv, float footprint, float dither) const {
  const float exponent = std::log2(std::max(footprint * texels_per_metre_, 1e-6f)) + dither;
  const int index = std::clamp(int(std::floor(exponent)), 0, int(levels_.size()) - 1);
  const Level& level = levels_[std::size_t(index)];
  const float x = uv.x() * level.scale_x - 0.5f, y = uv.y() * level.scale_y - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const float u = x - left, v = y - top;
  auto wrapped = [](float at, int size) {
    const int rest = int(at) % size;
    return rest < 0 ? rest + size : rest;
  };
  const int x0 = wrapped(left, level.width), y0 = wrapped(top, level.height);
  const int x1 = x0 + 1 == level.width ? 0 : x0 + 1, y1 = y0 + 1 == level.height ? 0 : y0 + 1;
  const Texel* rows[2] = {&level.texels[std::size_t(y0) * std::size_t(level.width)],
                          &level.texels[std::size_t(y1) * std::size_t(level.width)]};
  const float w00 = (1 - u) * (1 - v), w10 = u * (1 - v), w01 = (1 - u) * v, w11 = u * v;
  Colour root;
  for (int c = 0; c < 3; ++c) {
    const auto k = std::size_t(c);
    root[c] = w00 * float(rows[0][x0][k]) + w10 * float(rows[0][x1][k]) +
              w01 * float(rows[1][x0][k]) + w11 * float(rows[1][x1][k]);
  }
  return root.cwiseAbs2() * (1.0f / (255.0f * 255.0f));
}

}  // namespace cairn
