#include "cairn/features/patch.h"

#include <Eigen/LU>
#include <cmath>

namespace cairn {
namespace {

constexpr int kIterations = 12;
constexpr float kSettled = 0.01F;            // pixels of the patch
constexpr float kLeastLikeness = 0.8F;       // correlation
constexpr float kLeastContrast = 0.1F;       // of the patch's own
constexpr float kLeastDeterminant = 1;       // of the normal equations, grey levels to the sixth
constexpr float kMostForeshortening = 0.5F;  // of the depth, from the middle to a corner
constexpr float kHalf = (Patch::kSize - 1) / 2.0F;

using Greys = Eigen::Array<float, Patch::kSize * Patch::kSize, 1>;

float interpolate(const cv::Mat& image, float x, float y) {
  const int c = static_cast<int>(x), r = static_cast<int>(y);
  const float a = x - static_cast<float>(c), b = y - static_cast<float>(r);
  const std::uint8_t* const p = image.data + static_cast<std::size_t>(r) * image.step + c;
  const std::uint8_t* const q = p + image.step;
  const auto p0 = static_cast<float>(p[0]), q0 = static_cast<float>(q[0]);
  const float upper = p0 + a * (static_cast<float>(p[1]) - p0);
  const float lower = q0 + a * (static_cast<float>(q[1]) - q0);
  return upper + b * (lower - upper);
}

bool inside(const cv::Mat& image, const Eigen::Vector2f& center, const Eigen::Vector2f& extent) {
  const Eigen::Vector2f far = center + extent;
  return (center - extent).minCoeff() >= 0 && far.x() < static_cast<float>(image.cols - 1) &&
         far.y() < static_cast<float>(image.rows - 1);
}

// Of the pixels of a patch, from its middle, in the picture.
struct Offsets {
  explicit Offsets(const Patch::Warp& warp) {
    for (int r = 0; r < Patch::kSize; ++r) {
      for (int c = 0; c < Patch::kSize; ++c) {
        const Eigen::Vector2f u(static_cast<float>(c) - kHalf, static_cast<float>(r) - kHalf);
        const Eigen::Vector2f at = warp.affine * u / (1 + warp.foreshortening.dot(u));
        x[r * Patch::kSize + c] = at.x();
        y[r * Patch::kSize + c] = at.y();
      }
    }
  }
  Eigen::Vector2f extent() const { return {x.abs().maxCoeff(), y.abs().maxCoeff()}; }

  Greys x, y;
};

Greys sample(const cv::Mat& image, const Eigen::Vector2f& center, const Offsets& offsets) {
  Greys greys;
  for (int i = 0; i < greys.size(); ++i) {
    greys[i] = interpolate(image, center.x() + offsets.x[i], center.y() + offsets.y[i]);
  }
  return greys;
}

}  // namespace

std::optional<Patch> Patch::cut(const cv::Mat& image, const Eigen::Vector2f& center) {
  constexpr float kExtent = (kBordered - 1) / 2.0F;
  if (!inside(image, center, Eigen::Vector2f::Constant(kExtent))) return std::nullopt;
  Patch patch;
  const float x = center.x() - kExtent, y = center.y() - kExtent;
  for (int r = 0; r < kBordered; ++r) {
    for (int c = 0; c < kBordered; ++c) {
      const float grey = interpolate(image, x + static_cast<float>(c), y + static_cast<float>(r));
      patch.grey_[r * kBordered + c] = static_cast<std::uint8_t>(grey + 0.5F);
    }
  }
  return patch;
}

std::optional<Eigen::Vector2f> Patch::find(const cv::Mat& image, const Eigen::Vector2f& start,
                                           const Warp& warp, float reach) const {
  if (!(warp.foreshortening.lpNorm<1>() * kHalf < kMostForeshortening)) return std::nullopt;
  Greys grey, dx, dy;
  for (int r = 0; r < kSize; ++r) {
    for (int c = 0; c < kSize; ++c) {
      const std::uint8_t* const p = &grey_[(r + 1) * kBordered + c + 1];
      const int i = r * kSize + c;
      grey[i] = p[0];
      dx[i] = 0.5F * static_cast<float>(p[1] - p[-1]);
      dy[i] = 0.5F * static_cast<float>(p[kBordered] - p[-kBordered]);
    }
  }
  // What the picture shows is taken for contrast * (patch + gradient * shift) + brightness, linear
  // in contrast, contrast * shift, and brightness, of which the last falls out with the means.
  grey -= grey.mean();
  dx -= dx.mean();
  dy -= dy.mean();
  Eigen::Matrix3f H;
  H << (dx * dx).sum(), (dx * dy).sum(), (dx * grey).sum(),  //
      0, (dy * dy).sum(), (dy * grey).sum(),                 //
      0, 0, (grey * grey).sum();
  H.triangularView<Eigen::StrictlyLower>() = H.transpose();
  const float power = H(2, 2);
  Eigen::Matrix3f inverse;
  bool invertible = false;
  H.computeInverseWithCheck(inverse, invertible, kLeastDeterminant);
  if (!invertible) return std::nullopt;

  const Offsets offsets(warp);
  const Eigen::Vector2f extent = offsets.extent();
  Eigen::Vector2f center = start;
  for (int k = 0; k < kIterations; ++k) {
    if (!inside(image, center, extent)) return std::nullopt;
    Greys seen = sample(image, center, offsets);
    seen -= seen.mean();
    const Eigen::Vector3f b((seen * dx).sum(), (seen * dy).sum(), (seen * grey).sum());
    const Eigen::Vector3f fit = inverse * b;
    if (!(fit.z() > kLeastContrast)) return std::nullopt;
    const Eigen::Vector2f shift = fit.head<2>() / fit.z();
    center -= warp.affine * shift;
    if (!((center - start).squaredNorm() <= reach * reach)) return std::nullopt;
    if (shift.squaredNorm() > kSettled * kSettled) continue;
    const float likeness = b.z() / std::sqrt(power * (seen * seen).sum());
    if (!(likeness >= kLeastLikeness)) return std::nullopt;
    return center;
  }
  return std::nullopt;
}

}  // namespace cairn
