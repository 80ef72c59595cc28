#include "cairn/output/video_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

// OpenCV's writers report no full disk, so the file is asked: both formats are chunks that say how
// long they are (ISO 14496-12, 4.2; RIFF), and a file that was cut off ends within one. An MPEG-4
// file whose table of frames (moov) was never written is none either.
bool is_whole_video(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code code;
  const std::uint64_t end = std::filesystem::file_size(file, code);
  if (!stream || code) return false;
  std::uint64_t at = 0;
  bool has_frames = false;
  while (at < end) {
    std::array<unsigned char, 16> head{};
    stream.clear();
    stream.seekg(std::streamoff(at));
    stream.read(reinterpret_cast<char*>(head.data()), head.size());
    const auto number = [&](int first, int step, int bytes) {
      std::uint64_t value = 0;
      for (int i = 0; i < bytes; ++i) value = value << 8 | head[std::size_t(first + step * i)];
      return value;
    };
    std::uint64_t length = 0;
    if (std::memcmp(head.data(), "RIFF", 4) == 0) {
      length = 8 + number(7, -1, 4);
      has_frames = true;
    } else {
      length = number(0, 1, 4);
      if (length == 1) length = number(8, 1, 8);
      has_frames |= std::memcmp(&head[4], "moov", 4) == 0;
    }
    if (length < 8 || length > end - at) return false;
    at += length;
  }
  return has_frames;
}

}  // namespace

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
  if (!is_whole_video(pending_.path())) {
    throw Error(Error::Kind::kOutput, file_.string() +
                                          ": the video did not reach the disk as a whole; free "
                                          "some space, or choose another --out");
  }
  pending_.commit();
}

}  // namespace cairn
