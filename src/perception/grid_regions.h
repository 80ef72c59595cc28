#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

namespace cairn {

/// The pixels of one connected region of a grid, row by row.
using GridRegion = std::vector<cv::Point>;

/// Connected components (4 neighbours) of the pixels that are `inside`, where two neighbours belong
/// together if `same(a, b)` says so; at least `min_pixels` large, by their first pixel.
std::vector<GridRegion> connected_regions(
    const cv::Size& size, int min_pixels, const std::function<bool(const cv::Point&)>& inside,
    const std::function<bool(const cv::Point&, const cv::Point&)>& same);

/// Those of a region's pixels that are not 0 in `wanted`, by connected components.
std::vector<GridRegion> connected_pieces(const GridRegion& region, const cv::Mat_<uchar>& wanted,
                                         int min_pixels);

/// CV_8U, 255 inside.
cv::Mat_<uchar> mask_of_region(const GridRegion& region, const cv::Size& size);
GridRegion region_of_mask(const cv::Mat_<uchar>& mask);

/// Fills holes of a mask that are smaller than `max_share` of it.
void fill_small_holes(cv::Mat_<uchar>& mask, double max_share);

/// A mask of the grid as one of a picture, its outline smoothed.
cv::Mat picture_mask(const cv::Mat_<uchar>& mask, const cv::Size& picture);

/// Regions of like colour (CV_8UC3, of the grid's size): neighbours whose distance in Lab after a
/// blur is below `max_step`. What stands for labels where no network gives them.
std::vector<GridRegion> colour_regions(const cv::Mat& bgr, int min_pixels, double max_step);

}  // namespace cairn
