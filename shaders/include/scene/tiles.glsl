// Which pixel an invocation of a tile-listed pass works on (classify_tiles.comp). Needs before the include: `frame`.
#ifndef SKERRY_TILES_GLSL
#define SKERRY_TILES_GLSL
#include "shared/bindings.h"
#include "shared/constants.h"

layout(scalar, binding = kTilesBinding) readonly buffer Tiles { TileDispatch dispatches[kListKinds]; uint tiles[]; };  // x | y << 16
layout(push_constant) uniform Push { uint kind; } push;  // of tiles: render::TileKind

bool is_listed(uint slot) { return slot < dispatches[push.kind].tiles; }

// @return false where there is no such tile; `first` is then the first pixel of some tile.
// @param slot in the list.
bool tile_in(uint slot, out uvec2 first) {
  uvec2 count = (frame.size + 7u) / 8u;
  bool here = is_listed(slot);
  uint tile = tiles[push.kind * count.x * count.y + (here ? slot : 0u)];
  first = uvec2(tile & 0xffffu, tile >> 16) * 8u;
  return here;
}

// The tile of a work group.
bool listed_tile(out uvec2 first) { return tile_in(gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x, first); }

// Of squares in place of tiles. @param slot in the list.
bool listed_square(uint slot, out uvec2 first) {
  uvec2 count = (frame.size + 7u) / 8u;
  uint room = count.x * count.y * (kTileEdge / kSquareEdge) * (kTileEdge / kSquareEdge);
  bool keeps = ((push.kind - kPlainSquares) & 1u) != 0u;
  uint begin = kTileKinds * count.x * count.y + (keeps ? room : 0u), last = begin + room - 1u;
  bool here = is_listed(slot);
  uint place = here ? slot : 0u, square = tiles[push.kind < kMixedSquares ? begin + place : last - place];
  first = uvec2(square & 0xffffu, square >> 16) * kSquareEdge;
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
