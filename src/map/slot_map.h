#pragma once

#include <cassert>
#include <deque>
#include <utility>
#include <vector>

#include "cairn/map/ids.h"

namespace cairn {

/// Elements of type T behind ids. Slots of erased elements are used again, so memory follows the
/// number of elements alive; references stay valid until their element is erased. Iteration is in
/// order of slots, which depends on the history of calls alone: runs are repeatable.
template <class T, class IdType>
class SlotMap {
 public:
  IdType insert(T value) {
    if (free_.empty()) {
      assert(slots_.size() < IdType::kNone);
      slots_.emplace_back();
      free_.push_back(static_cast<std::uint32_t>(slots_.size() - 1));
    }
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    slots_[slot].value = std::move(value);
    slots_[slot].alive = 1;
    ++size_;
    return {slot, slots_[slot].generation};
  }

  void erase(IdType id) {
    assert(contains(id));
    Slot& slot = slots_[id.slot];
    slot.value = T{};
    slot.alive = 0;
    ++slot.generation;
    free_.push_back(id.slot);
    --size_;
  }

  bool contains(IdType id) const { return find(id) != nullptr; }

  T* find(IdType id) { return const_cast<T*>(std::as_const(*this).find(id)); }
  const T* find(IdType id) const {
    if (id.slot >= slots_.size()) return nullptr;
    const Slot& slot = slots_[id.slot];
    return slot.alive && IdType{id.slot, slot.generation} == id ? &slot.value : nullptr;
  }

  T& operator[](IdType id) {
    T* value = find(id);
    assert(value != nullptr);
    return *value;
  }
  const T& operator[](IdType id) const {
    const T* value = find(id);
    assert(value != nullptr);
    return *value;
  }

  /// visit(id, element) for each element, in order of slots; the element may be erased in the call.
  template <class Visitor>
  void for_each(Visitor&& visit) {
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i].alive) visit(IdType{i, slots_[i].generation}, slots_[i].value);
    }
  }
  template <class Visitor>
  void for_each(Visitor&& visit) const {
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i].alive) visit(IdType{i, slots_[i].generation}, slots_[i].value);
    }
  }

  std::size_t size() const { return size_; }
  /// The slots of all ids are below.
  std::size_t slots() const { return slots_.size(); }
  bool empty() const { return size_ == 0; }

 private:
  struct Slot {
    T value;
    std::uint32_t generation : 31 = 0;
    std::uint32_t alive : 1 = 0;
  };
  std::deque<Slot> slots_;
  std::vector<std::uint32_t> free_;
  std::size_t size_ = 0;
};

}  // namespace cairn
