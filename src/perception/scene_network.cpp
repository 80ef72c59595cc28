#include "cairn/perception/scene_network.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

constexpr float kLeastDepth = 1e-3f;  // metres; below, a network says that it does not know

constexpr std::array<std::string_view, 11> kIndoors = {"floor", "ceiling", "bed",     "cabinet",
                                                       "table", "curtain", "chair",   "sofa",
                                                       "shelf", "rug",     "armchair"};
constexpr std::array<std::string_view, 10> kOutdoors = {
    "sky", "road", "sidewalk", "car", "tree", "grass", "earth", "mountain", "sea", "field"};

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& labels, const std::string& label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

cv::Mat_<float> depth_of(const Network& network, const cv::Mat& output, const cv::Size& picture,
                         const cv::Size& grid) {
  const NetworkCard& card = network.card();
  cv::Mat_<float> depth = network.to_grid(channel_of(output, 0), picture, grid);
  depth *= card.unit * card.factor;
  depth.setTo(0, depth < kLeastDepth);
  return depth;
}

cv::Mat_<cv::Vec3f> normals_of(const Network& network, const cv::Mat& output,
                               const cv::Size& picture, const cv::Size& grid) {
  std::vector<cv::Mat> axes;
  for (int i = 0; i < 3; ++i) {
    axes.push_back(network.to_grid(channel_of(output, i), picture, grid));
  }
  if (network.card().axes == NetworkCard::Axes::kForwardY) axes = {axes[0], -axes[2], axes[1]};
  cv::Mat_<cv::Vec3f> normals;
  cv::merge(axes, normals);
  for (cv::Vec3f& n : normals) {
    const float length = float(cv::norm(n));
    n = length > 1e-6f ? n / length : cv::Vec3f();
  }
  return normals;
}

cv::Mat_<uchar> labels_of(const Network& network, const cv::Mat& output, const cv::Size& picture,
                          const cv::Size& grid) {
  cv::Mat_<uchar> labels(grid, uchar(0));
  cv::Mat_<float> best = network.to_grid(channel_of(output, 0), picture, grid);
  for (int i = 1; i < channels_of(output); ++i) {
    const cv::Mat_<float> logits = network.to_grid(channel_of(output, i), picture, grid);
    labels.setTo(i, logits > best);
    best = cv::max(best, logits);
  }
  return labels;
}

}  // namespace

SceneNetwork::SceneNetwork(const std::vector<NetworkCard>& cards) {
  for (const NetworkCard& card : cards) {
    if (card.kind == NetworkCard::Kind::kPlanes || card.kind == NetworkCard::Kind::kObjects ||
        gives(card.kind)) {
      throw Error(Error::Kind::kUsage,
                  card.source.string() +
                      ": the key kind has no place beside the other cards; give one each of depth, "
                      "normals and labels at most");
    }
    networks_.push_back(std::make_unique<Network>(card));
    if (card.kind != NetworkCard::Kind::kLabels) continue;
    for (const std::string& label : card.labels) {
      const bool planar =
          std::find(card.planar.begin(), card.planar.end(), label) != card.planar.end();
      planar_labels_.push_back(planar ? label : "");
      places_.push_back(is_one_of(kIndoors, label)    ? Place::kIndoors
                        : is_one_of(kOutdoors, label) ? Place::kOutdoors
                                                      : Place::kAnywhere);
    }
  }
}

Network* SceneNetwork::find(NetworkCard::Kind kind) const {
  for (const auto& network : networks_) {
    if (network->card().kind == kind) return network.get();
  }
  return nullptr;
}

// By what most pixels show that is of one kind of place only.
bool SceneNetwork::outdoors(const cv::Mat_<uchar>& labels) const {
  int sum = 0;
  for (const uchar label : labels) {
    sum += (places_[label] == Place::kOutdoors) - (places_[label] == Place::kIndoors);
  }
  return sum > 0;
}

SceneMaps SceneNetwork::look(const cv::Mat& bgr, const cv::Size& grid) {
  SceneMaps maps;
  for (const auto& network : networks_) {
    const NetworkAnswer answer = network->run(bgr);
    if (!answer.problem.empty()) {
      SceneMaps none;
      none.problem = network->card().name + ": " + answer.problem;
      return none;
    }
    const cv::Mat& output = answer.outputs[0];
    switch (network->card().kind) {
      case NetworkCard::Kind::kDepth:
        maps.depth = depth_of(*network, output, bgr.size(), grid);
        maps.sigma_scale = network->card().factor_sigma;
        break;
      case NetworkCard::Kind::kNormals:
        maps.normals = normals_of(*network, output, bgr.size(), grid);
        break;
      case NetworkCard::Kind::kLabels:
        maps.labels = labels_of(*network, output, bgr.size(), grid);
        break;
      case NetworkCard::Kind::kPlanes:
      case NetworkCard::Kind::kObjects:
        break;  // refused by the constructor
    }
  }
  if (const Network* depth = find(NetworkCard::Kind::kDepth);
      depth != nullptr && depth->card().outdoor_sigma > 0 && outdoors(maps.labels)) {
    maps.sigma_scale = depth->card().outdoor_sigma;
  }
  return maps;
}

}  // namespace cairn
