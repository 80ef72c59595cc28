// What one walks and drives on, and wood.
#include <opencv2/imgproc.hpp>

#include "cairn/synthetic/textures/painting.h"
#include "cairn/synthetic/textures/patterns.h"

namespace cairn::painting {
namespace {

constexpr int kSide = 1024;
const cv::Size kSize(kSide, kSide);

const cv::Vec3f kWoods[] = {
    {92, 138, 180}, {58, 92, 134}, {116, 160, 196}, {44, 66, 98}, {80, 118, 152}};

cv::Vec3f wood_colour(cv::RNG& random) {
  return kWoods[random.uniform(0, 5)] * random.uniform(0.9f, 1.1f);
}

// Long fibres and darker years along x.
cv::Mat1f grain(cv::RNG& random) {
  const cv::Mat1f warp = noise(kSize, 2, 4, 3, 0.5, random);
  const cv::Mat1f fibres = noise(kSize, 8, 128, 3, 0.8, random);
  cv::Mat1f grain(kSize);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      // Sixteen years a side, so that it repeats.
      const float years = std::sin(2 * float(CV_PI) * float(y) * 16 / kSide + 7 * warp(y, x));
      grain(y, x) = 0.5f * years * std::abs(years) + 0.5f * fibres(y, x);
    }
  }
  return grain;
}

void crack(Canvas& canvas, cv::RNG& random) {
  cv::Point2f at(float(random.uniform(0, kSide)), float(random.uniform(0, kSide)));
  float angle = random.uniform(0.f, 6.28f);
  const cv::Scalar dark = cv::Scalar::all(double(random.uniform(28, 48)));
  for (int i = random.uniform(20, 90); i > 0; --i) {
    angle += random.uniform(-0.5f, 0.5f);
    const cv::Point2f next = at + 9 * cv::Point2f(std::cos(angle), std::sin(angle));
    cv::line(canvas, at, next, dark, random.uniform(1, 3));
    at = next;
  }
}

}  // namespace

Texture wood(cv::RNG& random) {
  return {finished(tinted(grain(random), wood_colour(random), 0.14f)), 700};
}

Texture parquet(cv::RNG& random) {
  constexpr int kRows = 16, kBoard = kSide / kRows;
  const cv::Vec3f colour = wood_colour(random);
  const Canvas base = tinted(grain(random), {1, 1, 1}, 0.13f);
  Canvas canvas(kSize);
  for (int row = 0; row < kRows; ++row) {
    const int start = random.uniform(0, kSide);
    for (int at = 0; at < kSide;) {
      int length = random.uniform(300, 620);
      if (kSide - at - length < 250) length = kSide - at;
      // A piece of the grain from elsewhere; no two boards have the same tone.
      const int from_x = random.uniform(0, kSide), from_y = random.uniform(0, kSide);
      const cv::Vec3f tone = colour * random.uniform(0.8f, 1.12f);
      for (int y = 0; y < kBoard; ++y) {
        for (int x = 0; x < length; ++x) {
          const cv::Vec3f& wood = base((y + from_y) % kSide, (x + from_x) % kSide);
          const bool joint = y < 2 || x < 2;
          canvas(row * kBoard + y, (start + at + x) % kSide) =
              wood.mul(tone) * (joint ? 0.45f : 1.f);
        }
      }
      at += length;
    }
  }
  return {finished(canvas), 500};
}

Texture carpet(cv::RNG& random) {
  const cv::Vec3f colour = muted(random, 70, 150, 0.25f);
  Canvas canvas = tinted(noise(kSize, 256, 256, 2, 0.9, random), colour, 0.2f);
  darken(canvas, noise(kSize, 4, 4, 4, 0.6, random), 0.06f);
  const cv::Vec3f second = muted(random, 60, 190, 0.3f);
  for (int i = 0; i < 5000; ++i) {
    const int x = random.uniform(0, kSide - 3), y = random.uniform(0, kSide - 3);
    fill(canvas, {x, y, random.uniform(1, 4), random.uniform(1, 4)},
         second * random.uniform(0.7f, 1.2f));
  }
  return {finished(canvas), 420};
}

Texture tiles(cv::RNG& random) {
  constexpr int kCount = 8, kTile = kSide / kCount;
  const cv::Vec3f colour = muted(random, 120, 215, 0.06f);
  const cv::Vec3f joint = muted(random, 70, 140, 0.05f);
  Canvas canvas = tinted(noise(kSize, 16, 16, 5, 0.75, random), colour, 0.045f);
  const bool chequered = random.uniform(0, 3) == 0;
  for (int row = 0; row < kCount; ++row) {
    for (int column = 0; column < kCount; ++column) {
      const cv::Rect tile(column * kTile, row * kTile, kTile, kTile);
      float tone = random.uniform(0.94f, 1.06f);
      if (chequered && (row + column) % 2 != 0) tone *= 0.55f;
      canvas(tile) *= tone;
      fill(canvas, {tile.x, tile.y, kTile, 3}, joint);
      fill(canvas, {tile.x, tile.y, 3, kTile}, joint);
    }
  }
  return {finished(canvas), kTile / 0.3f};
}

Texture asphalt(cv::RNG& random) {
  const float grey = random.uniform(70.f, 100.f);
  Canvas canvas = tinted(noise(kSize, 256, 256, 2, 0.9, random), {grey, grey, grey}, 0.14f);
  darken(canvas, noise(kSize, 4, 4, 5, 0.6, random), 0.09f);
  for (int i = 0; i < 5; ++i) {  // mended places
    const int w = random.uniform(90, 330), h = random.uniform(90, 330);
    const cv::Rect patch(random.uniform(0, kSide - w), random.uniform(0, kSide - h), w, h);
    canvas(patch) *= random.uniform(0.72f, 0.93f);
    cv::rectangle(canvas, patch, cv::Scalar::all(42), 3);
  }
  for (int i = 0; i < 8; ++i) crack(canvas, random);
  for (int i = 0; i < 30; ++i) {  // oil and chewing gum
    const cv::Point at(random.uniform(0, kSide), random.uniform(0, kSide));
    const double tone = random.uniform(0, 3) == 0 ? 140 : 45;
    cv::circle(canvas, at, random.uniform(2, 9), cv::Scalar::all(tone), cv::FILLED);
  }
  cv::GaussianBlur(canvas, canvas, {3, 3}, 0.7, 0, cv::BORDER_REPLICATE);
  return {finished(canvas), 110};
}

Texture paving(cv::RNG& random) {
  constexpr int kCount = 10;
  const cv::Vec3f colour = muted(random, 120, 165, 0.05f);
  Canvas canvas = tinted(noise(kSize, 64, 64, 4, 0.85, random), colour, 0.08f);
  for (int row = 0; row < kCount; ++row) {
    for (int column = 0; column < kCount; ++column) {
      const int x = column * kSide / kCount, y = row * kSide / kCount;
      const cv::Rect slab(x, y, (column + 1) * kSide / kCount - x, (row + 1) * kSide / kCount - y);
      canvas(slab) *= random.uniform(0.88f, 1.1f);
      fill(canvas, {x, y, slab.width, 3}, colour * 0.5f);
      fill(canvas, {x, y, 3, slab.height}, colour * 0.5f);
    }
  }
  return {finished(canvas), 200};
}

}  // namespace cairn::painting
