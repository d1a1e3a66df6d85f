// What the tile of a pixel knows of the ways to its lights (cull_shafts.comp); without SKERRY_SHAFTS nothing. Needs before the include, with it:
// clusters.glsl.
#ifndef SKERRY_SHAFTS_GLSL
#define SKERRY_SHAFTS_GLSL
#include "shared/shafts.h"
#include "shared/bindings.h"
#include "shared/constants.h"

// Where a pixel's list of its tile is, and whether there is one.
struct ShaftList {
  uint tile;
  uint first;  // word
  bool known;
};
const ShaftList kNoShafts = ShaftList(0u, 0u, false);

// A word's places of a list of `count` lights that are in use.
uint places_of(uint word, uint count) {
  uint left = count - word * 32u;
  return left < 32u ? (1u << left) - 1u : ~0u;
}

#ifdef SKERRY_SHAFTS
layout(constant_id = kShaftsConstant) const bool kShafts = false;  // else a buffer is bound that is never read

layout(scalar, binding = kTileShaftsBinding) readonly buffer Shafts { TileShafts tile_shafts[]; };

// @param z distance along the view axis.
ShaftList shafts_at(uvec2 pixel, float z) {
  ShaftList list = kNoShafts;
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
  uint all = places_of(word, count);
  bool known = kShafts && list.known && word < kShaftWords;
  return known ? tile_shafts[list.tile].asked[list.first + word] & all : all;
}
// Those of them whose ways are open.
uint open_of(ShaftList list, uint word) {
  bool known = kShafts && list.known && word < kShaftWords;
  return known ? tile_shafts[list.tile].open[list.first + word] : 0u;
}
#else
const bool kShafts = false;
ShaftList shafts_at(uvec2 pixel, float z) { return kNoShafts; }
uint asked_of(ShaftList list, uint word, uint count) { return places_of(word, count); }
uint open_of(ShaftList list, uint word) { return 0u; }
#endif
#endif
