#include "cairn/mapping/picture_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr int kMinScalePoints = 15;
constexpr double kGate = 3;  // σ
constexpr int kColumns = 8, kRows = 6;

struct Pair {
  double mapped, predicted;  // logarithms of depths
  double scale;              // the first less the stretched second
  std::size_t cell;
};

std::size_t cell_of(const View& view, const Eigen::Vector2d& pixel) {
  const auto along = [](double at, double from, double to, int cells) {
    return std::clamp(int((at - from) / (to - from) * cells), 0, cells - 1);
  };
  return std::size_t(along(pixel.y(), view.min_y(), view.max_y(), kRows) * kColumns +
                     along(pixel.x(), view.min_x(), view.max_x(), kColumns));
}

std::vector<Pair> pairs_of(const Map& map, const Keyframe& keyframe, double contrast) {
  const SE3 T_cw = keyframe.T_wc.inverse();
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < keyframe.depth.size(); ++i) {
    if (!keyframe.points[i].valid() || !(keyframe.depth[i] > 0)) continue;
    const MapPoint& point = map.points()[keyframe.points[i]];
    const double depth = (T_cw * point.position).z();
    if (point.assumed || !(depth > 0)) continue;
    const double mapped = std::log(depth);
    pairs.push_back(
        {mapped, std::log(keyframe.depth[i]),
         mapped - std::log(stretched_depth(keyframe.depth[i], keyframe.depth_range, contrast)),
         cell_of(map.view(), keyframe.frame->pixel(i))});
  }
  return pairs;
}

double mean_of_cells(const std::vector<Pair>& pairs, double Pair::*value) {
  std::array<std::vector<double>, std::size_t{kColumns * kRows}> cells;
  for (const Pair& p : pairs) cells[p.cell].push_back(p.*value);
  std::vector<double> medians;
  for (auto& cell : cells) {
    if (!cell.empty()) medians.push_back(median(cell));
  }
  return robust_mean(std::move(medians), kGate);
}

// Of the points that agree.
void find_contrast(std::vector<Pair> pairs, PictureScale& result) {
  const double middle = std::log(result.scale);
  std::erase_if(
      pairs, [&](const Pair& p) { return std::abs(p.scale - middle) > kGate * result.log_error; });
  if (pairs.empty()) return;
  const double n = double(pairs.size());
  double mapped = 0, predicted = 0;
  for (const Pair& p : pairs) {
    mapped += p.mapped / n;
    predicted += p.predicted / n;
  }
  for (const Pair& p : pairs) {
    result.variance += (p.mapped - mapped) * (p.mapped - mapped) / n;
    result.covariance += (p.mapped - mapped) * (p.predicted - predicted) / n;
  }
}

}  // namespace

double PictureScale::log_scale(double with_contrast) const {
  return std::log(scale) + log_stretch(predicted, range, contrast) -
         log_stretch(predicted, range, with_contrast);
}

PictureScale align_picture(const Map& map, KeyframeId id, double contrast) {
  const Keyframe& keyframe = map.keyframes()[id];
  const std::vector<Pair> pairs = pairs_of(map, keyframe, contrast);
  PictureScale result;
  result.points = static_cast<int>(pairs.size());
  if (result.points < kMinScalePoints) return result;
  result.usable = true;
  result.scale = std::exp(mean_of_cells(pairs, &Pair::scale));
  std::vector<double> scales;
  for (const Pair& p : pairs) scales.push_back(p.scale);
  result.log_error = robust_spread(std::move(scales));
  result.contrast = contrast;
  if (!keyframe.depth_range.known()) return result;
  result.range = keyframe.depth_range;
  result.predicted = mean_of_cells(pairs, &Pair::predicted) - result.range.mean;
  find_contrast(pairs, result);
  return result;
}

}  // namespace cairn
