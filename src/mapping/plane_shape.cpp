#include "cairn/mapping/plane_shape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr int kCells = 160;        // along the longer side of what the shape is drawn on
constexpr int kMargin = 2;         // cells around it
constexpr double kRare = 0.15;     // of the pictures that show a usual place: fewer are mistaken
constexpr double kShare = 0.4;     // of what pictures say of a place: with more it is surface;
constexpr double kOfSurest = 0.7;  // or so much of the share of the surest twentieth of places
constexpr std::size_t kTextured = 100;  // points of a plane: with so many a part has some, too
constexpr int kLargestGap = 32;         // cells, that are closed
constexpr double kNearlyAll = 0.95;     // of the area, that one part must have
constexpr double kCornerError = 2.0;    // cells, that a simplified outline may be off

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

  cv::Mat_<unsigned char> blank() const { return cv::Mat_<unsigned char>::zeros(size_); }

  // Not all of them are on the board.
  std::vector<cv::Point> cells_of(const std::vector<Eigen::Vector3d>& points) const {
    std::vector<cv::Point> cells;
    cells.reserve(points.size());
    for (const Eigen::Vector3d& x : points) {
      cells.emplace_back(cell_of(u_.dot(x), 0), cell_of(v_.dot(x), 1));
    }
    return cells;
  }

  void fill(const std::vector<Eigen::Vector3d>& polygon, cv::Mat_<unsigned char>& mask) const {
    const std::vector<cv::Point> corners = cells_of(polygon);
    if (corners.size() > 2) cv::fillPoly(mask, std::vector{corners}, cv::Scalar(1));
  }

  Eigen::Vector3d on_plane(const cv::Point& at) const {
    return foot_ + (low_.x() + (at.x - kMargin) * cell_) * u_ +
           (low_.y() + (at.y - kMargin) * cell_) * v_;
  }

  // From a cell to the next of its row.
  Eigen::Vector3d step() const { return cell_ * u_; }

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

// Of the values at chosen places, of which there is one at least.
template <class T>
T quantile_at(const cv::Mat_<T>& values, const cv::Mat_<unsigned char>& where, double rank) {
  std::vector<T> chosen;
  for (int row = 0; row < values.rows; ++row) {
    for (int column = 0; column < values.cols; ++column) {
      if (where(row, column) != 0) chosen.push_back(values(row, column));
    }
  }
  return quantile(chosen, rank);
}

// What pictures say of each place that they look at: it is in the mask, or not. Each counts by the
// solid angle under which it sees the place: masks are rough in pixels, and what is seen from afar,
// or nearly along the plane, may be of what stands behind.
class Poll {
 public:
  explicit Poll(const Board& board)
      : board_(board),
        pictures_(cv::Mat_<unsigned short>::zeros(board.size())),
        inside_(cv::Mat_<float>::zeros(board.size())),
        all_(cv::Mat_<float>::zeros(board.size())) {}

  void ask(const PlaneOutlines& picture, const Plane& plane, const View& camera) {
    cv::Mat_<unsigned char> mask = board_.blank();
    for (const auto& part : picture.outlines) {
      board_.fill(outline_on(plane, picture.T_rk, part), mask);
    }
    cv::add(pictures_, mask, pictures_, cv::noArray(), CV_16U);
    const SE3 T_kr = picture.T_rk.inverse();
    const double height = std::abs(plane.signed_distance(picture.T_rk.translation()));
    const Eigen::Vector3d step = T_kr.rotation() * board_.step();
    for (int row = 0; row < mask.rows; ++row) {
      Eigen::Vector3d x = T_kr * board_.on_plane({0, row});
      for (int column = 0; column < mask.cols; ++column, x += step) {
        if (!(x.z() > 0) || !camera.contains(camera.pinhole().project(x))) continue;
        const double squared = x.squaredNorm();
        const auto weight = static_cast<float>(height / (squared * std::sqrt(squared)));
        all_(row, column) += weight;
        if (mask(row, column) != 0) inside_(row, column) += weight;
      }
    }
  }

  // Where enough of them say that it is.
  cv::Mat_<unsigned char> surface() const {
    const cv::Mat_<unsigned char> shown = pictures_ > 0;
    if (cv::countNonZero(shown) == 0) return board_.blank();
    const cv::Mat_<unsigned char> common =
        pictures_ >= std::ceil(kRare * quantile_at(pictures_, shown, 0.5));
    cv::Mat_<float> share;
    cv::divide(inside_, cv::max(all_, std::numeric_limits<float>::min()), share);
    return common & (share >= std::min(kShare, kOfSurest * quantile_at(share, common, 0.95)));
  }

 private:
  const Board& board_;
  cv::Mat_<unsigned short> pictures_;
  cv::Mat_<float> inside_, all_;
};

// The parts in which points of the plane lie; all if none does.
cv::Mat_<unsigned char> with_points(const cv::Mat_<unsigned char>& seen,
                                    const std::vector<cv::Point>& points) {
  cv::Mat_<int> parts;
  std::vector<bool> has_point(std::size_t(cv::connectedComponents(seen, parts)), false);
  for (const cv::Point& at : points) {
    if (cv::Rect({}, seen.size()).contains(at)) has_point[std::size_t(parts(at))] = true;
  }
  has_point[0] = false;  // what is not seen
  if (std::none_of(has_point.begin(), has_point.end(), [](bool has) { return has; })) return seen;
  cv::Mat_<unsigned char> kept = cv::Mat_<unsigned char>::zeros(seen.size());
  std::transform(parts.begin(), parts.end(), kept.begin(),
                 [&](int part) { return has_point[std::size_t(part)] ? 255 : 0; });
  return kept;
}

// The one part that is left when gaps are closed, the narrowest first; of parts that are far apart
// their convex outline; empty where there are none.
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
  std::vector<cv::Point> cells, hull;
  cv::findNonZero(seen, cells);
  if (!cells.empty()) cv::convexHull(cells, hull);
  return hull;
}

}  // namespace

std::vector<Eigen::Vector3d> plane_shape(const Map& map, PlaneId id) {
  const PlaneLandmark& landmark = map.planes()[id];
  if (landmark.outline.empty()) return {};
  const SE3& T_wr = map.keyframes()[landmark.reference].T_wc;
  const Board board(landmark.plane, landmark.outline);
  Poll poll(board);
  for (const PlaneOutlines& view : map.plane_views(id)) poll.ask(view, landmark.plane, map.view());
  cv::Mat_<unsigned char> hull = board.blank();
  board.fill(landmark.outline, hull);
  std::vector<Eigen::Vector3d> points;
  for (const PointId p : landmark.points) points.push_back(map.points()[p].position);
  points = transformed(std::move(points), T_wr.inverse());
  cv::Mat_<unsigned char> surface = poll.surface() & hull * 255;
  if (points.size() >= kTextured) surface = with_points(surface, board.cells_of(points));
  std::vector<cv::Point> corners = border_of(surface);
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
