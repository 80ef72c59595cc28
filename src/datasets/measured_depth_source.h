#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cairn/datasets/calibration.h"
#include "cairn/datasets/depth_registration.h"
#include "cairn/datasets/picture_list_source.h"

namespace cairn {

/// Adds measured depth to the frames of another source: of the depth picture that is nearest in
/// time, if it is within 0.02 s. Where there is none, or none that can be used, the frame says so
/// and goes on without.
class MeasuredDepthSource : public FrameSource {
 public:
  /// `depth`: in any order; those that have no time are left out. `colour`: the camera of the
  /// frames, of which registration has need; without it, and without a depth camera in the
  /// calibration, depth is taken as registered.
  MeasuredDepthSource(std::unique_ptr<FrameSource> source, std::vector<ListedPicture> depth,
                      const DepthCalibration& calibration, const std::optional<Camera>& colour);

  bool next(SourceFrame& frame) override;
  std::optional<std::size_t> size() const override { return source_->size(); }
  bool live() const override { return source_->live(); }

 private:
  const ListedPicture* nearest(double timestamp) const;
  cv::Mat read(const SourceFrame& frame, std::string& problem) const;

  std::unique_ptr<FrameSource> source_;
  std::vector<ListedPicture> depth_;  // in order of time
  double scale_;
  std::optional<DepthRegistration> registration_;
  cv::Size depth_size_;  // of the depth camera, if it is another one
};

}  // namespace cairn
