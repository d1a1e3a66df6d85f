// Which pixel an invocation of a tile-listed pass works on (classify_tiles.comp). Needs before the include: `frame`.
#ifndef SKERRY_TILES_GLSL
#define SKERRY_TILES_GLSL
#include "shared/bindings.h"

layout(scalar, binding = kTilesBinding) readonly buffer Tiles { uint tiles[]; };  // x | y << 16
layout(scalar, binding = kTileDispatchesBinding) readonly buffer Dispatches { TileDispatch dispatches[]; };
layout(push_constant) uniform Push { uint kind; } push;  // of tiles: render::TileKind

// @return false where there is no such tile; `first` is then the first pixel of some tile.
bool listed_tile(out uvec2 first) {
  uvec2 count = (frame.size + 7u) / 8u;
  uint slot = gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x;
  bool here = slot < dispatches[push.kind].tiles;
  uint tile = tiles[push.kind * count.x * count.y + (here ? slot : 0u)];
  first = uvec2(tile & 0xffffu, tile >> 16) * 8u;
  return here;
}

// @return false where there is no such tile or the picture has no such pixel; `pixel` is then some valid pixel.
bool tile_pixel(out uvec2 pixel) {
  uvec2 first;
  bool here = listed_tile(first);
  pixel = first + gl_LocalInvocationID.xy;
  here = here && all(lessThan(pixel, frame.size));
  pixel = min(pixel, frame.size - 1u);
  return here;
}
#endif
