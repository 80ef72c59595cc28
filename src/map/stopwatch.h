#pragma once

#include <chrono>
#include <vector>

namespace cairn {

class Stopwatch {
 public:
  /// Since it was made, or since the last lap.
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  double lap() {
    const double ms = milliseconds();
    start_ = Clock::now();
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Appends how many milliseconds it has lived.
class Timed {
 public:
  explicit Timed(std::vector<double>& list) : list_(list) {}
  ~Timed() { list_.push_back(watch_.milliseconds()); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  std::vector<double>& list_;
  Stopwatch watch_;
};

}  // namespace cairn
