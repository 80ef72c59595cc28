#include "cairn/features/retrieval.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <memory>
#include <unordered_map>

namespace cairn {
namespace {

constexpr int kTables = 2;
constexpr int kBits = 18;
constexpr std::uint32_t kNobody = 0xffffffff;

std::uint32_t word_of(const Descriptor& descriptor, int table) {
  return (static_cast<std::uint32_t>(table) << kBits) |
         ((descriptor[0] >> (table * kBits)) & ((1U << kBits) - 1));
}

// The words of the wanted picture. The bits are there because nearly all words that are looked up
// are not.
class Words {
 public:
  struct Word {
    int wanted = 0;                  ///< features of the wanted picture that have it
    int pictures = 0;                ///< that have it
    std::uint32_t newest = kNobody;  ///< of these
  };

  explicit Words(const Features& wanted) : present_(std::make_unique<Bits>()) {
    for (const Descriptor& descriptor : wanted.descriptors) {
      for (int table = 0; table < kTables; ++table) {
        const std::uint32_t word = word_of(descriptor, table);
        present_->set(word);
        const auto [entry, is_new] =
            index_.try_emplace(word, static_cast<std::uint32_t>(words_.size()));
        if (is_new) words_.emplace_back();
        ++words_[entry->second].wanted;
      }
    }
  }

  /// The number of a word, or kNobody.
  std::uint32_t find(std::uint32_t word) const {
    return present_->test(word) ? index_.at(word) : kNobody;
  }
  Word& operator[](std::uint32_t number) { return words_[number]; }

 private:
  using Bits = std::bitset<std::size_t{kTables} << kBits>;
  std::unique_ptr<Bits> present_;
  std::unordered_map<std::uint32_t, std::uint32_t> index_;
  std::vector<Word> words_;
};

}  // namespace

std::vector<SimilarPicture> rank_by_appearance(const Features& wanted,
                                               std::span<const Features* const> pictures,
                                               std::size_t max_results) {
  Words words(wanted);
  struct Share {
    std::uint32_t picture, word;
  };
  std::vector<Share> shared;
  for (std::uint32_t p = 0; p < pictures.size(); ++p) {
    for (const Descriptor& descriptor : pictures[p]->descriptors) {
      for (int table = 0; table < kTables; ++table) {
        const std::uint32_t number = words.find(word_of(descriptor, table));
        // A word counts once a picture, however many of its features have it.
        if (number == kNobody || words[number].newest == p) continue;
        words[number].newest = p;
        ++words[number].pictures;
        shared.push_back({p, number});
      }
    }
  }
  std::vector<float> votes(pictures.size(), 0.0F);
  const auto all = static_cast<float>(pictures.size()) + 1;
  for (const Share& share : shared) {
    const Words::Word& word = words[share.word];
    votes[share.picture] += static_cast<float>(word.wanted) *
                            std::log(all / static_cast<float>(word.pictures)) / std::log(all);
  }
  std::vector<SimilarPicture> ranked;
  const auto own = static_cast<float>(wanted.size());
  for (std::size_t p = 0; p < pictures.size(); ++p) {
    if (votes[p] <= 0) continue;
    const float most = kTables * std::sqrt(own * static_cast<float>(pictures[p]->size()));
    ranked.push_back({p, votes[p] / most});
  }
  const std::size_t count = std::min(max_results, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                    ranked.end(), [](const SimilarPicture& a, const SimilarPicture& b) {
                      return a.score != b.score ? a.score > b.score : a.index < b.index;
                    });
  ranked.resize(count);
  return ranked;
}

}  // namespace cairn
