#include "cairn/perception/planenet_detector.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

constexpr float kLeastDistance = 1e-3f;  // metres; nearer "planes" are the network's empty slots

const NetworkCard& checked(const NetworkCard& card) {
  if (card.kind == NetworkCard::Kind::kPlanes) return card;
  throw Error(Error::Kind::kUsage, card.source.string() + ": the key kind must be planes here");
}

// The plane of a row (n d with n'x = d) in the camera frame, its normal towards the camera.
Eigen::Vector4d plane_of_row(const float* row, const NetworkCard& card) {
  Eigen::Vector3d p(row[0], row[1], row[2]);
  if (card.axes == NetworkCard::Axes::kForwardY) p = Eigen::Vector3d(p.x(), -p.z(), p.y());
  p *= card.unit * card.factor;
  if (!(p.norm() > kLeastDistance)) return Eigen::Vector4d::Zero();
  return (Eigen::Vector4d() << -p.normalized(), p.norm()).finished();
}

// For each pixel of the picture the index of the plane that it belongs to, or `count`.
cv::Mat_<uchar> owners(const Network& network, const cv::Mat& logits, int count,
                       const cv::Size& picture) {
  cv::Mat_<float> best(picture, 0.f);
  cv::Mat_<uchar> owner(picture, uchar(count));
  if (channels_of(logits) > count) {
    best = network.to_grid(channel_of(logits, count), picture, picture);
  }
  for (int i = 0; i < count; ++i) {
    const cv::Mat_<float> logit = network.to_grid(channel_of(logits, i), picture, picture);
    owner.setTo(i, logit > best);
    best = cv::max(best, logit);
  }
  return owner;
}

// Mean over the mask of the certainty that a logit stands for.
double mean_certainty(const cv::Mat_<float>& logit, const cv::Mat& mask) {
  cv::Mat certainty;
  cv::exp(-logit, certainty);
  certainty = 1 / (1 + certainty);
  return std::clamp(cv::mean(certainty, mask)[0], 0.0, 1.0);
}

}  // namespace

PlanenetDetector::PlanenetDetector(const NetworkCard& card, const PlanenetOptions& options)
    : network_(checked(card)), options_(options) {}

DetectedFrame PlanenetDetector::detect(const PerceptionInput& input) {
  DetectedFrame frame;
  frame.timestamp = input.timestamp;
  const NetworkAnswer answer = network_.run(input.bgr);
  if (!answer.problem.empty()) {
    frame.problem = network_.card().name + ": " + answer.problem;
    spdlog::warn("planes: the picture at {:.6f} s is left out: {}", input.timestamp, frame.problem);
    return frame;
  }
  const cv::Mat &rows = answer.outputs[0], &logits = answer.outputs[1];
  const int count = std::min(int(rows.total() / 3), 254);
  const cv::Size picture = input.bgr.size();
  const cv::Mat_<uchar> owner = owners(network_, logits, count, picture);
  for (int i = 0; i < count; ++i) {
    DetectedPlane plane;
    plane.plane = plane_of_row(rows.ptr<float>() + 3 * i, network_.card());
    plane.mask = owner == i;
    if (plane.plane.isZero() || plane.plane[3] > options_.max_distance_m ||
        cv::countNonZero(plane.mask) < options_.min_share * picture.area()) {
      continue;
    }
    plane.label = "plane";
    plane.score =
        mean_certainty(network_.to_grid(channel_of(logits, i), picture, picture), plane.mask);
    plane.sigma_angle = options_.sigma_angle_deg * M_PI / 180;
    plane.sigma_depth = options_.sigma_depth;
    frame.planes.push_back(plane);
  }
  std::stable_sort(frame.planes.begin(), frame.planes.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  frame.sigma_scale = network_.card().factor_sigma;
  return frame;
}

}  // namespace cairn
