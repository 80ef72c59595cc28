#pragma once

#include <unordered_map>
#include <vector>

#include "cairn/synthetic/mesh.h"

namespace cairn {

/// Where the light of a vertex is taken: a little off the surface and towards the middle of the
/// triangles around it, because corners of things lie in the corners of others.
struct Sample {
  Eigen::Vector3f position, normal;
};

/// One for each vertex.
std::vector<Sample> samples_of(const Mesh& mesh);

/// Some of many samples, so that near each there is a chosen one that faces the same way: where
/// something that changes slowly over a surface is worked out. After the irradiance cache of Ward,
/// Rubinstein, Clear (1988), whose weights fall with distance, turn and depth as these do.
class SampleSubset {
 public:
  /// `spacing`: metres between those chosen.
  SampleSubset(const std::vector<Sample>& samples, float spacing);

  /// Indices of samples.
  const std::vector<std::uint32_t>& chosen() const { return chosen_; }

  /// Calls `use(index into chosen(), weight > 0)` for those around a sample.
  template <typename Function>
  void visit(const Sample& sample, const Function& use) const {
    const Eigen::Vector3i middle = cell(sample.position);
    for (int i = 0; i < 27; ++i) {
      const auto at =
          cells_.find(key(middle + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
      if (at == cells_.end()) continue;
      for (const auto& [index, other] : at->second) {
        const float w = weight(sample, other);
        if (w > 0) use(std::size_t(index), w);
      }
    }
  }

 private:
  Eigen::Vector3i cell(const Eigen::Vector3f& position) const;
  static std::uint64_t key(const Eigen::Vector3i& cell);
  float weight(const Sample& a, const Sample& b) const;

  float reach_;
  std::vector<std::uint32_t> chosen_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<std::uint32_t, Sample>>> cells_;
};

}  // namespace cairn
