#include "perception_choice.h"

#include <cstdlib>

#include "cairn/geometry/error.h"
#include "cairn/perception/combined_detector.h"
#include "cairn/perception/object_detectors.h"
#include "cairn/perception/plane_detectors.h"
#include "cairn/perception/recording_detector.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLabelsCard = "mosaic_ade20k31";

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(Error::Kind::kUsage, sentence);
}

bool networks_known() {
  const char* folder = std::getenv("CAIRN_MODELS");
  return folder != nullptr && *folder != 0;
}

Landmarks without_planes(Landmarks set) {
  return has_objects(set) ? Landmarks::kPo : Landmarks::kPoints;
}

Landmarks without_objects(Landmarks set) {
  if (!has_objects(set)) return set;
  return has_planes(set) ? Landmarks::kPpm : Landmarks::kPoints;
}

std::string described(Landmarks set) {
  if (set == Landmarks::kPoints) return "points";
  if (set == Landmarks::kPo) return "points and objects";
  return has_objects(set) ? "points, planes and objects" : "points and planes";
}

std::string name_of(Landmarks set) {
  switch (set) {
    case Landmarks::kPoints:
      return "points";
    case Landmarks::kPp:
      return "pp";
    case Landmarks::kPpm:
      return "ppm";
    case Landmarks::kPo:
      return "po";
    case Landmarks::kFull:
      return "full";
  }
  return "";
}

bool given(const std::string& source) { return !source.empty() && source != "none"; }

// Networks that nobody asked for may be missing; anything else that is wrong is said.
void settle_networks(const PerceptionChoice& choice, Landmarks& set, Progress& progress) {
  if (!choice.landmarks.empty() || !choice.models.empty() || networks_known()) return;
  const Landmarks wanted = set;
  if (choice.planes.empty() && choice.objects != "recorded" && has_planes(wanted))
    set = without_planes(set);
  if (choice.objects.empty() && choice.planes != "recorded" && has_objects(wanted))
    set = without_objects(set);
  if (set == wanted) return;
  progress.note("no networks are given (--models, CAIRN_MODELS), so the map is of " +
                described(set) + (set == Landmarks::kPoints ? " alone" : ""));
}

// What nobody named is in the recording, if the other is, and else comes from a network.
std::string source(const std::string& named, const std::string& other, const char* network) {
  if (!named.empty()) return named;
  return other == "recorded" ? other : network;
}

std::unique_ptr<PlaneDetector> find_planes(const PerceptionChoice& choice, const fs::path& recorded,
                                           const Camera& camera) {
  PlaneDetectorSources sources;
  sources.models = choice.models;
  sources.recorded = recorded;
  sources.planenet_card = choice.planenet;
  // Depth has no names; planes get some where there is a network that knows them.
  if (!choice.models.empty() || networks_known()) sources.labels_card = kLabelsCard;
  return make_plane_detector(source(choice.planes, choice.objects, "network"), camera, sources);
}

std::unique_ptr<ObjectDetector> find_objects(const PerceptionChoice& choice,
                                             const fs::path& recorded, const Options& options) {
  ObjectDetectorSources sources;
  sources.models = choice.models;
  sources.recorded = recorded;
  sources.options = options.object_detector;
  return make_object_detector(source(choice.objects, choice.planes, kObjectsCard), sources);
}

}  // namespace

void settle_sources(const PerceptionChoice& choice, Landmarks& set) {
  if (given(choice.planes) && !has_planes(set)) {
    refuse("--planes " + choice.planes + ": a map of " + described(set) +
           " has no planes; give --landmarks " + (has_objects(set) ? "full" : "pp"));
  }
  if (given(choice.objects) && !has_objects(set)) {
    refuse("--objects " + choice.objects + ": a map of " + described(set) +
           " has no objects; give --landmarks " + (has_planes(set) ? "full" : "po"));
  }
  const auto turn_off = [&](const std::string& what, Landmarks left) {
    if (!choice.landmarks.empty()) {
      refuse("--landmarks " + choice.landmarks + ": without " + what + " there is only a map of " +
             described(left) + "; give --landmarks " + name_of(left) + ", or leave out --" + what +
             " none");
    }
    set = left;
  };
  if (choice.planes == "none" && has_planes(set)) turn_off("planes", without_planes(set));
  if (choice.objects == "none" && has_objects(set)) turn_off("objects", without_objects(set));
}

std::unique_ptr<PlaneDetector> find_detector(const PerceptionChoice& choice,
                                             const fs::path& recorded, const Camera& camera,
                                             Options& options, Progress& progress) {
  settle_networks(choice, options.landmarks, progress);
  const Landmarks set = options.landmarks;
  if (set == Landmarks::kPoints) return nullptr;
  std::unique_ptr<PlaneDetector> detector;
  if (has_planes(set)) detector = find_planes(choice, recorded, camera);
  if (has_objects(set)) {
    detector = std::make_unique<CombinedDetector>(std::move(detector),
                                                  find_objects(choice, recorded, options));
  }
  if (choice.record.empty()) return detector;
  return std::make_unique<RecordingDetector>(std::move(detector), choice.record);
}

}  // namespace cairn::app
