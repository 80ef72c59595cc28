#include "cairn/mapping/hung_things.h"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "cairn/map/plane_labels.h"

namespace cairn {
namespace {

constexpr double kAlone = 0.95;  // of a border that is with planes

struct Part {
  std::vector<int> border;  // pixels of its border with each plane
  int at_edge = 0;          // and with the edge of the picture
  int area = 0;
};

// Index into planes, or -1.
int wall_behind(const Part& part, std::span<const DetectedPlane> planes,
                const std::vector<int>& areas) {
  const auto most = std::max_element(part.border.begin(), part.border.end());
  const int all = std::accumulate(part.border.begin(), part.border.end(), 0);
  if (most == part.border.end() || *most < part.at_edge || *most < kAlone * all) return -1;
  const auto plane = most - part.border.begin();
  return *most > 0 && is_upright(planes[plane].label) && part.area < areas[plane] ? int(plane) : -1;
}

}  // namespace

cv::Mat_<int> hung_things(std::span<const DetectedPlane> planes, cv::Size size) {
  cv::Mat_<int> owner(size, -1);
  std::vector<int> areas(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].mask.type() != CV_8U || planes[i].mask.size() != size) continue;
    owner.setTo(int(i), planes[i].mask);
    areas[i] = cv::countNonZero(planes[i].mask);
  }
  cv::Mat_<int> part_of;
  const int count = cv::connectedComponents(owner < 0, part_of, 4);
  std::vector<Part> parts(static_cast<std::size_t>(count), {std::vector<int>(planes.size())});
  const auto meet = [&](int ya, int xa, int yb, int xb) {
    const int a = owner(ya, xa), b = owner(yb, xb);
    if (a < 0 && b >= 0) ++parts[part_of(ya, xa)].border[b];
    if (b < 0 && a >= 0) ++parts[part_of(yb, xb)].border[a];
  };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (x + 1 < size.width) meet(y, x, y, x + 1);
      if (y + 1 < size.height) meet(y, x, y + 1, x);
      Part& part = parts[part_of(y, x)];
      ++part.area;
      part.at_edge += x == 0 || y == 0 || x + 1 == size.width || y + 1 == size.height;
    }
  }
  std::vector<int> behind(parts.size(), -1);
  for (std::size_t i = 1; i < parts.size(); ++i) behind[i] = wall_behind(parts[i], planes, areas);
  cv::Mat_<int> result(size);
  std::transform(part_of.begin(), part_of.end(), result.begin(),
                 [&](int part) { return behind[std::size_t(part)]; });
  return result;
}

}  // namespace cairn
