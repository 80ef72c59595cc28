#include "cairn/map/frame.h"

#include <algorithm>

namespace cairn {
namespace {

constexpr int kTableStep = 4;            // pixels; bilinear between them errs by about 0.001 px
constexpr double kMinRayZ = 0.25;        // rays beyond 75° have no useful pinhole pixel
constexpr double kMaxBoundFactor = 3.0;  // the undistorted picture at most so many times larger

bool pinhole_pixel(const Camera& camera, const Eigen::Vector2d& pixel, Eigen::Vector2d& result) {
  const Eigen::Vector3d ray = camera.unproject(pixel);
  if (!ray.allFinite() || ray.z() < kMinRayZ) return false;
  // Polynomial lenses fold over outside of their calibrated range: accept what maps back.
  if ((camera.project(ray) - pixel).squaredNorm() > 0.01) return false;
  result = camera.pinhole().project(ray);
  return true;
}

}  // namespace

View::View(const Camera& camera, int levels, double scale, double sigma_px)
    : pinhole_(camera.pinhole()), sigma_px_(sigma_px) {
  const double w = camera.width() - 1, h = camera.height() - 1;
  min_x_ = w;
  min_y_ = h;
  // Within the picture, too: the border of a fisheye's may look where no pinhole can.
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      Eigen::Vector2d p;
      if (!pinhole_pixel(camera, {i * w / kSteps, k * h / kSteps}, p)) continue;
      min_x_ = std::min(min_x_, p.x());
      max_x_ = std::max(max_x_, p.x());
      min_y_ = std::min(min_y_, p.y());
      max_y_ = std::max(max_y_, p.y());
    }
  }
  min_x_ = std::max(min_x_, -(kMaxBoundFactor - 1) * w);
  min_y_ = std::max(min_y_, -(kMaxBoundFactor - 1) * h);
  max_x_ = std::min(max_x_, kMaxBoundFactor * w);
  max_y_ = std::min(max_y_, kMaxBoundFactor * h);
  log_scale_factor_ = std::log(scale);
  for (int i = 0; i < std::max(levels, 2); ++i) scale_.push_back(std::pow(scale, i));
}

void unroll(Frame& frame, const Pinhole& pinhole, std::span<const double> depths, double readout,
            const Vector6d& velocity) {
  if (frame.rows.empty()) return;
  frame.readout = readout;
  frame.velocity = velocity;
  if (readout == 0 && frame.sighted.empty()) return;
  if (frame.sighted.empty()) {
    frame.sighted.reserve(frame.size());
    for (const Keypoint& kp : frame.features.keypoints) frame.sighted.emplace_back(kp.x, kp.y);
  }
  const Vector6d motion = readout * velocity;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Eigen::Vector2f pixel =
        seen_at_once(pinhole, frame.sighted_pixel(i), depths[i], frame.moment(i), motion)
            .cast<float>();
    frame.features.keypoints[i].x = pixel.x();
    frame.features.keypoints[i].y = pixel.y();
  }
  frame.grid.build(std::span(frame.features.keypoints).first(frame.corners()));
  if (readout == 0) frame.sighted = std::vector<Eigen::Vector2f>();  // also frees its memory
}

Eigen::Vector2d drift_by_readout(const Frame& frame, std::size_t keypoint, const Pinhole& pinhole,
                                 double depth) {
  constexpr double kStep = 0.01;  // seconds: about what cameras take
  const Eigen::Vector2d pixel = frame.sighted_pixel(keypoint);
  return (seen_at_once(pinhole, pixel, depth, frame.moment(keypoint), kStep * frame.velocity) -
          pixel) /
         kStep;
}

Undistorter::Undistorter(const Camera& camera) : camera_(camera), height_(camera.height()) {
  needed_ = camera.model() == Camera::Model::kKannalaBrandt ||
            camera.distortion() != std::array<double, 5>{};
  if (!needed_) return;
  columns_ = (camera.width() + kTableStep - 1) / kTableStep + 1;
  rows_ = (camera.height() + kTableStep - 1) / kTableStep + 1;
  table_.reserve(static_cast<std::size_t>(columns_) * rows_);
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      Eigen::Vector2d p;
      const bool ok = pinhole_pixel(camera, Eigen::Vector2d(c, r) * kTableStep, p);
      table_.emplace_back(Eigen::Vector2f::Constant(NAN));
      if (ok) table_.back() = p.cast<float>();
    }
  }
}

Eigen::Vector2f Undistorter::to_pinhole(const Eigen::Vector2f& pixel) const {
  if (!needed_) return pixel;
  const float x = pixel.x() / kTableStep, y = pixel.y() / kTableStep;
  const int c = std::clamp(static_cast<int>(x), 0, columns_ - 2);
  const int r = std::clamp(static_cast<int>(y), 0, rows_ - 2);
  const float a = x - c, b = y - r;
  const Eigen::Vector2f* row = &table_[static_cast<std::size_t>(r) * columns_ + c];
  return (1 - b) * ((1 - a) * row[0] + a * row[1]) +
         b * ((1 - a) * row[columns_] + a * row[columns_ + 1]);
}

Eigen::Vector2d Undistorter::to_picture(const Eigen::Vector2d& pixel) const {
  if (!needed_) return pixel;
  return camera_.project(camera_.pinhole().unproject(pixel));
}

std::uint8_t Undistorter::row_of(double y) const {
  return static_cast<std::uint8_t>(std::clamp((y + 0.5) / height_ * 256, 0.0, 255.0));
}

void Undistorter::apply(Features& features, std::vector<std::uint8_t>* rows) const {
  const auto note_row = [&](const Keypoint& kp) {
    if (rows != nullptr) rows->push_back(row_of(kp.y));
  };
  if (rows != nullptr) {
    rows->clear();
    rows->reserve(features.size());
  }
  if (!needed_) {
    for (const Keypoint& kp : features.keypoints) note_row(kp);
    return;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    Keypoint kp = features.keypoints[i];
    const Eigen::Vector2f p = to_pinhole({kp.x, kp.y});
    if (!p.allFinite()) continue;
    note_row(kp);
    kp.x = p.x();
    kp.y = p.y();
    features.keypoints[kept] = kp;
    features.descriptors[kept] = features.descriptors[i];
    ++kept;
  }
  features.keypoints.resize(kept);
  features.descriptors.resize(kept);
}

}  // namespace cairn
