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

void read_labels(CardReader& card, const fs::path& models, std::size_t least, std::size_t most,
                 NetworkCard& network) {
  if (card.is_list("labels")) {
    network.labels = card.texts("labels");
  } else {
    const fs::path beside = network.source.parent_path() / card.text("labels");
    network.labels =
        lines_of(fs::is_regular_file(beside) ? beside : found_file(card, "labels", models));
  }
  if (network.labels.size() < least || network.labels.size() > most) {
    card.refuse("labels",
                "must name " + std::to_string(least) + " to " + std::to_string(most) + " labels");
  }
}

void read_planar(CardReader& card, NetworkCard& network) {
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
  network.outdoor_sigma = card.number("outdoor_sigma", 1e-3, 10, 0);
  card.refuse_unknown();
}

void read_objects(CardReader& card, const fs::path& models, NetworkCard& network) {
  ObjectHead& head = network.head;
  head.kind = ObjectHead::Kind(card.word("head", {"yolov3", "yolox", "nanodet", "picodet"}, true));
  head.input = network.input.size;
  if (head.kind == ObjectHead::Kind::kYolov3) {
    head.pixels = card.word("boxes", {"shares", "pixels"}, false) == 1;
  }
  if (head.kind == ObjectHead::Kind::kYolox) head.strides = {8, 16, 32};
  if (head.kind == ObjectHead::Kind::kNanodet) head.strides = {8, 16, 32, 64};
  if (!head.strides.empty() && card.has("strides")) {
    const std::vector<double> strides = card.numbers("strides", 1, 256);
    head.strides.assign(strides.begin(), strides.end());
  }
  if (head.kind == ObjectHead::Kind::kPicodet) {
    network.output = card.text("output");
    network.scores = card.text("scores");
  } else {
    network.output = card.text("output", "");
  }
  network.min_score = card.number("min_score", 0, 1, network.min_score);
  network.nms = card.number("nms", 0, 1, network.nms);
  read_labels(card, models, 1, 10000, network);
  head.classes = int(network.labels.size());
  if (card.has("weights") || fs::path(card.text("file")).extension() == ".cfg") {
    network.weights = found_file(card, "weights", models);
  }
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
  network.kind = NetworkCard::Kind(
      card.word("kind", {"depth", "normals", "labels", "planes", "objects"}, true));
  if (network.kind != NetworkCard::Kind::kObjects) network.output = card.text("output");
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
  if (network.kind == NetworkCard::Kind::kLabels) {
    read_labels(card, models, 2, 255, network);
    read_planar(card, network);
  }
  if (network.kind == NetworkCard::Kind::kObjects) read_objects(card, models, network);
  network.file = found_file(card, "file", models);
  card.refuse_unknown();
  return network;
}

}  // namespace cairn
