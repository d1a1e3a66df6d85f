// Lists pixels for light of their own (shade_samples.comp). Needs before the include: `frame`, `surfaces`, `depths`, `listed`, `pixels`, `clusters`,
// `grid`. docs/decisions/0030-light-at-fewer-pixels.md.
#ifndef SKERRY_LIST_PIXELS_GLSL
#define SKERRY_LIST_PIXELS_GLSL
#include "shared/constants.h"
#include "include/light/clusters.glsl"
#include "include/scene/coverage.glsl"

layout(constant_id = kStepConstant) const uint kStep = 4u;         // pixels between the grid's points
layout(constant_id = kLitConstant) const bool kLit = false;        // the frame has lights; if not, buffers are bound that are never read
layout(constant_id = kOracleConstant) const bool kOracle = false;  // every pixel asks every light

uvec2 grid_size() { return (frame.size + (kStep - 1u)) / kStep; }

// @return false where the pixel shows no surface.
bool surface_at(uvec2 pixel, out uint word, out float stored_depth) {
  stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  return word != 0u;
}

// Where an invocation's next pixels go: of the list of those that ask no light, and of the other.
struct Slots {
  uint unlit;
  uint lit;
};

// Room for pixels of each invocation, at most 511: 128 lanes sum to 16 bits. Every invocation calls it once.
Slots first_slots(uint unlit, uint lit) {
  uint counts = unlit | (lit << 16);  // both sums at once
  uint before = subgroupExclusiveAdd(counts), all = subgroupAdd(counts);
  Slots first = Slots(0u, 0u);
  if (subgroupElect()) {  // one for all: GPUs take turns at an address
    first.unlit = atomicAdd(listed[0].tiles, all & 0xffffu);
    if (kLit) first.lit = atomicAdd(listed[1].tiles, all >> 16);
  }
  return Slots(subgroupBroadcastFirst(first.unlit) + (before & 0xffffu), subgroupBroadcastFirst(first.lit) + (before >> 16));
}

void list_pixel(inout Slots next, bool lit, uvec2 pixel) {
  pixels[lit ? uint(pixels.length()) - 1u - next.lit : next.unlit] = pixel.x | (pixel.y << 16);
  next.unlit += lit ? 0u : 1u;
  next.lit += lit ? 1u : 0u;
}

// Whether some light may reach what a pixel shows.
bool asks_lights(uvec2 pixel, float stored_depth) {
  float z = view_distance(surface_depth(stored_depth), frame.near_plane);
  return kLit && (kOracle || clusters[cluster_of(tile_at(pixel), slice_at(z))].count != 0u);
}

#endif
