#include "cairn/perception/network_card.h"

#include <gmock/gmock.h>

#include "cairn/geometry/error.h"
#include "network_folder.h"

namespace cairn {
namespace {

using ::testing::AllOf;
using testing::depth_card;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kTinyInput;
using testing::NetworkFolder;

NetworkCard read(const NetworkFolder& folder, const std::string& text) {
  folder.write("tiny.onnx", "");
  return read_network_card(folder.write("card.yaml", text), folder.path());
}

std::string refusal(const std::string& text) {
  const NetworkFolder folder;
  try {
    read(folder, text);
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr(folder.path().string()), HasSubstr(": ")));
    return e.what();
  }
  return "";
}

TEST(NetworkCard, HasWhatTheFileSays) {
  const NetworkFolder folder;
  const NetworkCard card = read(
      folder, R"({name: n, kind: depth, file: tiny.onnx, output: d, unit: 0.01, input: {width: 64,
                  height: 48, channels: bgr, mean: [1, 2, 3], std: [4, 5, 6], resize: letterbox,
                  fill: 7, filter: area}, calibration: {factor: 0.5, sigma: 0.25}})");
  EXPECT_EQ(card.kind, NetworkCard::Kind::kDepth);
  EXPECT_EQ(card.file, folder.path() / "tiny.onnx");
  EXPECT_EQ(card.input.size, cv::Size(64, 48));
  EXPECT_FALSE(card.input.rgb);
  EXPECT_THAT(card.input.mean, ElementsAre(1, 2, 3));
  EXPECT_THAT(card.input.stddev, ElementsAre(4, 5, 6));
  EXPECT_TRUE(card.input.letterbox);
  EXPECT_EQ(card.input.fill, 7);
  EXPECT_TRUE(card.input.area);
  EXPECT_EQ(card.unit, 0.01);
  EXPECT_EQ(card.factor, 0.5);
  EXPECT_EQ(card.factor_sigma, 0.25);
}

TEST(NetworkCard, TakesLabelsFromAListOrAFile) {
  const NetworkFolder folder;
  const std::string begin =
      "name: n\nkind: labels\nfile: tiny.onnx\noutput: o\nplanar: [floor]\n" + kTinyInput;
  EXPECT_THAT(read(folder, begin + "labels: [other, floor]\n").labels,
              ElementsAre("other", "floor"));
  folder.write("l.names", "other\r\nfloor\nsky\n");
  EXPECT_THAT(read(folder, begin + "labels: l.names\n").labels,
              ElementsAre("other", "floor", "sky"));
}

TEST(NetworkCard, TakesAScaleForStd) {
  const NetworkFolder folder;
  const NetworkCard card = read(
      folder,
      R"({name: n, kind: planes, file: tiny.onnx, output: p, masks: m, axes: forward_y, unit: 1,
          input: {width: 64, height: 48, channels: rgb, scale: 0.25}})");
  EXPECT_THAT(card.input.stddev, ElementsAre(4, 4, 4));
  EXPECT_EQ(card.masks, "m");
  EXPECT_EQ(card.axes, NetworkCard::Axes::kForwardY);
}

TEST(NetworkCard, NamesFileAndKeyOfAMistake) {
  EXPECT_EQ(refusal(depth_card()), "");
  EXPECT_THAT(refusal("[1, 2]"), HasSubstr("needs keys"));
  EXPECT_THAT(refusal("name: [\n"), HasSubstr("cannot be read"));
  EXPECT_THAT(refusal("name: n\n"), HasSubstr("the key kind is missing"));
  EXPECT_THAT(refusal("name: n\nkind: colour\n"),
              HasSubstr("the key kind is \"colour\", but must be one of: depth, normals"));
  EXPECT_THAT(refusal(depth_card("units: 3\n")), HasSubstr("the key units is not known"));
  EXPECT_THAT(refusal(depth_card("calibration: {factor: -1, sigma: 1}\n")),
              HasSubstr("the key calibration.factor must be a number from 0.001 to 1000"));
  EXPECT_THAT(refusal(depth_card("calibration: 3\n")), HasSubstr("calibration must have keys"));
  EXPECT_THAT(refusal("name: n\nkind: depth\nfile: x.onnx\noutput: d\nunit: 1\n" + kTinyInput),
              HasSubstr("x.onnx: is not there; set CAIRN_MODELS"));
  const std::string labels = "name: n\nkind: labels\nfile: tiny.onnx\noutput: o\n" + kTinyInput;
  EXPECT_THAT(refusal(labels + "labels: [a, b]\nplanar: [c]\n"),
              HasSubstr("the key planar names \"c\""));
  EXPECT_THAT(refusal(labels + "labels: [a]\nplanar: [a]\n"), HasSubstr("2 to 255 labels"));
  EXPECT_THAT(refusal(labels + "labels: there.names\nplanar: [a]\n"),
              HasSubstr("there.names: is not there"));
}

TEST(NetworkCard, NamesTheKeysOfTheInput) {
  const auto input = [](const std::string& text) {
    return refusal("name: n\nkind: depth\nfile: tiny.onnx\noutput: d\nunit: 1\ninput: " + text);
  };
  EXPECT_THAT(input("{height: 24, channels: rgb}"), HasSubstr("input.width is missing"));
  EXPECT_THAT(input("{width: 32, height: 24, channels: grey}"), HasSubstr("input.channels is"));
  EXPECT_THAT(input("{width: 32, height: 24, channels: rgb, mean: [1]}"),
              HasSubstr("input.mean must be a list of 3 numbers"));
  EXPECT_THAT(input("{width: 32, height: 24, channels: rgb, std: [0, 1, 1]}"),
              HasSubstr("input.std must be a number from"));
  EXPECT_THAT(input("{width: 32, height: 24, channels: rgb, std: [1, 1, 1], scale: 2}"),
              HasSubstr("stands beside std"));
  EXPECT_THAT(input("{width: 32, height: 24, channels: rgb, crop: 1}"),
              HasSubstr("input.crop is not known"));
}

TEST(NetworkCard, IsFoundByNameInTheSourceTree) {
  EXPECT_EQ(find_card("meter_xxs_nyu").filename(), "meter_xxs_nyu.yaml");
  EXPECT_THROW(find_card("no_such_network"), Error);
}

}  // namespace
}  // namespace cairn
