#pragma once
#include "world/mesh/chunk_mesh.h"
#include "world/voxel/island.h"

namespace skerry::world {

/// An island as it is shown from far away: one section, whose voxels [-32, 32) have the lattice's
/// origin in their middle.
///
/// Made from samples of the island's design, one a column of voxels, without the fine columns,
/// caves, trees or crystals. A voxel is solid where the rock of its column fills half of its
/// height, and a column within the outline has one at least, so that the silhouette keeps its size.
/// Upper faces have the colour of what covers the ground, the others that of the rock. Opaque
/// alone: lakes are covered by what looks like them from afar.
/// @param voxel_log2 a voxel's edge is 2^this blocks. @pre not less than far_voxel_log2() of
/// the island's level, so that it fits a section.
/// @param out replaced; quads of opaque ranges, places in voxels counted from -32.
void far_island(const IslandSpec& spec, int voxel_log2, ChunkMesh& out);

/// How coarse an island is at a level of detail: as coarse as the level before it has whole
/// islands, but no coarser than a third of its radius at first, and of three quarters in the end.
/// @param level kLevelCount or more.
int far_voxel_log2(const IslandSpec& spec, int level);

}  // namespace skerry::world
