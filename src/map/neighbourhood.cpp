#include "cairn/map/neighbourhood.h"

#include "cairn/map/id_set.h"

namespace cairn {

std::vector<KeyframeId> neighbourhood(const Map& map, KeyframeId id, const Neighbours& direct,
                                      const Neighbours& second) {
  std::vector<KeyframeId> found;
  IdSet<KeyframeId> taken;
  auto take = [&](KeyframeId k) {
    if (taken.insert(k)) found.push_back(k);
  };
  auto take_around = [&](KeyframeId k, const Neighbours& wanted) {
    for (const auto& [near, shared] : map.covisible(k, wanted.min_shared, wanted.most)) take(near);
  };
  take(id);
  take_around(id, direct);
  const std::size_t n = found.size();
  for (std::size_t i = 1; i < n; ++i) take_around(found[i], second);
  return found;
}

}  // namespace cairn
