#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

namespace cairn {

/// What a picture shows around a keypoint: 8x8 grey levels, a pixel apart, with a border for their
/// gradients. It is found again to about a tenth of a pixel where the picture is sharp, corners
/// (see peak_offset) to half a pixel.
class Patch {
 public:
  /// Where a picture shows the pixels of a patch: one that is `u` from the middle is
  /// affine * u / (1 + foreshortening . u) pixels from where the middle is.
  struct Warp {
    Eigen::Matrix2f affine = Eigen::Matrix2f::Identity();
    Eigen::Vector2f foreshortening = Eigen::Vector2f::Zero();  ///< a pixel
  };

  static constexpr int kSize = 8;
  static constexpr int kBordered = kSize + 2;

  /// Around `center`, in pixels of `image` (CV_8UC1, centres at integers); nothing where it would
  /// not lie within.
  static std::optional<Patch> cut(const cv::Mat& image, const Eigen::Vector2f& center);

  /// Where `image` shows the same, near `start`: inverse compositional alignment (Baker and
  /// Matthews, "Lucas-Kanade 20 Years On", 2004, section 3.2) over shift and contrast, whatever the
  /// brightness. Nothing where it does not settle within `reach` pixels, or does not look alike
  /// there.
  std::optional<Eigen::Vector2f> find(const cv::Mat& image, const Eigen::Vector2f& start,
                                      const Warp& warp, float reach) const;

 private:
  std::array<std::uint8_t, std::size_t{kBordered} * kBordered> grey_;
};

}  // namespace cairn
