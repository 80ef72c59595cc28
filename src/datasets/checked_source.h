#pragma once

#include <memory>

#include "cairn/datasets/frame_source.h"

namespace cairn {

/// Marks frames that do not fit to the others: of another size, or with a time that is not later
/// than that of the last good frame. What comes out without a `problem` is safe to track.
class CheckedSource : public FrameSource {
 public:
  CheckedSource(std::unique_ptr<FrameSource> source, cv::Size size);

  bool next(SourceFrame& frame) override;
  std::optional<std::size_t> size() const override { return source_->size(); }
  bool live() const override { return source_->live(); }

 private:
  std::unique_ptr<FrameSource> source_;
  cv::Size picture_size_;
  std::optional<double> last_good_;  // time of the last frame without a problem
  double last_ = 0;                  // time of the last frame
};

}  // namespace cairn
