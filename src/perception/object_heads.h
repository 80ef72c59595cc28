#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cairn/geometry/box.h"

namespace cairn {

/// How the outputs of a detector of objects are laid out. All numbers are floats; "N" are the boxes
/// that the network thinks of, one a cell of its grids (stride by stride, row by row) where it has
/// grids, and C the classes. Scores and objectness are between 0 and 1.
struct ObjectHead {
  enum class Kind {
    kYolov3,   ///< any number of outputs N x (5+C): centre x, y, width, height, objectness, scores
    kYolox,    ///< N x (5+C): the same, the centre in cells from the cell, ln(size in cells)
    kNanodet,  ///< N x (C+32): scores, then 8 logits each of left, top, right, bottom: distances
               ///< from the cell's corner in cells, 0 to 7 (Li et al., Generalized Focal Loss)
    kPicodet,  ///< N x 4: x0 y0 x1 y1 in pixels; and C x N: scores
  };
  Kind kind = Kind::kYolov3;
  cv::Size input;            ///< of the network, pixels
  int classes = 0;           ///< C
  std::vector<int> strides;  ///< of the grids (kYolox, kNanodet): pixels of a cell
  /// kYolov3: in pixels, with scores that are still to be multiplied by the objectness (exports to
  /// ONNX); otherwise in shares of the input, already multiplied (OpenCV's import of Darknet).
  bool pixels = false;
};

/// A box as a head says it.
struct HeadBox {
  Box2 box;  ///< in the input's own measure: 0 is the left pixel's left edge, width the right one's
  int label = 0;     ///< 0 to C-1, the class of the highest score
  double score = 0;  ///< 0 to 1
};

/// Why a head cannot read these outputs (CV_32F, finite): their number, their shape, scores that
/// are none. Empty: it can.
std::string head_problem(const ObjectHead& head, const std::vector<cv::Mat>& outputs);

/// The boxes with an area and at least this score, in the outputs' order. `outputs` must be
/// without head_problem.
std::vector<HeadBox> decode_boxes(const ObjectHead& head, const std::vector<cv::Mat>& outputs,
                                  double min_score);

/// Non-maximum suppression: by falling score (then by order), without those that overlap a better
/// one of their class by more than `max_iou`.
std::vector<HeadBox> suppress_overlaps(std::vector<HeadBox> boxes, double max_iou);

/// "1x3598x112".
std::string shape_text(const cv::Mat& output);

}  // namespace cairn
