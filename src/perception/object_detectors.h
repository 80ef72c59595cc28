#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cairn/perception/object_detector.h"

namespace cairn {

/// What the detectors of objects are made from.
struct ObjectDetectorSources {
  std::filesystem::path recorded;  ///< of `recorded`: perception.jsonl
  std::filesystem::path models;    ///< folder of networks; empty: find_models
  ObjectDetectorOptions options;
};

/// The detector of this name: `recorded`, or the name or path of a card of kind objects
/// (find_card). Throws Error: kUsage for names that are neither, cards with mistakes and a
/// recording that is not given, kInput for files that cannot be used.
std::unique_ptr<ObjectDetector> make_object_detector(const std::string& name,
                                                     const ObjectDetectorSources& sources = {});

}  // namespace cairn
