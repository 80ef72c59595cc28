#include "cairn/output/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "cairn/output/number_text.h"

namespace cairn {
namespace {

// Everything is drawn at twice the size and then made smaller: OpenCV's own smoothing is coarse.
constexpr int kSuper = 2;

enum class Anchor { kLeft, kCentre, kRight };

struct Range {
  double from = 0, to = 1;
  double span() const { return to - from; }
};

void draw_text(cv::Mat& canvas, const std::string& text, cv::Point2d at, Anchor anchor, double size,
               const cv::Scalar& colour = colours::kText, bool bold = false) {
  const int thickness = bold ? 3 : 2;
  int base = 0;
  const cv::Size box = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, thickness, &base);
  if (anchor == Anchor::kCentre) at.x -= box.width / 2.0;
  if (anchor == Anchor::kRight) at.x -= box.width;
  cv::putText(canvas, text, {cvRound(at.x), cvRound(at.y + box.height / 2.0)},
              cv::FONT_HERSHEY_SIMPLEX, size, colour, thickness, cv::LINE_AA);
}

void draw_vertical_text(cv::Mat& canvas, const std::string& text, cv::Point at, double size) {
  int base = 0;
  const cv::Size box = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 2, &base);
  cv::Mat strip(box.height + base + 8, box.width + 8, CV_8UC3, colours::kBackground);
  draw_text(strip, text, {4.0, strip.rows / 2.0 - 2}, Anchor::kLeft, size);
  cv::rotate(strip, strip, cv::ROTATE_90_COUNTERCLOCKWISE);
  cv::Rect place(at.x - strip.cols / 2, at.y - strip.rows / 2, strip.cols, strip.rows);
  const cv::Rect seen = place & cv::Rect({0, 0}, canvas.size());
  if (!seen.empty()) strip(seen - place.tl()).copyTo(canvas(seen));
}

bool is_finite(const cv::Point2d& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// Maps data to pixels of the super-sampled canvas.
class ChartPainter {
 public:
  ChartPainter(const Chart& chart, const cv::Rect& area, cv::Mat& canvas);
  void paint();

 private:
  cv::Point2d pixel(const cv::Point2d& p) const {
    return {plot_.x + (p.x - x_.from) / x_.span() * plot_.width,
            plot_.y + plot_.height - (p.y - y_.from) / y_.span() * plot_.height};
  }
  void find_ranges();
  void widen_to_equal_scale();
  void paint_axes();
  void paint_series(const ChartSeries& series);
  void paint_inscription(const ChartSeries& series);
  void paint_legend();
  void paint_colour_bar();

  const Chart& chart_;
  cv::Rect area_;
  cv::Mat& canvas_;
  cv::Rect plot_;  // inside of the axes
  Range x_, y_;
};

ChartPainter::ChartPainter(const Chart& chart, const cv::Rect& area, cv::Mat& canvas)
    : chart_(chart), area_(area), canvas_(canvas) {
  const int left = 150, right = chart.colour_range ? 190 : 50, top = 96, bottom = 116;
  plot_ = {area.x + left, area.y + top, std::max(50, area.width - left - right),
           std::max(50, area.height - top - bottom)};
  find_ranges();
  if (chart.equal_scale) widen_to_equal_scale();
}

void ChartPainter::find_ranges() {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  x_ = y_ = {kNone, -kNone};
  for (const ChartSeries& series : chart_.series) {
    for (const cv::Point2d& p : series.points) {
      if (!is_finite(p)) continue;
      x_ = {std::min(x_.from, p.x), std::max(x_.to, p.x)};
      y_ = {std::min(y_.from, p.y), std::max(y_.to, p.y)};
    }
  }
  if (x_.from > x_.to) x_ = y_ = {0, 1};
  const bool from_y_min = chart_.y_min && y_.from >= *chart_.y_min;
  if (from_y_min) y_.from = *chart_.y_min;
  for (Range* range : {&x_, &y_}) {
    const double size = std::abs(range->to);
    const bool one_value = range->span() <= 1e-9 * size;
    const double margin = one_value ? std::max(1e-3, 0.01 * size) : 0.04 * range->span();
    range->from -= margin;
    range->to += margin;
  }
  if (from_y_min) y_.from = *chart_.y_min;
}

void ChartPainter::widen_to_equal_scale() {
  const double scale = std::max(x_.span() / plot_.width, y_.span() / plot_.height);
  const auto widen = [&](Range& range, int pixels) {
    const double middle = 0.5 * (range.from + range.to);
    range = {middle - 0.5 * scale * pixels, middle + 0.5 * scale * pixels};
  };
  widen(x_, plot_.width);
  widen(y_, plot_.height);
}

std::string tick_text(double value, double step) {
  const int decimals = std::clamp(int(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  const std::string text = fixed_text(value, decimals);
  return text.find_first_not_of("-0.") == std::string::npos ? "0" : text;
}

void ChartPainter::paint_axes() {
  const auto x_ticks = nice_ticks(x_.from, x_.to, std::max(2, plot_.width / 190));
  const auto y_ticks = nice_ticks(y_.from, y_.to, std::max(2, plot_.height / 130));
  const auto step = [](const std::vector<double>& t) { return t.size() > 1 ? t[1] - t[0] : 1.0; };
  for (const double value : x_ticks) {
    const cv::Point2d p = pixel({value, y_.from});
    cv::line(canvas_, p, {cvRound(p.x), plot_.y}, colours::kGrid, 2, cv::LINE_AA);
    draw_text(canvas_, tick_text(value, step(x_ticks)), {p.x, p.y + 26}, Anchor::kCentre, 0.8);
  }
  for (const double value : y_ticks) {
    const cv::Point2d p = pixel({x_.from, value});
    cv::line(canvas_, p, {plot_.x + plot_.width, cvRound(p.y)}, colours::kGrid, 2, cv::LINE_AA);
    draw_text(canvas_, tick_text(value, step(y_ticks)), {p.x - 14, p.y}, Anchor::kRight, 0.8);
  }
  cv::line(canvas_, plot_.tl(), {plot_.x, plot_.br().y}, colours::kText, 2, cv::LINE_AA);
  cv::line(canvas_, {plot_.x, plot_.br().y}, plot_.br(), colours::kText, 2, cv::LINE_AA);
  const double middle = plot_.x + plot_.width / 2.0;
  draw_text(canvas_, chart_.title, {double(plot_.x), area_.y + 46.0}, Anchor::kLeft, 1.15,
            colours::kText, true);
  draw_text(canvas_, chart_.x_label, {middle, area_.br().y - 36.0}, Anchor::kCentre, 0.9);
  draw_vertical_text(canvas_, chart_.y_label, {area_.x + 34, plot_.y + plot_.height / 2}, 0.9);
}

void ChartPainter::paint_series(const ChartSeries& series) {
  cv::Mat inside = canvas_(plot_);  // clips what lies outside
  constexpr int kShift = 4;         // sub-pixel drawing
  const auto fixed = [&](const cv::Point2d& p) {
    const cv::Point2d q = pixel(p) - cv::Point2d(plot_.tl());
    const auto limited = [](double v) { return cvRound(std::clamp(v, -1e5, 1e5) * (1 << kShift)); };
    return cv::Point(limited(q.x), limited(q.y));
  };
  if (series.filled) {
    constexpr double kTint = 0.1;
    std::vector<cv::Point> corners;
    for (const cv::Point2d& p : series.points) corners.push_back(fixed(p));
    cv::Mat tinted = inside.clone();
    cv::fillPoly(tinted, corners, series.colour, cv::LINE_AA, kShift);
    cv::addWeighted(tinted, kTint, inside, 1 - kTint, 0, inside);
  }
  const int width = std::max(1, cvRound(series.width * kSuper));
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    if (!is_finite(series.points[i])) continue;
    if (!series.line) {
      const cv::Scalar& colour = series.colours.empty() ? series.colour : series.colours[i];
      cv::circle(inside, fixed(series.points[i]), (width << kShift) / 2, colour, cv::FILLED,
                 cv::LINE_AA, kShift);
    } else if (i > 0 && is_finite(series.points[i - 1])) {
      cv::line(inside, fixed(series.points[i - 1]), fixed(series.points[i]), series.colour, width,
               cv::LINE_AA, kShift);
    }
  }
  if (!series.end_markers || series.points.empty()) return;
  const cv::Point first = fixed(series.points.front()), last = fixed(series.points.back());
  cv::circle(inside, first, 12 << kShift, colours::kBackground, cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(inside, first, 12 << kShift, series.colour, 4, cv::LINE_AA, kShift);
  cv::circle(inside, last, 12 << kShift, series.colour, cv::FILLED, cv::LINE_AA, kShift);
}

void ChartPainter::paint_inscription(const ChartSeries& series) {
  if (series.inscription.empty() || series.points.empty()) return;
  cv::Point2d least = series.points[0], most = least;
  for (const cv::Point2d& p : series.points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
  }
  const cv::Point2d middle = pixel(0.5 * (least + most));
  if (plot_.contains(middle)) draw_text(canvas_, series.inscription, middle, Anchor::kCentre, 0.7);
}

void ChartPainter::paint_legend() {
  // In the title's line, from the right: it never hides data there.
  double x = plot_.br().x - (chart_.colour_range ? 70 : 0);  // beside the name of the bar
  const double y = area_.y + 46;
  for (std::size_t i = chart_.series.size(); i-- > 0;) {
    const ChartSeries& series = chart_.series[i];
    if (series.name.empty()) continue;
    int base = 0;
    const cv::Size box = cv::getTextSize(series.name, cv::FONT_HERSHEY_SIMPLEX, 0.85, 2, &base);
    draw_text(canvas_, series.name, {x, y}, Anchor::kRight, 0.85);
    x -= box.width + 14;
    if (series.line) {
      cv::line(canvas_, cv::Point2d(x - 44, y), cv::Point2d(x, y), series.colour, 5, cv::LINE_AA);
    } else {
      cv::circle(canvas_, cv::Point2d(x - 12, y), 8, series.colour, cv::FILLED, cv::LINE_AA);
    }
    x -= 80;
  }
}

void ChartPainter::paint_colour_bar() {
  const auto [from, to] = *chart_.colour_range;
  const cv::Rect bar(plot_.br().x + 36, plot_.y, 24, plot_.height);
  for (int row = 0; row < bar.height; ++row) {
    const cv::Scalar colour = ramp_colour(1 - double(row) / std::max(1, bar.height - 1));
    cv::line(canvas_, {bar.x, bar.y + row}, {bar.x + bar.width, bar.y + row}, colour);
  }
  const auto ticks = nice_ticks(from, to, std::max(2, bar.height / 130));
  for (const double value : ticks) {
    const double y = bar.br().y - (value - from) / std::max(to - from, 1e-12) * bar.height;
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
    draw_text(canvas_, tick_text(value, step), {bar.br().x + 10.0, y}, Anchor::kLeft, 0.75);
  }
  draw_text(canvas_, chart_.colour_label, {bar.x + bar.width / 2.0, bar.y - 24.0}, Anchor::kCentre,
            0.8);
}

void ChartPainter::paint() {
  paint_axes();
  for (const ChartSeries& series : chart_.series) paint_series(series);
  for (const ChartSeries& series : chart_.series) paint_inscription(series);
  paint_legend();
  if (chart_.colour_range) paint_colour_bar();
}

}  // namespace

std::vector<double> nice_ticks(double from, double to, int wanted) {
  if (!(to > from) || !std::isfinite(to - from)) return {from};
  const double rough = (to - from) / std::max(1, wanted);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  const double first = std::ceil(from / step - 1e-9), last = std::floor(to / step + 1e-9);
  for (int i = 0; i <= last - first; ++i) ticks.push_back((first + i) * step);
  return ticks;
}

cv::Scalar ramp_colour(double value) {
  const std::array<cv::Vec3d, 5> kStops = {cv::Vec3d(150, 60, 50), cv::Vec3d(190, 150, 40),
                                           cv::Vec3d(110, 180, 80), cv::Vec3d(60, 180, 235),
                                           cv::Vec3d(40, 60, 205)};
  const double at = std::clamp(std::isfinite(value) ? value : 0, 0.0, 1.0) * 4;
  const std::size_t i = std::min<std::size_t>(3, std::size_t(at));
  const cv::Vec3d colour = kStops[i] + (kStops[i + 1] - kStops[i]) * (at - double(i));
  return {colour[0], colour[1], colour[2]};
}

void draw_chart(const Chart& chart, const cv::Rect& area, cv::Mat& canvas) {
  cv::Mat large(area.size() * kSuper, CV_8UC3, colours::kBackground);
  ChartPainter(chart, {{0, 0}, large.size()}, large).paint();
  cv::Mat small;
  cv::resize(large, small, area.size(), 0, 0, cv::INTER_AREA);
  small.copyTo(canvas(area));
}

cv::Mat draw_charts(const std::vector<Chart>& charts, const std::vector<double>& widths,
                    const cv::Size& size) {
  cv::Mat canvas(size, CV_8UC3, colours::kBackground);
  const double sum = std::accumulate(widths.begin(), widths.end(), 0.0);
  double begun = 0;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const int left = cvRound(begun / sum * size.width);
    begun += widths[i];
    const int right = cvRound(begun / sum * size.width);
    draw_chart(charts[i], {left, 0, right - left, size.height}, canvas);
  }
  return canvas;
}

}  // namespace cairn
