#pragma once
#include <gtest/gtest.h>

#include "engine/gpu/transfer/uploader.h"
#include "engine/render/scene/geometry_store.h"
#include "tools/skerry/stability/stage.h"
#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"

namespace skerry::render {

using tools::stability::BlockAt;

/// Meshes one chunk the way the game does and hands it to the store. Chunks without a face add
/// nothing.
inline void add_chunk(GeometryStore& store, gpu::Uploader& uploader, const BlockAt& block_at,
                      world::IVec3 chunk, std::uint32_t island, std::uint32_t voxel_size_log2 = 0) {
  tools::stability::MeshedChunk meshed =
      tools::stability::mesh_chunk_of(block_at, chunk, voxel_size_log2);
  if (meshed.quads.empty()) return;
  meshed.section.island = island;
  const Result<SectionId> added = store.add(uploader, meshed.section, meshed.quads);
  ASSERT_TRUE(added) << added.error().message;
}

/// All chunks of a box of chunks, [low, high).
inline void add_chunks(GeometryStore& store, gpu::Uploader& uploader, const BlockAt& block_at,
                       world::IVec3 low, world::IVec3 high, std::uint32_t island,
                       std::uint32_t voxel_size_log2 = 0) {
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z)
        add_chunk(store, uploader, block_at, {x, y, z}, island, voxel_size_log2);
}

}  // namespace skerry::render
