#include "cairn/synthetic/mip_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn {
namespace {

// The exponent and, in a straight line between powers of two, what is beyond it: 0.09 off at most.
float log2_estimate(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return float(int(bits >> 23) - 127) + float(bits & 0x7FFFFF) * 0x1p-23f;
}

std::uint8_t root_of(float linear) {
  return std::uint8_t(std::lround(255 * std::sqrt(std::clamp(linear, 0.f, 1.f))));
}

}  // namespace

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

MipMap::MipMap(const Texture& texture)
    : texels_per_metre_(texture.texels_per_metre),
      repeats_x_(texture.texels_per_metre / float(texture.picture.cols)),
      repeats_y_(texture.texels_per_metre / float(texture.picture.rows)) {
  std::array<float, 256> linear{};
  for (int i = 0; i < 256; ++i) linear[std::size_t(i)] = linear_from_srgb(float(i) / 255);
  cv::Mat3f picture(texture.picture.size());
  for (int y = 0; y < picture.rows; ++y) {
    const auto* from = texture.picture.ptr<cv::Vec3b>(y);
    auto* to = picture.ptr<cv::Vec3f>(y);
    for (int x = 0; x < picture.cols; ++x) {
      to[x] = {linear[from[x][2]], linear[from[x][1]], linear[from[x][0]]};
    }
  }
  while (true) {
    Level level{picture.cols, picture.rows, std::vector<Texel>(picture.total())};
    auto to = level.texels.begin();
    for (int y = 0; y < picture.rows; ++y) {
      const auto* from = picture.ptr<cv::Vec3f>(y);
      for (int x = 0; x < picture.cols; ++x, ++to) {
        *to = {root_of(from[x][0]), root_of(from[x][1]), root_of(from[x][2]), 0};
      }
    }
    levels_.push_back(std::move(level));
    if (picture.cols == 1 && picture.rows == 1) break;
    cv::Mat3f half;
    cv::resize(picture, half, {std::max(1, picture.cols / 2), std::max(1, picture.rows / 2)}, 0, 0,
               cv::INTER_AREA);
    picture = half;
  }
  mean_ = Colour(picture(0, 0)[0], picture(0, 0)[1], picture(0, 0)[2]);
}

Colour MipMap::sample(const Eigen::Vector2f& uv, float footprint) const {
  const float halvings = std::clamp(log2_estimate(std::max(footprint * texels_per_metre_, 1e-6f)),
                                    0.f, float(levels_.size() - 1));
  const auto finer = std::size_t(halvings);
  const float share = halvings - float(finer);  // of the coarser one
  const Eigen::Vector2f turns(uv.x() * repeats_x_, uv.y() * repeats_y_);
  if (share == 0) return levels_[finer].at(turns);
  return (1 - share) * levels_[finer].at(turns) + share * levels_[finer + 1].at(turns);
}

Colour MipMap::Level::at(const Eigen::Vector2f& turns) const {
  const float x = (turns.x() - std::floor(turns.x())) * float(width) - 0.5f;
  const float y = (turns.y() - std::floor(turns.y())) * float(height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const float u = x - left, v = y - top;
  const int x1 = left + 1 < float(width) ? int(left) + 1 : 0;
  const int y1 = top + 1 < float(height) ? int(top) + 1 : 0;
  const int x0 = left < 0 ? width - 1 : int(left);
  const int y0 = top < 0 ? height - 1 : int(top);
  const Texel* rows[2] = {&texels[std::size_t(y0) * std::size_t(width)],
                          &texels[std::size_t(y1) * std::size_t(width)]};
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
