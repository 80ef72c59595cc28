#include "cairn/synthetic/dense_noise.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cairn/perception/picture_box.h"

namespace cairn {
namespace {

// Normal noise at the nodes of a grid, a cell apart, with a border that interpolation needs.
// `value` gives that of node (column, row).
template <typename Value>
cv::Mat node_noise(int columns, int rows, const Value& value) {
  cv::Mat nodes(rows, columns, CV_32F);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) nodes.at<float>(y, x) = float(value(x, y));
  }
  return nodes;
}

// Smooth in between, with variance 1 at the nodes and everywhere between them: the cubic's weights
// do not keep the variance, so it is divided by the norm of the weights (which separate).
cv::Mat spread(const cv::Mat& nodes, const cv::Size& size) {
  const auto weights = [](int count, int length) {
    cv::Mat norms(1, length, CV_32F, cv::Scalar(0));
    for (int i = 0; i < count; ++i) {
      cv::Mat one(1, count, CV_32F, cv::Scalar(0)), response;
      one.at<float>(i) = 1;
      cv::resize(one, response, {length, 1}, 0, 0, cv::INTER_CUBIC);
      norms += response.mul(response);
    }
    cv::sqrt(norms, norms);
    return norms;
  };
  cv::Mat field;
  cv::resize(nodes, field, size, 0, 0, cv::INTER_CUBIC);
  cv::Mat norms = weights(nodes.rows, size.height).t() * weights(nodes.cols, size.width);
  return field / norms;
}

// A smooth field over a picture that changes with time; `length` is the share of the picture's
// width after which its correlation is 1/e: cubic interpolation between nodes falls to that after
// 0.81 of their distance. The grid is a cell larger than the picture on each side, as its border is
// flat.
cv::Mat field(const cv::Size& size, double length, double seconds, const HashedNoise& source,
              double time) {
  const int cell = std::max(2, int(std::lround(std::max(0.02, length) / 0.81 * size.width)));
  const int columns = (size.width - 1) / cell + 3, rows = (size.height - 1) / cell + 3;
  const cv::Mat nodes = node_noise(columns, rows, [&](int x, int y) {
    return source.of({std::uint64_t(x), std::uint64_t(y)}).correlated(time, seconds);
  });
  return spread(nodes, {columns * cell, rows * cell})(cv::Rect({cell, cell}, size));
}

// A Gaussian's mean over the pixels that have a depth; wide ones are taken at lower resolution.
cv::Mat blurred(const cv::Mat& depth, double sigma) {
  if (sigma <= 0.1) return depth;
  const int step = std::clamp(int(sigma / 4), 1, std::min(depth.cols, depth.rows) / 8);
  const cv::Size size(depth.cols / step, depth.rows / step);
  cv::Mat sum, weight;
  cv::Mat(depth > 0).convertTo(weight, CV_32F, 1 / 255.0);
  cv::resize(depth, sum, size, 0, 0, cv::INTER_AREA);
  cv::resize(weight, weight, size, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(sum, sum, {}, sigma / step);
  cv::GaussianBlur(weight, weight, {}, sigma / step);
  cv::Mat mean = sum / cv::max(weight, 1e-6f);
  cv::resize(mean, mean, depth.size(), 0, 0, cv::INTER_LINEAR);
  return mean;
}

cv::Mat logarithm(const cv::Mat& depth) {
  cv::Mat result;
  cv::log(cv::max(depth, 1e-3f), result);
  return result;
}

}  // namespace

double log_scale_error(const PerceptionNoise::Depth& noise, const HashedNoise& source,
                       double time) {
  return noise.scale_spread * source.of({1}).correlated(time, noise.scale_seconds);
}

cv::Mat noisy_depth(const cv::Mat& depth, const PerceptionNoise::Depth& noise,
                    const HashedNoise& source, double time) {
  CV_Assert(depth.type() == CV_32F);
  const double log_scale = std::log(noise.scale) + log_scale_error(noise, source, time);
  cv::Mat result = logarithm(blurred(depth, noise.blur * depth.cols));
  if (noise.sharp < 1) {
    result = noise.sharp * result +
             (1 - noise.sharp) * logarithm(blurred(depth, noise.smear * depth.cols));
  }
  result += log_scale;
  if (noise.local > 0) {
    result += noise.local *
              field(depth.size(), noise.local_length, noise.local_seconds, source.of({2}), time);
  }
  cv::exp(result, result);
  result.setTo(0, depth <= 0);
  return result;
}

cv::Mat noisy_normals(const cv::Mat& normals, const PerceptionNoise::Normals& noise,
                      const HashedNoise& source, double time) {
  CV_Assert(normals.type() == CV_32FC3);
  cv::Mat result = normals.clone();
  if (noise.angle_deg <= 0) return result;
  const double sigma = noise.angle_deg * M_PI / 180;
  const auto tilt = [&](std::uint64_t axis) {
    return field(normals.size(), noise.length, noise.seconds, source.of({3, axis}), time);
  };
  const cv::Mat tilt_u = sigma * tilt(0), tilt_v = sigma * tilt(1);
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      auto& pixel = result.at<cv::Vec3f>(y, x);
      const Eigen::Vector3f n(pixel[0], pixel[1], pixel[2]);
      if (!(n.squaredNorm() > 0.25f)) continue;
      const Eigen::Vector3f u =
          n.cross(Eigen::Vector3f::Unit(std::abs(n.x()) < 0.7f ? 0 : 1)).normalized();
      const Eigen::Vector3f lean = tilt_u.at<float>(y, x) * u + tilt_v.at<float>(y, x) * n.cross(u);
      const float angle = lean.norm();
      if (!(angle > 0)) continue;
      const Eigen::Vector3f turned =
          (std::cos(angle) * n + std::sin(angle) / angle * lean).normalized();
      pixel = {turned.x(), turned.y(), turned.z()};
    }
  }
  return result;
}

cv::Mat ragged_mask(const cv::Mat& mask, const PerceptionNoise::Masks& noise,
                    const HashedNoise& source, double time) {
  CV_Assert(mask.type() == CV_8U);
  const int area = cv::countNonZero(mask);
  const double displacement = noise.ragged * std::sqrt(double(area));
  if (displacement < 0.1) return mask.clone();
  constexpr int kNodes = 16;  // along each side of the mask
  const int margin = int(std::ceil(3 * displacement)) + 1;
  const cv::Rect part = surroundings(mask, margin);
  // Signed distance to the border in pixels, positive inside; the border is between two pixels,
  // each half a pixel away. The border of the picture is none.
  cv::Mat inside, outside, half;
  cv::distanceTransform(mask(part), inside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(~mask(part), outside, cv::DIST_L2, cv::DIST_MASK_5);
  mask(part).convertTo(half, CV_32F, -1 / 255.0, 0.5);
  const std::int64_t now = HashedNoise::tick(time);
  const cv::Mat push = spread(
      node_noise(kNodes, kNodes,
                 [&](int x, int y) {
                   const HashedNoise node = source.of({std::uint64_t(x), std::uint64_t(y)});
                   return std::sqrt(0.5) * (node.of({1}).normal() + node.of({2}).normal(now));
                 }),
      part.size());
  cv::Mat result(mask.size(), CV_8U, cv::Scalar(0));
  cv::Mat(inside - outside + half + displacement * push > 0).copyTo(result(part));
  return result;
}

}  // namespace cairn
