#include "cairn/evaluation/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cairn {

ErrorStatistics statistics(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  ErrorStatistics result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / double(n);
  result.rmse =
      std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / double(n));
  result.median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  result.max = values.back();
  return result;
}

std::vector<double> absolute_errors(std::span<const StampedPose> truth,
                                    std::span<const StampedPose> estimate) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    errors.push_back((truth[i].T_wc.translation() - estimate[i].T_wc.translation()).norm());
  }
  return errors;
}

RelativeError relative_error(std::span<const StampedPose> truth,
                             std::span<const StampedPose> estimate,
                             std::span<const IndexPair> pairs) {
  RelativeError result;
  result.pairs = pairs.size();
  if (pairs.empty()) return result;
  double translation = 0, rotation = 0;
  for (const auto& [i, j] : pairs) {
    const SE3 true_motion = truth[i].T_wc.inverse() * truth[j].T_wc;
    const SE3 motion = estimate[i].T_wc.inverse() * estimate[j].T_wc;
    const SE3 error = true_motion.inverse() * motion;
    translation += error.translation().squaredNorm();
    rotation += so3_log(error.rotation()).squaredNorm();
  }
  result.translation = std::sqrt(translation / double(pairs.size()));
  result.rotation_deg = std::sqrt(rotation / double(pairs.size())) * 180 / M_PI;
  return result;
}

std::vector<IndexPair> pairs_by_frame(std::size_t count) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 1; i < count; ++i) pairs.push_back({i - 1, i});
  return pairs;
}

std::vector<IndexPair> pairs_by_time(std::span<const StampedPose> poses, double seconds) {
  std::vector<IndexPair> pairs;
  std::size_t j = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto error = [&](std::size_t k) {
      return std::abs(poses[k].timestamp - poses[i].timestamp - seconds);
    };
    while (j + 1 < poses.size() && error(j + 1) < error(j)) ++j;
    if (j > i && error(j) <= 0.1 * seconds) pairs.push_back({i, j});
  }
  return pairs;
}

std::vector<IndexPair> pairs_by_path(std::span<const StampedPose> poses, double metres) {
  std::vector<std::size_t> marks;
  double path = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path += (poses[i].T_wc.translation() - poses[i - 1].T_wc.translation()).norm();
    if (path < metres) continue;
    marks.push_back(i);
    path = 0;
  }
  std::vector<IndexPair> pairs;
  for (std::size_t k = 1; k < marks.size(); ++k) pairs.push_back({marks[k - 1], marks[k]});
  return pairs;
}

}  // namespace cairn
