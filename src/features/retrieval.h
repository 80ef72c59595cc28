#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cairn/features/features.h"

namespace cairn {

/// Finds pictures that look like a given one, without a vocabulary: locality-sensitive hashing
/// (Indyk and Motwani 1998) of ORB descriptors. Each of two tables takes 18 bits of a descriptor as
/// its word; a picture is listed under the words of its features. Descriptors of one scene point
/// differ in about an eighth of their bits, so a fifth of them share a word; others hardly ever do.
/// Votes are weighted by how rare a word is, as in text retrieval (tf-idf). More tables or shorter
/// words find hardly more (7-Scenes) and take several times as long.
///
/// About 11 kB a picture of 1000 features, up to 16 kB while memory grows, and 4 MB. A query costs
/// as much as the lists under its words are long: 1.5 ms with 500 pictures of one room. The same
/// calls give the same results. Not for concurrent use.
class KeyframeRetrieval {
 public:
  using Id = std::uint32_t;

  struct Candidate {
    Id id = 0;
    float score = 0;  ///< 0: nothing alike; about 1: the same picture
  };

  KeyframeRetrieval();

  /// A picture that is there already is replaced.
  void add(Id id, const Features& features);
  void remove(Id id);  ///< nothing happens if it is not there
  void clear();
  bool contains(Id id) const { return slot_of_.contains(id); }
  std::size_t size() const { return slot_of_.size(); }

  /// The pictures most alike, best first; of equal ones the smaller id first. Those without any
  /// vote are left out.
  std::vector<Candidate> query(const Features& features, std::size_t max_results) const;

  /// Memory held, in bytes.
  std::size_t memory() const;

 private:
  static constexpr int kTables = 2;
  static constexpr int kBits = 18;
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Part of a list of slots; lists are linked backwards, the newest part first.
  struct Chunk {
    std::uint32_t next = kNone;
    std::array<std::uint32_t, 3> slots = {kNone, kNone, kNone};
  };
  struct Word {
    std::uint32_t head = kNone;
    std::uint32_t count = 0;  ///< pictures listed, removed ones included
  };
  /// A picture. Removed ones stay in the lists until there are as many as others.
  struct Slot {
    Id id = 0;
    std::uint32_t features = 0;
    bool alive = false;
  };

  static std::uint32_t word_of(const Descriptor& descriptor, int table) {
    return (static_cast<std::uint32_t>(table) << kBits) |
           ((descriptor[0] >> (table * kBits)) & ((1U << kBits) - 1));
  }
  void list(std::uint32_t word, std::uint32_t slot);
  void compact();
  void vote(const Word& word, std::vector<float>& votes) const;

  std::vector<Word> words_;
  std::vector<Chunk> chunks_;
  std::vector<Slot> slots_;
  std::unordered_map<Id, std::uint32_t> slot_of_;
};

}  // namespace cairn
