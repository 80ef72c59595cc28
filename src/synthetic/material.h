#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>

namespace cairn {

/// Linear light, red green blue; surfaces reflect 0 to 1 of it.
using Colour = Eigen::Vector3f;

/// A picture that covers a surface and repeats, with detail at every scale.
struct Texture {
  cv::Mat picture;             ///< CV_8UC3, BGR, sRGB-encoded as pictures in files are
  float texels_per_metre = 0;  ///< texture coordinates of meshes are in metres on the surface
};

/// How a surface reflects light: a diffuse part and a glossy highlight over it (Blinn-Phong).
struct Material {
  Colour colour = Colour::Constant(0.5f);            ///< diffuse albedo; tints the texture
  std::shared_ptr<const Texture> texture = nullptr;  ///< none: plain
  float gloss = 0;                                   ///< strength of the highlight, 0 to 1
  float shininess = 30;              ///< exponent of the highlight: sharper when larger
  Colour emission = Colour::Zero();  ///< times the texture: a screen that is on
};

}  // namespace cairn
