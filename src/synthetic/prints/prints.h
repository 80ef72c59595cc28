#pragma once

#include "cairn/synthetic/models/dice.h"
#include "cairn/synthetic/prints/canvas.h"

// Pictures that are printed on things. Sizes in metres.

namespace cairn {

using Print = std::shared_ptr<const Texture>;

/// What is around a mug: stripes, dots, a name, a picture; `width` is all the way around.
Print mug_print(float width, float height, const Colour& ground, Dice& dice);
/// A paper label around a bottle, its front in the middle.
Print bottle_label(float width, float height, Dice& dice);
Print book_cover(float width, float height, const Colour& ground, Dice& dice);
/// Title and author along a spine, which runs along the picture's height.
Print book_spine(float width, float height, const Colour& ground, Dice& dice);
/// The edges of paper sheets that lie on each other.
Print page_edges(float width, float height, Dice& dice);
/// A desktop with windows, text, code and icons, or a photograph-like scene.
Print screen_content(float width, float height, Dice& dice);
/// A board of wood, its grain along the longer side.
Print wood(float width, float height, const Colour& colour, Dice& dice);
/// Woven threads.
Print fabric(const Colour& colour, Dice& dice);
/// A sheet of paper on a wall: a bold heading, blocks of colour, lines of text.
Print poster_print(float width, float height, Dice& dice);

}  // namespace cairn
