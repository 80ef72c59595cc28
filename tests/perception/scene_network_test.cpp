#include "cairn/perception/scene_network.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "cairn/geometry/error.h"
#include "network_folder.h"

namespace cairn {
namespace {

using testing::depth_card;
using ::testing::HasSubstr;
using testing::kTinyInput;
using testing::NetworkFolder;
using testing::TinyOnnx;

const cv::Size kGrid(32, 24);

NetworkCard card_of(const NetworkFolder& folder, const std::string& text) {
  return read_network_card(folder.write("card.yaml", text), folder.path());
}

cv::Mat plain(const cv::Scalar& bgr) { return cv::Mat(48, 64, CV_8UC3, bgr); }

// The reason why a network is not taken.
std::string refusal(const std::string& network, const std::string& card) {
  const NetworkFolder folder;
  folder.write("tiny.onnx", network);
  try {
    const SceneNetwork scene({card_of(folder, card)});
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::kInput);
    EXPECT_THAT(e.what(), HasSubstr((folder.path() / "tiny.onnx").string()));
    return e.what();
  }
  return "";
}

TEST(SceneNetwork, FeedsTheColoursAsTheCardSays) {
  const NetworkFolder folder;
  TinyOnnx(24, 32).maps("depth", {1, 10, 100}, {1000}).write(folder.path() / "tiny.onnx");
  const std::string begin = "name: tiny\nkind: depth\nfile: tiny.onnx\noutput: depth\n";
  const auto depth = [&](const std::string& input) {
    SceneNetwork scene(
        {card_of(folder, begin + "unit: 0.01\ncalibration: {factor: 2, sigma: 0.1}\n" +
                             "input: {width: 32, height: 24, " + input + "}\n")});
    const SceneMaps maps = scene.look(plain({3, 2, 1}), kGrid);
    EXPECT_EQ(maps.sigma_scale, 0.1);
    return maps.depth(12, 16);
  };
  EXPECT_NEAR(depth("channels: rgb"), 0.02 * (1000 + 1 + 20 + 300), 1e-3);
  EXPECT_NEAR(depth("channels: bgr"), 0.02 * (1000 + 3 + 20 + 100), 1e-3);
  EXPECT_NEAR(depth("channels: rgb, mean: [1, 0, 1], std: [1, 2, 4]"), 0.02 * (1000 + 0 + 10 + 50),
              1e-3);
}

TEST(SceneNetwork, LeavesTheRestOfALetterboxOut) {
  const NetworkFolder folder;
  TinyOnnx(32, 32).maps("depth", {1, 0, 0}, {1}).write(folder.path() / "tiny.onnx");
  SceneNetwork scene(
      {card_of(folder,
               "name: t\nkind: depth\nfile: tiny.onnx\noutput: depth\nunit: 1\n"
               "input: {width: 32, height: 32, channels: rgb, resize: letterbox}\n")});
  cv::Mat picture = plain({0, 0, 10});
  picture.rowRange(24, 48) = cv::Scalar(0, 0, 50);
  const cv::Mat_<float> depth = scene.look(picture, kGrid).depth;
  EXPECT_NEAR(depth(0, 0), 11, 1e-4);
  EXPECT_NEAR(depth(10, 31), 11, 1e-4);
  EXPECT_NEAR(depth(13, 0), 51, 1e-4);
  EXPECT_NEAR(depth(23, 31), 51, 1e-4);
}

TEST(SceneNetwork, GivesLabelsAndNormals) {
  const NetworkFolder folder;
  TinyOnnx(24, 32)
      .maps("logits", {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0})
      .write(folder.path() / "tiny.onnx");
  TinyOnnx(24, 32).maps("n", std::vector<float>(9, 0.f), {0, 3, 4}).write(folder.path() / "n.onnx");
  const NetworkCard labels =
      card_of(folder, "name: l\nkind: labels\nfile: tiny.onnx\noutput: logits\n" + kTinyInput +
                          "labels: [other, floor, wall]\nplanar: [floor, wall]\n");
  const NetworkCard normals = card_of(
      folder, "name: n\nkind: normals\nfile: n.onnx\noutput: n\naxes: forward_y\n" + kTinyInput);
  SceneNetwork scene({labels, normals});
  EXPECT_FALSE(scene.gives(NetworkCard::Kind::kDepth));
  EXPECT_THAT(scene.planar_labels(), ::testing::ElementsAre("", "floor", "wall"));
  cv::Mat picture = plain({0, 0, 200});
  picture.colRange(32, 64) = cv::Scalar(200, 0, 0);
  const SceneMaps maps = scene.look(picture, kGrid);
  EXPECT_EQ(maps.problem, "");
  EXPECT_EQ(maps.labels(12, 4), 0);
  EXPECT_EQ(maps.labels(12, 28), 2);
  EXPECT_LT(cv::norm(maps.normals(5, 5) - cv::Vec3f(0, -0.8f, 0.6f)), 1e-5);
  EXPECT_THROW(SceneNetwork({labels, labels}), Error);
}

TEST(SceneNetwork, TrustsAMetreThatWasLearntIndoorsLessOutdoors) {
  const NetworkFolder folder;
  TinyOnnx(24, 32).maps("depth", {0, 0, 0}, {1}).write(folder.path() / "depth.onnx");
  TinyOnnx(24, 32)
      .maps("logits", {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0})
      .write(folder.path() / "tiny.onnx");
  const NetworkCard labels =
      card_of(folder, "name: l\nkind: labels\nfile: tiny.onnx\noutput: logits\n" + kTinyInput +
                          "labels: [floor, wall, road]\nplanar: [floor, wall, road]\n");
  const auto sigma = [&](const std::string& calibration, const cv::Scalar& half) {
    SceneNetwork scene({card_of(folder, "name: d\nkind: depth\nfile: depth.onnx\noutput: depth\n" +
                                            kTinyInput + "unit: 1\n" + calibration),
                        labels});
    cv::Mat picture = plain({0, 200, 0});  // a wall: anywhere
    picture.colRange(0, 40) = half;
    return scene.look(picture, kGrid).sigma_scale;
  };
  const cv::Scalar floor(0, 0, 200), road(200, 0, 0);
  const std::string both = "calibration: {factor: 1, sigma: 0.2, outdoor_sigma: 2.5}\n";
  EXPECT_EQ(sigma(both, floor), 0.2);
  EXPECT_EQ(sigma(both, road), 2.5);
  EXPECT_EQ(sigma("calibration: {factor: 1, sigma: 0.2}\n", road), 0.2);
}

TEST(SceneNetwork, RefusesNetworksThatCannotBeUsed) {
  const std::string good = TinyOnnx(24, 32).maps("depth", {0, 0, 0}, {1}).bytes();
  EXPECT_EQ(refusal(good, depth_card()), "");
  EXPECT_THAT(refusal("", depth_card()), HasSubstr("cannot be loaded"));
  EXPECT_THAT(refusal(good.substr(0, good.size() / 2), depth_card()),
              HasSubstr("cannot be loaded"));
  EXPECT_THAT(refusal("this is no network at all", depth_card()), HasSubstr("cannot be loaded"));
  EXPECT_THAT(refusal(TinyOnnx(24, 32).maps("metres", {0, 0, 0}, {1}).bytes(), depth_card()),
              HasSubstr("has no output \"depth\"; its outputs are: metres"));
  EXPECT_THAT(refusal(TinyOnnx(24, 32).maps("depth", std::vector<float>(6, 0.f), {1, 1}).bytes(),
                      depth_card()),
              HasSubstr("its output has the shape 1x2x24x32, but should have 1x1xHxW"));
  EXPECT_THAT(refusal(TinyOnnx(24, 32).maps("depth", {0, 0, 0}, {NAN}).bytes(), depth_card()),
              HasSubstr("is not finite"));
}

TEST(SceneNetwork, SaysWhyItGivesNothing) {
  const NetworkFolder folder;
  // The root of 200 - red: finite on a grey picture, not on a red one.
  TinyOnnx(24, 32).maps("depth", {-1, 0, 0}, {200}, "Sqrt").write(folder.path() / "tiny.onnx");
  SceneNetwork scene({card_of(folder, depth_card())});
  const SceneMaps good = scene.look(plain({0, 0, 100}), kGrid);
  EXPECT_EQ(good.problem, "");
  EXPECT_NEAR(good.depth(0, 0), 0.1, 1e-5);
  const SceneMaps bad = scene.look(plain({0, 0, 255}), kGrid);
  EXPECT_THAT(bad.problem, HasSubstr("is not finite"));
  EXPECT_TRUE(bad.depth.empty());
  EXPECT_THAT(scene.look(cv::Mat(), kGrid).problem, HasSubstr("picture is empty"));
  EXPECT_EQ(scene.look(cv::Mat(48, 64, CV_8U, cv::Scalar(100)), kGrid).problem, "");
}

}  // namespace
}  // namespace cairn
