#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cairn/perception/object_heads.h"

namespace cairn {

/// How a picture becomes the input of a network: float, 1 x 3 x height x width.
struct NetworkInput {
  cv::Size size;                          ///< pixels
  bool rgb = true;                        ///< order of the channels; otherwise blue comes first
  std::array<double, 3> mean{0, 0, 0};    ///< in that order; x = (pixel - mean) / std
  std::array<double, 3> stddev{1, 1, 1};  ///< the card's `std`
  bool letterbox = false;                 ///< keep the shape, at top left; otherwise stretch
  double fill = 114;                      ///< grey of the rest of a letterbox, 0 to 255
  bool area = false;  ///< resize by the mean of each pixel's area; otherwise bilinearly
};

/// A network as its card (YAML) describes it. All keys: docs/perception.md.
struct NetworkCard {
  enum class Kind {
    kDepth,    ///< `output` 1 x 1 x h x w: along the optical axis, in `unit` metres
    kNormals,  ///< `output` 1 x 3 x h x w: in `axes`, of any length
    kLabels,   ///< `output` 1 x labels x h x w: the largest is the label
    kPlanes,   ///< `output` N x 3: n d with n'x = d (in `axes`); `masks` N or N+1 x h x w: logits
    kObjects,  ///< boxes, as its `head` lays them out
  };
  enum class Axes {
    kCamera,   ///< x right, y down, z forward
    kForwardY  ///< x right, y forward, z up (PlaneNet, PlaneRCNN)
  };

  std::filesystem::path source;  ///< the card itself
  std::string name;
  Kind kind = Kind::kDepth;
  std::filesystem::path file;     ///< of the network, found
  std::filesystem::path weights;  ///< of a Darknet network, found; empty: `file` has them
  NetworkInput input;
  std::string output, masks;  ///< names of outputs; kObjects: empty for all that there are
  std::string scores;         ///< the same; only heads with two outputs have it
  double unit = 1;            ///< metres of one unit of the output
  Axes axes = Axes::kCamera;
  double factor = 1;                ///< metres = output * unit * factor
  double factor_sigma = 0.3;        ///< of the logarithm of a picture's true factor around `factor`
  double outdoor_sigma = 0;         ///< the same outdoors; 0: no other
  std::vector<std::string> labels;  ///< by channel, or by class
  std::vector<std::string> planar;  ///< those of `labels` whose regions may be planes
  ObjectHead head;
  double min_score = 0.35;  ///< of an object
  double nms = 0.5;         ///< of two boxes of a class: overlap (IoU) above which the worse goes
};

/// Reads a card and finds the network's file in `models`, or, if that is empty, in the folder of
/// find_models; a file of labels may also lie beside the card. Throws Error(kUsage), naming file
/// and key, for what is missing, unknown or out of range; Error(kInput) for a file that is not
/// there.
NetworkCard read_network_card(const std::filesystem::path& card,
                              const std::filesystem::path& models = {});

/// The folder of networks: $CAIRN_MODELS, or shared/models beside the tree that holds the folder of
/// the card. Empty if neither is there.
std::filesystem::path find_models(const std::filesystem::path& card);

/// The card of this name: a path to one, or NAME of cards/NAME.yaml in the working folder, in
/// cairn's source tree, or installed with it. Throws Error(kUsage).
std::filesystem::path find_card(const std::string& name);

}  // namespace cairn
