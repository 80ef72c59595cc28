#include "cairn/perception/plane_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairn/perception/inverse_depth_fit.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kRadians = M_PI / 180;
constexpr double kHalfScoreShare = 0.02;  // of the picture: a plane of this size has half the score

double angle_deg(const Vector4d& a, const Vector4d& b) {
  return std::acos(std::clamp(a.head<3>().dot(b.head<3>()), -1.0, 1.0)) / kRadians;
}

Vector3d middle_ray(const OrganizedCloud& cloud, const GridRegion& region) {
  Vector3d sum = Vector3d::Zero();
  for (const cv::Point& p : region) sum += cloud.ray(p.y, p.x);
  return sum / double(region.size());
}

// A fit to the region that most of it lies on and that faces the way that it should.
std::optional<Vector4d> checked_fit(const OrganizedCloud& cloud, const GridRegion& region,
                                    const Vector4d& like, double max_angle_deg,
                                    const PlaneHypothesisOptions& hypothesis,
                                    const PlaneAgreementOptions& options) {
  const auto fit = fit_region(cloud, region, hypothesis);
  if (!fit || fit->inlier_share < options.min_inlier_share ||
      angle_deg(fit->plane, like) > max_angle_deg) {
    return std::nullopt;
  }
  return fit->plane;
}

}  // namespace

double relative_offset(const Vector4d& a, const Vector4d& b, const Vector3d& ray) {
  const double wa = inverse_depth_at(a, ray), wb = inverse_depth_at(b, ray);
  if (!(wa > 0 && wb > 0)) return std::numeric_limits<double>::infinity();
  return std::abs(std::log(wa / wb));
}

std::vector<AgreedPlane> agreeing_planes(const OrganizedCloud& cloud,
                                         const std::vector<PlaneHypothesis>& of_regions,
                                         const std::vector<PlaneHypothesis>& of_components,
                                         const PlaneHypothesisOptions& hypothesis,
                                         const PlaneAgreementOptions& options) {
  const int least = hypothesis.least_pixels(cloud.size());
  std::vector<AgreedPlane> agreed;
  for (const PlaneHypothesis& second : of_components) {
    const cv::Mat_<uchar> mask = mask_of_region(second.pixels, cloud.size());
    for (const PlaneHypothesis& first : of_regions) {
      const double angle = angle_deg(first.plane, second.plane);
      if (angle > options.max_angle_deg) continue;
      for (GridRegion& both : connected_pieces(first.pixels, mask, least)) {
        const double smaller = double(std::min(first.pixels.size(), second.pixels.size()));
        const double overlap = double(both.size()) / smaller;
        const Vector3d ray = middle_ray(cloud, both);
        const double offset = relative_offset(first.plane, second.plane, ray);
        if (overlap < options.min_overlap || offset > options.max_offset) continue;
        const auto plane =
            checked_fit(cloud, both, first.plane, options.max_angle_deg, hypothesis, options);
        if (!plane || relative_offset(*plane, first.plane, ray) > options.max_offset) continue;
        const double agreement =
            overlap * (1 - 0.5 * angle / options.max_angle_deg - 0.5 * offset / options.max_offset);
        agreed.push_back({{*plane, std::move(both), first.label}, std::clamp(agreement, 0., 1.)});
      }
    }
  }
  return agreed;
}

void merge_pieces(const OrganizedCloud& cloud, const PlaneHypothesisOptions& hypothesis,
                  const PlaneAgreementOptions& options, std::vector<AgreedPlane>& planes) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      PlaneHypothesis &a = planes[i].plane, &b = planes[j].plane;
      if (a.label != b.label || angle_deg(a.plane, b.plane) > options.merge_angle_deg) continue;
      if (relative_offset(a.plane, b.plane, middle_ray(cloud, a.pixels)) > options.merge_offset ||
          relative_offset(a.plane, b.plane, middle_ray(cloud, b.pixels)) > options.merge_offset) {
        continue;
      }
      GridRegion all = a.pixels;
      all.insert(all.end(), b.pixels.begin(), b.pixels.end());
      const auto plane =
          checked_fit(cloud, all, a.plane, options.merge_angle_deg, hypothesis, options);
      if (!plane) continue;
      const double share = double(a.pixels.size()) / double(all.size());
      planes[i].agreement = share * planes[i].agreement + (1 - share) * planes[j].agreement;
      a.plane = *plane;
      a.pixels = std::move(all);
      planes.erase(planes.begin() + std::ptrdiff_t(j));
      j = i;  // the larger one may now meet what it did not before
    }
  }
}

void grow_rims(const OrganizedCloud& cloud, const PlaneHypothesisOptions& hypothesis, int rounds,
               std::vector<AgreedPlane>& planes) {
  constexpr double kRimSigmas =
      1;  // closer than what a plane's own pixels may be: no normal speaks
  cv::Mat_<uchar> taken(cloud.size(), uchar(0));
  std::vector<GridRegion> rims;
  for (const AgreedPlane& plane : planes) {
    rims.push_back(plane.plane.pixels);
    for (const cv::Point& p : plane.plane.pixels) taken(p) = 1;
  }
  const cv::Rect inside({0, 0}, cloud.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < planes.size(); ++i) {  // by turns, so that no plane takes all
      GridRegion next;
      for (const cv::Point& p : rims[i]) {
        for (const cv::Point step :
             {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
          const cv::Point q = p + step;
          if (!inside.contains(q) || taken(q) ||
              distance_in_sigmas(cloud, q, planes[i].plane.plane, hypothesis.noise) > kRimSigmas) {
            continue;
          }
          taken(q) = 1;
          next.push_back(q);
        }
      }
      GridRegion& pixels = planes[i].plane.pixels;
      pixels.insert(pixels.end(), next.begin(), next.end());
      rims[i] = std::move(next);
    }
  }
}

std::vector<DetectedPlane> detected_planes(const OrganizedCloud& cloud, const cv::Size& picture,
                                           const std::vector<AgreedPlane>& planes,
                                           const PlaneHypothesisOptions& hypothesis,
                                           const PlaneAgreementOptions& options) {
  std::vector<DetectedPlane> detected;
  for (const AgreedPlane& agreed : planes) {
    const GridRegion& pixels = agreed.plane.pixels;
    const auto fit = fit_region(cloud, pixels, hypothesis);
    if (!fit) continue;
    cv::Mat_<uchar> mask = mask_of_region(pixels, cloud.size());
    fill_small_holes(mask, options.max_hole_share);
    const double share = double(pixels.size()) / cloud.size().area();
    const double patches =
        std::max(1.0, double(pixels.size()) / (options.correlated_px * options.correlated_px));
    const double depth = fit->residual / std::sqrt(patches);
    DetectedPlane plane;
    plane.plane = fit->plane;
    plane.label = agreed.plane.label.empty() ? "plane" : agreed.plane.label;
    plane.score = agreed.agreement * share / (share + kHalfScoreShare);
    plane.mask = picture_mask(mask, picture);
    plane.sigma_depth = std::hypot(options.min_sigma_depth, depth);
    plane.sigma_angle =
        std::hypot(options.min_sigma_angle_deg * kRadians,
                   std::atan(depth * fit->mean_depth / std::max(fit->spread, 1e-9)));
    detected.push_back(plane);
  }
  std::stable_sort(detected.begin(), detected.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  return detected;
}

}  // namespace cairn
