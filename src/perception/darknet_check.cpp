#include "cairn/perception/darknet_check.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

constexpr int kMost = 1 << 14;  // filters, channels, pixels of a side: the count stays in range

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Error(Error::Kind::kInput, file.string() + ": " + why);
}

struct Section {
  std::string type;
  std::map<std::string, std::string> keys;
};

std::vector<Section> sections_of(const fs::path& cfg) {
  std::ifstream stream(cfg);
  std::vector<Section> sections;
  for (std::string line; std::getline(stream, line);) {
    std::erase_if(line, [](unsigned char c) { return std::isspace(c) != 0; });
    if (line.empty() || line[0] == '#' || line[0] == ';') continue;
    const std::size_t equals = line.find('=');
    if (line[0] == '[' && line.find(']') != std::string::npos) {
      sections.push_back({line.substr(1, line.find(']') - 1), {}});
    } else if (equals != std::string::npos && !sections.empty()) {
      sections.back().keys[line.substr(0, equals)] = line.substr(equals + 1);
    } else {
      refuse(cfg, "is no Darknet network: the line \"" + line.substr(0, 40) + "\" has no place");
    }
  }
  if (sections.empty() || sections[0].type != "net") {
    refuse(cfg, "is no Darknet network: it does not begin with [net]");
  }
  return sections;
}

// Counts layer by layer; `channels_` are those that each layer hands on.
class WeightCount {
 public:
  explicit WeightCount(const fs::path& cfg) : cfg_(cfg) {}

  std::optional<std::int64_t> of(const std::vector<Section>& sections) {
    before_ = integer(sections[0], "channels", 3, 1);
    for (std::size_t i = 1; i < sections.size(); ++i) {
      const std::string& type = sections[i].type;
      if (type == "connected" || type == "local" || type == "crnn" || type == "rnn" ||
          type == "gru" || type == "lstm" || type == "conv_lstm") {
        return std::nullopt;
      }
      if (type == "convolutional") before_ = convolution(sections[i]);
      if (type == "route") before_ = routed(sections[i]);
      if (type == "reorg") {
        const int stride = std::min(integer(sections[i], "stride", 2, 1), 64);
        before_ = std::min(before_ * stride * stride, kMost);
      }
      channels_.push_back(before_);
    }
    return count_;
  }

 private:
  int integer(const Section& section, const std::string& key, int otherwise, int least) const {
    const auto found = section.keys.find(key);
    if (found == section.keys.end() && otherwise >= least) return otherwise;
    int value = least - 1;
    if (found != section.keys.end()) std::istringstream(found->second) >> value;
    if (value < least || value > kMost) {
      refuse(cfg_, "is no Darknet network: layer " + std::to_string(channels_.size()) + " [" +
                       section.type + "] has no usable \"" + key + "\"");
    }
    return value;
  }

  int convolution(const Section& section) {
    const std::int64_t filters = integer(section, "filters", 0, 1);
    const std::int64_t size = integer(section, "size", 0, 1);
    const int groups = integer(section, "groups", 1, 1);
    if (before_ % groups != 0) {
      refuse(cfg_, "layer " + std::to_string(channels_.size()) + " has " + std::to_string(groups) +
                       " groups, which do not divide " + std::to_string(before_) + " channels");
    }
    const bool normalized = integer(section, "batch_normalize", 0, 0) == 1;
    count_ += filters * (normalized ? 4 : 1) + filters * (before_ / groups) * size * size;
    return int(filters);
  }

  int routed(const Section& section) const {
    const auto found = section.keys.find("layers");
    std::istringstream list(found == section.keys.end() ? "" : found->second);
    int sum = 0;
    for (std::string item; std::getline(list, item, ',');) {
      int layer = kMost;
      std::istringstream(item) >> layer;
      if (layer < 0) layer += int(channels_.size());
      if (layer < 0 || layer >= int(channels_.size())) {
        refuse(cfg_, "layer " + std::to_string(channels_.size()) + " [route] takes \"" + item +
                         "\", which is no layer before it");
      }
      sum = std::min(sum + channels_[std::size_t(layer)], kMost);
    }
    const int groups = integer(section, "groups", 1, 1);
    if (sum < groups) refuse(cfg_, "has a [route] that takes nothing");
    return sum / groups;
  }

  fs::path cfg_;
  std::vector<int> channels_;
  int before_ = 0;
  std::int64_t count_ = 0;
};

// Major and minor version, revision, then how many pictures were seen: of 8 bytes since 0.2.
std::int64_t header_bytes(const fs::path& weights) {
  std::array<std::int32_t, 3> version{};
  std::ifstream stream(weights, std::ios::binary);
  stream.read(reinterpret_cast<char*>(version.data()), sizeof version);
  if (!stream) refuse(weights, "is no file of Darknet weights; it may be cut short");
  return std::int64_t(version[0]) * 10 + version[1] >= 2 ? 20 : 16;
}

}  // namespace

std::optional<std::int64_t> darknet_weight_count(const fs::path& cfg) {
  return WeightCount(cfg).of(sections_of(cfg));
}

void check_darknet_weights(const fs::path& cfg, const fs::path& weights) {
  const std::optional<std::int64_t> count = darknet_weight_count(cfg);
  const std::int64_t header = header_bytes(weights);
  const std::int64_t bytes = std::int64_t(fs::file_size(weights));
  if (!count || bytes == header + 4 * *count) return;
  refuse(weights, "has " + std::to_string(bytes) + " bytes, but " + cfg.filename().string() +
                      " needs " + std::to_string(header + 4 * *count) +
                      "; it was cut short, or is of another network");
}

}  // namespace cairn
