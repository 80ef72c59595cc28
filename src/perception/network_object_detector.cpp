#include "cairn/perception/network_object_detector.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "cairn/geometry/error.h"
#include "cairn/perception/picture_box.h"

namespace cairn {
namespace {

const NetworkCard& checked(const NetworkCard& card) {
  if (card.kind == NetworkCard::Kind::kObjects) return card;
  throw Error(Error::Kind::kUsage, card.source.string() + ": the key kind must be objects here");
}

std::vector<bool> wanted_labels(const NetworkCard& card, const std::vector<std::string>& classes) {
  std::vector<bool> wanted(card.labels.size(), classes.empty());
  for (const std::string& name : classes) {
    const auto found = std::find(card.labels.begin(), card.labels.end(), name);
    if (found == card.labels.end()) {
      throw Error(Error::Kind::kUsage, "objects: the class \"" + name + "\" is none of those of " +
                                           card.source.string() + "; its key labels has them");
    }
    wanted[std::size_t(found - card.labels.begin())] = true;
  }
  return wanted;
}

}  // namespace

NetworkObjectDetector::NetworkObjectDetector(const NetworkCard& card,
                                             const ObjectDetectorOptions& options)
    : network_(checked(card)),
      min_score_(options.min_score > 0 ? options.min_score : card.min_score),
      wanted_(wanted_labels(card, options.classes)) {}

void NetworkObjectDetector::detect(const PerceptionInput& input, DetectedFrame& frame) {
  frame.objects.clear();
  const NetworkCard& card = network_.card();
  const NetworkAnswer answer = network_.run(input.bgr);
  if (!answer.problem.empty()) {
    frame.problem = card.name + ": " + answer.problem;
    spdlog::warn("objects: the picture at {:.6f} s is left out: {}", input.timestamp,
                 frame.problem);
    return;
  }
  std::vector<HeadBox> boxes = decode_boxes(card.head, answer.outputs, min_score_);
  std::erase_if(boxes, [&](const HeadBox& box) { return !wanted_[std::size_t(box.label)]; });
  const cv::Size inside = network_.scaled(input.bgr.size());
  const double x = double(input.bgr.cols) / inside.width;
  const double y = double(input.bgr.rows) / inside.height;
  for (const HeadBox& found : suppress_overlaps(std::move(boxes), card.nms)) {
    const Box2& b = found.box;
    const Box2 box = Box2{b.x0 * x - 0.5, b.y0 * y - 0.5, b.x1 * x - 0.5, b.y1 * y - 0.5}.clipped(
        picture_box(input.bgr.size()));
    if (!box.valid()) continue;
    frame.objects.push_back({box, card.labels[std::size_t(found.label)], found.score, {}, {}});
  }
}

}  // namespace cairn
