#pragma once
#include <cstdint>
#include <span>

#include "world/mesh/chunk_mesh.h"
#include "world/voxel/blocks.h"

namespace skerry::world {

/// Turns one padded chunk into merged quads.
/// @param voxels kPaddedVoxels block ids, index z + 66 x + 66^2 y; the shell comes from the
///   neighbours.
/// @param out replaced. Pass the same object again to spare its memory's first touch.
/// A face is drawn where a block meets one that does not hide it: opaque hides every kind's face;
/// cut-out and translucent blocks hide faces of their own id only; plants hide nothing and give one
/// quad for each diagonal. Faces of one id merge into rectangles: runs along one axis, then equal
/// runs of neighbouring rows.
/// Within a range quads are ordered by where they end: y, then x, then z. Every CPU gives the same
/// quads in the same order. Ids of 256 and more take a path that is some ten times slower;
/// of those that no material can have (shared::kMaxMaterials) the lowest bits are kept.
void mesh_chunk(std::span<const BlockId> voxels, MeshScratch& scratch, ChunkMesh& out);

/// Same, for chunks with at most 256 different ids: `voxels` index `palette`. Reads half the
/// memory, and takes no time when the palette shows that nothing can be seen (all of it opaque, or
/// one id that is no plant).
/// @param palette distinct ids; @pre every index is below its size.
void mesh_chunk(std::span<const std::uint8_t> voxels, std::span<const BlockId> palette,
                MeshScratch& scratch, ChunkMesh& out);

/// Makes cut-out blocks opaque ones. A coarse voxel of leaves stands for what blocks of them cover,
/// behind each other: a texture with holes would be far more open than they are.
void close_cutouts(ChunkMesh& mesh);

}  // namespace skerry::world
