#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cairn/synthetic/material.h"

namespace cairn {

/// A picture of a flat surface that is drawn upon in metres: x to the right, y downwards, as
/// textures are read.
class Canvas {
 public:
  struct Lettering {
    float thickness = 0.14f;  ///< of its strokes, by its height
    float max_width = 1e9f;   ///< metres; longer text is made smaller
    bool centred = false;     ///< around x
  };

  /// Of the given size and resolution; very large ones get fewer texels (a million at most).
  Canvas(float width, float height, float texels_per_metre, const Colour& background);

  float width() const { return width_; }
  float height() const { return height_; }

  void rectangle(float x, float y, float width, float height, const Colour& colour);
  void disc(float x, float y, float radius, const Colour& colour);
  void line(float x0, float y0, float x1, float y1, float thickness, const Colour& colour);
  void polygon(const std::vector<Eigen::Vector2f>& corners, const Colour& colour);
  /// Text whose capitals are `height` tall, from x on (or around x), its base line at y.
  void text(const std::string& text, float x, float y, float height, const Colour& colour,
            const Lettering& lettering);
  void text(const std::string& text, float x, float y, float height, const Colour& colour) {
    this->text(text, x, y, height, colour, Lettering());
  }
  /// Multiplies the picture by noise of the given strength (0 to 1) in grains of a size in metres
  /// along x and y: fibres, weaves, wear.
  void grain(float strength, float size_x, float size_y, std::uint64_t seed);

  /// Gives every texel the colour that the function has there.
  void paint(const std::function<Colour(float x, float y)>& colour_at);

  std::shared_ptr<const Texture> texture() const;

 private:
  cv::Point2f texel(float x, float y) const;

  float width_, height_, scale_;
  cv::Mat picture_;
};

}  // namespace cairn
