#include "cairn/perception/network.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/error.h"
#include "cairn/perception/darknet_check.h"

namespace cairn {
namespace {

bool is_maps(const cv::Mat& output) {
  return output.dims == 3 || (output.dims == 4 && output.size[0] == 1);
}

bool is_list_of_planes(const cv::Mat& output) {
  return output.dims >= 2 && output.size[output.dims - 1] == 3 &&
         std::all_of(output.size.p, output.size.p + output.dims - 2, [](int n) { return n == 1; });
}

[[noreturn]] void refuse(const NetworkCard& card, const std::string& why) {
  throw Error(Error::Kind::kInput,
              card.file.string() + ": " + why + " (the card is " + card.source.string() + ")");
}

}  // namespace

int channels_of(const cv::Mat& output) { return output.size[output.dims - 3]; }

cv::Mat channel_of(const cv::Mat& output, int index) {
  const int rows = output.size[output.dims - 2], columns = output.size[output.dims - 1];
  float* first = const_cast<float*>(output.ptr<float>()) + std::ptrdiff_t(index) * rows * columns;
  return cv::Mat(rows, columns, CV_32F, first);
}

void Network::load() {
  const std::string file = card_.file.string();
  if (!card_.weights.empty()) check_darknet_weights(card_.file, card_.weights);
  try {
    net_ = card_.weights.empty() ? cv::dnn::readNet(file)
                                 : cv::dnn::readNetFromDarknet(file, card_.weights.string());
  } catch (const cv::Exception& e) {
    refuse(card_, "cannot be loaded as a network, it may be cut short (" + e.err + ")");
  } catch (const std::exception& e) {  // Darknet layers that refer to none
    refuse(card_, std::string("cannot be loaded as a network (") + e.what() + ")");
  }
  const std::vector<std::string> there = net_.getUnconnectedOutLayersNames();
  for (const std::string& name : {card_.output, card_.masks, card_.scores}) {
    if (name.empty()) continue;
    names_.push_back(name);
    if (std::find(there.begin(), there.end(), name) != there.end()) continue;
    std::string all;
    for (const std::string& output : there) all += " " + output;
    refuse(card_, "has no output \"" + name + "\"; its outputs are:" + all);
  }
  if (names_.empty()) names_ = there;
}

Network::Network(const NetworkCard& card) : card_(card) {
  load();
  const cv::Mat grey(card.input.size, CV_8UC3, cv::Scalar::all(128));
  const NetworkAnswer answer = run(grey);
  if (!answer.problem.empty()) refuse(card, "cannot be used: " + answer.problem);
}

cv::Size Network::scaled(const cv::Size& picture) const {
  const cv::Size& input = card_.input.size;
  if (!card_.input.letterbox) return input;
  const double k =
      std::min(double(input.width) / picture.width, double(input.height) / picture.height);
  return {std::max(1, int(picture.width * k)), std::max(1, int(picture.height * k))};
}

cv::Mat Network::blob(const cv::Mat& bgr) const {
  const NetworkInput& input = card_.input;
  cv::Mat colour = bgr, resized, whole;
  if (bgr.channels() == 1) cv::cvtColor(bgr, colour, cv::COLOR_GRAY2BGR);
  const cv::Size inside = scaled(bgr.size());
  cv::resize(colour, resized, inside, 0, 0, input.area ? cv::INTER_AREA : cv::INTER_LINEAR);
  if (inside != input.size) {
    whole = cv::Mat(input.size, CV_8UC3, cv::Scalar::all(input.fill));
    resized.copyTo(whole(cv::Rect({0, 0}, inside)));
    resized = whole;
  }
  resized.convertTo(whole, CV_32FC3);
  const int shape[] = {1, 3, input.size.height, input.size.width};
  cv::Mat blob(4, shape, CV_32F);
  for (int i = 0; i < 3; ++i) {
    cv::Mat plane = channel_of(blob, i), channel;
    cv::extractChannel(whole, channel, input.rgb ? 2 - i : i);
    channel.convertTo(plane, CV_32F, 1 / input.stddev[i], -input.mean[i] / input.stddev[i]);
  }
  return blob;
}

std::string Network::shape_problem(const std::vector<cv::Mat>& outputs) const {
  if (card_.kind == NetworkCard::Kind::kObjects) return head_problem(card_.head, outputs);
  const cv::Mat& first = outputs[0];
  const auto wrong = [&](const cv::Mat& output, const std::string& wanted) {
    return "its output has the shape " + shape_text(output) + ", but should have " + wanted;
  };
  if (card_.kind == NetworkCard::Kind::kPlanes) {
    if (!is_list_of_planes(first)) return wrong(first, "Nx3");
    const int planes = first.size[first.dims - 2];
    if (!is_maps(outputs[1]) ||
        (channels_of(outputs[1]) != planes && channels_of(outputs[1]) != planes + 1)) {
      return wrong(outputs[1], "a map for each of the " + std::to_string(planes) + " planes");
    }
    return "";
  }
  const int wanted = card_.kind == NetworkCard::Kind::kDepth     ? 1
                     : card_.kind == NetworkCard::Kind::kNormals ? 3
                                                                 : int(card_.labels.size());
  if (is_maps(first) && channels_of(first) == wanted) return "";
  return wrong(first, "1x" + std::to_string(wanted) + "xHxW");
}

NetworkAnswer Network::run(const cv::Mat& bgr) {
  if (bgr.empty() || bgr.depth() != CV_8U || (bgr.channels() != 3 && bgr.channels() != 1)) {
    return {{}, "the picture is empty or not of 8 bits"};
  }
  NetworkAnswer answer;
  try {
    net_.setInput(blob(bgr));
    net_.forward(answer.outputs, names_);
  } catch (const cv::Exception& e) {
    return {{}, "it cannot be run (" + e.err + ")"};
  }
  for (cv::Mat& output : answer.outputs) {
    output = output.clone();  // the network's own memory is written again by the next run
    if (output.type() != CV_32F) return {{}, "its output is not of float"};
    if (!cv::checkRange(output, true, nullptr, -1e30, 1e30)) {
      return {{}, "its output is not finite"};
    }
  }
  answer.problem = shape_problem(answer.outputs);
  return answer;
}

cv::Mat Network::to_grid(const cv::Mat& map, const cv::Size& picture, const cv::Size& size) const {
  const cv::Size inside = scaled(picture), input = card_.input.size;
  const cv::Rect valid(0, 0, std::max(1, map.cols * inside.width / input.width),
                       std::max(1, map.rows * inside.height / input.height));
  cv::Mat result;
  cv::resize(map(valid), result, size, 0, 0, cv::INTER_LINEAR);
  return result;
}

}  // namespace cairn
