#include "cairn/map/plane_landmark.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr int kDirections = 24;      // in which the extent of an outline is asked
constexpr double kMaxStretch = 2.5;  // depth of a corner over the median of all

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

const std::string& PlaneLandmark::label() const {
  static const std::string kNone;
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? kNone : most->first;
}

SeenPlane SeenPlane::scaled(double factor) const {
  SeenPlane result = *this;
  result.plane = plane.scaled(factor);
  result.centroid *= factor;
  result.sigma_offset *= factor;
  for (Eigen::Vector3d& corner : result.outline) corner *= factor;
  return result;
}

MaskVotes& MaskVotes::operator+=(const MaskVotes& other) {
  inside += other.inside;
  rim += other.rim;
  beside += other.beside;
  outside += other.outside;
  return *this;
}

bool PlaneLandmark::seen_by(KeyframeId keyframe) const {
  return std::any_of(observations.begin(), observations.end(),
                     [&](const PlaneObservation& o) { return o.keyframe == keyframe; });
}

void PlaneLandmark::add(const PlaneObservation& o) {
  for (PlaneObservation& known : observations) {
    if (known.keyframe != o.keyframe) continue;
    append(known.outlines, o.outlines);
    append(known.keypoints, o.keypoints);
    append(known.inner, o.inner);
    append(known.beside, o.beside);
    return;
  }
  observations.push_back(o);
}

std::vector<Eigen::Vector3d> transformed(std::vector<Eigen::Vector3d> corners, const SE3& T_ba) {
  for (Eigen::Vector3d& corner : corners) corner = T_ba * corner;
  return corners;
}

std::vector<Eigen::Vector3d> moved_along_rays(const std::vector<Eigen::Vector3d>& corners,
                                              const Plane& plane) {
  std::vector<Eigen::Vector3d> moved;
  std::vector<double> depths;
  for (const Eigen::Vector3d& corner : corners) {
    const auto factor = plane.depth_along(corner);
    if (!factor) continue;
    moved.push_back(*factor * corner);
    depths.push_back(moved.back().z());
  }
  if (moved.empty()) return moved;
  const double most = kMaxStretch * median(depths);
  std::erase_if(moved, [&](const Eigen::Vector3d& corner) { return corner.z() > most; });
  return moved;
}

std::vector<Eigen::Vector3d> outline_on(const Plane& plane, const SE3& T_rk,
                                        const std::vector<Eigen::Vector3d>& corners) {
  return transformed(moved_along_rays(corners, plane.transformed(T_rk.inverse())), T_rk);
}

std::vector<Eigen::Vector3d> common_outline(
    const Plane& plane, const std::vector<std::vector<Eigen::Vector3d>>& outlines) {
  const Eigen::Vector3d u = plane.normal().unitOrthogonal(), v = plane.normal().cross(u);
  std::vector<Eigen::Vector3d> corners;
  for (const auto& outline : outlines) append(corners, outline);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Vector3d direction = std::cos(angle) * u + std::sin(angle) * v;
    std::vector<double> reaches;
    for (const auto& outline : outlines) {
      double reach = -std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& c : outline) reach = std::max(reach, direction.dot(c));
      if (!outline.empty()) reaches.push_back(reach);
    }
    if (reaches.empty()) break;
    const auto widest = reaches.begin() + static_cast<std::ptrdiff_t>(reaches.size() / 20);
    std::nth_element(reaches.begin(), widest, reaches.end(), std::greater<>());
    std::erase_if(corners, [&](const Eigen::Vector3d& c) { return direction.dot(c) > *widest; });
  }
  return convex_outline(plane, corners);
}

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& outline) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : outline) sum += corner;
  return outline.empty() ? sum : Eigen::Vector3d(sum / double(outline.size()));
}

// Outlines are in the reference's frame.
double viewing_distance(const PlaneLandmark& landmark) {
  return middle_of(landmark.outline).norm();
}

double angle_off(PlaneRelation relation, const Plane& a, const Plane& b) {
  const double angle = angle_between(a, b);
  return relation == PlaneRelation::kPerpendicular ? std::numbers::pi / 2 - angle : angle;
}

void change_reference(PlaneLandmark& landmark, KeyframeId reference, const SE3& T_nr) {
  landmark.reference = reference;
  landmark.plane = landmark.plane.transformed(T_nr);
  landmark.outline = transformed(std::move(landmark.outline), T_nr);
  for (PlaneOutlines& seen : landmark.buried_views) seen.T_rk = T_nr * seen.T_rk;
}

std::vector<Eigen::Vector3d> convex_outline(const Plane& plane,
                                            const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d n = plane.normal();
  const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
  struct Corner {
    double x, y;
  };
  std::vector<Corner> corners;
  corners.reserve(points.size());
  for (const Eigen::Vector3d& p : points) corners.push_back({u.dot(p), v.dot(p)});
  std::sort(corners.begin(), corners.end(),
            [](const Corner& a, const Corner& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Corner> hull;
  const auto turns_left = [](const Corner& a, const Corner& b, const Corner& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  const auto extend = [&](const Corner& c, std::size_t keep) {
    while (hull.size() > keep + 1 && !turns_left(hull[hull.size() - 2], hull.back(), c)) {
      hull.pop_back();
    }
    hull.push_back(c);
  };
  for (const Corner& c : corners) extend(c, 0);
  const std::size_t lower = hull.size() - (hull.empty() ? 0 : 1);
  for (std::size_t i = corners.size(); i-- > 1;) extend(corners[i - 1], lower);
  if (hull.size() > 1) hull.pop_back();  // the first once more
  std::vector<Eigen::Vector3d> outline;
  outline.reserve(hull.size());
  for (const Corner& c : hull) outline.push_back(c.x * u + c.y * v - plane.offset() * n);
  return outline;
}

}  // namespace cairn
