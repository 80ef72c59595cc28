#include "cairn/map/covisibility.h"

#include <algorithm>
#include <cassert>

namespace cairn {

void Covisibility::count(KeyframeId a, KeyframeId b, int change) {
  count_one_way(a, b, change);
  count_one_way(b, a, change);
}

void Covisibility::count_one_way(KeyframeId from, KeyframeId to, int change) {
  if (from.slot >= shared_.size()) shared_.resize(from.slot + 1);
  std::vector<Shared>& row = shared_[from.slot];
  const auto at = std::lower_bound(row.begin(), row.end(), to,
                                   [](const Shared& s, KeyframeId id) { return s.first < id; });
  if (at == row.end() || at->first != to) {
    assert(change > 0);
    row.insert(at, {to, change});
  } else if ((at->second += change) == 0) {
    row.erase(at);
  }
}

std::span<const Covisibility::Shared> Covisibility::of(KeyframeId id) const {
  return id.slot < shared_.size() ? shared_[id.slot] : std::span<const Shared>();
}

}  // namespace cairn
