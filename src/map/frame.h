#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cairn/features/features.h"
#include "cairn/features/matching.h"
#include "cairn/geometry/box.h"
#include "cairn/geometry/camera.h"
#include "cairn/geometry/rolling_shutter.h"

namespace cairn {

/// What the ideal pinhole camera sees: pixel bounds of the undistorted picture, and how uncertain a
/// keypoint of each octave is.
class View {
 public:
  View() = default;
  /// `sigma_px`: standard deviation of the position of a keypoint of octave 0.
  View(const Camera& camera, int levels, double scale, double sigma_px);

  const Pinhole& pinhole() const { return pinhole_; }
  bool contains(const Eigen::Vector2d& uv) const {
    return uv.x() >= min_x_ && uv.x() < max_x_ && uv.y() >= min_y_ && uv.y() < max_y_;
  }
  double min_x() const { return min_x_; }
  double min_y() const { return min_y_; }
  double max_x() const { return max_x_; }
  double max_y() const { return max_y_; }
  /// Pixel centres within.
  Box2 borders() const { return {min_x_, min_y_, max_x_ - 1, max_y_ - 1}; }

  int levels() const { return static_cast<int>(scale_.size()); }
  double log_scale_factor() const { return log_scale_factor_; }
  /// Size of a pixel of an octave in pixels of the full picture.
  double scale(int octave) const { return scale_[octave]; }
  /// Standard deviation of a keypoint's position in each direction, pixels, where few are wrong.
  /// `aligned`: it was moved to where the picture looks as its point did before.
  double sigma(int octave, bool aligned = false) const {
    return sigma_px_ * (aligned ? kAlignedSigma + kAlignedSlope * scale_[octave] : scale_[octave]);
  }
  /// Half-width of the core of its errors, pixels: most keypoints err less than sigma says, and
  /// some much more. For a Cauchy loss.
  double core(int octave, bool aligned) const {
    return (aligned ? kAlignedCore : kCornerCore) * sigma(octave, aligned);
  }

 private:
  // Measured against the final maps of real and rendered sequences: a corner errs in proportion to
  // the size of its octave's pixels, a patch nearly by as much in every octave.
  static constexpr double kAlignedSigma = 0.3, kAlignedSlope = 0.07;
  static constexpr double kAlignedCore = 0.5, kCornerCore = 0.75;

  Pinhole pinhole_;
  double min_x_ = 0, min_y_ = 0, max_x_ = 0, max_y_ = 0;
  double log_scale_factor_ = 0, sigma_px_ = 1;
  std::vector<double> scale_;
};

/// When a row was read (see Frame::rows): -1/2 is the beginning, 1/2 the end of the readout.
inline double moment_of_row(std::uint8_t row) { return (row + 0.5) / 256 - 0.5; }

/// One picture as tracking and mapping see it: features at undistorted pixels, with a grid to find
/// them. Immutable once tracked, shared between tracker and map.
struct Frame {
  double timestamp = 0;  ///< seconds
  Features features;     ///< at pixels of the ideal pinhole camera, as if all were seen at once
  KeypointGrid grid;
  /// When the row of each keypoint was read, in 256ths of the time that all rows take; empty: all
  /// at once. Finer steps would move keypoints by hundredths of a pixel.
  std::vector<std::uint8_t> rows;
  std::vector<Eigen::Vector2f> sighted;  ///< where rows saw the keypoints; empty: where they are
  double readout = 0;                    ///< seconds from the first row to the last, as assumed
  Vector6d velocity = Vector6d::Zero();  ///< tangent vector of the camera's motion a second
  std::size_t added = 0;  ///< keypoints, the last ones: no corner was found there (see `add`)

  std::size_t size() const { return features.size(); }
  /// So many keypoints, the first ones, are corners that were found in the picture.
  std::size_t corners() const { return size() - added; }
  Eigen::Vector2d pixel(std::size_t i) const {
    return {features.keypoints[i].x, features.keypoints[i].y};
  }
  /// Where it is in the picture as it was taken, but for the bend of the lens.
  Eigen::Vector2d sighted_pixel(std::size_t i) const {
    return sighted.empty() ? pixel(i) : sighted[i].cast<double>();
  }
  /// Its rows were read while the camera moved.
  bool rolls() const { return !rows.empty() && !velocity.isZero(0); }
  double moment(std::size_t i) const { return moment_of_row(rows[i]); }
  int octave(std::size_t i) const { return features.keypoints[i].octave; }
  /// Moves a keypoint; the grid, which is for searches by whole pixels, keeps it where it was.
  void move(std::size_t i, const Eigen::Vector2d& by) {
    features.keypoints[i].x += static_cast<float>(by.x());
    features.keypoints[i].y += static_cast<float>(by.y());
    if (!sighted.empty()) sighted[i] += by.cast<float>();
  }
  /// Adds a keypoint where no corner was found. `row` and `seen_at`: as in rows and sighted. The
  /// grid does not know it: searches are for corners.
  void add(const Keypoint& keypoint, const Descriptor& descriptor, std::uint8_t row,
           const Eigen::Vector2d& seen_at) {
    features.keypoints.push_back(keypoint);
    features.descriptors.push_back(descriptor);
    if (!rows.empty()) rows.push_back(row);
    if (!sighted.empty()) sighted.push_back(seen_at.cast<float>());
    ++added;
  }
  /// Calls visit(index) for the keypoints in a window; see KeypointGrid::for_each.
  template <class Visit>
  void for_each_near(const Eigen::Vector2f& center, float radius, int min_octave, int max_octave,
                     Visit&& visit) const {
    grid.for_each(features.keypoints, {center.x(), center.y()}, radius, min_octave, max_octave,
                  visit);
  }
};

/// Seconds for which a camera's motion is taken to last: what is farther off in time says nothing.
constexpr double kEvenMotion = 0.15;

/// Moves the keypoints of a frame to where a shutter that opens for all rows at once would have
/// seen them (see seen_at_once). `depths`: one a keypoint; `readout` and `velocity`: as in Frame,
/// which keeps them. Frames that were seen at once stay as they are.
void unroll(Frame& frame, const Pinhole& pinhole, std::span<const double> depths, double readout,
            const Vector6d& velocity);

/// Pixels by which an instant shutter would have seen a keypoint elsewhere, for each second of
/// readout.
Eigen::Vector2d drift_by_readout(const Frame& frame, std::size_t keypoint, const Pinhole& pinhole,
                                 double depth);

/// Moves keypoints of a real lens to the ideal pinhole, through a table made once.
class Undistorter {
 public:
  explicit Undistorter(const Camera& camera);
  /// Moves the keypoints in place; those without a pinhole position are removed. `rows`: as in
  /// Frame.
  void apply(Features& features, std::vector<std::uint8_t>* rows = nullptr) const;

  /// Where a pixel of the picture is to the ideal pinhole camera (not finite where it is nowhere),
  /// and where one of the ideal pinhole camera is in the picture.
  Eigen::Vector2f to_pinhole(const Eigen::Vector2f& pixel) const;
  Eigen::Vector2d to_picture(const Eigen::Vector2d& pixel) const;
  /// Of a pixel of the picture, in 256ths of all rows (see Frame::rows).
  std::uint8_t row_of(double y) const;

 private:
  Camera camera_;
  bool needed_ = false;
  int height_ = 0;  // of the picture
  int columns_ = 0, rows_ = 0;
  std::vector<Eigen::Vector2f> table_;
};

}  // namespace cairn
