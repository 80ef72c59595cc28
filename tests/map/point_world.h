#pragma once

// A world of points, each of which looks like nothing else, and what cameras see of it: frames with
// noise, flipped descriptor bits and clutter, as if features had been extracted from pictures. It
// remembers what each keypoint shows, so that tests of every room can ask for the truth.

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "cairn/geometry/sim3.h"
#include "cairn/map/map.h"
#include "geometry/scene.h"

namespace cairn::testing {

inline const View& point_view() {
  static const View view(Camera(Camera::Model::kRadialTangential, 640, 480, kCamera), 8, 1.2, 1.0);
  return view;
}

class PointWorld {
 public:
  struct Options {
    int count = 1700;
    double noise = 0.6;        ///< pixels at octave 0
    double bit_flips = 0.05;   ///< share of the bits of a descriptor
    int clutter = 100;         ///< keypoints of nothing a frame
    double readout = 0;        ///< of a rolling shutter, seconds
    double memory = 0;         ///< of noise: how alike that of a point is from frame to frame
    LensCorrection lens = {};  ///< what the calibration gets wrong
  };

  /// Points from 3 to 8 in front of the camera at the origin.
  explicit PointWorld(std::uint64_t seed) : PointWorld(seed, Options()) {}
  PointWorld(std::uint64_t seed, const Options& options) : options_(options), random_(seed) {
    for (int i = 0; i < options.count; ++i) {
      Point p;
      const double z = random_.uniform(3, 8);
      const double x = random_.uniform(-6, 8), y = random_.uniform(-3, 3);
      p.position = {x, y, z};
      p.descriptor = random_descriptor();
      p.angle = static_cast<float>(random_.uniform(-3, 3));
      p.base_distance = p.position.norm() * std::pow(1.2, random_.uniform(0, 4));
      points_.push_back(p);
    }
  }

  /// What a camera at T_wc sees, whose shutter rolls while it moves by `velocity` a second.
  std::shared_ptr<Frame> show(const SE3& T_wc, double timestamp,
                              const Vector6d& velocity = Vector6d::Zero()) {
    auto frame = std::make_shared<Frame>();
    frame->timestamp = timestamp;
    frame->velocity = velocity;
    Sight sight{T_wc, {}};
    const SE3 T_cw = T_wc.inverse();
    const View& view = point_view();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point& p = points_[i];
      const Eigen::Vector3d X = T_cw * p.position;
      const int octave =
          static_cast<int>(std::lround(std::log(p.base_distance / X.norm()) / std::log(1.2)));
      if (X.z() < 0.3 || octave < 0 || octave >= view.levels()) continue;
      const double dx = random_.gaussian(), dy = random_.gaussian();
      const double fresh = std::sqrt(1 - options_.memory * options_.memory);
      points_[i].noise = options_.memory * p.noise + fresh * Eigen::Vector2d(dx, dy);
      const Eigen::Vector2d pixel =
          rolling(X, velocity) + options_.noise * view.scale(octave) * p.noise;
      if (!view.contains(pixel)) continue;
      add(*frame, pixel, octave, p.angle, noisy(p.descriptor));
      sight.points.push_back(static_cast<int>(i));
    }
    for (int i = 0; i < options_.clutter; ++i) {
      const double x = random_.uniform(0, 639), y = random_.uniform(0, 479);
      add(*frame, {x, y}, random_.below(8), 0, random_descriptor());
      sight.points.push_back(-1);
    }
    if (options_.readout != 0) {
      for (const Keypoint& kp : frame->features.keypoints) {
        frame->rows.push_back(static_cast<std::uint8_t>(256 * (moment(kp.y) + 0.5)));
      }
    }
    frame->grid.build(frame->features.keypoints);
    sights_[frame.get()] = std::move(sight);
    frames_.push_back(frame);
    return frame;
  }

  const Eigen::Vector3d& position(int point) const { return points_[point].position; }
  /// The point that a keypoint shows; -1: clutter.
  int point_of(const Frame& frame, std::size_t keypoint) const {
    return sights_.at(&frame).points[keypoint];
  }
  /// Where a frame was taken.
  const SE3& truth(const Frame& frame) const { return sights_.at(&frame).T_wc; }
  /// The point that looks like this; -1: none does.
  int point_like(const Descriptor& descriptor) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (hamming(descriptor, points_[i].descriptor) < 64) return static_cast<int>(i);
    }
    return -1;
  }
  /// The point that all observations of a map point show; -1: they disagree.
  int point_of(const Map& map, const MapPoint& point) const {
    int result = -2;
    for (const Observation& o : point.observations) {
      const int shown = point_of(*map.keyframes()[o.keyframe].frame, o.keypoint);
      if (result == -2) result = shown;
      if (shown != result) return -1;
    }
    return result;
  }

 private:
  struct Point {
    Eigen::Vector3d position;
    Descriptor descriptor;
    float angle;
    double base_distance;            ///< shows in octave 0
    Eigen::Vector2d noise = {0, 0};  ///< when last seen
  };
  struct Sight {
    SE3 T_wc;
    std::vector<int> points;  ///< a keypoint
  };

  Descriptor random_descriptor() {
    return {random_.next(), random_.next(), random_.next(), random_.next()};
  }
  Descriptor noisy(Descriptor d) {
    for (int bit = 0; bit < 256; ++bit) {
      if (random_.uniform(0, 1) < options_.bit_flips) d[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    }
    return d;
  }
  static void add(Frame& frame, const Eigen::Vector2d& pixel, int octave, float angle,
                  const Descriptor& descriptor) {
    frame.features.keypoints.push_back({static_cast<float>(pixel.x()),
                                        static_cast<float>(pixel.y()),
                                        angle,
                                        50,
                                        static_cast<std::int8_t>(octave),
                                        {200, 100, 50}});
    frame.features.descriptors.push_back(descriptor);
  }

  static double moment(double row) { return (row + 0.5) / 480 - 0.5; }

  // Where the row sees a point that is read at the moment when the point is there.
  Eigen::Vector2d rolling(const Eigen::Vector3d& X_c, const Vector6d& velocity) const {
    Eigen::Vector2d pixel = options_.lens.project(kCamera, X_c);
    for (int i = 0; i < (options_.readout != 0 ? 10 : 0); ++i) {
      const SE3 T_mid_row = SE3::exp(moment(pixel.y()) * options_.readout * velocity);
      pixel = options_.lens.project(kCamera, T_mid_row.inverse() * X_c);
    }
    return pixel;
  }

  Options options_;
  Random random_;
  std::vector<Point> points_;
  std::map<const Frame*, Sight> sights_;
  std::vector<std::shared_ptr<const Frame>> frames_;  // so that no address is used again
};

/// A walk sideways past the points, looking at them: place `s` of 0 to about 2.
inline SE3 along(double s) {
  return SE3(so3_exp({0.02 * std::sin(3 * s), -0.02 * s, 0.01 * std::sin(5 * s)}),
             Eigen::Vector3d(s, 0.1 * std::sin(2 * s), 0.15 * std::sin(1.5 * s)));
}

/// A map in which all is true: keyframes at these poses and every point that two of them see.
inline Map true_map(PointWorld& world, std::span<const SE3> poses,
                    std::span<const Vector6d> velocities = {}) {
  Map map(point_view());
  std::map<int, std::vector<Observation>> seen;
  double timestamp = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto frame = world.show(poses[i], timestamp += 0.5,
                                  velocities.empty() ? Vector6d::Zero() : velocities[i]);
    const KeyframeId id = map.add_keyframe(frame, poses[i]);
    for (std::uint32_t k = 0; k < frame->size(); ++k) {
      if (const int p = world.point_of(*frame, k); p >= 0) seen[p].push_back({id, k});
    }
  }
  for (const auto& [p, observations] : seen) {
    if (observations.size() < 2) continue;
    const PointId id = map.add_point(world.position(p));
    for (const Observation& o : observations) map.add_observation(id, o.keyframe, o.keypoint);
    map.update_descriptor(id);
    map.update_geometry(id);
  }
  return map;
}

inline std::vector<KeyframeId> keyframes_of(const Map& map) {
  std::vector<KeyframeId> ids;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { ids.push_back(id); });
  return ids;
}

/// The map points that the keypoints of a frame show, as a perfect tracker would say.
inline std::vector<PointId> true_points(const PointWorld& world, const Map& map,
                                        const Frame& frame) {
  std::map<int, PointId> ids;
  map.points().for_each([&](PointId id, const MapPoint& p) {
    if (const int index = world.point_of(map, p); index >= 0) ids.emplace(index, id);
  });
  std::vector<PointId> points(frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const auto it = ids.find(world.point_of(frame, i));
    if (it != ids.end()) points[i] = it->second;
  }
  return points;
}

/// How far a map is from the truth after the similarity that fits its points best; lengths in units
/// of the world.
struct MapErrors {
  int points = 0;
  int mixed = 0;  ///< map points whose observations show different points of the world
  double median = 0;
  double camera = 0, rotation_deg = 0;  ///< of the worst keyframe
  Sim3 to_world;
};

inline MapErrors errors_of(const Map& map, const PointWorld& world) {
  MapErrors errors;
  std::vector<Eigen::Vector3d> from, to;
  map.points().for_each([&](PointId, const MapPoint& p) {
    const int index = world.point_of(map, p);
    ++errors.points;
    errors.mixed += index < 0;
    if (index < 0) return;
    from.push_back(p.position);
    to.push_back(world.position(index));
  });
  const SimilarityFit alignment = align_umeyama(from, to, true);
  if (!alignment.usable) return {.median = NAN, .camera = NAN, .rotation_deg = NAN, .to_world = {}};
  errors.to_world = alignment.transform;
  std::vector<double> distances;
  for (std::size_t i = 0; i < from.size(); ++i) {
    distances.push_back((errors.to_world * from[i] - to[i]).norm());
  }
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
  errors.median = distances[distances.size() / 2];
  map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
    const SE3 moved = errors.to_world.move(k.T_wc);
    const SE3& truth = world.truth(*k.frame);
    errors.camera = std::max(errors.camera, (moved.translation() - truth.translation()).norm());
    errors.rotation_deg = std::max(errors.rotation_deg, rotation_error_deg(moved, truth));
  });
  return errors;
}

}  // namespace cairn::testing
