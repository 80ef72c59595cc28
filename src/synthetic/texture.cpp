#include "cairn/synthetic/texture.h"

#include "cairn/synthetic/textures/patterns.h"

namespace cairn {
namespace {

Texture painted(Pattern pattern, cv::RNG& random) {
  switch (pattern) {
    case Pattern::kWood:
      return painting::wood(random);
    case Pattern::kParquet:
      return painting::parquet(random);
    case Pattern::kCarpet:
      return painting::carpet(random);
    case Pattern::kTiles:
      return painting::tiles(random);
    case Pattern::kPlaster:
      return painting::plaster(random);
    case Pattern::kWallpaper:
      return painting::wallpaper(random);
    case Pattern::kPoster:
      return painting::poster(random);
    case Pattern::kBrick:
      return painting::brick(random);
    case Pattern::kAsphalt:
      return painting::asphalt(random);
    case Pattern::kPaving:
      return painting::paving(random);
    case Pattern::kFacade:
      return painting::facade(random);
    case Pattern::kFoliage:
      return painting::foliage(random);
    case Pattern::kView:
      break;
  }
  return painting::view(random);
}

}  // namespace

std::shared_ptr<const Texture> make_texture(Pattern pattern, std::uint64_t seed) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ull + 0x632BE59BD9B4E019ull + std::uint64_t(pattern));
  return std::make_shared<const Texture>(painted(pattern, random));
}

}  // namespace cairn
