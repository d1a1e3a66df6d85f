// What the tile of a pixel knows of the ways to its lights (cull_shafts.comp). Needs before the include: clusters.glsl.
#ifndef SKERRY_SHAFTS_GLSL
#define SKERRY_SHAFTS_GLSL
#include "shared/shafts.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(constant_id = kShaftsConstant) const bool kShafts = false;  // else a buffer is bound that is never read

layout(scalar, binding = kTileShaftsBinding) readonly buffer Shafts { TileShafts tile_shafts[]; };

// Where a pixel's list of its tile is, and whether there is one.
struct ShaftList {
  uint tile;
  uint first;  // word
  bool known;
};

// @param z distance along the view axis.
ShaftList shafts_at(uvec2 pixel, float z) {
  ShaftList list = ShaftList(0u, 0u, false);
  if (!kShafts) return list;
  list.tile = (pixel.y >> 3) * ((grid.size.x + 7u) >> 3) + (pixel.x >> 3);
  uint slices = tile_shafts[list.tile].slices, slice = slice_at(z);
  bool second = (slices >> 8) == slice;
  list.first = second ? kShaftWords : 0u;
  list.known = second || (slices & 255u) == slice;
  return list;
}

// Lights 32 * word to 32 * word + 31 of a list of `count`: those that may light the pixel.
uint asked_of(ShaftList list, uint word, uint count) {
  uint left = count - word * 32u;
  uint all = left < 32u ? (1u << left) - 1u : ~0u;
  bool known = kShafts && list.known && word < kShaftWords;
  return known ? tile_shafts[list.tile].asked[list.first + word] & all : all;
}
// Those of them whose ways are open.
uint open_of(ShaftList list, uint word) {
  bool known = kShafts && list.known && word < kShaftWords;
  return known ? tile_shafts[list.tile].open[list.first + word] : 0u;
}
#endif
