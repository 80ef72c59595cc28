#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace cairn {

/// What turns light into a picture file's numbers. Every part can be switched off by its zero.
struct SensorOptions {
  double vignetting = 0.25;    ///< how much darker the corners are, 0 to 1
  double auto_exposure = 0.5;  ///< how far the exposure follows the scene; 0: fixed, 1: all
  double blur_px = 0.6;        ///< deviation of the lens's blur
  double full_well = 6000;     ///< electrons of a white pixel, for shot noise; 0: none
  double read_noise = 0.003;   ///< deviation, as a share of white
  bool mosaic = true;          ///< a colour a pixel (RGGB), the others from its neighbours
};

/// Linear light (CV_32FC3, red green blue, 1: white at gain 1) to CV_8UC3, BGR, sRGB-encoded.
/// `noise_seed`: another one a picture. The same arguments give the same bytes.
cv::Mat develop(const cv::Mat& light, double gain, const SensorOptions& options,
                std::uint64_t noise_seed);

}  // namespace cairn
