#include "cairn/system/pace.h"

#include <chrono>
#include <thread>

namespace cairn {
namespace {

class SteadyClock : public Clock {
 public:
  double now() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  void sleep_until(double time) override {
    std::this_thread::sleep_until(start_ +
                                  std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                      std::chrono::duration<double>(time)));
  }

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A recording with a hole (a camera that was paused) does not make anyone wait for longer than
// this.
constexpr double kLongestWait = 2.0;

}  // namespace

Clock& Clock::machine() {
  static SteadyClock clock;
  return clock;
}

RealtimePacer::Verdict RealtimePacer::wait_for(double timestamp, std::optional<double> next) {
  const double now = clock_.now();
  if (!offset_) offset_ = now - timestamp;
  double due = timestamp + *offset_;
  if (due - now > kLongestWait) {
    *offset_ -= due - now - kLongestWait;
    due = now + kLongestWait;
  }
  const std::optional<double> before = previous_;
  previous_ = timestamp;
  if (now < due) {
    clock_.sleep_until(due);
    return Verdict::kProcess;
  }
  const bool late = before && now - due > timestamp - *before;
  const bool successor_due = next && now >= *next + *offset_;
  return late && successor_due ? Verdict::kDrop : Verdict::kProcess;
}

}  // namespace cairn
