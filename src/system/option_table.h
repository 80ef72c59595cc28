#pragma once

#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cairn/system/options.h"

namespace cairn {

/// Every setting of `Options` under the name that users see (`features.count`), with unit, range
/// and one line of meaning. The rows themselves are in options.cpp. The table writes into the
/// `Options` that it was made for, which must outlive it.
///
/// All errors are Error(kUsage), save for a file that cannot be opened (kInput): an unknown key
/// names the nearest one, a value out of range the range, a value of the wrong type what is
/// expected.
class OptionTable {
 public:
  explicit OptionTable(Options& options);

  /// Takes "key=value".
  void set(const std::string& assignment);
  void set(const std::string& key, const std::string& value);
  /// Takes a YAML file; keys are nested (`features: {count: 800}`) or dotted (`features.count:
  /// 800`).
  void load_yaml(const std::string& path);
  /// All keys with their values, each with its range, unit and meaning as a comment, and its
  /// default where the value is another one; `load_yaml` takes this back.
  std::string print_yaml() const;

  std::vector<std::string> keys() const;
  /// The value of a key as text.
  std::string get(const std::string& key) const;

  /// How rows are declared, one line a key:
  ///     add("features.count", options.features.count, "keypoints", {100, 20000}, "meaning");
  struct Range {
    double low = 0, high = 0;
  };
  void add(const char* key, int& value, const char* unit, Range range, const char* meaning);
  void add(const char* key, double& value, const char* unit, Range range, const char* meaning);
  void add(const char* key, bool& value, const char* meaning);
  void add(const char* key, std::uint64_t& value, const char* meaning);
  /// Words between commas; none of them: "all".
  void add(const char* key, std::vector<std::string>& value, const char* meaning);
  template <typename Enum>
  void add(const char* key, Enum& value, std::vector<std::pair<std::string, Enum>> choices,
           const char* meaning);

  void add_factor(const std::string& name, FactorOptions& factor, const char* unit, Range range,
                  const char* meaning);

 private:
  /// A value that is one of a few words.
  struct Choice {
    std::vector<std::string> names;
    std::function<std::size_t()> get;
    std::function<void(std::size_t)> set;
  };
  struct Row {
    std::string key;
    std::variant<int*, double*, bool*, std::uint64_t*, std::vector<std::string>*, Choice> value;
    std::string unit;
    Range range;
    std::string meaning;

    std::string print() const;
    std::string describe_range() const;
  };

  const Row& find(const std::string& key) const;
  std::string nearest(const std::string& key) const;

  std::vector<Row> rows_;
};

template <typename Enum>
void OptionTable::add(const char* key, Enum& value,
                      std::vector<std::pair<std::string, Enum>> choices, const char* meaning) {
  Choice choice;
  for (const auto& [name, _] : choices) choice.names.push_back(name);
  choice.get = [&value, choices]() {
    std::size_t i = 0;
    while (i + 1 < choices.size() && choices[i].second != value) ++i;
    return i;
  };
  choice.set = [&value, choices](std::size_t i) { value = choices[i].second; };
  rows_.push_back({key, std::move(choice), "", {}, meaning});
}

}  // namespace cairn
