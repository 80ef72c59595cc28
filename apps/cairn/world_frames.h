#pragma once

#include <cmath>
#include <string>

#include "cairn/datasets/frame_source.h"
#include "cairn/synthetic/world.h"

namespace cairn::app {

/// A synthetic world as it is filmed, from the start of its path to the end; nothing is stored.
class WorldFrames : public FrameSource {
 public:
  /// World and camera are used where they are.
  WorldFrames(const World& world, const Camera& camera, const RenderOptions& options)
      : world_(world), camera_(camera), options_(options) {}

  bool next(SourceFrame& frame) override {
    if (index_ == *size()) return false;
    const double t = double(index_++) / world_.scene().fps;
    frame = {t, world_.render(camera_, t, options_), std::to_string(index_), ""};
    return true;
  }
  std::optional<std::size_t> size() const override {
    return std::size_t(std::lround(world_.scene().duration * world_.scene().fps));
  }

 private:
  const World& world_;
  const Camera& camera_;
  RenderOptions options_;
  std::size_t index_ = 0;
};

}  // namespace cairn::app
