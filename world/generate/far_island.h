#pragma once
#include "world/mesh/chunk_mesh.h"
#include "world/voxel/island.h"

namespace skerry::world {

/// An island as it is shown from far away: one section, whose voxels [-32, 32) have the lattice's
/// origin in their middle.
///
/// Made from samples of the island's design, without columns, caves, trees or crystals: a voxel is
/// solid where half of it is, and a column of voxels that is half inside the outline has one at
/// least, so that the silhouette keeps its size. Upper faces have the colour of what covers the
/// ground, the others that of the rock. Opaque alone: lakes are covered by what looks like them.
/// @param level a voxel's edge is 2^level blocks. @pre far_level(spec, level) == level.
/// @param out replaced; quads of opaque ranges, places in voxels counted from -32.
void far_island(const IslandSpec& spec, int level, ChunkMesh& out);

/// The level up to `level` whose voxels are small enough for an island, so that some three at least
/// lie side by side.
int far_level(const IslandSpec& spec, int level);

}  // namespace skerry::world
