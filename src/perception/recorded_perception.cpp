#include "cairn/perception/recorded_perception.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "cairn/geometry/error.h"
#include "cairn/perception/mask_rle.h"

namespace cairn {
namespace {

using nlohmann::json;

const cv::Size kRecordedDepth(40, 30);
constexpr int kLargestSide = 1 << 15;  // of a mask, pixels

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

json mask_json(const cv::Mat& mask) {
  return {{"size", {mask.rows, mask.cols}}, {"counts", runs_to_text(encode_runs(mask))}};
}

json object_json(const DetectedObject& object) {
  const auto pixel = [](double value) { return rounded(value, 1e3); };
  const Box2& b = object.box;
  json value = {{"box", {pixel(b.x0), pixel(b.y0), pixel(b.x1), pixel(b.y1)}},
                {"class", object.class_name},
                {"score", rounded(object.score, 1e5)}};
  if (!object.mask.empty()) value["mask"] = mask_json(object.mask);
  if (object.thing) value["thing"] = *object.thing;
  return value;
}

// Never 0, which would be read back as a mistake.
double sigma_json(double sigma) { return std::max(rounded(sigma, 1e5), 1e-5); }

json plane_json(const DetectedPlane& plane) {
  const Eigen::Vector4d& p = plane.plane;
  json value = {{"plane", {p[0], p[1], p[2], p[3]}},
                {"label", plane.label},
                {"score", rounded(plane.score, 1e5)},
                {"sigma_angle", sigma_json(plane.sigma_angle)},
                {"sigma_depth", sigma_json(plane.sigma_depth)}};
  if (!plane.mask.empty()) value["mask"] = mask_json(plane.mask);
  if (plane.truth) value["truth"] = *plane.truth;
  return value;
}

// Coarse, in millimetres, row by row.
json depth_json(const cv::Mat& depth) {
  cv::Mat coarse = depth;
  if (depth.cols > kRecordedDepth.width) {
    cv::resize(depth, coarse, kRecordedDepth, 0, 0, cv::INTER_NEAREST);
  }
  json values = json::array();
  for (int y = 0; y < coarse.rows; ++y) {
    for (int x = 0; x < coarse.cols; ++x) {
      values.push_back(static_cast<int>(std::lround(1000 * coarse.at<float>(y, x))));
    }
  }
  return {{"size", {coarse.rows, coarse.cols}}, {"millimetres", values}};
}

// What is wrong with a line; parse_json_line adds where.
[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

double finite(const json& value) {
  const double number = value.get<double>();
  if (!std::isfinite(number)) refuse("a number is not finite");
  return number;
}

std::vector<double> four_numbers(const json& value, const char* key) {
  if (!value.is_array() || value.size() != 4) refuse(std::string(key) + " has not four numbers");
  std::vector<double> numbers;
  for (const json& item : value) numbers.push_back(finite(item));
  return numbers;
}

double score_of(const json& value) {
  const double score = finite(value.at("score"));
  if (!(score >= 0 && score <= 1)) refuse("a score is not between 0 and 1");
  return score;
}

double sigma_of(const json& value, const char* key, double otherwise) {
  if (!value.contains(key)) return otherwise;
  const double sigma = finite(value.at(key));
  if (!(sigma > 0)) refuse(std::string("a ") + key + " is not positive");
  return sigma;
}

std::optional<int> identity(const json& value, const char* key) {
  return value.contains(key) ? std::optional<int>(value.at(key).get<int>()) : std::nullopt;
}

cv::Mat mask_of(const json& value) {
  if (!value.contains("mask")) return {};
  const json& mask = value.at("mask");
  const cv::Size size(mask.at("size").at(1).get<int>(), mask.at("size").at(0).get<int>());
  if (size.width <= 0 || size.height <= 0 || size.width > kLargestSide ||
      size.height > kLargestSide) {
    refuse("a mask has no possible size");
  }
  const json& counts = mask.at("counts");
  return decode_runs(counts.is_string() ? runs_from_text(counts.get<std::string>())
                                        : counts.get<std::vector<std::uint32_t>>(),
                     size);
}

cv::Mat depth_of(const json& value) {
  const int rows = value.at("size").at(0).get<int>(), cols = value.at("size").at(1).get<int>();
  const json& numbers = value.at("millimetres");
  if (rows <= 0 || cols <= 0 || rows > kLargestSide || cols > kLargestSide ||
      numbers.size() != std::size_t(rows) * std::size_t(cols)) {
    refuse("a depth has not as many numbers as its size says");
  }
  cv::Mat depth(rows, cols, CV_32F);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double metres = finite(numbers[i]) / 1000;
    if (metres < 0) refuse("a depth is negative");
    depth.at<float>(int(i) / cols, int(i) % cols) = static_cast<float>(metres);
  }
  return depth;
}

DetectedObject parse_object(const json& value) {
  const auto b = four_numbers(value.at("box"), "a box");
  if (!(b[0] < b[2] && b[1] < b[3])) refuse("a box has no area");
  return {{b[0], b[1], b[2], b[3]},
          value.at("class").get<std::string>(),
          score_of(value),
          mask_of(value),
          identity(value, "thing")};
}

DetectedPlane parse_plane(const json& value) {
  const auto p = four_numbers(value.at("plane"), "a plane");
  const double length = Eigen::Vector3d(p.data()).norm();
  if (!(length > 1e-9)) refuse("a plane has no normal");
  DetectedPlane plane;
  plane.plane = Eigen::Vector4d(p.data()) / length;
  plane.label = value.at("label").get<std::string>();
  plane.score = score_of(value);
  plane.mask = mask_of(value);
  plane.truth = identity(value, "truth");
  plane.sigma_angle = sigma_of(value, "sigma_angle", plane.sigma_angle);
  plane.sigma_depth = sigma_of(value, "sigma_depth", plane.sigma_depth);
  return plane;
}

}  // namespace

std::string to_json_line(const DetectedFrame& frame) {
  json objects = json::array(), planes = json::array();
  for (const DetectedObject& object : frame.objects) objects.push_back(object_json(object));
  for (const DetectedPlane& plane : frame.planes) planes.push_back(plane_json(plane));
  json line = {{"timestamp", frame.timestamp}, {"objects", objects}, {"planes", planes}};
  if (frame.sigma_scale > 0) line["sigma_scale"] = sigma_json(frame.sigma_scale);
  if (!frame.depth.empty()) line["depth"] = depth_json(frame.depth);
  return line.dump();
}

DetectedFrame parse_json_line(const std::string& line, const std::string& where) {
  try {
    const json value = json::parse(line);
    DetectedFrame frame;
    frame.timestamp = finite(value.at("timestamp"));
    for (const json& object : value.at("objects")) frame.objects.push_back(parse_object(object));
    for (const json& plane : value.at("planes")) frame.planes.push_back(parse_plane(plane));
    frame.sigma_scale = sigma_of(value, "sigma_scale", 0);
    if (value.contains("depth")) frame.depth = depth_of(value.at("depth"));
    return frame;
  } catch (const json::exception& e) {
    throw Error(Error::Kind::kInput, where + ": is no recorded detections (" + e.what() +
                                         "); record them again or remove the line");
  } catch (const std::invalid_argument& e) {
    throw Error(Error::Kind::kInput,
                where + ": " + e.what() + "; record the detections again or remove the line");
  }
}

}  // namespace cairn
