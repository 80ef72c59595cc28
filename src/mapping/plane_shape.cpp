#include "cairn/mapping/plane_shape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace cairn {
namespace {

constexpr int kCells = 160;           // along the longer side of what the shape is drawn on
constexpr int kMargin = 2;            // cells around it
constexpr double kRare = 0.15;        // of the pictures that show a usual place: fewer are mistaken
constexpr int kLargestGap = 32;       // cells, that are closed
constexpr double kNearlyAll = 0.95;   // of the area, that one part must have
constexpr double kCornerError = 2.0;  // cells, that a simplified outline may be off

// The plane as a drawing board around its convex outline; lengths in cells.
class Board {
 public:
  Board(const Plane& plane, const std::vector<Eigen::Vector3d>& hull)
      : foot_(-plane.offset() * plane.normal()), u_(plane.normal().unitOrthogonal()) {
    v_ = plane.normal().cross(u_);
    Eigen::Vector2d high = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
    low_ = -high;
    for (const Eigen::Vector3d& corner : hull) {
      const Eigen::Vector2d x(u_.dot(corner), v_.dot(corner));
      low_ = low_.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    cell_ = std::max((high - low_).maxCoeff() / kCells, 1e-9);
    size_ = cv::Size(cell_of(high.x(), 0) + kMargin + 1, cell_of(high.y(), 1) + kMargin + 1);
  }

  cv::Mat_<unsigned char> filled(const std::vector<Eigen::Vector3d>& polygon) const {
    cv::Mat_<unsigned char> mask = cv::Mat_<unsigned char>::zeros(size_);
    std::vector<cv::Point> corners;
    corners.reserve(polygon.size());
    for (const Eigen::Vector3d& x : polygon) {
      corners.emplace_back(cell_of(u_.dot(x), 0), cell_of(v_.dot(x), 1));
    }
    if (corners.size() > 2) cv::fillPoly(mask, std::vector{corners}, cv::Scalar(1));
    return mask;
  }

  Eigen::Vector3d on_plane(const cv::Point& at) const {
    return foot_ + (low_.x() + (at.x - kMargin) * cell_) * u_ +
           (low_.y() + (at.y - kMargin) * cell_) * v_;
  }

  cv::Size size() const { return size_; }

 private:
  int cell_of(double x, int axis) const {
    const double most = 100.0 * kCells;  // far beyond the board is as good as anywhere there
    return kMargin + int(std::lround(std::clamp((x - low_[axis]) / cell_, -most, most)));
  }

  Eigen::Vector3d foot_, u_, v_;
  Eigen::Vector2d low_;
  double cell_ = 1;
  cv::Size size_;
};

// What is shown often enough.
cv::Mat_<unsigned char> commonly_seen(const Board& board,
                                      const std::vector<std::vector<Eigen::Vector3d>>& outlines) {
  cv::Mat_<unsigned short> pictures = cv::Mat_<unsigned short>::zeros(board.size());
  for (const auto& outline : outlines) {
    cv::add(pictures, board.filled(outline), pictures, cv::noArray(), CV_16U);
  }
  std::vector<unsigned short> shown;
  std::copy_if(pictures.begin(), pictures.end(), std::back_inserter(shown),
               [](unsigned short n) { return n > 0; });
  if (shown.empty()) return cv::Mat_<unsigned char>::zeros(board.size());
  const auto half = shown.begin() + std::ptrdiff_t(shown.size() / 2);
  std::nth_element(shown.begin(), half, shown.end());
  return pictures >= std::max(1.0, std::ceil(kRare * *half));
}

// The one part that is left when gaps are closed, the narrowest first; empty where none is.
std::vector<cv::Point> border_of(const cv::Mat_<unsigned char>& seen) {
  for (int gap = 2; gap <= kLargestGap; gap *= 2) {
    cv::Mat closed;
    // Not by the board's border, which would draw all to itself.
    cv::copyMakeBorder(seen, closed, gap, gap, gap, gap, cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::morphologyEx(closed, closed, cv::MORPH_CLOSE,
                     cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * gap + 1, 2 * gap + 1}));
    std::vector<std::vector<cv::Point>> parts;
    cv::findContours(closed, parts, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE, {-gap, -gap});
    double all = 0, most = 0;
    std::vector<cv::Point>* largest = nullptr;
    for (auto& part : parts) {
      const double area = cv::contourArea(part);
      all += area;
      if (area > most) largest = &part;
      most = std::max(most, area);
    }
    if (largest != nullptr && most > kNearlyAll * all) return std::move(*largest);
  }
  return {};
}

}  // namespace

std::vector<Eigen::Vector3d> plane_shape(const Map& map, PlaneId id) {
  const PlaneLandmark& landmark = map.planes()[id];
  if (landmark.outline.empty()) return {};
  const SE3& T_wr = map.keyframes()[landmark.reference].T_wc;
  const Board board(landmark.plane, landmark.outline);
  const cv::Mat_<unsigned char> seen = commonly_seen(board, map.seen_outlines(id));
  std::vector<cv::Point> corners = border_of(seen & board.filled(landmark.outline) * 255);
  if (!corners.empty()) cv::approxPolyDP(std::vector(corners), corners, kCornerError, true);
  std::vector<Eigen::Vector3d> shape;
  if (corners.size() < 3) {
    for (const Eigen::Vector3d& x : landmark.outline) {
      shape.push_back(x - landmark.plane.signed_distance(x) * landmark.plane.normal());
    }
    return transformed(std::move(shape), T_wr);
  }
  for (const cv::Point& corner : corners) shape.push_back(board.on_plane(corner));
  if (cv::contourArea(corners, true) < 0) std::reverse(shape.begin(), shape.end());
  return transformed(std::move(shape), T_wr);
}

}  // namespace cairn
