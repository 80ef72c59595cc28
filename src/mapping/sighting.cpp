#include "cairn/mapping/sighting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairn/geometry/median.h"
#include "cairn/optimization/pose_adjustment.h"

namespace cairn {
namespace {

constexpr int kMinInliers = 30;
constexpr double kFraction = 16;  // parts of a pixel that are kept
constexpr std::uint8_t kMiddleRow = 128;
// A point that the adjustment has moved far off says nothing, but near the camera it says it louder
// than a hundred others. So what is off by so many times as much as most, and by so many σ, is left
// out from the start.
constexpr double kFarOff = 6, kFarOffSigma = 10;

void leave_out_far_off(std::vector<PoseObservation>& observations, const Pinhole& pinhole,
                       const SE3& T_cw) {
  if (observations.empty()) return;
  const auto off = [&](const PoseObservation& o) {
    return (pinhole.project(T_cw * o.position) - o.pixel).norm() / o.sigma;
  };
  std::vector<double> all;
  all.reserve(observations.size());
  for (const PoseObservation& o : observations) all.push_back(off(o));
  const double limit = std::max(kFarOff * median(all), kFarOffSigma);
  std::erase_if(observations, [&](const PoseObservation& o) { return !(off(o) <= limit); });
}

}  // namespace

std::vector<Sighting> sightings_of(const Frame& frame, std::span<const PointId> points,
                                   std::span<const char> aligned) {
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid()) continue;
    const Eigen::Vector2d pixel = frame.sighted_pixel(i) * kFraction;
    constexpr double kLimit = std::numeric_limits<std::int16_t>::max();
    if (pixel.cwiseAbs().maxCoeff() > kLimit) continue;
    Sighting& s = sightings.emplace_back();
    s.point = points[i];
    s.x = static_cast<std::int16_t>(std::lround(pixel.x()));
    s.y = static_cast<std::int16_t>(std::lround(pixel.y()));
    s.row = frame.rows.empty() ? kMiddleRow : frame.rows[i];
    s.octave = static_cast<std::uint8_t>(frame.octave(i)) & 0x7f;
    s.aligned = !aligned.empty() && aligned[i] != 0;
  }
  return sightings;
}

std::optional<SE3> place(const Map& map, std::span<const Sighting> sightings,
                         std::uint32_t last_birth, const SE3& T_wc, const Vector6d& velocity) {
  const Pinhole& pinhole = map.view().pinhole();
  const Vector6d motion = map.readout() * velocity;
  const SE3 T_cw = T_wc.inverse();
  std::vector<PoseObservation> observations;
  observations.reserve(sightings.size());
  std::vector<double> depths;
  for (const Sighting& s : sightings) {
    const MapPoint* point = map.points().find(s.point);
    if (point == nullptr || point->born > last_birth) continue;
    const Eigen::Vector3d X = T_cw * point->position;
    if (!(X.z() > 0)) continue;
    // The pixel that the camera would have seen if its calibration were right, and all at once.
    const Eigen::Vector2d bend = map.lens().project(pinhole, X) - pinhole.project(X);
    const Eigen::Vector2d sighted = Eigen::Vector2d(s.x, s.y) / kFraction;
    const Eigen::Vector2d pixel =
        seen_at_once(pinhole, sighted, X.z(), moment_of_row(s.row), motion) - bend;
    observations.push_back(
        {point->position, pixel, map.view().sigma(s.octave, s.aligned != 0), moment_of_row(s.row)});
    depths.push_back(X.z());
  }
  leave_out_far_off(observations, pinhole, T_cw);
  SE3 placed = T_wc;
  std::vector<char> inlier;
  ShutterMotion shutter;
  const bool rolls = !motion.isZero(0) && !depths.empty();
  if (rolls) shutter = expected_motion(map.readout(), velocity, median(depths));
  const PoseAdjustmentSummary summary =
      adjust_pose(observations, pinhole, placed, inlier, nullptr, rolls ? &shutter : nullptr);
  if (!summary.usable || summary.inliers < kMinInliers) return std::nullopt;
  return placed;
}

}  // namespace cairn
