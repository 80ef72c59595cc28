#include "cairn/evaluation/association.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

// Index of the value nearest to `wanted`; of two equally near ones the first.
std::size_t nearest(std::span<const double> rising, double wanted) {
  const auto after = std::lower_bound(rising.begin(), rising.end(), wanted);
  if (after == rising.begin()) return 0;
  const std::size_t j = std::size_t(after - rising.begin());
  if (after == rising.end()) return j - 1;
  return std::abs(rising[j] - wanted) < std::abs(rising[j - 1] - wanted) ? j : j - 1;
}

}  // namespace

std::vector<IndexPair> associate(std::span<const double> first, std::span<const double> second,
                                 double max_difference, double offset) {
  std::vector<double> shifted(second.begin(), second.end());
  for (double& t : shifted) t += offset;
  const bool second_longer = shifted.size() > first.size();
  const std::span<const double> few = second_longer ? first : std::span<const double>(shifted);
  const std::span<const double> many = second_longer ? std::span<const double>(shifted) : first;
  std::vector<IndexPair> pairs;  // (few, many)
  if (many.empty()) return pairs;
  const auto difference = [&](const IndexPair& p) {
    return std::abs(few[p.first] - many[p.second]);
  };
  for (std::size_t i = 0; i < few.size(); ++i) {
    const IndexPair pair{i, nearest(many, few[i])};
    if (!(difference(pair) <= max_difference)) continue;
    if (pairs.empty() || pairs.back().second != pair.second) {
      pairs.push_back(pair);
    } else if (difference(pair) < difference(pairs.back())) {
      pairs.back() = pair;
    }
  }
  if (!second_longer) {
    for (IndexPair& pair : pairs) std::swap(pair.first, pair.second);
  }
  return pairs;
}

}  // namespace cairn
