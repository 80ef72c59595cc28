#pragma once

#include <array>
#include <cstdint>

namespace cairn {

/// SplitMix64 (Steele, Lea, Flood 2014) with the draws that RANSAC needs. The standard library's
/// distributions differ between implementations; this one gives the same numbers everywhere.
class Sampler {
 public:
  explicit Sampler(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }

  /// A whole number in [0, n), n > 0.
  int below(int n) {
    return static_cast<int>(((next() >> 32) * static_cast<std::uint64_t>(n)) >> 32);
  }

  /// A number in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

  /// N different numbers in [0, n), n >= N.
  template <int N>
  std::array<int, N> distinct(int n) {
    std::array<int, N> drawn{};
    for (int i = 0; i < N; ++i) {
      bool fresh = false;
      while (!fresh) {
        drawn[i] = below(n);
        fresh = true;
        for (int j = 0; j < i; ++j) fresh = fresh && drawn[j] != drawn[i];
      }
    }
    return drawn;
  }

 private:
  std::uint64_t state_;
};

}  // namespace cairn
