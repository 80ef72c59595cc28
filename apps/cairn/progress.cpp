#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace cairn::app {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr std::size_t kBarWidth = 24;
constexpr double kFirstRate = 0.2;  // seconds before it means anything

}  // namespace

Progress::Progress(bool wanted, std::optional<std::size_t> all, std::string unit)
    : visible_(wanted && isatty(STDERR_FILENO) != 0),
      all_(all),
      unit_(std::move(unit)),
      start_(std::chrono::steady_clock::now()),
      last_drawn_(start_) {}

Progress::~Progress() { clear(); }

void Progress::show(const FrameRecord& record) {
  keyframes_ += record.keyframe;
  show(std::string(to_string(record.state)) + "  " + std::to_string(keyframes_) + " keyframes");
}

void Progress::show(const std::string& what) {
  ++seen_;
  const auto now = std::chrono::steady_clock::now();
  if (!visible_ || (drawn_ && now - last_drawn_ < kRedraw)) return;
  last_drawn_ = now;
  drawn_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double per_second = seconds > kFirstRate ? double(seen_) / seconds : 0;
  std::string bar(kBarWidth, '.'), all;
  if (all_ && *all_ > 0) {
    std::fill_n(bar.begin(), std::min<std::size_t>(seen_ * kBarWidth / *all_, kBarWidth), '#');
    all = "of " + std::to_string(*all_) + " ";
  }
  std::fprintf(stderr, "\r\033[K[%s] %zu %s%s  %.1f/s  %s", bar.c_str(), seen_, all.c_str(),
               unit_.c_str(), per_second, what.c_str());
  std::fflush(stderr);
}

void Progress::note(const std::string& sentence) {
  clear();
  std::fprintf(stderr, "cairn: %s\n", sentence.c_str());
}

void Progress::clear() {
  if (!drawn_) return;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace cairn::app
