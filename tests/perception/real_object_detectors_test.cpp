// The shipped cards of detectors on a recorded picture; skipped where networks or picture are not
// there.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "cairn/perception/object_detectors.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

// $`variable`, or shared/`name` beside the project.
fs::path folder_of(const char* variable, const std::string& name) {
  if (const char* folder = std::getenv(variable)) return folder;
  return fs::path(CAIRN_SOURCE_DIR).parent_path() / "shared" / name;
}

class RealObjects : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path file = folder_of("CAIRN_DATA", "data") / "redkitchen" / "rgb" / "0.633333.jpg";
    if (!fs::exists(models_ / "nanodet_plus_m_416.onnx") || !fs::exists(file)) {
      GTEST_SKIP() << "no networks in " << models_ << " or no picture " << file
                   << "; set CAIRN_MODELS and CAIRN_DATA to the folders of both";
    }
    picture_ = cv::imread(file.string());
    ASSERT_FALSE(picture_.empty());
  }

  std::vector<DetectedObject> found(const std::string& card) const {
    ObjectDetectorSources sources;
    sources.models = models_;
    DetectedFrame frame;
    make_object_detector(card, sources)->detect({picture_, {}, 0}, frame);
    EXPECT_EQ(frame.problem, "");
    for (std::size_t i = 0; i < frame.objects.size(); ++i) {
      const Box2& box = frame.objects[i].box;
      EXPECT_TRUE(box.valid());
      EXPECT_GE(std::min(box.x0, box.y0), -0.5);
      EXPECT_LE(box.x1, picture_.cols - 0.5);
      EXPECT_LE(box.y1, picture_.rows - 0.5);
      EXPECT_LE(frame.objects[i].score, frame.objects[i > 0 ? i - 1 : 0].score);
    }
    return frame.objects;
  }

  fs::path models_ = folder_of("CAIRN_MODELS", "models");
  cv::Mat picture_;
};

// The best of a class have these scores.
void expect_scores(const std::vector<DetectedObject>& objects, const std::string& class_name,
                   const std::vector<double>& scores) {
  std::vector<double> there;
  for (const DetectedObject& object : objects) {
    if (object.class_name == class_name) there.push_back(object.score);
  }
  ASSERT_GE(there.size(), scores.size()) << class_name;
  for (std::size_t i = 0; i < scores.size(); ++i) EXPECT_NEAR(there[i], scores[i], 0.05);
}

// Scores: the reference decoder's (README.md beside the networks, OpenCV 4.6).
TEST_F(RealObjects, OfNanodetAreThoseOfTheReferenceDecoder) {
  const auto objects = found("nanodet_plus_m");
  expect_scores(objects, "dining table", {0.65});
  expect_scores(objects, "chair", {0.57, 0.56});
  expect_scores(objects, "cup", {0.47});
}

TEST_F(RealObjects, OfYoloxAreThoseOfTheReferenceDecoder) {
  const auto objects = found("yolox_nano");
  expect_scores(objects, "dining table", {0.78});
  expect_scores(objects, "chair", {0.62, 0.50});
  expect_scores(objects, "cup", {0.42});
}

TEST_F(RealObjects, OfPicodetAreThoseOfTheReferenceDecoder) {
  const auto objects = found("picodet_xs");
  expect_scores(objects, "dining table", {0.73});
  expect_scores(objects, "chair", {0.70});
  expect_scores(objects, "cup", {0.41});
}

TEST_F(RealObjects, OfYoloFastestAreThoseOfTheReferenceDecoder) {
  expect_scores(found("yolo_fastest"), "cup", {0.41});
}

}  // namespace
}  // namespace cairn
