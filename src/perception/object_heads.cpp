#include "cairn/perception/object_heads.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cairn {
namespace {

using Kind = ObjectHead::Kind;

constexpr int kBins = 8;                 // of each distance of kNanodet
constexpr float kScoreRounding = 1e-3f;  // by which a network's sigmoid may pass 0 and 1

struct Cell {
  int column, row, stride;
};

std::vector<Cell> cells_of(const ObjectHead& head) {
  std::vector<Cell> cells;
  for (const int stride : head.strides) {
    const int columns = (head.input.width + stride - 1) / stride;
    const int rows = (head.input.height + stride - 1) / stride;
    for (int i = 0; i < columns * rows; ++i) cells.push_back({i % columns, i / columns, stride});
  }
  return cells;
}

bool has_grid(Kind kind) { return kind == Kind::kYolox || kind == Kind::kNanodet; }

// The last two dimensions of a 1 x ... x rows x columns output, without copying; empty for others.
cv::Mat_<float> table_of(const cv::Mat& output) {
  if (output.dims < 2 || !output.isContinuous()) return {};
  for (int i = 0; i < output.dims - 2; ++i) {
    if (output.size[i] != 1) return {};
  }
  float* first = const_cast<float*>(output.ptr<float>());
  return cv::Mat(output.size[output.dims - 2], output.size[output.dims - 1], CV_32F, first);
}

int columns_wanted(const ObjectHead& head) {
  if (head.kind == Kind::kNanodet) return head.classes + 4 * kBins;
  return head.kind == Kind::kPicodet ? 4 : head.classes + 5;
}

std::string shape_problem(const cv::Mat& output, const std::string& wanted) {
  return "its output has the shape " + shape_text(output) + ", but should have " + wanted;
}

bool are_scores(const cv::Mat_<float>& values) {
  return cv::checkRange(values, true, nullptr, -kScoreRounding, 1.0 + kScoreRounding);
}

// The part of the first table that holds scores, objectness included.
cv::Mat_<float> scores_of(const ObjectHead& head, const cv::Mat_<float>& table) {
  const bool first = head.kind == Kind::kNanodet;
  return first ? table.colRange(0, head.classes) : table.colRange(4, 5 + head.classes);
}

Box2 box_around(double x, double y, double width, double height) {
  return {x - width / 2, y - height / 2, x + width / 2, y + height / 2};
}

// The mean of 0..7 with the weights softmax(logits), Generalized Focal Loss (3).
double expected_bin(const float* logits) {
  const float most = *std::max_element(logits, logits + kBins);
  double sum = 0, weighted = 0;
  for (int i = 0; i < kBins; ++i) {
    const double weight = std::exp(double(logits[i]) - most);
    sum += weight;
    weighted += weight * i;
  }
  return weighted / sum;
}

Box2 nanodet_box(const float* logits, const Cell& cell) {
  std::array<double, 4> distance;
  for (int i = 0; i < 4; ++i) distance[std::size_t(i)] = expected_bin(logits + i * kBins);
  const double s = cell.stride, x = cell.column, y = cell.row;
  return {(x - distance[0]) * s, (y - distance[1]) * s, (x + distance[2]) * s,
          (y + distance[3]) * s};
}

Box2 yolox_box(const float* row, const Cell& cell) {
  const double s = cell.stride;
  return box_around((row[0] + cell.column) * s, (row[1] + cell.row) * s, std::exp(row[2]) * s,
                    std::exp(row[3]) * s);
}

Box2 yolov3_box(const float* row, const ObjectHead& head) {
  const double x = head.pixels ? 1 : head.input.width, y = head.pixels ? 1 : head.input.height;
  return box_around(row[0] * x, row[1] * y, row[2] * x, row[3] * y);
}

// The best of scores that lie `step` floats apart, times `objectness`.
HeadBox best_class(const float* scores, std::ptrdiff_t step, int classes, double objectness) {
  int best = 0;
  for (int i = 1; i < classes; ++i) {
    if (scores[i * step] > scores[best * step]) best = i;
  }
  return {{}, best, std::clamp(objectness * scores[best * step], 0.0, 1.0)};
}

}  // namespace

std::string shape_text(const cv::Mat& output) {
  std::string text;
  for (int i = 0; i < output.dims; ++i) {
    if (i > 0) text += 'x';
    text += std::to_string(output.size[i]);
  }
  return text;
}

std::string head_problem(const ObjectHead& head, const std::vector<cv::Mat>& outputs) {
  const std::size_t wanted = head.kind == Kind::kPicodet ? 2 : 1;
  if (outputs.size() < wanted || (head.kind != Kind::kYolov3 && outputs.size() > wanted)) {
    return "it has " + std::to_string(outputs.size()) + " outputs, but its head reads " +
           std::to_string(wanted) + "; name them by the card's keys output and scores";
  }
  const std::string columns = std::string("x").append(std::to_string(columns_wanted(head)));
  const std::string classes = " for the card's " + std::to_string(head.classes) + " labels";
  if (head.kind == Kind::kPicodet) {
    const cv::Mat_<float> boxes = table_of(outputs[0]), scores = table_of(outputs[1]);
    if (boxes.cols != 4) return shape_problem(outputs[0], "1xN" + columns);
    if (scores.rows != head.classes || scores.cols != boxes.rows) {
      return shape_problem(outputs[1], std::string("1x").append(std::to_string(head.classes)) +
                                           "x" + std::to_string(boxes.rows) + classes);
    }
    return are_scores(scores) ? "" : "its scores are not between 0 and 1";
  }
  const std::string rows =
      has_grid(head.kind) ? std::to_string(cells_of(head).size()) : std::string("N");
  for (const cv::Mat& output : outputs) {
    const cv::Mat_<float> table = table_of(output);
    if (table.cols != columns_wanted(head) ||
        (has_grid(head.kind) && rows != std::to_string(table.rows))) {
      return shape_problem(output, "1x" + rows + columns + classes);
    }
    if (!are_scores(scores_of(head, table))) return "its scores are not between 0 and 1";
  }
  return "";
}

std::vector<HeadBox> decode_boxes(const ObjectHead& head, const std::vector<cv::Mat>& outputs,
                                  double min_score) {
  std::vector<HeadBox> boxes;
  const std::vector<Cell> cells = cells_of(head);
  const bool two = head.kind == Kind::kPicodet;
  for (std::size_t o = 0; o < (two ? 1 : outputs.size()); ++o) {
    const cv::Mat_<float> table = table_of(outputs[o]);
    const float* by_class = two ? outputs[1].ptr<float>() : nullptr;
    for (int i = 0; i < table.rows; ++i) {
      const float* row = table[i];
      HeadBox found;
      switch (head.kind) {
        case Kind::kYolov3:
          found = best_class(row + 5, 1, head.classes, head.pixels ? row[4] : 1);
          found.box = yolov3_box(row, head);
          break;
        case Kind::kYolox:
          found = best_class(row + 5, 1, head.classes, row[4]);
          found.box = yolox_box(row, cells[std::size_t(i)]);
          break;
        case Kind::kNanodet:
          found = best_class(row, 1, head.classes, 1);
          if (found.score < min_score) continue;  // its boxes cost more than all the rest
          found.box = nanodet_box(row + head.classes, cells[std::size_t(i)]);
          break;
        case Kind::kPicodet:
          found = best_class(by_class + i, table.rows, head.classes, 1);
          found.box = {row[0], row[1], row[2], row[3]};
          break;
      }
      if (found.score >= min_score && found.box.valid()) boxes.push_back(found);
    }
  }
  return boxes;
}

std::vector<HeadBox> suppress_overlaps(std::vector<HeadBox> boxes, double max_iou) {
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const HeadBox& a, const HeadBox& b) { return a.score > b.score; });
  std::vector<HeadBox> kept;
  for (const HeadBox& box : boxes) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const HeadBox& better) {
      return better.label == box.label && intersection_over_union(better.box, box.box) > max_iou;
    });
    if (!known) kept.push_back(box);
  }
  return kept;
}

}  // namespace cairn
