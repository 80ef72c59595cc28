#pragma once

#include "cairn/synthetic/mesh.h"
#include "cairn/synthetic/models/dice.h"
#include "cairn/synthetic/prints/prints.h"

namespace cairn {

/// The keys of a keyboard, lying: columns run along +y from 0 to `width`, rows along +x (towards
/// the typist) from 0 to `depth`; the keys stand on z = 0.
struct Keys {
  Mesh mesh;      ///< one material: the legends' print
  Print legends;  ///< all keys from above
  float width = 0, depth = 0;
};

struct KeyOptions {
  float pitch = 0.019f;  ///< from key to key, metres
  float height = 0.007f;
  float gap = 0.0025f;
  bool function_row = true, number_pad = true;
  Colour colour = Colour::Constant(0.02f);
};

Keys make_keys(const KeyOptions& options, Dice& dice);

}  // namespace cairn
