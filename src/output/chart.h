#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cairn {

/// The colours of all pictures that cairn draws (BGR).
namespace colours {
inline const cv::Scalar kEstimate(180, 92, 20);  // blue
inline const cv::Scalar kTruth(176, 172, 168);   // grey
inline const cv::Scalar kAccent(60, 76, 214);    // red
inline const cv::Scalar kMapped(96, 200, 60);    // green
inline const cv::Scalar kText(60, 52, 46);
inline const cv::Scalar kGrid(236, 232, 228);
inline const cv::Scalar kBackground(255, 255, 255);
}  // namespace colours

/// Points to be drawn in one colour. A point that is not finite interrupts the line.
struct ChartSeries {
  std::string name;  ///< for the legend; empty: not in it
  std::vector<cv::Point2d> points;
  cv::Scalar colour;
  bool line = true;                      ///< false: dots
  double width = 2;                      ///< of the line, or diameter of a dot, in pixels
  std::vector<cv::Scalar> colours = {};  ///< of each dot, in place of `colour`
  bool end_markers = false;              ///< a ring at the first point, a dot at the last
  bool filled = false;                   ///< a hint of the colour inside of a closed line
  std::string inscription = {};          ///< written in the middle of the points
};

/// One pair of axes with what is drawn in it.
struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartSeries> series;
  bool equal_scale = false;     ///< one metre is as long in x as in y
  std::optional<double> y_min;  ///< lowest y shown, at most
  /// A bar of colours beside the axes, from blue (first) to red (second), and what it means.
  std::optional<std::pair<double, double>> colour_range;
  std::string colour_label;
};

/// Ticks at 1, 2 or 5 times a power of ten, about `wanted` of them, within [from, to].
std::vector<double> nice_ticks(double from, double to, int wanted);

/// The colour of `value` between 0 (blue) and 1 (red), BGR.
cv::Scalar ramp_colour(double value);

/// Draws the chart into `area` of `canvas` (CV_8UC3).
void draw_chart(const Chart& chart, const cv::Rect& area, cv::Mat& canvas);

/// A picture of charts beside each other, each as wide as its part of the sum of `widths`.
cv::Mat draw_charts(const std::vector<Chart>& charts, const std::vector<double>& widths,
                    const cv::Size& size);

}  // namespace cairn
