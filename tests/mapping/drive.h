#pragma once

// Keyframes of a point world for a mapper: with the poses and matches of a good tracker.

#include <algorithm>

#include "cairn/map/initial_pair.h"
#include "cairn/mapping/mapper.h"
#include "map/point_world.h"

namespace cairn::testing {

class Drive {
 public:
  explicit Drive(PointWorld& world) : world_(world) {}

  /// Two frames with all points that both see.
  InitialPair initial(const SE3& T_w1, const SE3& T_w2) {
    InitialPair pair{next(T_w1), next(T_w2), T_w2.inverse() * T_w1, {}};
    const double unit = pair.T_21.translation().norm();
    pair.T_21 = SE3(pair.T_21.rotation(), pair.T_21.translation() / unit);
    std::map<int, std::uint32_t> first;
    for (std::uint32_t i = 0; i < pair.frame1->size(); ++i) {
      first[world_.point_of(*pair.frame1, i)] = i;
    }
    for (std::uint32_t i = 0; i < pair.frame2->size(); ++i) {
      const int p = world_.point_of(*pair.frame2, i);
      if (p < 0 || !first.contains(p)) continue;
      pair.points.push_back({first[p], i, T_w1.inverse() * world_.position(p) / unit});
    }
    return pair;
  }

  /// A frame at T_wc as a tracker that works with this view would hand it over.
  KeyframeCandidate candidate(const SE3& T_wc, const MapView& view) {
    const auto frame = next(T_wc);
    KeyframeCandidate candidate{frame, view.reference, SE3(), std::vector<PointId>(frame->size())};
    const SE3& T_wr = world_.truth(*view.reference_frame);
    const SE3 T_vr = view.pose_of(view.reference).value();
    std::map<int, PointId> ids;
    std::vector<double> ratios;  // length in the map to length in the world
    for (const MapView::Point& p : view.points) {
      const int index = world_.point_like(p.descriptor);
      if (index < 0) continue;
      ids.emplace(index, p.id);
      ratios.push_back((p.position - T_vr.translation()).norm() /
                       (world_.position(index) - T_wr.translation()).norm());
    }
    std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
    const SE3 T_rc = T_wr.inverse() * T_wc;
    candidate.T_rc = SE3(T_rc.rotation(), ratios[ratios.size() / 2] * T_rc.translation());
    for (std::size_t i = 0; i < frame->size(); ++i) {
      const auto it = ids.find(world_.point_of(*frame, i));
      if (it != ids.end()) candidate.points[i] = it->second;
    }
    return candidate;
  }

  double step = 0.5;  ///< seconds from one frame to the next

 private:
  std::shared_ptr<const Frame> next(const SE3& T_wc) { return world_.show(T_wc, time_ += step); }

  PointWorld& world_;
  double time_ = 0;
};

}  // namespace cairn::testing
