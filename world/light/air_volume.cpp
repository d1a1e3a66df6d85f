#include "world/light/air_volume.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

#include "engine/core/check.h"
#include "shaders/shared/occupancy.h"
#include "world/light/base/face_changes.h"
#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

constexpr int kBrick = static_cast<int>(shared::kBrickEdge);

bool is_empty(std::uint32_t entry) {
  return entry == shared::kBrickEmpty || entry == shared::kChunkEmpty;
}

/// A brick's words, also of one that is not stored.
const std::uint32_t* words_of(const ChunkOccupancy& chunk, std::size_t brick) {
  using Words = std::array<std::uint32_t, shared::kBrickWords>;
  static constexpr Words kNone{};
  static constexpr Words kAll = [] {
    Words all{};
    all.fill(~0u);
    return all;
  }();
  using Fill = ChunkOccupancy::Fill;
  if (chunk.fill != Fill::kMixed) return chunk.fill == Fill::kEmpty ? kNone.data() : kAll.data();
  const std::uint32_t entry = chunk.table[brick];
  if (entry == shared::kBrickFull) return kAll.data();
  if (is_empty(entry)) return kNone.data();
  return &chunk.words[std::size_t{entry & shared::kMaxBricks} * shared::kBrickWords];
}

/// Calls fn(x, y, z) for each run of 8 voxels along z in a brick, chunk-local.
template <class Fn>
void for_each_run(std::size_t brick_index, const Fn& fn) {
  const auto brick = static_cast<int>(brick_index);
  const int z0 = (brick & 7) * kBrick, x0 = (brick >> 3 & 7) * kBrick, y0 = (brick >> 6) * kBrick;
  for (int y = 0; y < kBrick; ++y)
    for (int x = 0; x < kBrick; ++x) fn(x0 + x, y0 + y, z0);
}

/// Bits of a run. @param x, y chunk-local or in the brick.
std::uint32_t run_bits(const std::uint32_t* words, int x, int y) {
  const int word = 2 * (x / 4 % 2) + 4 * (y / 2 % 4), shift = 4 * (x % 4) + 16 * (y % 2);
  return (words[word] >> shift & 15u) | (words[word + 1] >> shift & 15u) << 4;
}

/// Calls fn(x, y, z, bits) for each run of 8 voxels along z, chunk-local, that has a bit.
/// @param wanted whether to look at bricks, by their lowest x and y.
template <class Wanted, class Fn>
void for_each_byte(const ChunkOccupancy& chunk, const Wanted& wanted, const Fn& fn) {
  if (chunk.fill == ChunkOccupancy::Fill::kEmpty) return;
  const bool mixed = chunk.fill == ChunkOccupancy::Fill::kMixed;
  for (std::size_t b = 0; b < shared::kBricksPerChunk; ++b) {
    if (mixed && is_empty(chunk.table[b])) continue;
    if (!wanted(static_cast<int>(b >> 3 & 7) * kBrick, static_cast<int>(b >> 6) * kBrick)) continue;
    const std::uint32_t* words = words_of(chunk, b);
    for_each_run(b, [&](int x, int y, int z) {
      if (const std::uint32_t bits = run_bits(words, x, y)) fn(x, y, z, bits);
    });
  }
}

template <class Fn>
void for_each_byte(const ChunkOccupancy& chunk, const Fn& fn) {
  for_each_byte(
      chunk, [](int, int) { return true; }, fn);
}

/// Calls fn(x, y, z, bits) for each run whose bits differ, with those of `now`.
template <class Fn>
void for_each_change(const ChunkOccupancy& before, const ChunkOccupancy& now, const Fn& fn) {
  for (std::size_t b = 0; b < shared::kBricksPerChunk; ++b) {
    const std::uint32_t *old = words_of(before, b), *words = words_of(now, b);
    if (std::equal(old, old + shared::kBrickWords, words)) continue;
    for_each_run(b, [&](int x, int y, int z) {
      const std::uint32_t bits = run_bits(words, x, y);
      if (bits != run_bits(old, x, y)) fn(x, y, z, bits);
    });
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

IVec3 place_of(const StainedVoxel& voxel) {
  const auto bits = [&](int shift) { return static_cast<int>(voxel.place >> shift & 63u); };
  return {bits(6), bits(12), bits(0)};
}

/// Calls fn(voxel, block) for each voxel whose glass differs, chunk-local, with the glass of `now`.
template <class Fn>
void for_each_change(std::span<const StainedVoxel> before, std::span<const StainedVoxel> now,
                     const Fn& fn) {
  auto old = before.begin();
  for (const StainedVoxel& voxel : now) {
    for (; old != before.end() && old->place < voxel.place; ++old) fn(place_of(*old), kAir);
    const bool same_place = old != before.end() && old->place == voxel.place;
    if (!same_place || old->block != voxel.block) fn(place_of(voxel), voxel.block);
    if (same_place) ++old;
  }
  for (; old != before.end(); ++old) fn(place_of(*old), kAir);
}

}  // namespace

void StainedGlass::set(IVec3 voxel, BlockId block) {
  const std::ptrdiff_t bit = voxels_.bit_at(voxel);
  voxels_.set(voxel, block != kAir);
  if (block == kAir)
    blocks_.erase(bit);
  else
    blocks_[bit] = block;
}

VoxelBits::VoxelBits(IVec3 low, IVec3 size, bool value) : low_(low), size_(size) {
  SKERRY_ASSERT(floor_mod(low.z, 64) == 0 && size.z % 64 == 0);
  words_.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                    static_cast<std::size_t>(row_words() + 2),
                value ? ~std::uint64_t{0} : 0);
}

void VoxelBits::set(IVec3 voxel, bool value) {
  const IVec3 p{voxel.x - low_.x, voxel.y - low_.y, voxel.z - low_.z};
  const std::uint64_t bit = std::uint64_t{1} << p.z % 64;
  std::uint64_t& word = row(p.x, p.y)[p.z / 64];
  word = value ? word | bit : word & ~bit;
}

AirVolume air_volume_of(const LightChunks& chunks, int margin) {
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
  const IVec3 low{box.low.x - margin, box.low.y - margin, aligned(box.low.z - margin)};
  const IVec3 size{box.high.x + margin + 1 - low.x, box.high.y + margin + 1 - low.y,
                   aligned(box.high.z + margin) + 64 - low.z};
  out.opaque = VoxelBits(low, size, false);
  if (out.has_leaves) out.leaves = out.plants = VoxelBits(low, size, false);
  for (const auto& [at, chunk] : chunks) {
    if (!chunk->stained.empty() && out.stained.empty())
      out.stained = StainedGlass(low, size, chunk->voxel_blocks);
    for (const StainedVoxel& voxel : chunk->stained)
      out.stained.set(corner_of(at) + place_of(voxel), voxel.block);
  }
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
  const auto apart = [](int from, int length, int its) { return from >= length || from <= -its; };
  for (const auto& [at, chunk] : chunks) {
    const IVec3 corner{corner_of(at).x - low.x, corner_of(at).y - low.y, corner_of(at).z - low.z};
    if (apart(corner.x, size.x, kChunkEdge) || apart(corner.y, size.y, kChunkEdge) ||
        apart(corner.z, size.z, kChunkEdge))
      continue;
    for_each_byte(
        chunk->opaque,
        [&](int x, int y) {
          return !apart(corner.x + x, size.x, kBrick) && !apart(corner.y + y, size.y, kBrick);
        },
        [&](int x, int y, int z, std::uint32_t eight) {
          if (out.has_row(corner.x + x, corner.y + y))
            out.row(corner.x + x, corner.y + y)[corner.z / 64] |= std::uint64_t{eight} << z;
        });
  }
  return out;
}

std::optional<std::vector<IVec3>> take_chunk(AirVolume& air, IVec3 at, const LightChunk& before,
                                             const LightChunk& now, const FaceChanges& faces) {
  const auto has_plant = [](const BlockFace& face) { return face.drawn.plant; };
  if (!air.has_leaves && (now.leaves.fill != ChunkOccupancy::Fill::kEmpty ||
                          std::ranges::any_of(faces.came, has_plant)))
    return std::nullopt;
  if (air.stained.empty() && !now.stained.empty()) return std::nullopt;
  struct Change {
    VoxelBits* of;
    IVec3 voxel;
    bool value;
  };
  std::vector<Change> changes;
  const IVec3 corner = corner_of(at);
  const auto compare = [&](VoxelBits& bits, const ChunkOccupancy& old, const ChunkOccupancy& its) {
    for_each_change(old, its, [&](int x, int y, int z, std::uint32_t eight) {
      for (int i = 0; i < 8; ++i) {
        const IVec3 voxel = corner + IVec3{x, y, z + i};
        const bool value = (eight >> i & 1u) != 0;
        if (bits.at(voxel) != value) changes.push_back({&bits, voxel, value});
      }
    });
  };
  compare(air.opaque, before.opaque, now.opaque);
  if (air.has_leaves) {
    compare(air.leaves, before.leaves, now.leaves);
    for (const std::vector<BlockFace>* some : {&faces.went, &faces.came})
      for (const BlockFace& face : *some)
        if (has_plant(face))
          changes.push_back({&air.plants, corner + face.drawn.voxel, some == &faces.came});
  }
  std::vector<std::pair<IVec3, BlockId>> glass;
  for_each_change(before.stained, now.stained,
                  [&](IVec3 voxel, BlockId block) { glass.emplace_back(corner + voxel, block); });
  std::vector<IVec3> out;
  for (const Change& change : changes) {
    if (!change.of->inside(change.voxel)) return std::nullopt;
    out.push_back(change.voxel);
  }
  for (const auto& [voxel, block] : glass) {
    if (!air.stained.voxels().inside(voxel)) return std::nullopt;
    out.push_back(voxel);
  }
  for (const Change& change : changes) change.of->set(change.voxel, change.value);
  for (const auto& [voxel, block] : glass) air.stained.set(voxel, block);
  return out;
}

}  // namespace skerry::world
