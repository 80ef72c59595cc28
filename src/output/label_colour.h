#pragma once

#include <string>

#include "cairn/output/map_ply.h"

namespace cairn {

/// The colour of a plane of this label in all that cairn draws: walls, floors, ceilings, tables,
/// cabinets and doors, with what is like them, have one each, and all other labels one together.
/// Told apart by the colour-blind, too (Okabe and Ito, "Color universal design", 2008).
Rgb label_colour(const std::string& label);

}  // namespace cairn
