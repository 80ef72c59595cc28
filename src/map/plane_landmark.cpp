#include "cairn/map/plane_landmark.h"

#include <algorithm>

namespace cairn {

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

bool PlaneLandmark::seen_by(KeyframeId keyframe) const {
  return std::any_of(observations.begin(), observations.end(),
                     [&](const PlaneObservation& o) { return o.keyframe == keyframe; });
}

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& outline) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : outline) sum += corner;
  return outline.empty() ? sum : Eigen::Vector3d(sum / double(outline.size()));
}

void change_reference(PlaneLandmark& landmark, KeyframeId reference, const SE3& T_nr) {
  landmark.reference = reference;
  landmark.plane = landmark.plane.transformed(T_nr);
  for (Eigen::Vector3d& corner : landmark.outline) corner = T_nr * corner;
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
