#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cairn/geometry/camera.h"
#include "cairn/perception/plane_detector.h"
#include "cairn/system/options.h"
#include "progress.h"

namespace cairn::app {

/// The card of the network that finds objects where nobody names another.
inline constexpr const char* kObjectsCard = "nanodet_plus_m";

/// What the user says of perception; empty: nothing.
struct PerceptionChoice {
  std::string landmarks;        ///< the set, by name
  std::string planes, objects;  ///< where they come from
  std::string models;           ///< folder of the networks
  std::string record;           ///< file to write detections to
  std::string planenet;         ///< card of --planes planenet
};

/// Sources must be of landmarks that the map has: throws Error(kUsage), also where a set that is
/// named has need of what is turned off. From a set that nobody named, that goes.
void settle_sources(const PerceptionChoice& choice, Landmarks& set);

/// The detectors of the set, as one; null for points alone. Where nobody asked for networks and
/// nobody has said where they are, the set (`options.landmarks`) loses what has need of them, and
/// the user is told. `recorded`: what `recorded` reads. Throws Error as make_plane_detector and
/// make_object_detector do.
std::unique_ptr<PlaneDetector> find_detector(const PerceptionChoice& choice,
                                             const std::filesystem::path& recorded,
                                             const Camera& camera, Options& options,
                                             Progress& progress);

}  // namespace cairn::app
