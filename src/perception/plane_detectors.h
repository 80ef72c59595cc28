#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/perception/network_plane_detector.h"
#include "cairn/perception/plane_detector.h"
#include "cairn/perception/planenet_detector.h"
#include "cairn/perception/rgbd_plane_detector.h"

namespace cairn {

/// What the detectors of planes are made from. Cards: names or paths (find_card).
struct PlaneDetectorSources {
  std::vector<std::string> network_cards{"meter_xxs_nyu", "mosaic_ade20k31"};  ///< of `network`
  std::string labels_card;         ///< of `rgbd`, a card of kind labels; empty: no labels
  std::string planenet_card;       ///< of `planenet`
  std::filesystem::path recorded;  ///< of `recorded`: perception.jsonl
  std::filesystem::path models;    ///< folder of networks; empty: find_models
  NetworkPlaneOptions network;
  RgbdPlaneOptions rgbd;
  PlanenetOptions planenet;
};

/// The detector `kind`: network, rgbd, planenet, recorded. `camera`: of all pictures, with its
/// lens. Throws Error: kUsage for another kind, cards with mistakes and sources that are not given,
/// kInput for files that cannot be used.
std::unique_ptr<PlaneDetector> make_plane_detector(const std::string& kind, const Camera& camera,
                                                   const PlaneDetectorSources& sources = {});

}  // namespace cairn
