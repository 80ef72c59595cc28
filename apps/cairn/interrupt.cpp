#include "interrupt.h"

#include <csignal>
#include <ctime>

namespace cairn::app {
namespace {

// One press can arrive twice: `timeout` and some service managers send it to the process and again
// to its group.
constexpr double kSamePress = 0.5;  // seconds

volatile std::sig_atomic_t interrupt_seen = 0;
volatile double last_seen = -1;

double now() {  // safe to call from a signal handler
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

void on_interrupt(int signal) {
  const double time = now();
  if (last_seen >= 0 && time - last_seen < kSamePress) return;
  last_seen = time;
  if (interrupt_seen != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  interrupt_seen = 1;
}

}  // namespace

void remember_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return interrupt_seen != 0; }

void forget_interrupt() { interrupt_seen = 0; }

}  // namespace cairn::app
