#include "cairn/perception/recorded_perception.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cairn/geometry/error.h"
#include "cairn/perception/recorded_frames.h"

namespace cairn {
namespace {

using testing::HasSubstr;

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::countNonZero(a != b) == 0;
}

DetectedFrame example() {
  DetectedFrame frame;
  frame.timestamp = 1.25;
  cv::Mat mask(48, 64, CV_8U, cv::Scalar(0));
  mask(cv::Rect(10, 5, 20, 30)) = 255;
  frame.objects.push_back({{10.125, 20.5, 30.25, 40}, "wine glass", 0.75, {}, {}});
  frame.objects.push_back({{9.5, 4.5, 29.5, 34.5}, "cup", 0.5, mask, 3});
  frame.planes.push_back({{0, 0.6, -0.8, 1.23456789012345}, "table", 0.875, mask, 1, 0.0625, 0.25});
  return frame;
}

TEST(RecordedPerception, WritesTheDocumentedKeys) {
  const std::string line = to_json_line(example());
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(line);
  EXPECT_EQ(json.at("timestamp"), 1.25);
  const nlohmann::json& glass = json.at("objects").at(0);
  EXPECT_EQ(glass.at("box"), nlohmann::json({10.125, 20.5, 30.25, 40}));
  EXPECT_EQ(glass.at("class"), "wine glass");
  EXPECT_EQ(glass.at("score"), 0.75);
  EXPECT_FALSE(glass.contains("mask"));
  const nlohmann::json& plane = json.at("planes").at(0);
  EXPECT_EQ(plane.at("plane").size(), 4u);
  EXPECT_EQ(plane.at("label"), "table");
  EXPECT_EQ(plane.at("mask").at("size"), nlohmann::json({48, 64}));
  EXPECT_TRUE(plane.at("mask").at("counts").is_string());
}

TEST(RecordedPerception, ComesBackAsItWasWritten) {
  const DetectedFrame frame = example();
  const DetectedFrame back = parse_json_line(to_json_line(frame), "here");
  EXPECT_EQ(back.timestamp, frame.timestamp);
  ASSERT_EQ(back.objects.size(), 2u);
  EXPECT_EQ(back.objects[0].box.x0, 10.125);
  EXPECT_EQ(back.objects[0].box.y1, 40);
  EXPECT_EQ(back.objects[0].class_name, "wine glass");
  EXPECT_TRUE(back.objects[0].mask.empty());
  EXPECT_FALSE(back.objects[0].thing.has_value());
  EXPECT_EQ(back.objects[1].thing, 3);
  EXPECT_TRUE(same(back.objects[1].mask, frame.objects[1].mask));
  ASSERT_EQ(back.planes.size(), 1u);
  EXPECT_LT((back.planes[0].plane - frame.planes[0].plane).norm(), 1e-15);
  EXPECT_EQ(back.planes[0].truth, 1);
  EXPECT_EQ(back.planes[0].sigma_angle, 0.0625);
  EXPECT_EQ(back.planes[0].sigma_depth, 0.25);
  EXPECT_TRUE(back.depth.empty());
  EXPECT_TRUE(same(back.planes[0].mask, frame.planes[0].mask));
}

TEST(RecordedPerception, ReadsMasksWithUncompressedRunsAndScalesPlanes) {
  const DetectedFrame frame = parse_json_line(
      R"({"timestamp": 0, "objects": [{"box": [0, 0, 2, 2], "class": "cup", "score": 1, "other": 7,
          "mask": {"size": [2, 2], "counts": [1, 3]}}],
          "planes": [{"plane": [0, 0, 2, -4], "label": "wall", "score": 0.5}]})",
      "here");
  EXPECT_EQ(cv::countNonZero(frame.objects[0].mask), 3);
  EXPECT_EQ(frame.planes[0].plane, Eigen::Vector4d(0, 0, 1, -2));
  EXPECT_EQ(frame.planes[0].sigma_angle, DetectedPlane().sigma_angle);
}

TEST(RecordedPerception, SaysWhereAndWhyALineIsBad) {
  const auto reason = [](const std::string& line) {
    try {
      parse_json_line(line, "perception.jsonl, line 3");
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::kInput);
      EXPECT_THAT(e.what(), HasSubstr("perception.jsonl, line 3: "));
      return std::string(e.what());
    }
    return std::string();
  };
  const auto object = [&](const std::string& text) {
    return reason(R"({"timestamp": 0, "planes": [], "objects": [)" + text + "]}");
  };
  EXPECT_THAT(reason("{"), HasSubstr("is no recorded detections"));
  EXPECT_THAT(reason("{}"), HasSubstr("timestamp"));
  EXPECT_THAT(reason(R"({"timestamp": 0, "objects": []})"), HasSubstr("planes"));
  EXPECT_THAT(object(R"({"box": [0, 0, 1], "class": "cup", "score": 1})"),
              HasSubstr("four numbers"));
  EXPECT_THAT(object(R"({"box": [5, 0, 1, 1], "class": "cup", "score": 1})"), HasSubstr("no area"));
  EXPECT_THAT(object(R"({"box": [0, 0, 1, null], "class": "cup", "score": 1})"),
              HasSubstr("number"));
  EXPECT_THAT(object(R"({"box": [0, 0, 1, 1], "class": 5, "score": 1})"), HasSubstr("string"));
  EXPECT_THAT(object(R"({"box": [0, 0, 1, 1], "class": "cup", "score": 1.5})"), HasSubstr("score"));
  EXPECT_THAT(object(R"({"box": [0, 0, 1, 1], "class": "cup", "score": 1,
                         "mask": {"size": [2, 2], "counts": [9]}})"),
              HasSubstr("longer than the mask"));
  EXPECT_THAT(object(R"({"box": [0, 0, 1, 1], "class": "cup", "score": 1,
                         "mask": {"size": [2, 999999], "counts": "9"}})"),
              HasSubstr("no possible size"));
  EXPECT_THAT(reason(R"({"timestamp": 0, "objects": [], "planes": [
                         {"plane": [0, 0, 0, 1], "label": "wall", "score": 1}]})"),
              HasSubstr("no normal"));
  EXPECT_THAT(reason(R"({"timestamp": 0, "objects": [], "planes": [
                         {"plane": [0, 0, 1, 1], "label": "wall", "score": 1, "sigma_angle": 0}]})"),
              HasSubstr("sigma_angle is not positive"));
}

TEST(RecordedPerception, ReadsAFileLineByLine) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("cairn_recorded_" + std::to_string(getpid()) + ".jsonl");
  DetectedFrame second = example();
  second.timestamp = 2.5;
  std::ofstream(file) << to_json_line(example()) << "\n\n" << to_json_line(second) << "\n";
  const RecordedFrames frames(file);
  ASSERT_TRUE(frames.at(example().timestamp) && frames.at(2.5));
  EXPECT_EQ(frames.at(2.5)->timestamp, 2.5);
  EXPECT_EQ(frames.at(2.5)->objects.size(), example().objects.size());
  EXPECT_FALSE(frames.at(2.0));
  std::ofstream(file) << to_json_line(example()) << "\n\nnot JSON\n";
  try {
    const RecordedFrames bad(file);
    FAIL() << "a bad line was read";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("line 3"));
  }
  std::filesystem::remove(file);
  EXPECT_THROW(RecordedFrames{file}, Error);
}

}  // namespace
}  // namespace cairn
