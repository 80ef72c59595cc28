#include "cairn/features/retrieval.h"

#include <algorithm>
#include <cmath>

namespace cairn {

KeyframeRetrieval::KeyframeRetrieval() { clear(); }

void KeyframeRetrieval::clear() {
  words_.assign(std::size_t{kTables} << kBits, {});
  chunks_.clear();
  slots_.clear();
  slot_of_.clear();
}

void KeyframeRetrieval::list(std::uint32_t word, std::uint32_t slot) {
  Word& entry = words_[word];
  const std::size_t used = entry.count % Chunk{}.slots.size();
  if (entry.count > 0) {
    // A picture is listed once under a word, however many of its features have it.
    const Chunk& newest = chunks_[entry.head];
    if (newest.slots[used == 0 ? newest.slots.size() - 1 : used - 1] == slot) return;
  }
  if (used == 0) {
    // Doubling, as push_back does, would waste too much of what is meant to be small.
    if (chunks_.size() == chunks_.capacity()) chunks_.reserve(chunks_.size() * 5 / 4 + 4096);
    chunks_.push_back({entry.head, {kNone, kNone, kNone}});
    entry.head = static_cast<std::uint32_t>(chunks_.size() - 1);
  }
  chunks_[entry.head].slots[used] = slot;
  ++entry.count;
}

void KeyframeRetrieval::add(Id id, const Features& features) {
  remove(id);
  const auto slot = static_cast<std::uint32_t>(slots_.size());
  slots_.push_back({id, static_cast<std::uint32_t>(features.size()), true});
  slot_of_[id] = slot;
  for (const Descriptor& descriptor : features.descriptors) {
    for (int table = 0; table < kTables; ++table) list(word_of(descriptor, table), slot);
  }
}

void KeyframeRetrieval::remove(Id id) {
  const auto found = slot_of_.find(id);
  if (found == slot_of_.end()) return;
  slots_[found->second].alive = false;
  slot_of_.erase(found);
  constexpr std::size_t kWorthIt = 64;
  if (slots_.size() >= 2 * std::max(slot_of_.size(), kWorthIt)) compact();
}

/// Lists again what is still there, in the same order.
void KeyframeRetrieval::compact() {
  std::vector<std::uint32_t> new_slot(slots_.size(), kNone);
  std::vector<Slot> alive;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].alive) continue;
    new_slot[i] = static_cast<std::uint32_t>(alive.size());
    slot_of_[slots_[i].id] = new_slot[i];
    alive.push_back(slots_[i]);
  }
  slots_ = std::move(alive);
  const std::vector<Chunk> old_chunks = std::move(chunks_);
  chunks_.clear();
  std::vector<std::uint32_t> listed;
  for (std::uint32_t word = 0; word < words_.size(); ++word) {
    listed.clear();
    for (std::uint32_t i = words_[word].head; i != kNone; i = old_chunks[i].next) {
      const auto& slots = old_chunks[i].slots;
      for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) {
        if (*slot != kNone && new_slot[*slot] != kNone) listed.push_back(new_slot[*slot]);
      }
    }
    words_[word] = {};
    for (auto slot = listed.rbegin(); slot != listed.rend(); ++slot) list(word, *slot);
  }
}

void KeyframeRetrieval::vote(const Word& word, std::vector<float>& votes) const {
  if (word.count == 0) return;
  const float all = static_cast<float>(slots_.size()) + 1;
  const float weight = std::log(all / static_cast<float>(word.count)) / std::log(all);
  for (std::uint32_t i = word.head; i != kNone; i = chunks_[i].next) {
    for (const std::uint32_t slot : chunks_[i].slots) {
      if (slot != kNone) votes[slot] += weight;
    }
  }
}

std::vector<KeyframeRetrieval::Candidate> KeyframeRetrieval::query(const Features& features,
                                                                   std::size_t max_results) const {
  std::vector<float> votes(slots_.size(), 0.0F);
  for (const Descriptor& descriptor : features.descriptors) {
    for (int table = 0; table < kTables; ++table) vote(words_[word_of(descriptor, table)], votes);
  }
  std::vector<Candidate> candidates;
  const auto own = static_cast<float>(features.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].alive || votes[i] <= 0) continue;
    const float most = kTables * std::sqrt(own * static_cast<float>(slots_[i].features));
    candidates.push_back({slots_[i].id, votes[i] / most});
  }
  const std::size_t count = std::min(max_results, candidates.size());
  std::partial_sort(candidates.begin(), candidates.begin() + count, candidates.end(),
                    [](const Candidate& a, const Candidate& b) {
                      return a.score != b.score ? a.score > b.score : a.id < b.id;
                    });
  candidates.resize(count);
  return candidates;
}

std::size_t KeyframeRetrieval::memory() const {
  return words_.capacity() * sizeof(Word) + chunks_.capacity() * sizeof(Chunk) +
         slots_.capacity() * sizeof(Slot) + slot_of_.size() * 32;
}

}  // namespace cairn
