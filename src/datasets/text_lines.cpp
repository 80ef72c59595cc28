#include "cairn/datasets/text_lines.h"

#include <charconv>
#include <cmath>
#include <fstream>

#include "cairn/geometry/error.h"

namespace cairn {

std::vector<TextLine> read_text_lines(const std::filesystem::path& file, const std::string& what,
                                      std::string_view separators) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) {
    throw Error(Error::Kind::kInput,
                file.string() + ": this is a folder, but " + what + " is a file; name the file");
  }
  std::ifstream stream(file);
  if (!stream) {
    throw Error(Error::Kind::kInput, file.string() + ": " + what +
                                         " cannot be opened; check that the file is there and "
                                         "may be read");
  }
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // written by Windows
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
    TextLine line{number, {}};
    for (std::size_t at = text.find_first_not_of(separators); at != std::string::npos;) {
      const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
      line.fields.push_back(text.substr(at, end - at));
      at = text.find_first_not_of(separators, end);
    }
    if (!line.fields.empty() && line.fields[0][0] != '#') lines.push_back(std::move(line));
  }
  if (stream.bad()) {
    throw Error(Error::Kind::kInput,
                file.string() + ": " + what + " cannot be read to its end; check the disk");
  }
  return lines;
}

std::optional<double> parse_number(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<long long> parse_integer(std::string_view field) {
  long long value = 0;
  const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

std::string at_line(const std::filesystem::path& file, int line) {
  return file.filename().string() + ", line " + std::to_string(line);
}

}  // namespace cairn
