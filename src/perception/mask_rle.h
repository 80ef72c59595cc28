#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace cairn {

/// Lengths of runs in a mask (CV_8U, inside is not 0), column by column, of outside and inside by
/// turns; the first is of outside and may be 0. The form that COCO calls uncompressed RLE.
std::vector<std::uint32_t> encode_runs(const cv::Mat& mask);

/// The mask of such runs: 255 inside. Throws std::invalid_argument if they do not fill it exactly.
cv::Mat decode_runs(const std::vector<std::uint32_t>& runs, const cv::Size& size);

/// COCO's text form of the runs: from the third on the difference to the last but one; then five
/// bits a character, lowest first, 32 where more follow, plus 48; the last one carries the sign.
std::string runs_to_text(const std::vector<std::uint32_t>& runs);

/// Throws std::invalid_argument for what is no such text.
std::vector<std::uint32_t> runs_from_text(const std::string& text);

}  // namespace cairn
