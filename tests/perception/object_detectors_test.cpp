#include "cairn/perception/object_detectors.h"

#include <gmock/gmock.h>

#include "cairn/geometry/error.h"
#include "cairn/perception/combined_detector.h"
#include "cairn/perception/darknet_check.h"
#include "cairn/perception/network_object_detector.h"
#include "cairn/perception/recorded_object_detector.h"
#include "cairn/perception/recorded_perception.h"
#include "tiny_darknet.h"

namespace cairn {
namespace {

using testing::darknet_card;
using testing::depth_card;
using ::testing::HasSubstr;
using testing::kTinyInput;
using testing::NetworkFolder;
using testing::TinyDarknet;

const double kSure = 1 / (1 + std::exp(-4.)) / (1 + std::exp(-10.));

void expect_object(const DetectedObject& object, const std::string& class_name, const Box2& box,
                   double score) {
  EXPECT_EQ(object.class_name, class_name);
  EXPECT_NEAR((object.box.edges() - box.edges()).norm(), 0, 1e-3) << object.box.edges().transpose();
  EXPECT_NEAR(object.score, score, 1e-3);
}

// Black, but for a quadrant (column, row) of each colour.
cv::Mat picture(const cv::Size& size, const std::vector<std::pair<cv::Point, cv::Scalar>>& parts) {
  cv::Mat bgr(size, CV_8UC3, cv::Scalar::all(0));
  const cv::Size half = size / 2;
  for (const auto& [cell, colour] : parts) {
    bgr(cv::Rect({cell.x * half.width, cell.y * half.height}, half)) = colour;
  }
  return bgr;
}

const cv::Scalar kRed(0, 0, 255), kDarkGreen(0, 150, 0);

DetectedFrame detect(const TinyDarknet& network, const cv::Mat& bgr,
                     const ObjectDetectorOptions& options = {},
                     const std::string& card = darknet_card()) {
  const NetworkFolder folder;
  DetectedFrame frame;
  const ObjectDetectorSources sources{{}, folder.path(), options};
  make_object_detector(network.write(folder, card).string(), sources)->detect({bgr, {}, 1}, frame);
  return frame;
}

std::string refusal(const TinyDarknet& network, Error::Kind kind = Error::Kind::kInput,
                    const std::string& card = darknet_card(),
                    const ObjectDetectorOptions& options = {}) {
  try {
    detect(network, picture({64, 64}, {}), options, card);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind) << e.what();
    return e.what();
  }
  return "";
}

TEST(NetworkObjects, AreInPixelsOfThePictureAndCutOffAtItsBorder) {
  const DetectedFrame frame = detect({}, picture({128, 96}, {{{1, 1}, kRed}}));
  EXPECT_EQ(frame.problem, "");
  ASSERT_EQ(frame.objects.size(), 1u);
  expect_object(frame.objects[0], "cup", {79.5, 23.5, 111.5, 95.5}, kSure);
}

TEST(NetworkObjects, AreInPixelsOfThePictureBehindALetterbox) {
  const DetectedFrame frame = detect({}, picture({128, 64}, {{{1, 0}, kRed}, {{1, 1}, kRed}}), {},
                                     darknet_card("letterbox"));
  ASSERT_EQ(frame.objects.size(), 1u);
  expect_object(frame.objects[0], "cup", {79.5, -0.5, 111.5, 63.5}, kSure);
}

TEST(NetworkObjects, ComeByFallingScoreAndAsTheOptionsWantThem) {
  const cv::Mat bgr = picture({64, 64}, {{{0, 0}, kDarkGreen}, {{1, 1}, kRed}});
  const double chair = 1 / (1 + std::exp(-4.)) / (1 + std::exp(10 - 20 * 150 / 255.));
  const auto both = detect({}, bgr).objects;
  ASSERT_EQ(both.size(), 2u);
  expect_object(both[0], "cup", {39.5, 15.5, 55.5, 63.5}, kSure);
  expect_object(both[1], "chair", {7.5, -0.5, 23.5, 47.5}, chair);
  const auto chairs = detect({}, bgr, {0, {"chair"}}).objects;
  ASSERT_EQ(chairs.size(), 1u);
  EXPECT_EQ(chairs[0].class_name, "chair");
  const auto sure = detect({}, bgr, {0.9, {}}).objects;
  ASSERT_EQ(sure.size(), 1u);
  EXPECT_EQ(sure[0].class_name, "cup");
  EXPECT_EQ(detect({}, bgr, {}, darknet_card() + "min_score: 0.9\n").objects.size(), 1u);
  EXPECT_THAT(refusal({}, Error::Kind::kUsage, darknet_card(), {0, {"sofa"}}),
              HasSubstr("\"sofa\" is none of those of"));
}

TEST(NetworkObjects, OfOneClassThatOverlapAreOne) {
  TinyDarknet large;
  large.bias[2] = large.bias[3] = std::log(16.f);  // four times the input: cells hardly differ
  const cv::Mat red(64, 64, CV_8UC3, kRed);
  EXPECT_EQ(detect(large, red).objects.size(), 1u);
}

TEST(NetworkObjects, KeepQuietAboutPicturesThatCannotBeUsed) {
  TinyDarknet network;
  network.weights[2 * 3] = 120;  // the width of what is red is infinite, of what is grey only large
  const DetectedFrame frame = detect(network, picture({64, 64}, {{{1, 1}, kRed}}));
  EXPECT_THAT(frame.problem, HasSubstr("tiny: its output is not finite"));
  EXPECT_TRUE(frame.objects.empty());
  EXPECT_THAT(detect({}, {}).problem, HasSubstr("empty"));
}

TEST(NetworkObjects, NeedANetworkThatFitsItsCard) {
  EXPECT_EQ(refusal({}), "");
  EXPECT_THAT(refusal({}, Error::Kind::kInput, darknet_card("stretch", "[cup]")),
              HasSubstr("for the card's 1 labels"));
  EXPECT_THAT(refusal({}, Error::Kind::kInput, darknet_card("stretch", "[cup, chair]", "nanodet")),
              HasSubstr("but should have 1x85x34"));
  TinyDarknet broken;
  broken.bias[2] = NAN;
  EXPECT_THAT(refusal(broken), HasSubstr("tiny.cfg: cannot be used: its output is not finite"));
  TinyDarknet unreadable;
  unreadable.cfg += "[shortcut]\nfrom=-9\n";
  EXPECT_THAT(refusal(unreadable), HasSubstr("tiny.cfg: cannot be loaded"));
}

TEST(NetworkObjects, NeedWeightsOfTheNetwork) {
  TinyDarknet cut;
  cut.weights.pop_back();
  EXPECT_THAT(refusal(cut),
              HasSubstr("tiny.weights: has 128 bytes, but tiny.cfg needs 132; it was cut short"));
  TinyDarknet other;
  other.cfg.replace(other.cfg.find("filters=7"), 9, "filters=14");
  EXPECT_THAT(refusal(other), HasSubstr("has 132 bytes, but tiny.cfg needs 244"));
  TinyDarknet old;
  old.header = {0, 1, 0, 0};
  EXPECT_EQ(refusal(old), "");
  TinyDarknet none;
  none.cfg = "hello\n";
  EXPECT_THAT(refusal(none), HasSubstr("tiny.cfg: is no Darknet network"));
}

TEST(DarknetWeights, AreCountedLayerByLayer) {
  const NetworkFolder folder;
  const auto count = [&](const std::string& layers) {
    return darknet_weight_count(folder.write("n.cfg", "[net]\nchannels=3\n" + layers));
  };
  const std::string layers =
      "# a comment\n[convolutional]\nbatch_normalize=1\nfilters = 8\nsize=3\n"  // 32 + 216
      "[maxpool]\nsize=2\n"
      "[convolutional]\nfilters=8\nsize=3\ngroups=4\n"  // 8 + 144
      "[route]\nlayers = -1, 0\n"
      "[convolutional]\nfilters=4\nsize=1\n";  // 4 + 64
  EXPECT_EQ(count(layers), 468);
  EXPECT_EQ(count(layers + "[reorg]\nstride=2\n[convolutional]\nfilters=1\nsize=1\n"), 485);
  EXPECT_EQ(count(layers + "[connected]\noutput=3\n"), std::nullopt);
  EXPECT_THROW(count("[route]\nlayers=5\n"), Error);
  EXPECT_THROW(count("[convolutional]\nsize=1\n"), Error);
  EXPECT_THROW(count("[convolutional]\nsize=1\nfilters=4\ngroups=2\n"), Error);
}

TEST(ObjectCards, NameTheKeyOfAMistake) {
  const auto of = [](const std::string& card) { return refusal({}, Error::Kind::kUsage, card); };
  const std::string begin = "name: n\nkind: objects\nfile: tiny.cfg\n" + kTinyInput;
  EXPECT_THAT(of(begin), HasSubstr("the key head is missing"));
  EXPECT_THAT(of(begin + "head: ssd\n"), HasSubstr("must be one of: yolov3, yolox, nanodet"));
  EXPECT_THAT(of(begin + "head: yolov3\nlabels: [a]\n"), HasSubstr("the key weights is missing"));
  EXPECT_THAT(of(begin + "head: picodet\nlabels: [a]\n"), HasSubstr("the key output is missing"));
  EXPECT_THAT(of(darknet_card() + "nms: 2\n"), HasSubstr("the key nms must be a number"));
  EXPECT_THAT(of(darknet_card() + "strides: [8]\n"), HasSubstr("the key strides is not known"));
}

TEST(ObjectCards, ThatAreShippedKnowTheClassesOfCoco) {
  const NetworkFolder folder;
  for (const char* file : {"nanodet_plus_m_416.onnx", "yolox_nano_416.onnx", "picodet_xs_320.onnx",
                           "yolo-fastest-1.1-xl.cfg", "yolo-fastest-1.1-xl.weights"}) {
    folder.write(file, "");
  }
  for (const char* name : {"nanodet_plus_m", "yolox_nano", "picodet_xs", "yolo_fastest"}) {
    const NetworkCard card = read_network_card(find_card(name), folder.path());
    EXPECT_EQ(card.kind, NetworkCard::Kind::kObjects);
    EXPECT_EQ(card.name, name);
    EXPECT_EQ(card.min_score, 0.35);
    ASSERT_EQ(card.labels.size(), 80u);
    EXPECT_EQ(card.labels.front(), "person");
    EXPECT_EQ(card.labels.back(), "toothbrush");
  }
}

std::filesystem::path recording(const NetworkFolder& folder) {
  DetectedFrame frame;
  frame.timestamp = 1;
  frame.objects = {{{-10, -10, 20, 20}, "cup", 0.5, cv::Mat(9, 9, CV_8U, cv::Scalar(255)), 7},
                   {{100, 100, 120, 120}, "chair", 0.9, {}, {}},
                   {{60, 40, 80, 60}, "chair", 0.75, {}, {}}};
  return folder.write("perception.jsonl", to_json_line(frame) + "\n");
}

const cv::Mat kBlack(48, 64, CV_8UC3, cv::Scalar::all(0));

TEST(RecordedObjects, AreCutOffAtTheBorderAndCountedOutside) {
  const NetworkFolder folder;
  RecordedObjectDetector detector(recording(folder));
  DetectedFrame frame;
  detector.detect({kBlack, {}, 1.004}, frame);
  ASSERT_EQ(frame.objects.size(), 2u);
  expect_object(frame.objects[0], "chair", {60, 40, 63.5, 47.5}, 0.75);
  expect_object(frame.objects[1], "cup", {-0.5, -0.5, 20, 20}, 0.5);
  EXPECT_EQ(frame.objects[1].thing, 7);
  EXPECT_TRUE(frame.objects[1].mask.empty());  // of another size than the picture
  EXPECT_EQ(detector.outside_count(), 1);
  detector.detect({kBlack, {}, 1.1}, frame);
  EXPECT_TRUE(frame.objects.empty());
  EXPECT_EQ(frame.problem, "");
}

TEST(RecordedObjects, AreAsTheOptionsWantThem) {
  const NetworkFolder folder;
  const auto found = [&](const ObjectDetectorOptions& options) {
    DetectedFrame frame;
    make_object_detector("recorded", {recording(folder), {}, options})
        ->detect({kBlack, {}, 1}, frame);
    return frame.objects;
  };
  EXPECT_EQ(found({}).size(), 2u);
  ASSERT_EQ(found({0, {"cup"}}).size(), 1u);
  EXPECT_EQ(found({0, {"cup"}})[0].class_name, "cup");
  ASSERT_EQ(found({0.6, {}}).size(), 1u);
  EXPECT_EQ(found({0.6, {}})[0].class_name, "chair");
}

TEST(ObjectDetectors, SayWhatIsMissing) {
  const auto kind = [](const std::string& name, const ObjectDetectorSources& sources) {
    try {
      make_object_detector(name, sources);
    } catch (const Error& e) {
      return e.kind();
    }
    return Error::Kind::kOutput;  // none was thrown
  };
  const NetworkFolder folder;
  EXPECT_EQ(kind("recorded", {}), Error::Kind::kUsage);
  EXPECT_EQ(kind("recorded", {folder.path() / "none.jsonl", {}, {}}), Error::Kind::kInput);
  EXPECT_EQ(kind("no_such_network", {}), Error::Kind::kUsage);
  folder.write("tiny.onnx", "");
  const std::string depth = folder.write("depth.yaml", depth_card()).string();
  EXPECT_EQ(kind(depth, {{}, folder.path(), {}}), Error::Kind::kUsage);
}

class FixedPlanes : public PlaneDetector {
 public:
  DetectedFrame detect(const PerceptionInput&) override {
    DetectedFrame frame;
    frame.planes.resize(2);
    frame.objects.resize(3);
    frame.problem = "no depth";
    return frame;
  }
};

class FixedObjects : public ObjectDetector {
 public:
  void detect(const PerceptionInput&, DetectedFrame& frame) override {
    frame.objects.assign(1, {{0, 0, 1, 1}, "cup", 0.5, {}, {}});
    frame.problem = "too dark";
  }
};

TEST(CombinedDetector, HasPlanesOfOneAndObjectsOfTheOther) {
  const PerceptionInput input{kBlack, {}, 3};
  const DetectedFrame both =
      CombinedDetector(std::make_unique<FixedPlanes>(), std::make_unique<FixedObjects>())
          .detect(input);
  EXPECT_EQ(both.timestamp, 3);
  EXPECT_EQ(both.planes.size(), 2u);
  ASSERT_EQ(both.objects.size(), 1u);
  EXPECT_EQ(both.problem, "no depth; too dark");
  const DetectedFrame planes =
      CombinedDetector(std::make_unique<FixedPlanes>(), nullptr).detect(input);
  EXPECT_EQ(planes.planes.size(), 2u);
  EXPECT_TRUE(planes.objects.empty());
  EXPECT_EQ(planes.problem, "no depth");
  const DetectedFrame objects =
      CombinedDetector(nullptr, std::make_unique<FixedObjects>()).detect(input);
  EXPECT_EQ(objects.timestamp, 3);
  EXPECT_TRUE(objects.planes.empty());
  EXPECT_EQ(objects.objects.size(), 1u);
  EXPECT_EQ(objects.problem, "too dark");
  EXPECT_TRUE(CombinedDetector(nullptr, nullptr).detect(input).objects.empty());
}

}  // namespace
}  // namespace cairn
