#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "cairn/map/frame_record.h"

namespace cairn::app {

/// One line on a terminal that is written over and over; silent where there is no terminal.
class Progress {
 public:
  Progress(bool wanted, std::optional<std::size_t> all, std::string unit = "frames");
  ~Progress();

  void show(const FrameRecord& record);
  /// One more; `what` says what is going on.
  void show(const std::string& what);
  /// A line of its own, for what happens once.
  void note(const std::string& sentence);

 private:
  void clear();

  bool visible_;
  bool drawn_ = false;
  std::optional<std::size_t> all_;
  std::string unit_;
  std::size_t seen_ = 0, keyframes_ = 0;
  std::chrono::steady_clock::time_point start_, last_drawn_;
};

}  // namespace cairn::app
