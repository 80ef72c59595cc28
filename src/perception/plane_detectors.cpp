#include "cairn/perception/plane_detectors.h"

#include "cairn/geometry/error.h"
#include "cairn/perception/recorded_plane_detector.h"

namespace cairn {
namespace {

SceneNetwork scene_network(const std::vector<std::string>& names,
                           const std::filesystem::path& models) {
  std::vector<NetworkCard> cards;
  for (const std::string& name : names) cards.push_back(read_network_card(find_card(name), models));
  return SceneNetwork(cards);
}

}  // namespace

std::unique_ptr<PlaneDetector> make_plane_detector(const std::string& kind, const Camera& camera,
                                                   const PlaneDetectorSources& sources) {
  if (kind == "network") {
    return std::make_unique<NetworkPlaneDetector>(
        scene_network(sources.network_cards, sources.models), camera, sources.network);
  }
  if (kind == "rgbd") {
    std::optional<SceneNetwork> labels;
    if (!sources.labels_card.empty()) labels = scene_network({sources.labels_card}, sources.models);
    return std::make_unique<RgbdPlaneDetector>(camera, std::move(labels), sources.rgbd);
  }
  if (kind == "planenet") {
    if (sources.planenet_card.empty()) {
      throw Error(Error::Kind::kUsage, "planes: planenet needs a card of kind planes; name one");
    }
    return std::make_unique<PlanenetDetector>(
        read_network_card(find_card(sources.planenet_card), sources.models), sources.planenet);
  }
  if (kind == "recorded") {
    if (sources.recorded.empty()) {
      throw Error(Error::Kind::kUsage,
                  "planes: recorded needs a file of recorded detections (perception.jsonl)");
    }
    return std::make_unique<RecordedPlaneDetector>(sources.recorded);
  }
  throw Error(Error::Kind::kUsage, "planes: there is no detector \"" + kind +
                                       "\"; give network, rgbd, planenet or recorded");
}

}  // namespace cairn
