#include "cairn/mapping/keyframe_motion.h"

#include "cairn/geometry/median.h"
#include "cairn/optimization/pose_adjustment.h"

namespace cairn {
namespace {

constexpr int kLeastPoints = 50;
constexpr double kUnknown = 10;  // times as unsure of a velocity that nobody knows

void find_motion(Map& map, KeyframeId id) {
  Keyframe& keyframe = map.keyframes()[id];
  const Frame& frame = *keyframe.frame;
  const SE3 T_cw = keyframe.T_wc.inverse();
  std::vector<PoseObservation> observations;
  std::vector<double> depths;
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    const MapPoint& point = map.points()[keyframe.points[i]];
    const bool aligned = point.seen_from(id)->aligned();
    observations.push_back({point.position, frame.pixel(i),
                            map.view().sigma(frame.octave(i), aligned), frame.moment(i)});
    depths.push_back((T_cw * point.position).z());
  }
  if (static_cast<int>(observations.size()) < kLeastPoints) return;
  const double readout = map.readout();
  ShutterMotion shutter = expected_motion(readout, frame.velocity, median(depths));
  if (!frame.rolls()) shutter.sigma *= kUnknown;  // the first two
  SE3 T_wc = keyframe.T_wc;
  std::vector<char> inlier;
  const PoseAdjustmentSummary summary =
      adjust_pose(observations, map.view().pinhole(), T_wc, inlier, nullptr, &shutter);
  if (!summary.usable || summary.inliers < kLeastPoints) return;
  map.set_velocity(id, shutter.motion / readout);
  keyframe.T_wc = T_wc;
}

}  // namespace

void set_motions(Map& map, std::span<const KeyframeMotion> motions) {
  for (const KeyframeMotion& m : motions) {
    if (!map.keyframes()[m.keyframe].frame->rows.empty()) map.set_velocity(m.keyframe, m.velocity);
  }
}

void find_motions(Map& map) {
  if (map.readout() == 0) return;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    if (!keyframe.frame->rows.empty()) find_motion(map, id);
  });
}

}  // namespace cairn
