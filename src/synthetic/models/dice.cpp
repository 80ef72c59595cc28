#include "cairn/synthetic/models/dice.h"

namespace cairn {

std::string Dice::word(int shortest, int longest) {
  constexpr std::string_view kVowels = "aeiou", kConsonants = "bcdfglmnprstvz";
  const int length = shortest + below(longest - shortest + 1);
  std::string word;
  bool vowel = chance(0.4f);
  for (int i = 0; i < length; ++i, vowel = !vowel) {
    const std::string_view letters = vowel ? kVowels : kConsonants;
    word += letters[std::size_t(below(int(letters.size())))];
  }
  return word;
}

}  // namespace cairn
