#pragma once
#include <array>
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/voxel/blocks.h"

namespace skerry::world {

/// What closes a chunk where its neighbour is drawn at another level of detail: by direction, the
/// faces on the chunk's border between two opaque blocks, which mesh_chunk leaves out.
using SeamFaces = std::array<std::vector<shared::Quad>, shared::kFaceCount>;

/// @param voxels kPaddedVoxels block ids, as mesh_chunk takes them.
SeamFaces seam_faces(std::span<const BlockId> voxels);

}  // namespace skerry::world
