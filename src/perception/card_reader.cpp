#include "cairn/perception/card_reader.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace

CardReader::CardReader(const std::filesystem::path& file) : file_(file) {
  try {
    node_ = YAML::LoadFile(file.string());
  } catch (const YAML::Exception& e) {
    throw Error(Error::Kind::kInput,
                file.string() + ": cannot be read as a network card (" + e.what() + ")");
  }
  if (!node_.IsMap()) {
    throw Error(Error::Kind::kInput, file.string() + ": is no network card; it needs keys");
  }
}

void CardReader::refuse(const std::string& key, const std::string& why) const {
  throw Error(Error::Kind::kUsage, file_.string() + ": the key " + prefix_ + key + " " + why);
}

YAML::Node CardReader::get(const std::string& key) {
  asked_.insert(key);
  const YAML::Node value = std::as_const(node_)[key];
  if (!value || value.IsNull()) refuse(key, "is missing");
  return value;
}

CardReader CardReader::section(const std::string& key) {
  const YAML::Node value = get(key);
  if (!value.IsMap()) refuse(key, "must have keys of its own");
  return CardReader(file_, prefix_ + key + ".", value);
}

std::string CardReader::text(const std::string& key) {
  const YAML::Node value = get(key);
  if (!value.IsScalar() || value.Scalar().empty()) refuse(key, "must be one word or line");
  return value.Scalar();
}

std::string CardReader::text(const std::string& key, const std::string& otherwise) {
  return has(key) ? text(key) : otherwise;
}

std::size_t CardReader::word(const std::string& key, const std::vector<std::string>& words,
                             bool required) {
  if (!has(key) && !required) return 0;
  const std::string given = text(key);
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (given == words[i]) return i;
    all += (i > 0 ? ", " : "") + words[i];
  }
  refuse(key, "is \"" + given + "\", but must be one of: " + all);
}

double CardReader::checked(const std::string& key, const YAML::Node& value, double least,
                           double most) const {
  double number = std::nan("");
  if (!value.IsScalar() || !YAML::convert<double>::decode(value, number) ||
      !(number >= least && number <= most)) {
    refuse(key, "must be a number from " + short_number(least) + " to " + short_number(most));
  }
  return number;
}

double CardReader::number(const std::string& key, double least, double most) {
  return checked(key, get(key), least, most);
}

double CardReader::number(const std::string& key, double least, double most, double otherwise) {
  return has(key) ? number(key, least, most) : otherwise;
}

std::vector<double> CardReader::numbers(const std::string& key, std::size_t count, double least,
                                        double most) {
  const YAML::Node value = get(key);
  if (!value.IsSequence() || value.size() != count) {
    refuse(key, "must be a list of " + std::to_string(count) + " numbers");
  }
  return numbers(key, least, most);
}

std::vector<double> CardReader::numbers(const std::string& key, double least, double most) {
  const YAML::Node value = get(key);
  if (!value.IsSequence() || value.size() == 0) refuse(key, "must be a list of numbers");
  std::vector<double> result;
  for (const YAML::Node& item : value) result.push_back(checked(key, item, least, most));
  return result;
}

std::vector<std::string> CardReader::texts(const std::string& key) {
  const YAML::Node value = get(key);
  if (!value.IsSequence() || value.size() == 0) refuse(key, "must be a list of names");
  std::vector<std::string> result;
  for (const YAML::Node& item : value) {
    if (!item.IsScalar()) refuse(key, "must be a list of names");
    result.push_back(item.Scalar());
  }
  return result;
}

void CardReader::refuse_unknown() const {
  for (const auto& item : node_) {
    const std::string key = item.first.Scalar();
    if (!asked_.contains(key)) refuse(key, "is not known here; see docs/perception.md");
  }
}

}  // namespace cairn
