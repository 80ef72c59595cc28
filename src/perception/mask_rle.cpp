#include "cairn/perception/mask_rle.h"

#include <limits>
#include <stdexcept>

namespace cairn {
namespace {

constexpr int kFirstCharacter = 48, kBits = 5, kMore = 1 << kBits, kSign = 1 << (kBits - 1);
constexpr std::size_t kFirstDifference = 3;  // runs before it are written as they are

}  // namespace

std::vector<std::uint32_t> encode_runs(const cv::Mat& mask) {
  CV_Assert(mask.type() == CV_8U);
  std::vector<std::uint32_t> runs = {0};
  bool inside = false;
  for (int x = 0; x < mask.cols; ++x) {
    for (int y = 0; y < mask.rows; ++y) {
      if ((mask.at<std::uint8_t>(y, x) != 0) != inside) {
        inside = !inside;
        runs.push_back(0);
      }
      ++runs.back();
    }
  }
  return runs;
}

cv::Mat decode_runs(const std::vector<std::uint32_t>& runs, const cv::Size& size) {
  const std::uint64_t pixels = std::uint64_t(size.width) * std::uint64_t(size.height);
  cv::Mat mask(size, CV_8U, cv::Scalar(0));
  std::uint64_t at = 0;
  bool inside = false;
  for (const std::uint32_t run : runs) {
    if (run > pixels - at) throw std::invalid_argument("the runs are longer than the mask");
    for (const std::uint64_t end = at + run; at < end; ++at) {
      if (!inside) continue;
      mask.at<std::uint8_t>(int(at % size.height), int(at / size.height)) = 255;
    }
    inside = !inside;
  }
  if (at != pixels) throw std::invalid_argument("the runs are shorter than the mask");
  return mask;
}

std::string runs_to_text(const std::vector<std::uint32_t>& runs) {
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t value = runs[i];
    if (i >= kFirstDifference) value -= runs[i - 2];
    for (bool more = true; more;) {
      int digit = int(value & (kMore - 1));
      value >>= kBits;  // keeps the sign
      more = (digit & kSign) ? value != -1 : value != 0;
      if (more) digit |= kMore;
      text.push_back(char(digit + kFirstCharacter));
    }
  }
  return text;
}

std::vector<std::uint32_t> runs_from_text(const std::string& text) {
  std::vector<std::uint32_t> runs;
  std::size_t at = 0;
  while (at < text.size()) {
    std::int64_t value = 0;
    int digit = kMore, shift = 0;
    for (; digit & kMore; shift += kBits) {
      if (at == text.size() || shift > 35) throw std::invalid_argument("a run does not end");
      digit = int(text[at++]) - kFirstCharacter;
      if (digit < 0 || digit >= 2 * kMore) throw std::invalid_argument("a character is not of RLE");
      value |= std::int64_t(digit & (kMore - 1)) << shift;
    }
    if (digit & kSign) value -= std::int64_t(1) << shift;
    if (runs.size() >= kFirstDifference) value += runs[runs.size() - 2];
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
      throw std::invalid_argument("a run has no possible length");
    }
    runs.push_back(std::uint32_t(value));
  }
  return runs;
}

}  // namespace cairn
