#pragma once

#include <cstdint>
#include <memory>

#include "cairn/synthetic/material.h"

namespace cairn {

/// What the surfaces of buildings and streets look like. Colours are part of it.
enum class Pattern {
  kWood,       ///< one board, grain along u
  kParquet,    ///< a floor of many boards
  kCarpet,     ///< speckled pile
  kTiles,      ///< square tiles with joints
  kPlaster,    ///< a painted wall: hardly anything to see
  kWallpaper,  ///< a repeating ornament
  kPoster,     ///< one print with picture and text, poster_size large
  kBrick,      ///< a wall of bricks
  kAsphalt,    ///< a road with patches and cracks
  kPaving,     ///< slabs of a pavement
  kFacade,     ///< a house: storeys of windows, facade_size large
  kFoliage,    ///< leaves
  kView,       ///< what one sees through a window, view_size large
};

inline const Eigen::Vector2f poster_size(0.6f, 0.8f), facade_size(12, 12), view_size(2, 1.5f);

/// The same arguments give the same picture; all of them repeat. Those with a size in metres fill
/// it once, their left top at texture coordinate (0, 0), u to the right, v down.
std::shared_ptr<const Texture> make_texture(Pattern pattern, std::uint64_t seed);

}  // namespace cairn
