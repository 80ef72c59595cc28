#include "cairn/synthetic/hashed_noise.h"

#include <cmath>

namespace cairn {
namespace {

// Ticks that weigh less than this in a correlated number are left out.
constexpr double kForgotten = 0.01;

}  // namespace

std::uint64_t HashedNoise::mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

HashedNoise HashedNoise::of(Key key) const {
  HashedNoise result;
  result.state_ = state_;
  for (const std::uint64_t part : key) result.state_ = mix(result.state_ ^ mix(part));
  return result;
}

double HashedNoise::uniform(std::int64_t index) const {
  return double(bits(index) >> 11) * 0x1.0p-53;
}

double HashedNoise::normal(std::int64_t index) const {  // Box and Muller
  const std::uint64_t drawn = bits(index);
  const double u = (double(drawn >> 32) + 1) * 0x1.0p-32;
  const double v = double(drawn & 0xffffffffu) * 0x1.0p-32;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
}

std::int64_t HashedNoise::tick(double time) { return std::llround(time / kTick); }

double HashedNoise::correlated(double time, double seconds) const {
  const std::int64_t now = tick(time);
  if (seconds <= 0) return normal(now);
  const double decay = std::exp(-kTick / seconds);
  const auto remembered = std::int64_t(std::log(kForgotten) / std::log(decay)) + 1;
  double sum = 0, squares = 0, weight = 1;
  for (std::int64_t back = 0; back < remembered; ++back, weight *= decay) {
    sum += weight * normal(now - back);
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

double HashedNoise::correlated_uniform(double time, double seconds) const {
  return 0.5 * std::erfc(-correlated(time, seconds) / std::sqrt(2.0));
}

}  // namespace cairn
