#pragma once
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/face_records.h"
#include "world/light/sky_transfer.h"
#include "world/mesh/mesh.h"
#include "world/voxel/blocks.h"
#include "world/voxel/chunk.h"

namespace skerry::world::test {

using Voxels = std::set<IVec3>;

inline IVec3 beside(IVec3 v, int face) {
  const int by = face % 2 == 0 ? 1 : -1;
  return {v.x + (face / 2 == 0 ? by : 0), v.y + (face / 2 == 1 ? by : 0),
          v.z + (face / 2 == 2 ? by : 0)};
}

inline IVec3 chunk_holding(IVec3 v) {
  return {static_cast<std::int32_t>(floor_div(v.x, kChunkEdge)),
          static_cast<std::int32_t>(floor_div(v.y, kChunkEdge)),
          static_cast<std::int32_t>(floor_div(v.z, kChunkEdge))};
}

using Glass = std::map<IVec3, BlockId>;

/// A white lamp in the middle of each of some voxels.
struct Lamps {
  Voxels voxels;
  float range = 8.0f;
};

/// Chunks of stone voxels with a quad for each face that is not covered by stone.
/// @param plants voxels in which tall grass stands. @param glass blocks of stained glass and water,
/// none of them in stone.
inline LightChunks chunks_of(const Voxels& stone, const Lamps& lamps = {},
                             const Voxels& plants = {}, const Glass& glass = {}) {
  struct Building {
    std::vector<BlockId> padded = std::vector<BlockId>(kPaddedVoxels, kAir);
    LightChunk chunk;
  };
  std::map<IVec3, Building> building;
  for (const IVec3& v : stone) {
    const IVec3 at = chunk_holding(v);
    Building& b = building[at];
    const int x = v.x - at.x * kChunkEdge, y = v.y - at.y * kChunkEdge, z = v.z - at.z * kChunkEdge;
    b.padded[static_cast<std::size_t>(1 + z + kPaddedEdge * (x + 1 + kPaddedEdge * (y + 1)))] =
        block::kStone;
    for (int face = 0; face < 6; ++face)
      if (!stone.contains(beside(v, face)))
        b.chunk.quads.push_back(
            {static_cast<std::uint32_t>(x | y << 6 | z << 12),
             static_cast<std::uint32_t>(block::kStone | face << shared::kFaceShift)});
  }
  for (const IVec3& v : plants)
    building[chunk_holding(v)].chunk.quads.push_back(
        {static_cast<std::uint32_t>((v.x & 63) | (v.y & 63) << 6 | (v.z & 63) << 12),
         static_cast<std::uint32_t>(block::kTallGrass) | 6u << shared::kFaceShift});
  for (const auto& [v, block] : glass) {
    Building& b = building[chunk_holding(v)];
    const auto local = [](int x, int y, int z) {
      return static_cast<std::uint32_t>((x & 63) | (y & 63) << 6 | (z & 63) << 12);
    };
    if (!block_types()[block].liquid) b.chunk.stained.push_back({local(v.z, v.x, v.y), block});
    for (int face = 0; face < 6; ++face) {
      const auto next = glass.find(beside(v, face));
      if (stone.contains(beside(v, face)) || (next != glass.end() && next->second == block))
        continue;
      b.chunk.quads.push_back(
          {local(v.x, v.y, v.z), static_cast<std::uint32_t>(block | face << shared::kFaceShift)});
    }
  }
  for (const IVec3& v : lamps.voxels) {
    const IVec3 at = chunk_holding(v);
    const auto place = [](int voxel, int chunk) {
      return static_cast<float>(voxel - chunk * kChunkEdge) + 0.5f;
    };
    building[at].chunk.lamps.push_back(
        {{place(v.x, at.x), place(v.y, at.y), place(v.z, at.z)}, glm::vec3(1.0f), lamps.range});
  }
  LightChunks out;
  for (auto& [at, b] : building) {
    b.chunk.opaque = occupancy_of(b.padded);
    std::ranges::sort(b.chunk.stained, {}, &StainedVoxel::place);
    out[at] = std::make_shared<const LightChunk>(std::move(b.chunk));
  }
  return out;
}

/// What the GPU would read for a face: 8 words of the sky, 4 of lamps, 4 of bounces, and 4 of a
/// tint that is not white; empty: no such face. @param keyed out: the words of key directions, 0
/// without.
inline std::vector<std::uint32_t> record_of(const SkyTransfer::Skies& sky, IVec3 voxel, int face,
                                            glm::uvec4* keyed = nullptr) {
  if (keyed) *keyed = glm::uvec4(0);
  const IVec3 at = chunk_holding(voxel);
  const auto found = sky.find(at);
  if (found == sky.end()) return {};
  const ChunkSky& chunk = *found->second;
  const int x = voxel.x & 63, y = voxel.y & 63, z = voxel.z & 63;
  const std::uint32_t brick = chunk.table[static_cast<std::size_t>(z / 8 + x / 8 * 8 + y / 8 * 64)];
  if (brick == 0) return {};
  const glm::uvec4 masks = chunk.texels[(brick - 1) * shared::kIndirectBrickTexels +
                                        static_cast<std::size_t>(face * 8 + y % 8)];
  const int half = x / 4 % 2, bit = z % 8 + 8 * (x % 4);
  if ((masks[half] >> bit & 1u) == 0) return {};
  std::size_t record = masks[2 + half];
  for (int i = 0; i < bit; ++i) record += chunk.record_texels() * (masks[half] >> i & 1u);
  const glm::uvec4 a = chunk.texels[record], b = chunk.texels[record + 1],
                   c = chunk.texels[record + 2], d = chunk.texels[record + 3];
  std::vector<std::uint32_t> words{a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w,
                                   c.x, c.y, c.z, c.w, d.x, d.y, d.z, d.w};
  const glm::uvec4 tint =
      chunk.parts.tinted ? chunk.texels[record + chunk.parts.before_tint()] : white_tint();
  if (keyed && chunk.parts.keyed) *keyed = chunk.texels[record + 4];
  for (int i = 0; i < 4 && tint != white_tint(); ++i) words.push_back(tint[i]);
  return words;
}

/// Where a line along a lattice vector begins that a face of an axis looks along: in the middle of
/// the face that it enters the voxel by, and as little aside as it takes to cross planes one after
/// the other: of axes a < b that of a first if the vector's signs along a and along the third axis
/// are the same, the other way round if the sum of its parts' lengths is even.
inline glm::dvec3 start_of_line(IVec3 voxel, IVec3 vector, int face_axis) {
  const glm::ivec3 d(vector.x, vector.y, vector.z);
  glm::dvec3 start(voxel.x + 0.5, voxel.y + 0.5, voxel.z + 0.5);
  start[face_axis] -= d[face_axis] > 0 ? 0.5 : -0.5;
  glm::ivec3 earlier(1);  // than so many, itself among them
  for (int a = 0; a < 3; ++a)
    for (int b = a + 1; b < 3; ++b) {
      const bool alike = d[a] * d[3 - a - b] > 0;
      const bool even = (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) % 2 == 0;
      ++earlier[alike != even ? a : b];
    }
  return start + 1e-6 * glm::dvec3(earlier * d);
}

}  // namespace skerry::world::test
