#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// How the unit of a picture's predicted depth compares with the map's.
struct PictureScale {
  bool usable = false;
  double scale = 1;      ///< map units a metre of the detector
  double log_error = 0;  ///< spread of the logarithm over the points: local errors of the depth
  int points = 0;
  // How it changes with the contrast; predicted depths as they came.
  double contrast = 1;   ///< that was taken
  DepthRange range;      ///< of the whole picture
  double predicted = 0;  ///< logarithm of the depth at the points, from the picture's mean
  // What tells of the contrast: of the logarithms, over the points that agree.
  double variance = 0;    ///< of depth in the map
  double covariance = 0;  ///< of the two

  /// With another contrast.
  double log_scale(double with_contrast) const;
};

/// One robust scale from the keyframe's map points: the mean of the logarithm of their depth over
/// the predicted one, stretched by `contrast` (see stretched_depth). Corners crowd on what is near
/// and full of texture, so it is the mean over the cells of a grid, each with its median.
PictureScale align_picture(const Map& map, KeyframeId keyframe, double contrast = 1);

}  // namespace cairn
