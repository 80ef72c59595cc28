#pragma once

#include <cstdint>
#include <initializer_list>

namespace cairn {

/// Random numbers that are looked up, not drawn: each has a key, and one key always gives the same
/// number. So what is random about one thing at one time depends on nothing else: not on the order
/// of calls, not on threads. Hash: the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
class HashedNoise {
 public:
  /// Time goes in ticks of this many seconds.
  static constexpr double kTick = 1.0 / 30;

  using Key = std::initializer_list<std::uint64_t>;

  explicit HashedNoise(std::uint64_t seed) : state_(mix(seed)) {}

  /// Noise of its own for what `key` names: a purpose, a thing, an edge of a box.
  HashedNoise of(Key key) const;

  double uniform(std::int64_t index = 0) const;  ///< in [0, 1)
  double normal(std::int64_t index = 0) const;   ///< mean 0, variance 1

  /// Normal at any time, and correlated over time: exp(−|Δt| / seconds), as of a first-order
  /// autoregressive process, of which it is the moving-average form over all ticks that still
  /// matter. 0 seconds: white from tick to tick.
  double correlated(double time, double seconds) const;
  /// The same, made uniform in [0, 1).
  double correlated_uniform(double time, double seconds) const;

  static std::int64_t tick(double time);

 private:
  HashedNoise() = default;
  static std::uint64_t mix(std::uint64_t x);
  std::uint64_t bits(std::int64_t index) const { return mix(state_ + mix(std::uint64_t(index))); }

  std::uint64_t state_ = 0;
};

}  // namespace cairn
