#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cairn {

/// A line of a text file that is neither empty nor a comment (#), cut into its fields.
struct TextLine {
  int number = 0;  ///< counted from 1, as editors do
  std::vector<std::string> fields;
};

/// Fields are separated by any of `separators` (repeated ones count once). Throws Error(kInput) if
/// the file is missing or cannot be read. `what` names the file's role in the sentence.
std::vector<TextLine> read_text_lines(const std::filesystem::path& file, const std::string& what,
                                      std::string_view separators = " \t,");

/// A finite number that fills the whole field, or nothing.
std::optional<double> parse_number(std::string_view field);

/// An integer that fills the whole field, or nothing.
std::optional<long long> parse_integer(std::string_view field);

/// "rgb.txt, line 12" for error sentences.
std::string at_line(const std::filesystem::path& file, int line);

}  // namespace cairn
