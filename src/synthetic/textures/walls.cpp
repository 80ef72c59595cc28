// What stands upright: walls, houses, hedges, and what hangs on them.
#include <opencv2/imgproc.hpp>

#include "cairn/synthetic/texture.h"
#include "cairn/synthetic/textures/painting.h"
#include "cairn/synthetic/textures/patterns.h"

namespace cairn::painting {
namespace {

constexpr int kSide = 1024;
const cv::Size kSize(kSide, kSide);

cv::Scalar scalar(const cv::Vec3f& colour) { return {colour[0], colour[1], colour[2]}; }

// A window with frame, panes that mirror the sky above and show curtains or darkness, a sill.
void paint_window(Canvas& canvas, const cv::Rect& hole, const cv::Vec3f& frame, cv::RNG& random) {
  fill(canvas, {hole.x - 3, hole.y - 3, hole.width + 6, hole.height + 6}, frame * 0.55f);
  fill(canvas, hole, frame);
  const int bar = 4, panes = hole.width > 70 ? 3 : 2;
  const float dark = random.uniform(28.f, 60.f);
  const int curtain = random.uniform(0, 3) == 0 ? random.uniform(8, hole.height / 2) : 0;
  for (int i = 0; i < panes; ++i) {
    const int x = hole.x + bar + i * (hole.width - bar) / panes;
    const cv::Rect pane(x, hole.y + bar, (hole.width - bar) / panes - bar, hole.height - 2 * bar);
    for (int y = 0; y < pane.height; ++y) {
      const float sky = std::max(0.f, 1 - 1.6f * float(y) / float(pane.height));
      cv::Vec3f glass = cv::Vec3f(1.15f, 1.05f, 0.95f) * (dark + 70 * sky * sky);
      if (y < curtain) glass = cv::Vec3f(175, 185, 190) * (0.8f + 0.1f * float(y % 7) / 7);
      fill(canvas, {pane.x, pane.y + y, pane.width, 1}, glass);
    }
  }
  fill(canvas, {hole.x - 6, hole.y + hole.height, hole.width + 12, 6}, frame * 0.85f);
  fill(canvas, {hole.x - 6, hole.y + hole.height + 6, hole.width + 12, 4}, frame * 0.4f);
}

Canvas bricks(cv::RNG& random, int rows, int columns) {
  const cv::Vec3f joint = muted(random, 130, 180, 0.06f);
  const cv::Vec3f clay = cv::Vec3f(62, 78, 140) * random.uniform(0.75f, 1.3f);
  Canvas canvas = tinted(noise(kSize, 128, 128, 3, 0.8, random), {1, 1, 1}, 0.1f);
  const Canvas surface = canvas.clone();
  canvas = tinted(noise(kSize, 128, 128, 2, 0.8, random), joint, 0.06f);
  for (int row = 0; row < rows; ++row) {
    const int top = row * kSide / rows, bottom = (row + 1) * kSide / rows;
    for (int column = 0; column < columns; ++column) {
      const int shift = row % 2 * kSide / columns / 2;
      const int left = column * kSide / columns + shift;
      const int right = (column + 1) * kSide / columns + shift;
      const int gap = std::max(1, (bottom - top) / 8);
      const cv::Vec3f tone = clay * random.uniform(0.72f, 1.18f);
      for (int y = top; y < bottom - gap; ++y) {
        for (int x = left; x < right - gap; ++x) {
          canvas(y, x % kSide) = surface(y, x % kSide).mul(tone);
        }
      }
    }
  }
  return canvas;
}

}  // namespace

Texture plaster(cv::RNG& random) {
  const cv::Vec3f colour = muted(random, 195, 230, 0.05f);
  Canvas canvas = tinted(noise(kSize, 2, 2, 4, 0.6, random), colour, 0.012f);
  darken(canvas, noise(kSize, 128, 128, 2, 0.9, random), 0.008f);
  return {finished(canvas), 300};
}

Texture wallpaper(cv::RNG& random) {
  constexpr int kMotif = 128;
  const cv::Vec3f ground = muted(random, 170, 225, 0.1f);
  const cv::Vec3f ink = ground * random.uniform(0.72f, 0.88f);
  Canvas canvas = tinted(noise(kSize, 128, 128, 2, 0.9, random), ground, 0.012f);
  const int petals = random.uniform(4, 8), length = random.uniform(22, 40);
  const bool stripes = random.uniform(0, 2) == 0;
  for (int row = 0; row < kSide / kMotif; ++row) {
    for (int column = 0; column < kSide / kMotif; ++column) {
      const int x = column * kMotif + kMotif / 4 + row % 2 * kMotif / 2;
      const cv::Point at(x, row * kMotif + kMotif / 2);
      if (stripes && row == 0) {
        fill(canvas, {column * kMotif, 0, 5, kSide}, ink);
        fill(canvas, {column * kMotif + 11, 0, 2, kSide}, ink);
      }
      for (int i = 0; i < petals; ++i) {
        const double angle = 2 * CV_PI * i / petals;
        const cv::Point tip(int(length * 0.6 * std::cos(angle)),
                            int(length * 0.6 * std::sin(angle)));
        cv::ellipse(canvas, at + tip, {length / 2, length / 5}, angle * 180 / CV_PI, 0, 360,
                    scalar(ink), cv::FILLED);
      }
      cv::circle(canvas, at, length / 5, scalar(ground * 0.6f), cv::FILLED);
    }
  }
  cv::GaussianBlur(canvas, canvas, {3, 3}, 0.8, 0, cv::BORDER_REPLICATE);
  return {finished(canvas), 480};
}

Texture brick(cv::RNG& random) { return {finished(bricks(random, 32, 10)), kSide / 2.4f}; }

Texture facade(cv::RNG& random) {
  const float scale = kSide / facade_size.x();
  const bool of_brick = random.uniform(0, 3) == 0;
  Canvas canvas = of_brick ? bricks(random, 128, 48)
                           : tinted(noise(kSize, 64, 64, 4, 0.7, random),
                                    muted(random, 120, 215, 0.14f), 0.035f);
  // Rain has run down the wall.
  darken(canvas, noise(kSize, 64, 4, 3, 0.7, random), 0.045f);
  const cv::Vec3f frame =
      random.uniform(0, 3) == 0 ? muted(random, 50, 90, 0.15f) : muted(random, 200, 235, 0.03f);
  const int columns = random.uniform(3, 7), storeys = 4;
  const float wide = random.uniform(0.9f, 1.5f), tall = random.uniform(1.3f, 1.8f);
  const bool shop = random.uniform(0, 2) == 0;
  const int door = random.uniform(0, columns);
  for (int storey = 0; storey < storeys; ++storey) {
    const auto floor_y = int((storey + 1) * 3 * scale);
    const bool ground = storey == storeys - 1;
    if (!ground) fill(canvas, {0, floor_y - 8, kSide, 8}, muted(random, 120, 190, 0.03f));
    for (int column = 0; column < columns; ++column) {
      const int middle = (2 * column + 1) * kSide / (2 * columns);
      if (ground && column == door) {
        const cv::Rect hole(middle - int(0.55f * scale), floor_y - int(2.2f * scale),
                            int(1.1f * scale), int(2.2f * scale));
        fill(canvas, {hole.x - 5, hole.y - 5, hole.width + 10, hole.height + 5}, frame * 0.7f);
        fill(canvas, hole, vivid(random) * 0.45f);
        fill(canvas, {hole.x + 12, hole.y + 12, hole.width - 24, 40}, {45, 42, 40});
      } else {
        const float w = ground && shop ? 0.8f * facade_size.x() / float(columns) : wide;
        const float h = ground && shop ? 2.1f : tall, sill = ground && shop ? 0.4f : 0.95f;
        paint_window(canvas,
                     {middle - int(0.5f * w * scale), floor_y - int((sill + h) * scale),
                      int(w * scale), int(h * scale)},
                     frame, random);
      }
    }
    if (ground && shop) {
      const cv::Rect sign(30, floor_y - int(2.95f * scale), kSide - 60, int(0.38f * scale));
      fill(canvas, sign, vivid(random) * 0.7f);
      write_text(canvas, {sign.x + random.uniform(20, 300), sign.y + 4, 500, 28}, 18,
                 {235, 235, 235}, random);
    }
  }
  return {finished(canvas), scale};
}

Texture foliage(cv::RNG& random) {
  const cv::Vec3f leaf = cv::Vec3f(46, 108, 78) * random.uniform(0.7f, 1.1f);
  Canvas canvas = tinted(noise(kSize, 32, 32, 4, 0.8, random), leaf * 0.45f, 0.3f);
  for (int i = 0; i < 9000; ++i) {
    const cv::Point at(random.uniform(0, kSide), random.uniform(0, kSide));
    cv::ellipse(canvas, at, {random.uniform(5, 11), random.uniform(2, 5)},
                double(random.uniform(0, 180)), 0, 360, scalar(leaf * random.uniform(0.5f, 1.5f)),
                cv::FILLED);
  }
  return {finished(canvas), 130};
}

Texture poster(cv::RNG& random) {
  constexpr float kScale = 900;
  const cv::Size size(int(poster_size.x() * kScale), int(poster_size.y() * kScale));
  Canvas canvas(size, muted(random, 215, 245, 0.04f));
  if (random.uniform(0, 2) == 0) canvas.setTo(scalar(vivid(random)));
  const int margin = random.uniform(16, 40);
  const cv::Rect inner(margin, margin, size.width - 2 * margin,
                       size.height * random.uniform(5, 8) / 10);
  const cv::Vec3f low = vivid(random), high = vivid(random);
  for (int y = 0; y < inner.height; ++y) {
    const float t = float(y) / float(inner.height);
    fill(canvas, {inner.x, inner.y + y, inner.width, 1}, (1 - t) * high + t * low);
  }
  // Hills or shapes.
  cv::Mat inside = canvas(inner);
  for (int i = random.uniform(4, 16); i > 0; --i) {
    const cv::Point at(random.uniform(0, inner.width), random.uniform(0, inner.height));
    const int size_px = random.uniform(15, 130);
    const cv::Scalar ink = scalar(vivid(random));
    if (random.uniform(0, 2) == 0) {
      cv::circle(inside, at, size_px, ink, cv::FILLED);
    } else {
      const std::vector<cv::Point> corners = {at, at + cv::Point(size_px, random.uniform(-60, 120)),
                                              at + cv::Point(random.uniform(-120, 60), size_px)};
      cv::fillConvexPoly(inside, corners, ink);
    }
  }
  const int below = inner.y + inner.height + 12;
  const cv::Vec3f ink = muted(random, 15, 50, 0.1f);
  write_text(canvas, {margin, below, inner.width, 50}, random.uniform(34, 48), ink, random);
  write_text(canvas, {margin, below + 62, inner.width, size.height - below - 62 - margin},
             random.uniform(9, 15), ink, random);
  return {finished(canvas), kScale};
}

Texture view(cv::RNG& random) {
  constexpr float kScale = 256;
  const cv::Size size(int(view_size.x() * kScale), int(view_size.y() * kScale));
  Canvas canvas(size);
  const int horizon = size.height * random.uniform(45, 65) / 100;
  for (int y = 0; y < size.height; ++y) {
    const float t = float(y) / float(horizon);
    const cv::Vec3f sky = cv::Vec3f(250, 228, 205) * (1 - 0.5f * t) + cv::Vec3f(120, 120, 120) * t;
    fill(canvas, {0, y, size.width, 1}, y < horizon ? sky : cv::Vec3f(88, 118, 108));
  }
  for (int i = 0; i < 14; ++i) {  // houses and trees far away
    const int w = random.uniform(30, 90), h = random.uniform(20, 110);
    const cv::Rect house(random.uniform(-20, size.width), horizon - h + 10, w, h);
    if (random.uniform(0, 2) == 0) {
      fill(canvas, house, muted(random, 120, 200, 0.12f));
    } else {
      cv::circle(canvas, {house.x, horizon - 5}, w / 2, scalar({66, 82 + float(h) / 4, 72}),
                 cv::FILLED);
    }
  }
  cv::GaussianBlur(canvas, canvas, {0, 0}, 3, 0, cv::BORDER_REPLICATE);
  return {finished(canvas), kScale};
}

}  // namespace cairn::painting
