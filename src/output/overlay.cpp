#include "cairn/output/overlay.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/error.h"
#include "cairn/output/atomic_file.h"
#include "cairn/output/chart.h"
#include "cairn/output/label_colour.h"
#include "cairn/output/number_text.h"

namespace cairn {
namespace {

constexpr int kShift = 4;  // sub-pixel drawing

void draw_features(const std::vector<FrameOverlay::Feature>& features, double scale,
                   cv::Mat& canvas) {
  const cv::Scalar grey(170, 170, 170);
  for (const bool mapped : {false, true}) {  // those of the map on top
    for (const auto& feature : features) {
      if (feature.mapped != mapped) continue;
      const cv::Point at(cvRound(feature.x * (1 << kShift)), cvRound(feature.y * (1 << kShift)));
      const int radius = cvRound((mapped ? 2.6 : 1.6) * scale * (1 << kShift));
      cv::circle(canvas, at, radius, mapped ? colours::kMapped : grey,
                 mapped ? std::max(1, cvRound(1.4 * scale)) : 1, cv::LINE_AA, kShift);
    }
  }
}

cv::Scalar colour_of(const std::string& label) {
  const Rgb colour = label_colour(label);
  return {double(colour.z()), double(colour.y()), double(colour.x())};
}

void draw_mask(const FrameOverlay::Mask& mask, double scale, cv::Mat& canvas) {
  constexpr double kTint = 0.25;
  const cv::Scalar colour = colour_of(mask.label);
  cv::Mat tinted;
  cv::addWeighted(canvas, 1 - kTint, cv::Mat(canvas.size(), CV_8UC3, colour), kTint, 0, tinted);
  tinted.copyTo(canvas, mask.inside);
  std::vector<std::vector<cv::Point>> borders;
  cv::findContours(mask.inside, borders, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  cv::drawContours(canvas, borders, -1, colour, std::max(1, cvRound(scale)), cv::LINE_AA);
}

void draw_outline(const FrameOverlay::Outline& outline, double scale, cv::Mat& canvas) {
  std::vector<cv::Point> corners;
  for (const cv::Point2f& c : outline.corners) corners.emplace_back(c * float(1 << kShift));
  if (corners.empty()) return;
  cv::polylines(canvas, corners, true, colour_of(outline.label), std::max(1, cvRound(1.4 * scale)),
                cv::LINE_AA, kShift);
}

// Its middle at `at`, or as near to that as fits into the picture. Light, with a dark rim.
void draw_name(const std::string& name, cv::Point at, double scale, cv::Mat& canvas) {
  const double height = 0.42 * scale;
  int base = 0;
  const int thin = std::max(1, cvRound(scale));
  const cv::Size box = cv::getTextSize(name, cv::FONT_HERSHEY_SIMPLEX, height, thin, &base);
  at.x = std::clamp(at.x - box.width / 2, 2, std::max(2, canvas.cols - box.width - 2));
  at.y =
      std::clamp(at.y + box.height / 2, box.height + 2, std::max(box.height + 2, canvas.rows - 4));
  cv::putText(canvas, name, at, cv::FONT_HERSHEY_SIMPLEX, height, {38, 33, 30}, thin + 2,
              cv::LINE_AA);
  cv::putText(canvas, name, at, cv::FONT_HERSHEY_SIMPLEX, height,
              0.5 * (colour_of(name) + cv::Scalar::all(255)), thin, cv::LINE_AA);
}

// The name of a surface where it is widest; nothing where it is too small for that.
void draw_label(const FrameOverlay::Mask& mask, double scale, cv::Mat& canvas) {
  cv::Mat framed, distance;
  cv::copyMakeBorder(mask.inside, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  cv::distanceTransform(framed, distance, cv::DIST_L2, 3);
  double widest = 0;
  cv::Point at;
  cv::minMaxLoc(distance, nullptr, &widest, nullptr, &at);
  if (widest < 14 * scale) return;
  draw_name(mask.label, at, scale, canvas);
}

void draw_box(const Box2& box, cv::Mat& canvas) {
  const auto fixed = [](double x, double y) {
    return cv::Point(cvRound(x * (1 << kShift)), cvRound(y * (1 << kShift)));
  };
  cv::rectangle(canvas, fixed(box.x0, box.y0), fixed(box.x1, box.y1), colours::kBackground, 1,
                cv::LINE_AA, kShift);
}

// Above the thing: there it hides the least of it.
void draw_object_name(const FrameOverlay::Outline& object, double scale, cv::Mat& canvas) {
  if (object.corners.empty()) return;
  const cv::Rect around = cv::boundingRect(object.corners);
  const cv::Point at(around.x + around.width / 2, around.y - cvRound(9 * scale));
  draw_name(object.label, at, scale, canvas);
}

cv::Scalar state_colour(const std::string& state) {
  if (state == "tracked") return colours::kMapped;
  if (state == "lost") return colours::kAccent;
  return {60, 180, 235};  // amber: waiting, initialising, ...
}

}  // namespace

cv::Mat draw_overlay(const cv::Mat& picture, const FrameOverlay& overlay) {
  const double scale = std::max(1.0, picture.cols / 640.0);
  const int bar = cvRound(28 * scale);
  const cv::Size size((picture.cols + 1) / 2 * 2, (picture.rows + bar + 1) / 2 * 2);
  cv::Mat canvas(size, CV_8UC3, cv::Scalar(38, 33, 30));
  cv::Mat inside = canvas({0, 0, picture.cols, picture.rows});
  if (picture.channels() == 1) {
    cv::cvtColor(picture, inside, cv::COLOR_GRAY2BGR);
  } else {
    picture.copyTo(inside);
  }
  for (const auto& mask : overlay.masks) draw_mask(mask, scale, inside);
  for (const auto& outline : overlay.outlines) draw_outline(outline, scale, inside);
  draw_features(overlay.features, scale, inside);
  for (const Box2& box : overlay.boxes) draw_box(box, inside);
  for (const auto& object : overlay.objects) draw_outline(object, 1.4 * scale, inside);
  for (const auto& mask : overlay.masks) draw_label(mask, scale, inside);
  for (const auto& object : overlay.objects) draw_object_name(object, scale, inside);
  const int middle = picture.rows + (size.height - picture.rows) / 2;
  const cv::Scalar colour = state_colour(overlay.state);
  cv::circle(canvas, {cvRound(16 * scale), middle}, cvRound(6 * scale), colour, cv::FILLED,
             cv::LINE_AA);
  std::string text = overlay.state + "   " + std::to_string(overlay.matches) + " matches";
  if (overlay.fps > 0) text += "   " + fixed_text(overlay.fps, 1) + " fps";
  text += "   " + fixed_text(overlay.timestamp, 2) + " s";
  cv::putText(canvas, text, {cvRound(32 * scale), middle + cvRound(5 * scale)},
              cv::FONT_HERSHEY_SIMPLEX, 0.5 * scale, {235, 235, 235}, std::max(1, int(scale)),
              cv::LINE_AA);
  return canvas;
}

void write_strip(const std::filesystem::path& file, const std::vector<cv::Mat>& pictures,
                 int columns, int width) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Kind::kOutput, file.string() + ": " + why);
  };
  if (pictures.empty()) refuse("there are no pictures to put together");
  constexpr int kGap = 6;
  columns = std::clamp(columns, 1, int(pictures.size()));
  const int rows = (int(pictures.size()) + columns - 1) / columns;
  const cv::Size one(width, std::max(1, pictures[0].rows * width / pictures[0].cols));
  cv::Mat sheet(rows * (one.height + kGap) - kGap, columns * (one.width + kGap) - kGap, CV_8UC3,
                colours::kBackground);
  for (int i = 0; i < int(pictures.size()); ++i) {
    const cv::Rect place({(i % columns) * (one.width + kGap), (i / columns) * (one.height + kGap)},
                         one);
    cv::Mat small;
    cv::resize(pictures[std::size_t(i)], small, one, 0, 0, cv::INTER_AREA);
    if (small.channels() == 1) cv::cvtColor(small, small, cv::COLOR_GRAY2BGR);
    small.copyTo(sheet(place));
  }
  std::vector<unsigned char> bytes;
  try {
    if (!cv::imencode(file.extension().string(), sheet, bytes)) refuse("it cannot be encoded");
  } catch (const cv::Exception&) {
    refuse("its ending is no kind of picture that can be written; use .png or .jpg");
  }
  write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace cairn
