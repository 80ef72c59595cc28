#pragma once

#include <memory>

#include "cairn/map/frame.h"

namespace cairn::testing {

/// A frame with `count` keypoints in octave 0 whose descriptors count up.
inline std::shared_ptr<Frame> plain_frame(int count) {
  auto frame = std::make_shared<Frame>();
  for (int i = 0; i < count; ++i) {
    frame->features.keypoints.push_back({float(10 * i), 20, 0, 1, 0});
    frame->features.descriptors.push_back({static_cast<std::uint64_t>(i), 0, 0, 0});
  }
  frame->grid.build(frame->features.keypoints);
  return frame;
}

}  // namespace cairn::testing
