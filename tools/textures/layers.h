#pragma once
#include <string>
#include <vector>

#include "tools/textures/canvas.h"

namespace skerry::textures {

/// One layer of the texture array. docs/textures.md lists them all.
struct Layer {
  std::string name;  ///< lower-case words joined by '_', unique
  Canvas canvas;
};

/// All layers in the array's order: those of world::Texture, then the builders' palette. Always
/// 256.
std::vector<Layer> paint_layers();

}  // namespace skerry::textures
