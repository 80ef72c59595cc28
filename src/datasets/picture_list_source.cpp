#include "cairn/datasets/picture_list_source.h"

#include "cairn/datasets/picture_file.h"

namespace cairn {

PictureListSource::PictureListSource(std::vector<ListedPicture> pictures, bool colour)
    : pictures_(std::move(pictures)), colour_(colour) {}

bool PictureListSource::next(SourceFrame& frame) {
  if (next_ == pictures_.size()) return false;
  const ListedPicture& picture = pictures_[next_++];
  frame.timestamp = picture.timestamp;
  frame.name = picture.file.filename().string();
  frame.problem = picture.problem;
  frame.image =
      frame.problem.empty() ? read_picture(picture.file, colour_, frame.problem) : cv::Mat();
  return true;
}

}  // namespace cairn
