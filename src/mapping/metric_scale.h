#pragma once

#include <string>
#include <vector>

#include "cairn/geometry/median.h"
#include "cairn/mapping/picture_scale.h"

namespace cairn {

/// What one source says of the scale.
struct ScalePart {
  std::string how;
  double value = 1;
  double sigma = 0;  ///< relative
  int count = 0;     ///< pictures or things that had a say
};

/// Metres a unit of the map.
struct ScaleEstimate {
  std::string how = "none";  ///< none (free), predicted depth, object sizes, given, ...
  double value = 1;
  double sigma = 0;                   ///< relative; 0 where nothing is known of it
  int pictures = 0;                   ///< that had a say
  std::vector<ScalePart> parts = {};  ///< where there are several, what each said

  bool known() const { return how != "none"; }
};

/// The estimate after a user has measured: true lengths are `factor` (more than 0) times those that
/// it gives. Of the error of that measurement nothing is known.
ScaleEstimate given_scale(const ScaleEstimate& found, double factor);

/// Both joined, of which either may be unknown: the mean of logarithms that is surest, unless they
/// contradict each other by more than 3 σ; then the surer one.
ScaleEstimate joined(const ScaleEstimate& pictures, const ScaleEstimate& sizes);

/// Collects what pictures say about the unit of the map.
class MetricScale {
 public:
  MetricScale();
  /// A picture's time (seconds) and alignment, and how far off the detector's metre may be in a
  /// scene, of the logarithm; 0 where it is measured.
  void add(double time, const PictureScale& picture, double sigma);
  /// Of all pictures the mean of those that agree; 0 where there is none yet. Pictures that follow
  /// each other err alike: they weigh as for the mean of a process whose correlation falls with
  /// exp(-t / 0.76 s), so that it has the least variance.
  double picture_scale() const;
  /// How far pictures differ from one another: σ of the logarithm. A guess while they are few.
  double spread() const;
  /// Of those that came with pictures the largest, but for the last quarter; 0 without any.
  double sigma() const;
  /// Metres. Its σ: that of the detector in a scene, or of the calibration of a depth camera, which
  /// no number of pictures makes smaller, and the spread of the pictures over the root of the
  /// number of independent ones.
  ScaleEstimate estimate() const;
  /// Networks shy away from what is near and what is far: the range of depths in the map over that
  /// in predictions, of logarithms, at least 1. Measured depth has 1.
  double contrast() const;

 private:
  struct Picture {
    double time;
    PictureScale scale;
    double sigma;
  };
  // With the contrast of now, logarithms of map units a metre, and how much each is worth in
  // independent pictures.
  std::vector<WeightedValue> scales() const;

  std::vector<Picture> pictures_;  // in order of time
  double variance_, covariance_;   // of depths in the map and in predictions
};

}  // namespace cairn
