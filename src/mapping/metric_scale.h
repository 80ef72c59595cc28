#pragma once

#include <string>
#include <vector>

#include "cairn/mapping/keyframe_perception.h"

namespace cairn {

/// Metres a unit of the map.
struct ScaleEstimate {
  std::string how = "none";  ///< none (free), predicted depth, given, ...
  double value = 1;
  double sigma = 0;  ///< relative; 0 where nothing is known of it
  int pictures = 0;  ///< that had a say

  bool known() const { return how != "none"; }
};

/// The estimate after a user has measured: true lengths are `factor` (more than 0) times those that
/// it gives. Of the error of that measurement nothing is known.
ScaleEstimate given_scale(const ScaleEstimate& found, double factor);

/// Collects what pictures say about the unit of the map.
class MetricScale {
 public:
  MetricScale();
  /// A picture's alignment, and how far off the detector's metre may be in a scene, of the
  /// logarithm; 0 where it is measured.
  void add(const PictureScale& picture, double sigma);
  /// Of all pictures the median; 0 where there is none yet.
  double picture_scale() const;
  /// How far pictures differ from one another: σ of the logarithm. A guess while they are few.
  double spread() const;
  /// Metres, from the median over all pictures. Its σ: that of the detector in a scene, which no
  /// number of pictures makes smaller, and the spread of the pictures over the root of their
  /// number.
  ScaleEstimate estimate() const;
  /// Networks shy away from what is near and what is far: the range of depths in the map over that
  /// in predictions, of logarithms, at least 1. Measured depth has 1.
  double contrast() const;

 private:
  struct Picture {
    double log_scale, contrast, predicted;
  };
  std::vector<double> logs() const;  // of map units a metre, with the contrast of now

  double sigma_ = 0;  // the largest of all pictures
  std::vector<Picture> pictures_;
  double variance_, covariance_;  // of depths in the map and in predictions
};

}  // namespace cairn
