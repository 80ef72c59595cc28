#pragma once

#include "cairn/synthetic/material.h"

namespace cairn::painting {

// One function a pattern; see Pattern.
Texture wood(cv::RNG& random);
Texture parquet(cv::RNG& random);
Texture carpet(cv::RNG& random);
Texture tiles(cv::RNG& random);
Texture asphalt(cv::RNG& random);
Texture paving(cv::RNG& random);
Texture plaster(cv::RNG& random);
Texture wallpaper(cv::RNG& random);
Texture brick(cv::RNG& random);
Texture facade(cv::RNG& random);
Texture foliage(cv::RNG& random);
Texture poster(cv::RNG& random);
Texture view(cv::RNG& random);

}  // namespace cairn::painting
