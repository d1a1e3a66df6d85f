#pragma once
#include <cstdint>
#include <vector>

#include "tools/textures/canvas.h"

namespace skerry::textures {

/// One mip of one layer: edge^2 texels of R, G, B (sRGB) and A (coverage), row 0 on top.
struct Mip {
  int edge;
  std::vector<std::uint8_t> rgba;
};

/// The mips of a layer, edges 32, 16, ... 1. Averages are taken of linear light, weighted by alpha.
/// Where alpha is 0 the colour is that of the surroundings, so that filtering draws no dark fringe.
/// Alpha of cut-outs, which is 0 or 1 on the canvas, is scaled in each mip of 2 x 2 texels or more
/// so that a bilinear filter finds a half or more at the same share of places, to 1/100; any other
/// alpha is averaged. Source: I. Castano, Computing Alpha Mipmaps (2010); the share is that of what
/// is filtered, and met by rank instead of by search.
std::vector<Mip> make_mips(const Canvas& canvas);

}  // namespace skerry::textures
