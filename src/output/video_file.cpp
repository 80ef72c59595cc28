#include "cairn/output/video_file.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/error.h"

namespace cairn {

VideoFile::VideoFile(const std::filesystem::path& file, double fps)
    : file_(file), pending_(file), fps_(std::isfinite(fps) && fps > 0 ? fps : 30) {
  if (file.extension() == ".mp4" || file.extension() == ".avi") return;
  throw Error(Error::Kind::kUsage, file.string() + ": videos are written as .mp4 or .avi");
}

VideoFile::~VideoFile() { writer_.release(); }

void VideoFile::write(const cv::Mat& picture) {
  if (!writer_.isOpened()) {
    size_ = picture.size();
    const bool mp4 = file_.extension() == ".mp4";
    const int codec = mp4 ? cv::VideoWriter::fourcc('m', 'p', '4', 'v')
                          : cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
    bool opened = false;
    try {
      opened = writer_.open(pending_.path().string(), codec, fps_, size_);
    } catch (const cv::Exception&) {
      opened = false;
    }
    if (!opened) {
      throw Error(Error::Kind::kOutput, file_.string() +
                                            ": the video cannot be begun; check the folder and its "
                                            "permissions, or that OpenCV can encode video");
    }
  }
  if (picture.size() == size_) {
    writer_.write(picture);
  } else {  // encoders would leave it out in silence
    cv::Mat fitting;
    cv::resize(picture, fitting, size_, 0, 0, cv::INTER_AREA);
    writer_.write(fitting);
  }
}

void VideoFile::finish() {
  if (!writer_.isOpened()) return;
  writer_.release();
  pending_.commit();
}

}  // namespace cairn
