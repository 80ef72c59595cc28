#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cairn/features/features.h"

namespace cairn {

struct SimilarPicture {
  std::size_t index = 0;  ///< into the pictures given
  float score = 0;        ///< 0: nothing alike; about 1: the same picture
};

/// Ranks pictures by how much they look like a given one, without a vocabulary: locality-sensitive
/// hashing (Indyk and Motwani 1998) of ORB descriptors. Twice 18 bits of a descriptor are its two
/// words. Descriptors of one scene point differ in about an eighth of their bits, so a fifth of
/// them share a word; others hardly ever do. Votes are weighted by how rare a word is, as in text
/// retrieval (tf-idf). More or shorter words find hardly more (7-Scenes).
///
/// Best first, of equal ones the earlier first; those without any vote are left out. Keeps no
/// index: who is lost can wait the 4 ms that a thousand pictures take, and a map is smaller
/// without.
std::vector<SimilarPicture> rank_by_appearance(const Features& wanted,
                                               std::span<const Features* const> pictures,
                                               std::size_t max_results);

}  // namespace cairn
