// Lists tiles by kind, for passes that include tiles.glsl. Needs before the include: shared/frame.h.
#ifndef SKERRY_LIST_TILES_GLSL
#define SKERRY_LIST_TILES_GLSL
#include "shared/bindings.h"
#include "shared/constants.h"

layout(scalar, binding = kTilesBinding) buffer Tiles {
  TileDispatch dispatches[kListKinds];
  uint tiles[];  // [kind][tile]: x | y << 16
};

// @param count of tiles of the picture, across and down. @param per_group tiles that a work group takes.
void list_tile_of(uint kind, uvec2 tile, uvec2 count, const uint per_group) {
  uint slot = atomicAdd(dispatches[kind].tiles, 1u), group = slot / per_group;
  if (slot % per_group == 0u) {
    atomicMax(dispatches[kind].groups_x, min(group + 1u, kTileRow));
    if (group % kTileRow == 0u) atomicMax(dispatches[kind].groups_y, group / kTileRow + 1u);
  }
  tiles[kind * count.x * count.y + slot] = tile.x | (tile.y << 16);
}

void list_tile(uint kind, uvec2 tile, uvec2 count) { list_tile_of(kind, tile, count, 1u); }
#endif
