#include "world/light/air_volume.h"

#include <algorithm>
#include <array>
#include <bit>

#include "engine/core/check.h"
#include "shaders/shared/occupancy.h"
#include "world/light/face_records.h"
#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

constexpr int kBrick = static_cast<int>(shared::kBrickEdge);
constexpr int kMargin = 2;

/// Calls fn(x, y, z, bits) for each run of 8 voxels along z, chunk-local, that has a bit.
template <class Fn>
void for_each_byte(const ChunkOccupancy& chunk, const Fn& fn) {
  using Fill = ChunkOccupancy::Fill;
  if (chunk.fill == Fill::kEmpty) return;
  for (int b = 0; b < static_cast<int>(shared::kBricksPerChunk); ++b) {
    const int z0 = (b & 7) * kBrick, x0 = (b >> 3 & 7) * kBrick, y0 = (b >> 6) * kBrick;
    const std::uint32_t entry =
        chunk.fill == Fill::kFull ? shared::kBrickFull : chunk.table[static_cast<std::size_t>(b)];
    if (entry == shared::kBrickEmpty || entry == shared::kChunkEmpty) continue;
    const std::uint32_t* words =
        entry == shared::kBrickFull
            ? nullptr
            : &chunk.words[std::size_t{entry & shared::kMaxBricks} * shared::kBrickWords];
    for (int y = 0; y < kBrick; ++y) {
      for (int x = 0; x < kBrick; ++x) {
        std::uint32_t bits = 0xffu;
        if (words) {
          const int word = 2 * (x / 4) + 4 * (y / 2), shift = 4 * (x % 4) + 16 * (y % 2);
          bits = (words[word] >> shift & 15u) | (words[word + 1] >> shift & 15u) << 4;
        }
        if (bits != 0) fn(x0 + x, y0 + y, z0, bits);
      }
    }
  }
}

struct Box {
  IVec3 low{INT32_MAX, INT32_MAX, INT32_MAX}, high{INT32_MIN, INT32_MIN, INT32_MIN};
};

void widen(Box& box, IVec3 corner, const ChunkOccupancy& chunk) {
  for_each_byte(chunk, [&](int x, int y, int z, std::uint32_t) {
    box.low = {std::min(box.low.x, corner.x + x), std::min(box.low.y, corner.y + y),
               std::min(box.low.z, corner.z + z)};
    box.high = {std::max(box.high.x, corner.x + x), std::max(box.high.y, corner.y + y),
                std::max(box.high.z, corner.z + z + 7)};
  });
}

void fill(VoxelBits& bits, IVec3 corner, const ChunkOccupancy& chunk) {
  for_each_byte(chunk, [&](int x, int y, int z, std::uint32_t eight) {
    const int row_z = corner.z + z - bits.low().z;
    bits.row(corner.x + x - bits.low().x, corner.y + y - bits.low().y)[row_z / 64] |=
        std::uint64_t{eight} << row_z % 64;
  });
}

/// Whether leaves or plants are in it.
bool has_leaves(const LightChunk& chunk) {
  return chunk.leaves.fill != ChunkOccupancy::Fill::kEmpty ||
         std::ranges::any_of(chunk.quads, is_of_plant);
}

void fill_plants(VoxelBits& bits, IVec3 corner, const LightChunk& chunk) {
  for (const shared::Quad& quad : chunk.quads)
    if (is_of_plant(quad))
      for_each_face(quad, [&](const DrawnFace& face) { bits.set(corner + face.voxel); });
}

}  // namespace

VoxelBits::VoxelBits(IVec3 low, IVec3 size, bool value) : low_(low), size_(size) {
  SKERRY_ASSERT(floor_mod(low.z, 64) == 0 && size.z % 64 == 0);
  words_.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                    static_cast<std::size_t>(row_words() + 2),
                value ? ~std::uint64_t{0} : 0);
}

bool VoxelBits::at(IVec3 voxel) const {
  const IVec3 p{voxel.x - low_.x, voxel.y - low_.y, voxel.z - low_.z};
  if (!has_row(p.x, p.y) || p.z < 0 || p.z >= size_.z) return false;
  return row(p.x, p.y)[p.z / 64] >> p.z % 64 & 1;
}

void VoxelBits::set(IVec3 voxel, bool value) {
  const IVec3 p{voxel.x - low_.x, voxel.y - low_.y, voxel.z - low_.z};
  const std::uint64_t bit = std::uint64_t{1} << p.z % 64;
  std::uint64_t& word = row(p.x, p.y)[p.z / 64];
  word = value ? word | bit : word & ~bit;
}

AirVolume air_volume_of(const LightChunks& chunks) {
  Box box;
  AirVolume out;
  for (const auto& [at, chunk] : chunks) {
    widen(box, corner_of(at), chunk->opaque);
    widen(box, corner_of(at), chunk->leaves);
    out.has_leaves = out.has_leaves || has_leaves(*chunk);
    // Glass and plants may stand away from all else.
    for (const shared::Quad& q : chunk->quads) {
      const IVec3 c = corner_of(at);
      const int x = static_cast<int>(q.geometry & 63u), y = static_cast<int>(q.geometry >> 6 & 63u),
                z = static_cast<int>(q.geometry >> 12 & 63u),
                most = static_cast<int>(std::max(q.geometry >> 18 & 63u, q.geometry >> 24 & 63u));
      box.low = {std::min(box.low.x, c.x + x), std::min(box.low.y, c.y + y),
                 std::min(box.low.z, c.z + z)};
      box.high = {std::max(box.high.x, c.x + std::min(x + most, 63)),
                  std::max(box.high.y, c.y + std::min(y + most, 63)),
                  std::max(box.high.z, c.z + std::min(z + most, 63))};
    }
  }
  if (box.low.x > box.high.x) return out;
  const auto aligned = [](int z) { return static_cast<int>(floor_div(z, 64)) * 64; };
  const IVec3 low{box.low.x - kMargin, box.low.y - kMargin, aligned(box.low.z - kMargin)};
  const IVec3 size{box.high.x + kMargin + 1 - low.x, box.high.y + kMargin + 1 - low.y,
                   aligned(box.high.z + kMargin) + 64 - low.z};
  out.opaque = VoxelBits(low, size, false);
  if (out.has_leaves) out.leaves = out.plants = VoxelBits(low, size, false);
  for (const auto& [at, chunk] : chunks) {
    fill(out.opaque, corner_of(at), chunk->opaque);
    if (!out.has_leaves) continue;
    fill(out.leaves, corner_of(at), chunk->leaves);
    fill_plants(out.plants, corner_of(at), *chunk);
  }
  return out;
}

VoxelBits opaque_within(const LightChunks& chunks, IVec3 low, IVec3 high) {
  const auto aligned = [](int z) { return static_cast<int>(floor_div(z, 64)) * 64; };
  low.z = aligned(low.z), high.z = aligned(high.z) + 63;
  const IVec3 size{high.x + 1 - low.x, high.y + 1 - low.y, high.z + 1 - low.z};
  VoxelBits out(low, size, false);
  for (const auto& [at, chunk] : chunks) {
    const IVec3 corner{corner_of(at).x - low.x, corner_of(at).y - low.y, corner_of(at).z - low.z};
    const auto apart = [](int from, int length) { return from >= length || from <= -kChunkEdge; };
    if (apart(corner.x, size.x) || apart(corner.y, size.y) || apart(corner.z, size.z)) continue;
    for_each_byte(chunk->opaque, [&](int x, int y, int z, std::uint32_t eight) {
      if (out.has_row(corner.x + x, corner.y + y))
        out.row(corner.x + x, corner.y + y)[corner.z / 64] |= std::uint64_t{eight} << z;
    });
  }
  return out;
}

std::optional<std::vector<IVec3>> take_chunk(AirVolume& air, IVec3 at, const LightChunk& chunk) {
  if (!air.has_leaves && has_leaves(chunk)) return std::nullopt;
  const IVec3 corner = corner_of(at), size{kChunkEdge, kChunkEdge, kChunkEdge};
  const std::array<VoxelBits*, 3> kinds{&air.opaque, &air.leaves, &air.plants};
  struct Word {
    VoxelBits* of;
    int x, y, word;  // from the volume's lowest voxel
    std::uint64_t bits;
  };
  std::vector<Word> words;  // that change
  std::vector<IVec3> out;
  for (std::size_t kind = 0; kind < (air.has_leaves ? kinds.size() : 1); ++kind) {
    VoxelBits bits(corner, size, false);
    if (kind < 2)
      fill(bits, corner, kind == 0 ? chunk.opaque : chunk.leaves);
    else
      fill_plants(bits, corner, chunk);
    VoxelBits& before = *kinds[kind];
    const IVec3 low = before.low();
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const int in_x = corner.x + x - low.x, in_y = corner.y + y - low.y,
                  word = (corner.z - low.z) / 64;
        const bool has_room =
            before.has_row(in_x, in_y) && corner.z >= low.z && word < before.row_words();
        const std::uint64_t old = has_room ? before.row(in_x, in_y)[word] : 0;
        const std::uint64_t new_bits = *bits.row(x, y);
        if (old == new_bits) continue;
        if (!has_room) return std::nullopt;
        words.push_back({&before, in_x, in_y, word, new_bits});
        for (std::uint64_t left = old ^ new_bits; left != 0; left &= left - 1)
          out.push_back({corner.x + x, corner.y + y, corner.z + std::countr_zero(left)});
      }
  }
  for (const Word& word : words) word.of->row(word.x, word.y)[word.word] = word.bits;
  return out;
}

}  // namespace skerry::world
