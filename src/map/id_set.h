#pragma once

#include <vector>

namespace cairn {

/// Ids of things that are alive at the same time, so that a slot stands for one. Takes the place of
/// sorting, where ids come many times.
template <class Id>
class IdSet {
 public:
  /// Whether it was not in yet.
  bool insert(Id id) {
    if (id.slot >= taken_.size()) taken_.resize(id.slot + 1, false);
    const bool is_new = !taken_[id.slot];
    taken_[id.slot] = true;
    return is_new;
  }

 private:
  std::vector<bool> taken_;
};

}  // namespace cairn
