#pragma once

#include <opencv2/core.hpp>

#include "cairn/synthetic/hashed_noise.h"
#include "cairn/synthetic/perception_noise.h"

namespace cairn {

/// What a depth network would say where `depth` (CV_32F, metres, 0: nothing) is true; see
/// PerceptionNoise::Depth.
cv::Mat noisy_depth(const cv::Mat& depth, const PerceptionNoise::Depth& noise,
                    const HashedNoise& source, double time);

/// The logarithm of the scale that noisy_depth gives a picture, apart from the median of all.
double log_scale_error(const PerceptionNoise::Depth& noise, const HashedNoise& source, double time);

/// Normals (CV_32FC3, unit, camera frame; 0: nothing), turned by angles that are smooth over the
/// picture.
cv::Mat noisy_normals(const cv::Mat& normals, const PerceptionNoise::Normals& noise,
                      const HashedNoise& source, double time);

/// A mask (CV_8U, 255 inside) whose border is displaced in and out. Half of the variance belongs to
/// the thing, half to the picture.
cv::Mat ragged_mask(const cv::Mat& mask, const PerceptionNoise::Masks& noise,
                    const HashedNoise& source, double time);

}  // namespace cairn
