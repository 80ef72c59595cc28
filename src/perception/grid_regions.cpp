#include "cairn/perception/grid_regions.h"

#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace cairn {
namespace {

// Union-find over the pixels of a grid; the root is the first pixel, so the order is fixed.
class Forest {
 public:
  explicit Forest(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<GridRegion> connected_regions(
    const cv::Size& size, int min_pixels, const std::function<bool(const cv::Point&)>& inside,
    const std::function<bool(const cv::Point&, const cv::Point&)>& same) {
  cv::Mat_<uchar> in(size, uchar(0));
  Forest forest(size.area());
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const cv::Point here(u, v);
      if (!inside(here)) continue;
      in(here) = 1;
      for (const cv::Point before : {cv::Point(u - 1, v), cv::Point(u, v - 1)}) {
        if (before.x < 0 || before.y < 0 || !in(before) || !same(before, here)) continue;
        forest.join(before.y * size.width + before.x, v * size.width + u);
      }
    }
  }
  std::map<int, GridRegion> by_root;
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      if (in(v, u)) by_root[forest.root(v * size.width + u)].push_back({u, v});
    }
  }
  std::vector<GridRegion> regions;
  for (auto& [root, region] : by_root) {
    if (int(region.size()) >= min_pixels) regions.push_back(std::move(region));
  }
  return regions;
}

std::vector<GridRegion> connected_pieces(const GridRegion& region, const cv::Mat_<uchar>& wanted,
                                         int min_pixels) {
  cv::Mat_<uchar> both(wanted.size(), uchar(0));
  for (const cv::Point& p : region) both(p) = wanted(p);
  return connected_regions(
      wanted.size(), min_pixels, [&](const cv::Point& p) { return both(p) != 0; },
      [](const cv::Point&, const cv::Point&) { return true; });
}

cv::Mat_<uchar> mask_of_region(const GridRegion& region, const cv::Size& size) {
  cv::Mat_<uchar> mask(size, uchar(0));
  for (const cv::Point& p : region) mask(p) = 255;
  return mask;
}

GridRegion region_of_mask(const cv::Mat_<uchar>& mask) {
  GridRegion region;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (mask(v, u)) region.push_back({u, v});
    }
  }
  return region;
}

void fill_small_holes(cv::Mat_<uchar>& mask, double max_share) {
  const double most = max_share * cv::countNonZero(mask);
  cv::Mat labels, stats, centroids;
  const cv::Mat outside = mask == 0;
  const int count = cv::connectedComponentsWithStats(outside, labels, stats, centroids, 4);
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) <= most) mask.setTo(255, labels == i);
  }
}

cv::Mat picture_mask(const cv::Mat_<uchar>& mask, const cv::Size& picture) {
  cv::Mat large;
  cv::resize(mask, large, picture, 0, 0, cv::INTER_LINEAR);
  return large > 127;
}

std::vector<GridRegion> colour_regions(const cv::Mat& bgr, int min_pixels, double max_step) {
  cv::Mat_<cv::Vec3b> smooth, lab;
  cv::medianBlur(bgr, smooth, 5);
  cv::cvtColor(smooth, lab, cv::COLOR_BGR2Lab);
  return connected_regions(
      bgr.size(), min_pixels, [](const cv::Point&) { return true; },
      [&](const cv::Point& a, const cv::Point& b) { return cv::norm(lab(a), lab(b)) < max_step; });
}

}  // namespace cairn
