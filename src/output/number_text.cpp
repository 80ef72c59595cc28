#include "cairn/output/number_text.h"

#include <array>
#include <charconv>
#include <cstdio>

namespace cairn {

std::string exact_text(double value) {
  std::array<char, 64> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string time_text(double seconds) {
  std::array<char, 512> text;
  std::string result(
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), seconds, std::chars_format::fixed).ptr);
  const std::size_t point = result.find('.');
  if (point == std::string::npos) return result + ".000000";
  const std::size_t decimals = result.size() - point - 1;
  if (decimals < 6) result.append(6 - decimals, '0');
  return result;
}

std::string fixed_text(double value, int decimals) {
  std::array<char, 512> text;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

}  // namespace cairn
