#include "cairn/mapping/point_creation.h"

#include <cmath>

#include "cairn/geometry/triangulation.h"

namespace cairn {
namespace {

constexpr int kMaxDistance = 50;        // Hamming
constexpr double kEpipolarGate = 3.84;  // χ², 1 degree of freedom, 95 %
constexpr double kReprojectionGate = 5.991;
constexpr double kMinBaselineRatio = 0.01;  // of the median depth
constexpr double kSizeTolerance = 1.8;      // between what distance and octaves say

// All that is needed of one keyframe in a pair.
struct Eye {
  const Keyframe& keyframe;
  const Frame& frame;
  SE3 T_cw;

  explicit Eye(const Keyframe& k) : keyframe(k), frame(*k.frame), T_cw(k.T_wc.inverse()) {}
};

bool reprojects(const View& view, const Eye& eye, const Eigen::Vector3d& X_w,
                std::uint32_t keypoint) {
  const Eigen::Vector3d X = eye.T_cw * X_w;
  if (!(X.z() > 0)) return false;
  const double sigma = view.sigma(eye.frame.octave(keypoint));
  return (view.pinhole().project(X) - eye.frame.pixel(keypoint)).squaredNorm() <
         kReprojectionGate * sigma * sigma;
}

class PairMatcher {
 public:
  PairMatcher(Map& map, KeyframeId id1, KeyframeId id2, const PointCreationOptions& options)
      : map_(map),
        id1_(id1),
        id2_(id2),
        a_(map.keyframes()[id1]),
        b_(map.keyframes()[id2]),
        min_parallax_(options.min_parallax_deg * M_PI / 180),
        ratio_(options.ratio) {
    const SE3 T_21 = b_.T_cw * a_.T_cw.inverse();
    const Pinhole& K = map.view().pinhole();
    Eigen::Matrix3d K_inv;
    K_inv << 1 / K.fx, 0, -K.cx / K.fx, 0, 1 / K.fy, -K.cy / K.fy, 0, 0, 1;
    F_ = K_inv.transpose() * skew(T_21.translation()) * T_21.matrix3() * K_inv;
    R_21_ = T_21.matrix3();
    t_21_ = T_21.translation();
  }

  void run(std::vector<PointId>& created) {
    for (std::uint32_t j = 0; j < b_.frame.size(); ++j) {
      if (b_.keyframe.points[j].valid()) continue;
      const Keypoint& kp = b_.frame.features.keypoints[j];
      const double sigma = map_.view().sigma(kp.octave);
      free_.push_back(j);
      x_.push_back(kp.x);
      y_.push_back(kp.y);
      gate_.push_back(static_cast<float>(kEpipolarGate * sigma * sigma));
    }
    near_line_.resize(free_.size());
    for (std::uint32_t i = 0; i < a_.frame.size(); ++i) {
      if (a_.keyframe.points[i].valid()) continue;
      const int k = best_on_line(i);
      if (k < 0 || !try_point(i, free_[k], created)) continue;
      gate_[k] = -1;  // taken
    }
  }

 private:
  // Of the free keypoints near to the epipolar line of keypoint i the one that looks most alike: an
  // index into free_, or -1.
  int best_on_line(std::uint32_t i) {
    const Eigen::Vector3d line = F_ * a_.frame.pixel(i).homogeneous();
    const double norm = line.head<2>().norm();
    if (norm < 1e-10) return -1;
    const Eigen::Vector3f l = (line / norm).cast<float>();
    const std::size_t n = free_.size();
    for (std::size_t k = 0; k < n; ++k) {  // vectorised
      const float e = l.x() * x_[k] + l.y() * y_[k] + l.z();
      near_line_[k] = e * e < gate_[k];
    }
    BestMatch best;
    const Descriptor& d = a_.frame.features.descriptors[i];
    for (std::size_t k = 0; k < n; ++k) {
      if (!near_line_[k]) continue;
      best.offer(static_cast<std::uint32_t>(k),
                 hamming(d, b_.frame.features.descriptors[free_[k]]));
    }
    return best.accepted(kMaxDistance, ratio_) ? static_cast<int>(best.index) : -1;
  }

  bool try_point(std::uint32_t i, std::uint32_t j, std::vector<PointId>& created) {
    const View& view = map_.view();
    const Eigen::Vector3d ray1 = view.pinhole().unproject(a_.frame.pixel(i));
    const Eigen::Vector3d ray2 = view.pinhole().unproject(b_.frame.pixel(j));
    const TwoRayPoint meeting = triangulate_two_rays(R_21_, t_21_, ray1, ray2);
    if (!meeting.in_front() || meeting.parallax < min_parallax_) return false;
    const Eigen::Vector3d X = a_.keyframe.T_wc * meeting.point;
    if (!X.allFinite() || !reprojects(view, a_, X, i) || !reprojects(view, b_, X, j)) return false;
    const double d1 = (X - a_.keyframe.T_wc.translation()).norm();
    const double d2 = (X - b_.keyframe.T_wc.translation()).norm();
    const double size_ratio =
        d1 * view.scale(a_.frame.octave(i)) / (d2 * view.scale(b_.frame.octave(j)));
    if (size_ratio > kSizeTolerance || size_ratio * kSizeTolerance < 1) return false;
    const PointId id = map_.add_point(X);
    map_.add_observation(id, id1_, i);
    map_.add_observation(id, id2_, j);
    MapPoint& p = map_.points()[id];
    p.colour = a_.frame.features.keypoints[i].colour;
    map_.update_descriptor(id);
    map_.update_geometry(id);
    created.push_back(id);
    return true;
  }

  Map& map_;
  KeyframeId id1_, id2_;
  Eye a_, b_;
  double min_parallax_;  // radians
  double ratio_;
  Eigen::Matrix3d F_, R_21_;
  Eigen::Vector3d t_21_;
  // The keypoints of b without a point.
  std::vector<std::uint32_t> free_;
  std::vector<float> x_, y_, gate_;
  std::vector<char> near_line_;
};

}  // namespace

std::vector<PointId> create_points(Map& map, KeyframeId keyframe,
                                   const PointCreationOptions& options) {
  std::vector<PointId> created;
  for (const auto& [other, shared] : map.covisible(keyframe, 10, options.neighbours)) {
    const double baseline =
        (map.keyframes()[keyframe].T_wc.translation() - map.keyframes()[other].T_wc.translation())
            .norm();
    if (baseline < kMinBaselineRatio * map.depth_quantile(other, 0.5)) continue;
    PairMatcher(map, keyframe, other, options).run(created);
  }
  return created;
}

}  // namespace cairn
