#include "cairn/perception/plane_hypotheses.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "cairn/geometry/median.h"
#include "cairn/perception/inverse_depth_fit.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kFitRounds = 8, kModeRounds = 3;
constexpr std::size_t kModeCandidates = 64, kModeVoters = 400;

double cosine(double degrees) { return std::cos(degrees * M_PI / 180); }

// The direction that most normals of a region lie around; nothing for an empty region. Candidates
// and voters are spread evenly over the region: no chance is involved.
std::optional<Vector3d> normal_mode(const OrganizedCloud& cloud, const GridRegion& region,
                                    double min_cosine) {
  if (region.empty()) return std::nullopt;
  const std::size_t candidate_step = std::max<std::size_t>(1, region.size() / kModeCandidates);
  const std::size_t voter_step = std::max<std::size_t>(1, region.size() / kModeVoters);
  Vector3d best = Vector3d::Zero();
  int most = 0;
  for (std::size_t i = candidate_step / 2; i < region.size(); i += candidate_step) {
    const Vector3d candidate = cloud.normal(region[i].y, region[i].x);
    int votes = 0;
    for (std::size_t j = 0; j < region.size(); j += voter_step) {
      votes += candidate.dot(cloud.normal(region[j].y, region[j].x)) > min_cosine;
    }
    if (votes > most) most = votes, best = candidate;
  }
  if (most == 0) return std::nullopt;
  for (int round = 0; round < kModeRounds; ++round) {
    Vector3d sum = Vector3d::Zero();
    for (const cv::Point& p : region) {
      const Vector3d n = cloud.normal(p.y, p.x);
      if (n.dot(best) > min_cosine) sum += n;
    }
    if (!(sum.norm() > 0)) break;
    best = sum.normalized();
  }
  return best;
}

// ln(-n'X) of the densest layer of a region across n: the middle of the narrow window (of `width`)
// that holds most of its points.
std::optional<double> densest_offset(const OrganizedCloud& cloud, const GridRegion& region,
                                     const Vector3d& normal, double width) {
  std::vector<double> offsets;
  for (const cv::Point& p : region) {
    const double d = -normal.dot(cloud.point(p.y, p.x));
    if (d > 0) offsets.push_back(std::log(d));
  }
  if (offsets.empty()) return std::nullopt;
  std::sort(offsets.begin(), offsets.end());
  std::size_t first = 0, best_first = 0, best_count = 0;
  for (std::size_t last = 0; last < offsets.size(); ++last) {
    while (offsets[last] - offsets[first] > width) ++first;
    if (last - first + 1 > best_count) best_count = last - first + 1, best_first = first;
  }
  return std::exp(offsets[best_first + best_count / 2]);
}

// Says the plane of connected pixels whose normals are around this one.
using PlaneOf =
    std::function<std::optional<Vector4d>(const GridRegion& piece, const Vector3d& normal)>;

// The pixels of a piece that lie on a plane, as a mask; empty if they are too few.
cv::Mat_<uchar> pixels_on(const OrganizedCloud& cloud, const GridRegion& piece,
                          const Vector4d& plane, const PlaneHypothesisOptions& options) {
  const double min_cosine = cosine(options.max_normal_deg);
  cv::Mat_<uchar> on(cloud.size(), uchar(0));
  int count = 0;
  for (const cv::Point& p : piece) {
    if (distance_in_sigmas(cloud, p, plane, options.noise) > options.max_distance_sigmas ||
        cloud.normal(p.y, p.x).dot(plane.head<3>()) < min_cosine) {
      continue;
    }
    on(p) = 255;
    ++count;
  }
  return count >= options.least_pixels(cloud.size()) ? on : cv::Mat_<uchar>();
}

// Cuts planes out of a region, the commonest direction first: its connected pieces, each with a
// plane of its own. What fits no plane is left for the next direction, or, if nothing did, dropped.
void peel(const OrganizedCloud& cloud, GridRegion region, const PlaneHypothesisOptions& options,
          const std::string& label, const PlaneOf& plane_of, std::vector<PlaneHypothesis>& found) {
  const double min_cosine = cosine(options.max_normal_deg);
  const int least = options.least_pixels(cloud.size());
  for (int i = 0; i < options.max_directions && int(region.size()) >= least; ++i) {
    const auto mode = normal_mode(cloud, region, min_cosine);
    if (!mode) return;
    cv::Mat_<uchar> around(cloud.size(), uchar(0)), free = mask_of_region(region, cloud.size());
    for (const cv::Point& p : region) {
      if (cloud.normal(p.y, p.x).dot(*mode) > min_cosine) around(p) = 255;
    }
    free.setTo(0, around);
    for (const GridRegion& piece : connected_pieces(region, around, least)) {
      const auto plane = plane_of(piece, *mode);
      const cv::Mat_<uchar> on =
          plane ? pixels_on(cloud, piece, *plane, options) : cv::Mat_<uchar>();
      if (on.empty()) continue;
      for (GridRegion& part : connected_pieces(piece, on, least)) {
        found.push_back({*plane, std::move(part), label});
      }
      for (const cv::Point& p : piece) free(p) = on(p) ? 0 : 255;
    }
    std::erase_if(region, [&](const cv::Point& p) { return free(p) == 0; });
  }
}

// One round of fit_region: the weighted least squares in inverse depth.
std::optional<Vector3d> weighted_fit(const OrganizedCloud& cloud, const GridRegion& region,
                                     const std::vector<double>& weights, const DepthNoise& noise) {
  InverseDepthFit fit;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const double z = cloud.depth(region[i]);
    if (!(z > 0) || !(weights[i] > 0)) continue;
    const double sigma = noise.sigma(z) / (z * z);  // of 1/z
    fit.add(cloud.rays(region[i])[0], cloud.rays(region[i])[1], 1 / z,
            weights[i] / (sigma * sigma));
  }
  return fit.solve();
}

// Fills what a fit says besides its plane; false if hardly a point lies on it.
bool describe(const OrganizedCloud& cloud, const GridRegion& region,
              const std::vector<double>& residuals, const PlaneHypothesisOptions& options,
              RegionPlane& result) {
  std::vector<double> relative;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (residuals[i] > options.max_distance_sigmas) continue;
    const double z = cloud.depth(region[i]);
    const Vector3d X = cloud.point(region[i].y, region[i].x);
    relative.push_back(residuals[i] * options.noise.sigma(z) / z);
    result.mean_depth += z;
    sum += X;
    scatter += X * X.transpose();
  }
  if (relative.size() < 3) return false;
  const double count = double(relative.size());
  result.inlier_share = count / double(region.size());
  result.mean_depth /= count;
  result.residual = robust_sigma(relative);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      scatter / count - sum * sum.transpose() / (count * count), Eigen::EigenvaluesOnly);
  result.spread = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  return true;
}

}  // namespace

int PlaneHypothesisOptions::least_pixels(const cv::Size& grid) const {
  return std::max(8, int(min_share * grid.area()));
}

double distance_in_sigmas(const OrganizedCloud& cloud, const cv::Point& p, const Vector4d& plane,
                          const DepthNoise& noise) {
  const double z = cloud.depth(p), w = inverse_depth_at(plane, cloud.ray(p.y, p.x));
  if (!(z > 0) || !(w > 0)) return std::numeric_limits<double>::infinity();
  return std::abs(z - 1 / w) / noise.sigma(z);
}

std::optional<RegionPlane> fit_region(const OrganizedCloud& cloud, const GridRegion& region,
                                      const PlaneHypothesisOptions& options) {
  RegionPlane result;
  std::vector<double> weights(region.size(), 1), residuals;
  for (int round = 0; round < kFitRounds; ++round) {
    const auto m = weighted_fit(cloud, region, weights, options.noise);
    if (!m) return std::nullopt;
    result.plane = plane_of_inverse_depth(*m);
    residuals.clear();
    for (const cv::Point& p : region) {
      const double r = distance_in_sigmas(cloud, p, result.plane, options.noise);
      residuals.push_back(std::min(r, 1e6));
    }
    std::vector<double> sorted = residuals;
    const double cut = std::max(options.max_distance_sigmas, 3 * median(sorted));
    for (std::size_t i = 0; i < region.size(); ++i) {
      const double r = residuals[i] / cut;
      weights[i] = r < 1 ? (1 - r * r) * (1 - r * r) : 0;
    }
  }
  return describe(cloud, region, residuals, options, result) ? std::optional(result) : std::nullopt;
}

std::vector<PlaneHypothesis> planes_of_regions(const OrganizedCloud& cloud,
                                               const std::vector<LabelledRegion>& regions,
                                               const PlaneHypothesisOptions& options) {
  std::vector<PlaneHypothesis> found;
  const int least = options.least_pixels(cloud.size());
  for (const LabelledRegion& region : regions) {
    GridRegion known;
    std::copy_if(region.pixels.begin(), region.pixels.end(), std::back_inserter(known),
                 [&](const cv::Point& p) { return cloud.known(p.y, p.x); });
    if (int(known.size()) < least) continue;
    peel(
        cloud, known, options, region.label,
        [&](const GridRegion& around, const Vector3d& normal) -> std::optional<Vector4d> {
          const double z = cloud.depth(around[around.size() / 2]);
          const double width = 2 * options.max_distance_sigmas * options.noise.sigma(z) / z;
          const auto d = densest_offset(cloud, around, normal, width);
          if (!d) return std::nullopt;
          return (Vector4d() << normal, *d).finished();
        },
        found);
  }
  return found;
}

std::vector<PlaneHypothesis> planes_of_components(const OrganizedCloud& cloud,
                                                  const PlaneHypothesisOptions& options) {
  const double min_cosine = cosine(options.max_step_deg);
  const auto same = [&](const cv::Point& a, const cv::Point& b) {
    const Vector3d n = cloud.normal(a.y, a.x);
    if (n.dot(cloud.normal(b.y, b.x)) < min_cosine) return false;
    // Along the ray of b, not along the normal: depth is what is uncertain.
    Vector4d tangent;
    tangent << n, -n.dot(cloud.point(a.y, a.x));
    return distance_in_sigmas(cloud, b, tangent, options.noise) < options.max_step_sigmas;
  };
  const auto components = connected_regions(
      cloud.size(), options.least_pixels(cloud.size()),
      [&](const cv::Point& p) { return cloud.known(p.y, p.x); }, same);
  std::vector<PlaneHypothesis> found;
  for (const GridRegion& component : components) {
    peel(
        cloud, component, options, "",
        [&](const GridRegion& around, const Vector3d&) -> std::optional<Vector4d> {
          const auto fit = fit_region(cloud, around, options);
          return fit ? std::optional<Vector4d>(fit->plane) : std::nullopt;
        },
        found);
  }
  return found;
}

}  // namespace cairn
