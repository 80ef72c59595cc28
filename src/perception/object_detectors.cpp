#include "cairn/perception/object_detectors.h"

#include "cairn/geometry/error.h"
#include "cairn/perception/network_object_detector.h"
#include "cairn/perception/recorded_object_detector.h"

namespace cairn {

std::unique_ptr<ObjectDetector> make_object_detector(const std::string& name,
                                                     const ObjectDetectorSources& sources) {
  if (name != "recorded") {
    return std::make_unique<NetworkObjectDetector>(
        read_network_card(find_card(name), sources.models), sources.options);
  }
  if (sources.recorded.empty()) {
    throw Error(Error::Kind::kUsage,
                "objects: recorded needs a file of recorded detections (perception.jsonl)");
  }
  return std::make_unique<RecordedObjectDetector>(sources.recorded, sources.options);
}

}  // namespace cairn
