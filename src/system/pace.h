#pragma once

#include <optional>

namespace cairn {

/// Time as the pacer sees it, in seconds from any start; tests bring their own.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() const = 0;
  virtual void sleep_until(double time) = 0;

  /// The steady clock of the machine.
  static Clock& machine();
};

/// Plays a recorded sequence at its own rate: frame i is due when as much time has passed since the
/// first frame as on the recording. A frame that is late by more than a frame period, while the one
/// after it is due as well, is given up, so that the tracker sees the present and not the past.
class RealtimePacer {
 public:
  explicit RealtimePacer(Clock& clock = Clock::machine()) : clock_(clock) {}

  enum class Verdict { kProcess, kDrop };
  /// Waits until the frame is due. `timestamp`: seconds, rising. `next`: the timestamp of the
  /// successor where it is known already; without a successor no frame is dropped.
  Verdict wait_for(double timestamp, std::optional<double> next);

 private:
  Clock& clock_;
  std::optional<double> offset_;    ///< clock time minus timestamp
  std::optional<double> previous_;  ///< timestamp of the frame before
};

}  // namespace cairn
