#pragma once

#include <cstdint>

#include "cairn/features/orb_extractor.h"
#include "cairn/mapping/mapper.h"
#include "cairn/perception/object_detector.h"
#include "cairn/tracking/initializer.h"
#include "cairn/tracking/tracker.h"

namespace cairn {

enum class Pace { kLockstep, kRealtime };

/// What the map is made of: points; and planes (pp); and Manhattan edges between planes (ppm);
/// points and objects (po); all of them, and what stands on what (full).
enum class Landmarks { kPoints, kPp, kPpm, kPo, kFull };

inline bool has_planes(Landmarks set) { return set != Landmarks::kPoints && set != Landmarks::kPo; }
inline bool has_objects(Landmarks set) { return set == Landmarks::kPo || set == Landmarks::kFull; }

/// Every setting of the system. Keys, units and ranges as users see them: option_table.h.
struct Options {
  Pace pace = Pace::kRealtime;
  Landmarks landmarks = Landmarks::kPpm;  ///< without a plane detector: points, whatever it says
  int threads = 0;                        ///< 0: all cores
  std::uint64_t seed = 0;
  double scale = 0;  ///< true lengths over those of the result without it; 0: not known
  OrbOptions features = {.count = 0};  ///< count 0: by the size of the picture
  InitializerOptions initialization;
  TrackingOptions tracking;
  MappingOptions mapping;
  bool look_at_every_frame = false;  ///< not only at keyframes; `process` waits for the detector
  ObjectDetectorOptions object_detector;
};

}  // namespace cairn
