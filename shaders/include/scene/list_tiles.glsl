// Lists tiles by kind, for passes that include tiles.glsl. Needs before the include: shared/frame.h.
#ifndef SKERRY_LIST_TILES_GLSL
#define SKERRY_LIST_TILES_GLSL
#include "shared/bindings.h"

layout(scalar, binding = kTileDispatchesBinding) buffer Dispatches { TileDispatch dispatches[]; };
layout(scalar, binding = kTilesBinding) writeonly buffer Tiles { uint tiles[]; };  // [kind][tile]: x | y << 16

// @param count of tiles of the picture, across and down.
void list_tile(uint kind, uvec2 tile, uvec2 count) {
  uint slot = atomicAdd(dispatches[kind].tiles, 1u);
  atomicMax(dispatches[kind].groups_x, min(slot + 1u, kTileRow));
  if (slot % kTileRow == 0u) atomicMax(dispatches[kind].groups_y, slot / kTileRow + 1u);
  tiles[kind * count.x * count.y + slot] = tile.x | (tile.y << 16);
}
#endif
