#include "cairn/mapping/missed_points.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "cairn/map/seen_points.h"
#include "cairn/map/visibility.h"

namespace cairn {
namespace {

constexpr std::size_t kNeighbours = 40;  // keyframes, those that share most points
constexpr int kShared = 10;              // points, that a keyframe is a neighbour
constexpr std::size_t kSure = 3;         // views of a point that say where it should be
constexpr double kReach = 1.5;           // pixels that it may be from there
constexpr double kOneCorner = 1.5;       // pixels between keypoints of one corner
constexpr std::size_t kPictures = 30;    // kept; each takes a megabyte

std::vector<PointId> points_around(const Map& map, KeyframeId id) {
  std::vector<KeyframeId> around;
  for (const auto& [neighbour, shared] : map.covisible(id, kShared, kNeighbours)) {
    around.push_back(neighbour);
  }
  return points_seen_from(map, around);
}

// Pixels by which an instant shutter would have seen elsewhere what a row saw at `pixel`.
Eigen::Vector2d drift_at(const Frame& frame, const Undistorter& lens, const Pinhole& pinhole,
                         const Eigen::Vector2d& pixel, double depth) {
  if (frame.sighted.empty()) return Eigen::Vector2d::Zero();
  const double moment = moment_of_row(lens.row_of(lens.to_picture(pixel).y()));
  return seen_at_once(pinhole, pixel, depth, moment, frame.readout * frame.velocity) - pixel;
}

}  // namespace

int find_missed_points(Map& map, KeyframeId id) {
  Keyframe& keyframe = map.keyframes()[id];
  if (!keyframe.picture) return 0;
  const Pinhole& pinhole = map.view().pinhole();
  const Undistorter& lens = *keyframe.picture->lens;
  const SE3 T_cw = keyframe.T_wc.inverse();
  auto frame = std::make_shared<Frame>(*keyframe.frame);  // trackers may look at the other
  std::vector<PointId> seen;
  for (const PointId p : points_around(map, id)) {
    const MapPoint& point = map.points()[p];
    if (!point.patch || point.assumed || point.observations.size() < kSure) continue;
    if (map.keypoint_of(p, id) >= 0) continue;
    const Visibility v = predict_visibility(map.view(), T_cw, keyframe.T_wc.translation(),
                                            point.position, point.normal, point.base_distance);
    if (!v.visible) continue;
    const double depth = (T_cw * point.position).z();
    const Eigen::Vector2d expected = v.pixel - drift_at(*frame, lens, pinhole, v.pixel, depth);
    const auto found =
        find_patch(*point.patch, *keyframe.picture, pinhole, T_cw, point.position, expected);
    if (!found || (*found - expected).norm() > kReach) continue;
    const Eigen::Vector2d pixel = *found + drift_at(*frame, lens, pinhole, *found, depth);
    bool taken = false;
    auto keypoint = static_cast<std::uint32_t>(frame->size());
    frame->for_each_near(pixel.cast<float>(), kOneCorner, v.octave - 1, v.octave + 1,
                         [&](std::uint32_t i) {
                           taken = taken || keyframe.points[i].valid();
                           keypoint = i;
                         });
    if (taken) continue;
    if (keypoint < frame->size()) {
      frame->move(keypoint, *found - frame->sighted_pixel(keypoint));
    } else {
      const Keypoint there = {.x = static_cast<float>(pixel.x()),
                              .y = static_cast<float>(pixel.y()),
                              .octave = static_cast<std::int8_t>(v.octave),
                              .colour = point.colour};
      frame->add(there, point.descriptor, lens.row_of(lens.to_picture(*found).y()), *found);
      keyframe.points.emplace_back();
    }
    map.add_observation(p, id, keypoint, PatchState::kFound);
    seen.push_back(p);
  }
  keyframe.frame = std::move(frame);
  if (!keyframe.depth.empty()) keyframe.depth.resize(keyframe.points.size());
  for (const PointId p : seen) map.update_geometry(p);
  return static_cast<int>(seen.size());
}

void look_back(Map& map) {
  std::vector<std::pair<std::uint32_t, KeyframeId>> at_hand;  // by age
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& k) {
    if (k.picture) at_hand.emplace_back(k.sequence, id);
  });
  std::sort(at_hand.begin(), at_hand.end());
  for (std::size_t i = 0; i + kPictures < at_hand.size(); ++i) {
    find_missed_points(map, at_hand[i].second);
    map.keyframes()[at_hand[i].second].picture = nullptr;
  }
}

}  // namespace cairn
