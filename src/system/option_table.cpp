#include "cairn/system/option_table.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(Error::Kind::kUsage, sentence);
}

template <typename T>
std::string number(T value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <typename T>
bool parse(const std::string& text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// Levenshtein's distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  std::stringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    if (!trimmed(word).empty()) words.push_back(trimmed(word));
  }
  return words;
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

void flatten(const YAML::Node& node, const std::string& prefix,
             std::vector<std::pair<std::string, std::string>>& entries) {
  for (const auto& item : node) {
    const std::string key = prefix + item.first.as<std::string>();
    if (item.second.IsMap()) {
      flatten(item.second, key + ".", entries);
    } else if (item.second.IsScalar()) {
      entries.emplace_back(key, item.second.Scalar());
    } else {
      refuse(key + " takes one value, but the file gives " +
             (item.second.IsNull() ? "none" : "a list"));
    }
  }
}

}  // namespace

void OptionTable::add(const char* key, int& value, const char* unit, Range range,
                      const char* meaning) {
  rows_.push_back({key, &value, unit, range, meaning});
}
void OptionTable::add(const char* key, double& value, const char* unit, Range range,
                      const char* meaning) {
  rows_.push_back({key, &value, unit, range, meaning});
}
void OptionTable::add(const char* key, bool& value, const char* meaning) {
  rows_.push_back({key, &value, "", {}, meaning});
}
void OptionTable::add(const char* key, std::uint64_t& value, const char* meaning) {
  rows_.push_back({key, &value, "", {}, meaning});
}
void OptionTable::add(const char* key, std::vector<std::string>& value, const char* meaning) {
  rows_.push_back({key, &value, "", {}, meaning});
}

std::string OptionTable::Row::print() const {
  struct Printer {
    std::string operator()(const int* v) const { return number(*v); }
    std::string operator()(const double* v) const { return number(*v); }
    std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
    std::string operator()(const std::uint64_t* v) const { return number(*v); }
    std::string operator()(const std::vector<std::string>* v) const {
      return v->empty() ? "all" : joined(*v, ",");
    }
    std::string operator()(const Choice& c) const { return c.names[c.get()]; }
  };
  return std::visit(Printer{}, value);
}

std::string OptionTable::Row::describe_range() const {
  if (std::holds_alternative<bool*>(value)) return "true or false";
  if (std::holds_alternative<std::uint64_t*>(value)) return "0 or more";
  if (std::holds_alternative<std::vector<std::string>*>(value)) return "all, or names by commas";
  if (const auto* choice = std::get_if<Choice>(&value)) return joined(choice->names, " or ");
  return number(range.low) + " to " + number(range.high) + (unit.empty() ? "" : " " + unit);
}

const OptionTable::Row& OptionTable::find(const std::string& key) const {
  for (const auto& row : rows_) {
    if (row.key == key) return row;
  }
  refuse("\"" + key + "\" is no configuration key; the nearest is " + nearest(key) +
         ", and `cairn config` prints all");
}

std::string OptionTable::nearest(const std::string& key) const {
  // Someone who forgot the group ("count") means the key that ends so.
  auto distance = [&](const Row& row) {
    const std::size_t whole = edit_distance(key, row.key);
    return key.find('.') == std::string::npos
               ? std::min(whole, edit_distance(key, last_part(row.key)))
               : whole;
  };
  return std::min_element(rows_.begin(), rows_.end(),
                          [&](const Row& a, const Row& b) { return distance(a) < distance(b); })
      ->key;
}

void OptionTable::set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) {
    refuse("\"" + assignment + "\" is no setting; write key=value, as features.count=1500");
  }
  set(trimmed(assignment.substr(0, equals)), trimmed(assignment.substr(equals + 1)));
}

void OptionTable::set(const std::string& key, const std::string& text) {
  const Row& row = find(key);
  auto wrong_type = [&](const char* expected) {
    refuse(key + " takes " + expected + ", but \"" + text + "\" is none; give " +
           row.describe_range());
  };
  auto check_range = [&](double v) {
    if (!(v >= row.range.low && v <= row.range.high)) {
      refuse(key + " = " + text + " is out of range; give " + row.describe_range());
    }
  };
  if (auto* const* i = std::get_if<int*>(&row.value)) {
    long long v = 0;
    if (!parse(text, v)) wrong_type("a whole number");
    check_range(double(v));
    **i = int(v);
  } else if (auto* const* d = std::get_if<double*>(&row.value)) {
    double v = 0;
    if (!parse(text, v)) wrong_type("a number");
    check_range(v);
    **d = v;
  } else if (auto* const* u = std::get_if<std::uint64_t*>(&row.value)) {
    std::uint64_t v = 0;
    if (!parse(text, v)) wrong_type("a whole number that is not negative");
    **u = v;
  } else if (auto* const* b = std::get_if<bool*>(&row.value)) {
    if (text != "true" && text != "false") wrong_type("a truth value");
    **b = text == "true";
  } else if (auto* const* words = std::get_if<std::vector<std::string>*>(&row.value)) {
    **words = text == "all" ? std::vector<std::string>() : split(text);
  } else {
    const Choice& choice = std::get<Choice>(row.value);
    const auto name = std::find(choice.names.begin(), choice.names.end(), text);
    if (name == choice.names.end()) {
      refuse(key + " = " + text + " is none of its values; give " + row.describe_range());
    }
    choice.set(std::size_t(name - choice.names.begin()));
  }
}

void OptionTable::load_yaml(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf())) {
    throw Error(
        Error::Kind::kInput,
        path + ": this configuration cannot be read; give a YAML file with at least one key");
  }
  try {
    const YAML::Node root = YAML::Load(text.str());
    if (root.IsNull()) return;
    if (!root.IsMap()) refuse("keys and values are expected, as `cairn config` prints them");
    std::vector<std::pair<std::string, std::string>> entries;
    flatten(root, "", entries);
    for (const auto& [key, value] : entries) set(key, value);
  } catch (const YAML::Exception& error) {
    refuse(path + ": this is no YAML (line " + std::to_string(error.mark.line + 1) + ": " +
           error.msg + "); `cairn config` prints a file to start from");
  } catch (const Error& error) {
    throw Error(error.kind(), path + ": " + error.what());
  }
}

std::string OptionTable::print_yaml() const {
  Options default_options;
  const OptionTable defaults(default_options);
  std::string text, group;
  for (const Row& row : rows_) {
    const auto dot = row.key.rfind('.');
    const std::string of = dot == std::string::npos ? "" : row.key.substr(0, dot);
    if (of != group) {
      text += "\n" + of + ":\n";
      group = of;
    }
    std::string line = (of.empty() ? "" : "  ") + last_part(row.key) + ": " + row.print();
    line.resize(std::max<std::size_t>(line.size() + 2, 30), ' ');
    line += "# " + row.describe_range();
    const std::string standard = defaults.find(row.key).print();
    if (standard != row.print()) line += " (default " + standard + ")";
    text += line + "; " + row.meaning + "\n";
  }
  return text;
}

std::vector<std::string> OptionTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& row : rows_) keys.push_back(row.key);
  return keys;
}

std::string OptionTable::get(const std::string& key) const { return find(key).print(); }

}  // namespace cairn
