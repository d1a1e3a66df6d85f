// Which voxels are opaque, one bit each, as CPU and GPU share them: an island's grid of chunks, a
// chunk's table of bricks, a brick's bits. docs/decisions/0013-occupancy-in-bricks.md.
#ifndef SKERRY_SHARED_OCCUPANCY_H
#define SKERRY_SHARED_OCCUPANCY_H
#include "types.h"
SHARED_BEGIN

// A brick is 8^3 voxels, a chunk 8^3 bricks. Index of a brick in its chunk's table: z + 8 x + 64 y.
SHARED_CONST uint kBrickEdge = 8u;         // voxels
SHARED_CONST uint kBricksPerChunk = 512u;  // entries of a table
SHARED_CONST uint kBrickWords = 16u;       // words of bits that a stored brick has

// A word of a brick holds 4 x 4 voxels in x and z and 2 in y. For a voxel at (x, y, z) of a brick:
// word z/4 + 2 (x/4) + 4 (y/2), bit z%4 + 4 (x%4) + 16 (y%2).

// An entry of a table: bits 0-23 the stored brick, 24-31 which of its octants of 4^3 voxels have an
// opaque voxel (bit z/4 + 2 (x/4) + 4 (y/4)). Or one of these, which store nothing:
SHARED_CONST uint kChunkEmpty = 0u;          // no voxel of the chunk is opaque
SHARED_CONST uint kBrickEmpty = 1u;          // none of the brick, but some of its chunk
SHARED_CONST uint kBrickFull = 0xffffffffu;  // all of the brick
SHARED_CONST uint kMaxBricks = 0x00ffffffu;  // stored at once
SHARED_CONST int kLowestGridChunk = -512;    // chunk coordinates that a grid can have
SHARED_CONST int kHighestGridChunk = 511;
SHARED_CONST uint kMaxGridEdge = 255u;  // chunks

// Where an island's chunks are, at the level of detail it is shown at. All 0: nowhere.
struct OccupancyGrid {
  uint low;    // lowest chunk, 10 bits each of x, y, z from bit 0 up, two's complement
  uint size;   // chunks along x, y, z, 8 bits each from bit 0 up; 24-31 log2 of a voxel's edge
  uint first;  // table of the lowest chunk; then z fastest, x, y slowest
};

SHARED_END
#endif
