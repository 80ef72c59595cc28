#pragma once

#include <filesystem>
#include <vector>

#include "cairn/datasets/frame_source.h"

namespace cairn {

/// A picture that a layout promises.
struct ListedPicture {
  double timestamp = 0;  ///< seconds; NaN if the layout gives none that can be used
  std::filesystem::path file;
  std::string problem;  ///< not empty: the layout itself is broken here
};

/// Frames from picture files with known times. Files are decoded in `next`. A time that is later
/// than what follows it is a problem of its own frame, not of the frames that follow.
class PictureListSource : public FrameSource {
 public:
  PictureListSource(std::vector<ListedPicture> pictures, bool colour);

  bool next(SourceFrame& frame) override;
  std::optional<std::size_t> size() const override { return pictures_.size(); }

 private:
  std::vector<ListedPicture> pictures_;
  bool colour_;
  std::size_t next_ = 0;
};

}  // namespace cairn
