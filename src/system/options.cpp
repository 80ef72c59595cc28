#include "cairn/system/options.h"

#include "cairn/system/option_table.h"

namespace cairn {

// One line a key, in the order in which `cairn config` prints them; keys of one group stand
// together.
OptionTable::OptionTable(Options& o) {
  // clang-format off
  add("pace", o.pace, {{"realtime", Pace::kRealtime}, {"lockstep", Pace::kLockstep}}, "realtime: frames at their own rate; lockstep: repeatable to the byte");
  add("threads", o.threads, "threads", {0, 1024}, "threads to work with; 0: all cores");
  add("seed", o.seed, "what all random choices are drawn from");

  add("features.count", o.features.count, "keypoints", {100, 20000}, "keypoints a picture, about");
  add("features.levels", o.features.levels, "levels", {1, 16}, "levels of the image pyramid");
  add("features.scale", o.features.scale, "", {1.01, 2.0}, "size ratio between two levels of the pyramid");
  add("features.threshold", o.features.threshold, "grey levels", {1, 254}, "FAST: difference that makes a good corner");
  add("features.weak_threshold", o.features.weak_threshold, "grey levels", {1, 254}, "FAST: accepted where a region has no good corner");
  // clang-format on
}

}  // namespace cairn
