#include "cairn/perception/object_heads.h"

#include <gmock/gmock.h>

#include <cmath>

namespace cairn {
namespace {

using ::testing::HasSubstr;
using Kind = ObjectHead::Kind;

cv::Mat output(std::vector<int> shape) {
  return cv::Mat(int(shape.size()), shape.data(), CV_32F, cv::Scalar(0));
}

// The values from the first of a row on; rows of an output's last two dimensions.
void write(cv::Mat& output, int row, const std::vector<float>& values) {
  float* first = output.ptr<float>() + std::ptrdiff_t(row) * output.size[output.dims - 1];
  std::copy(values.begin(), values.end(), first);
}

void expect_box(const HeadBox& found, const Box2& box, int label, double score) {
  EXPECT_NEAR((found.box.edges() - box.edges()).norm(), 0, 1e-4)
      << found.box.edges().transpose() << ", not " << box.edges().transpose();
  EXPECT_EQ(found.label, label);
  EXPECT_NEAR(found.score, score, 1e-6);
}

std::vector<HeadBox> decoded(const ObjectHead& head, const std::vector<cv::Mat>& outputs,
                             double min_score = 0.3) {
  EXPECT_EQ(head_problem(head, outputs), "");
  return decode_boxes(head, outputs, min_score);
}

TEST(Yolov3Head, ReadsRowsInSharesOfTheInputFromAllOutputs) {
  const ObjectHead head{Kind::kYolov3, {100, 50}, 2, {}, false};
  cv::Mat first = output({3, 7}), second = output({1, 1, 7});
  write(first, 1, {0.5f, 0.4f, 0.2f, 0.4f, 0.9f, 0.1f, 0.8f});
  write(first, 2, {0.5f, 0.4f, 0.2f, 0.4f, 0.9f, 0.1f, 0.2f});  // too low a score
  write(second, 0, {0, 0, 1, 1, 0.9f, 0.5f, 0.4f});
  const auto found = decoded(head, {first, second});
  ASSERT_EQ(found.size(), 2u);
  expect_box(found[0], {40, 10, 60, 30}, 1, 0.8);
  expect_box(found[1], {-50, -25, 50, 25}, 0, 0.5);
}

TEST(Yolov3Head, MultipliesScoresOfRowsInPixelsByTheObjectness) {
  const ObjectHead head{Kind::kYolov3, {100, 50}, 2, {}, true};
  cv::Mat rows = output({1, 1, 7});
  write(rows, 0, {50, 20, 20, 20, 0.5f, 0.1f, 0.8f});
  const auto found = decoded(head, {rows});
  ASSERT_EQ(found.size(), 1u);
  expect_box(found[0], {40, 10, 60, 30}, 1, 0.4);
}

TEST(YoloxHead, CountsFromTheCell) {
  const ObjectHead head{Kind::kYolox, {64, 32}, 1, {8, 16, 32}, false};
  cv::Mat rows = output({1, 32 + 8 + 2, 6});
  write(rows, 32 + 1 * 4 + 2, {0.5f, 0.25f, std::log(2.f), 0, 0.5f, 0.8f});  // row 1, column 2
  write(rows, 0, {0, 0, 500, 0, 1, 1});                                      // infinitely wide
  const auto found = decoded(head, {rows});
  ASSERT_EQ(found.size(), 1u);
  expect_box(found[0], {24, 12, 56, 28}, 0, 0.4);
}

TEST(NanodetHead, TakesTheMeanOfEachDistribution) {
  const ObjectHead head{Kind::kNanodet, {64, 32}, 1, {8, 64}, false};
  cv::Mat rows = output({1, 32 + 1, 1 + 32});
  std::vector<float> row(33, 0.f);
  row[0] = 0.75f;
  row[1 + 3] = 50;                 // left: 3
  row[17 + 0] = row[17 + 1] = 50;  // right: a half; top: all the same, 3.5
  row[25 + 7] = 50;                // bottom: 7
  write(rows, 1 * 8 + 2, row);     // row 1, column 2: (16, 8)
  const auto found = decoded(head, {rows});
  ASSERT_EQ(found.size(), 1u);
  expect_box(found[0], {16 - 24, 8 - 28, 16 + 4, 8 + 56}, 0, 0.75);
}

TEST(PicodetHead, ReadsScoresByClass) {
  const ObjectHead head{Kind::kPicodet, {64, 32}, 2, {}, false};
  cv::Mat boxes = output({1, 3, 4}), scores = output({1, 2, 3});
  write(boxes, 0, {1, 2, 3, 4});
  write(boxes, 1, {5, 6, 17, 18});
  write(boxes, 2, {9, 9, 9, 12});  // no width
  write(scores, 0, {0.1f, 0.2f, 0.9f});
  write(scores, 1, {0.25f, 0.625f, 0.3f});
  const auto found = decoded(head, {boxes, scores});
  ASSERT_EQ(found.size(), 1u);
  expect_box(found[0], {5, 6, 17, 18}, 1, 0.625);
  EXPECT_EQ(decoded(head, {boxes, scores}, 0).size(), 2u);
}

TEST(ObjectHead, SaysWhatItCannotRead) {
  const ObjectHead yolo{Kind::kYolov3, {64, 32}, 2, {}, false};
  EXPECT_THAT(head_problem(yolo, {output({3, 85})}),
              HasSubstr("the shape 3x85, but should have 1xNx7 for the card's 2 labels"));
  EXPECT_THAT(head_problem(yolo, {output({2, 3, 7})}), HasSubstr("2x3x7"));
  EXPECT_THAT(head_problem(yolo, {}), HasSubstr("0 outputs"));
  const ObjectHead nanodet{Kind::kNanodet, {64, 32}, 1, {8, 64}, false};
  EXPECT_THAT(head_problem(nanodet, {output({1, 32, 33})}), HasSubstr("1x33x33"));
  EXPECT_THAT(head_problem(nanodet, {output({1, 33, 33}), output({1, 33, 33})}),
              HasSubstr("2 outputs"));
  const ObjectHead picodet{Kind::kPicodet, {64, 32}, 2, {}, false};
  EXPECT_THAT(head_problem(picodet, {output({1, 3, 4}), output({1, 3, 2})}), HasSubstr("1x2x3"));
  cv::Mat logits = output({1, 3, 7});
  write(logits, 1, {0, 0, 0, 0, 0.5f, 0.5f, -4});
  EXPECT_THAT(head_problem(yolo, {logits}), HasSubstr("not between 0 and 1"));
}

TEST(SuppressedOverlaps, KeepTheBestOfAClass) {
  const Box2 box{0, 0, 10, 10}, near{0, 0, 10, 8}, half{5, 0, 15, 10};
  const auto kept = suppress_overlaps(
      {{near, 0, 0.5}, {box, 0, 0.9}, {half, 0, 0.6}, {near, 1, 0.4}, {box, 1, 0.4}}, 0.5);
  ASSERT_EQ(kept.size(), 3u);
  expect_box(kept[0], box, 0, 0.9);
  expect_box(kept[1], half, 0, 0.6);  // a third in common
  expect_box(kept[2], near, 1, 0.4);  // of equal scores the first
  EXPECT_EQ(suppress_overlaps({{box, 0, 0.5}, {near, 0, 0.4}}, 0.85).size(), 2u);
}

}  // namespace
}  // namespace cairn
