#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "engine/gpu/uploader.h"
#include "engine/render/geometry_store.h"
#include "shaders/shared/geometry.h"
#include "world/blocks.h"
#include "world/coords.h"
#include "world/mesh/mesh.h"

namespace skerry::render {

/// The block at a voxel of an island's lattice [voxels of the level].
using BlockAt = std::function<world::BlockId(int x, int y, int z)>;

/// The look of every built-in block, as the game tells the renderer.
inline std::vector<shared::Material> built_in_materials() {
  std::vector<shared::Material> table;
  for (const world::BlockType& type : world::block_types()) {
    shared::Material m{};
    m.layer_side = static_cast<std::uint32_t>(type.side);
    m.layer_top = static_cast<std::uint32_t>(type.top);
    m.layer_bottom = static_cast<std::uint32_t>(type.bottom);
    m.emission = glm::packHalf1x16(type.emission);
    m.absorption = {type.absorption[0], type.absorption[1], type.absorption[2]};
    m.roughness = type.roughness;
    table.push_back(m);
  }
  return table;
}

/// Meshes one chunk the way the game does and hands it to the store. Chunks without a face add
/// nothing.
inline void add_chunk(GeometryStore& store, gpu::Uploader& uploader, const BlockAt& block_at,
                      world::IVec3 chunk, std::uint32_t island, std::uint32_t voxel_size_log2 = 0) {
  std::vector<world::BlockId> voxels(world::kPaddedVoxels);
  std::size_t index = 0;
  for (int y = -1; y <= 64; ++y)
    for (int x = -1; x <= 64; ++x)
      for (int z = -1; z <= 64; ++z)
        voxels[index++] = block_at(chunk.x * 64 + x, chunk.y * 64 + y, chunk.z * 64 + z);
  world::MeshScratch scratch;
  world::ChunkMesh mesh;
  world::mesh_chunk(voxels, scratch, mesh);
  if (mesh.quads.empty()) return;
  shared::Section section{};
  const int edge = 64 << voxel_size_log2;
  section.origin = {chunk.x * edge, chunk.y * edge, chunk.z * edge};
  section.island = island;
  section.voxel_size_log2 = voxel_size_log2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    section.bounds_min |= std::uint32_t{mesh.bounds_min[axis]} << (7 * axis);
    section.bounds_max |= std::uint32_t{mesh.bounds_max[axis]} << (7 * axis);
  }
  std::copy(mesh.range_end.begin(), mesh.range_end.end(), section.range_end);
  const Result<SectionId> added = store.add(uploader, section, mesh.quads);
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
