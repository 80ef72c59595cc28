#pragma once

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "cairn/perception/network_card.h"

namespace cairn {

/// What a network said of a picture, or why it said nothing that can be used.
struct NetworkAnswer {
  std::vector<cv::Mat> outputs;  ///< CV_32F, finite, of the shapes that the card's kind asks for
  std::string problem;           ///< empty: none
};

/// A network that a card describes, run by OpenCV dnn on the processor.
class Network {
 public:
  /// Loads it and tries it on a grey picture. Throws Error(kInput), naming the network's file, if
  /// it cannot be loaded, lacks an output, or gives a wrong shape or what is not finite.
  explicit Network(const NetworkCard& card);

  const NetworkCard& card() const { return card_; }
  /// `bgr`: CV_8UC3 or CV_8U (grey), of any size. Outputs: the card's `output`, then its `masks` or
  /// `scores`.
  NetworkAnswer run(const cv::Mat& bgr);
  /// A map (CV_32F, one channel, of the network's size), enlarged or reduced to `size`, which
  /// covers all of a picture that has the size `picture`: without the rest of a letterbox.
  cv::Mat to_grid(const cv::Mat& map, const cv::Size& picture, const cv::Size& size) const;
  /// Pixels of the input, from its top left, that a picture of this size fills.
  cv::Size scaled(const cv::Size& picture) const;

 private:
  void load();
  cv::Mat blob(const cv::Mat& bgr) const;
  std::string shape_problem(const std::vector<cv::Mat>& outputs) const;

  NetworkCard card_;
  cv::dnn::Net net_;
  std::vector<std::string> names_;  // of the outputs that are read
};

/// Channel `index` of a 1 x C x h x w or C x h x w output as a picture; shares its memory.
cv::Mat channel_of(const cv::Mat& output, int index);
/// The number of channels of such an output.
int channels_of(const cv::Mat& output);

}  // namespace cairn
