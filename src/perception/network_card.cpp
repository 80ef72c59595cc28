#include "cairn/perception/network_card.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "cairn/geometry/error.h"
#include "cairn/perception/card_reader.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

constexpr int kLeastSide = 8, kMostSide = 4096;  // of a network's input, pixels

std::array<double, 3> three(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

void read_input(CardReader card, NetworkInput& input) {
  input.size = {int(card.number("width", kLeastSide, kMostSide)),
                int(card.number("height", kLeastSide, kMostSide))};
  input.rgb = card.word("channels", {"rgb", "bgr"}, true) == 0;
  if (card.has("mean")) input.mean = three(card.numbers("mean", 3, -1e4, 1e4));
  if (card.has("std") && card.has("scale")) card.refuse("scale", "stands beside std; give one");
  if (card.has("std")) input.stddev = three(card.numbers("std", 3, 1e-6, 1e6));
  if (card.has("scale")) input.stddev.fill(1 / card.number("scale", 1e-6, 1e6));
  input.letterbox = card.word("resize", {"stretch", "letterbox"}, false) == 1;
  input.fill = card.number("fill", 0, 255, input.fill);
  input.area = card.word("filter", {"linear", "area"}, false) == 1;
  card.refuse_unknown();
}

fs::path found_file(CardReader& card, const std::string& key, const fs::path& models) {
  const fs::path file = models / card.text(key);
  if (fs::is_regular_file(file)) return file;
  throw Error(Error::Kind::kInput, file.string() +
                                       ": is not there; set CAIRN_MODELS to the folder of the "
                                       "networks, or change the card's key " +
                                       key);
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

void read_labels(CardReader& card, const fs::path& models, NetworkCard& network) {
  network.labels =
      card.is_list("labels") ? card.texts("labels") : lines_of(found_file(card, "labels", models));
  if (network.labels.size() < 2 || network.labels.size() > 255) {
    card.refuse("labels", "must name 2 to 255 labels");
  }
  network.planar = card.texts("planar");
  for (const std::string& label : network.planar) {
    if (std::find(network.labels.begin(), network.labels.end(), label) == network.labels.end()) {
      card.refuse("planar", "names \"" + label + "\", which is none of its labels");
    }
  }
}

void read_calibration(CardReader card, NetworkCard& network) {
  network.factor = card.number("factor", 1e-3, 1e3);
  network.factor_sigma = card.number("sigma", 1e-3, 2);
  card.refuse_unknown();
}

}  // namespace

fs::path find_models(const fs::path& card) {
  if (const char* folder = std::getenv("CAIRN_MODELS")) return folder;
  const fs::path beside =
      fs::absolute(card).parent_path().parent_path().parent_path() / "shared" / "models";
  return fs::is_directory(beside) ? beside : fs::path();
}

fs::path find_card(const std::string& name) {
  if (fs::is_regular_file(name)) return name;
  for (const fs::path& folder :
       {fs::path("cards"), fs::path(CAIRN_SOURCE_CARDS), fs::path(CAIRN_INSTALLED_CARDS)}) {
    const fs::path file = folder / (name + ".yaml");
    if (fs::is_regular_file(file)) return file;
  }
  throw Error(Error::Kind::kUsage,
              "there is no network card \"" + name + "\"; give a file, or a name from cards/");
}

NetworkCard read_network_card(const fs::path& source, const fs::path& given_models) {
  CardReader card(source);
  const fs::path models = given_models.empty() ? find_models(source) : given_models;
  NetworkCard network;
  network.source = source;
  network.name = card.text("name");
  network.kind =
      NetworkCard::Kind(card.word("kind", {"depth", "normals", "labels", "planes"}, true));
  network.output = card.text("output");
  read_input(card.section("input"), network.input);
  const bool metric =
      network.kind == NetworkCard::Kind::kDepth || network.kind == NetworkCard::Kind::kPlanes;
  if (metric) {
    network.unit = card.number("unit", 1e-6, 1e6);
    if (card.has("calibration")) read_calibration(card.section("calibration"), network);
  }
  if (network.kind == NetworkCard::Kind::kPlanes) network.masks = card.text("masks");
  if (network.kind == NetworkCard::Kind::kPlanes || network.kind == NetworkCard::Kind::kNormals) {
    network.axes = NetworkCard::Axes(card.word("axes", {"camera", "forward_y"}, false));
  }
  if (network.kind == NetworkCard::Kind::kLabels) read_labels(card, models, network);
  network.file = found_file(card, "file", models);
  card.refuse_unknown();
  return network;
}

}  // namespace cairn
