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
/// Alpha of cut-outs, which is 0 or 1 on the canvas, is scaled so that alpha >= 128 covers the same
/// share of every mip, to half a texel; any other alpha is averaged. Source: I. Castano, Computing
/// Alpha Mipmaps (2010); the share is met by rank instead of by search.
std::vector<Mip> make_mips(const Canvas& canvas);

}  // namespace skerry::textures
