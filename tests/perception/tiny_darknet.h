#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "network_folder.h"

namespace cairn::testing {

/// A YOLOv3 of Darknet with the classes cup and chair, on 64 x 64 pixels, that sees four pixels:
/// the upper left ones of the quadrants, each a cell. Red is a cup, green a chair; each is in the
/// middle of its cell, a quarter of the input wide and as high as the input.
struct TinyDarknet {
  std::string cfg =
      "[net]\nwidth=64\nheight=64\nchannels=3\n\n"
      "[convolutional]\nfilters=7\nsize=1\nstride=32\npad=0\nactivation=linear\n\n"
      "[yolo]\nmask = 0\nanchors = 16,16\nclasses=2\nnum=1\n";
  // x, y, ln of width and height in anchors, objectness, cup, chair; before their sigmoids.
  std::vector<float> bias{0, 0, 0, std::log(4.f), 4, -10, -10};
  std::vector<float> weights = std::vector<float>(21, 0.f);  // 7 x (red, green, blue)
  std::vector<std::int32_t> header{0, 2, 5, 0, 0};

  TinyDarknet() { weights[5 * 3 + 0] = weights[6 * 3 + 1] = 20; }

  std::string weight_bytes() const { return raw(header) + raw(bias) + raw(weights); }
  /// Writes tiny.cfg, tiny.weights and a card, which it says where it is.
  std::filesystem::path write(const NetworkFolder& folder, const std::string& card) const {
    folder.write("tiny.cfg", cfg);
    folder.write("tiny.weights", weight_bytes());
    return folder.write("card.yaml", card);
  }

 private:
  template <class T>
  static std::string raw(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }
};

/// A card of kind objects without `resize`, `labels` and `head`.
inline std::string darknet_card(const std::string& resize = "stretch",
                                const std::string& labels = "[cup, chair]",
                                const std::string& head = "yolov3") {
  return "name: tiny\nkind: objects\nfile: tiny.cfg\nweights: tiny.weights\nhead: " + head +
         "\nlabels: " + labels + "\ninput: {width: 64, height: 64, channels: rgb, fill: 0, " +
         "scale: 0.00392156862745098, resize: " + resize + "}\n";
}

}  // namespace cairn::testing
