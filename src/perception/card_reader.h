#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace cairn {

/// A mapping of a YAML file whose mistakes become sentences with the file and the key.
class CardReader {
 public:
  /// Reads the file. Throws Error(kInput) if it is no YAML mapping.
  explicit CardReader(const std::filesystem::path& file);

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }
  /// The mapping under a key. All getters throw Error(kUsage) for what cannot be used.
  CardReader section(const std::string& key);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& otherwise);
  /// One of these words; the first is what stands where the key does not.
  std::size_t word(const std::string& key, const std::vector<std::string>& words, bool required);
  double number(const std::string& key, double least, double most);
  double number(const std::string& key, double least, double most, double otherwise);
  std::vector<double> numbers(const std::string& key, std::size_t count, double least, double most);
  /// One or more.
  std::vector<double> numbers(const std::string& key, double least, double most);
  std::vector<std::string> texts(const std::string& key);
  bool is_list(const std::string& key) const { return has(key) && node_[key].IsSequence(); }
  /// Throws if there is a key that no getter was asked for.
  void refuse_unknown() const;
  [[noreturn]] void refuse(const std::string& key, const std::string& why) const;

 private:
  CardReader(const std::filesystem::path& file, const std::string& prefix, const YAML::Node& node)
      : file_(file), prefix_(prefix), node_(node) {}
  YAML::Node get(const std::string& key);
  double checked(const std::string& key, const YAML::Node& value, double least, double most) const;

  std::filesystem::path file_;
  std::string prefix_;  // of keys, "input." in a section
  YAML::Node node_;
  std::set<std::string> asked_;
};

}  // namespace cairn
