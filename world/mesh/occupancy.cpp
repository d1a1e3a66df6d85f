#include "world/mesh/occupancy.h"

#include <algorithm>
#include <array>

#include "engine/core/check.h"
#include "shaders/shared/occupancy.h"
#include "world/mesh/mesh.h"
#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

constexpr int kRowsAlongX = kChunkEdge;
constexpr int kBrick = static_cast<int>(shared::kBrickEdge);

/// One row of voxels along z: bit z says whether it is of the kind.
using Rows = std::array<std::uint64_t, std::size_t{kChunkEdge} * kRowsAlongX>;

/// Rows in the order x, then y. Runs of one id, which most of a world is, ask the table once.
void fill_rows(std::span<const BlockId> voxels, BlockKind kind, Rows& rows) {
  BlockId known = kAir;
  std::uint64_t bit = 0;
  for (int y = 0; y < kChunkEdge; ++y) {
    for (int x = 0; x < kChunkEdge; ++x) {
      const BlockId* row =
          &voxels[static_cast<std::size_t>(1 + kPaddedEdge * (x + 1 + kPaddedEdge * (y + 1)))];
      std::uint64_t bits = 0;
      for (int z = 0; z < kChunkEdge; ++z) {
        if (row[z] != known) {
          known = row[z];
          bit = block_kind(known) == kind ? 1 : 0;
        }
        bits |= bit << z;
      }
      rows[static_cast<std::size_t>(x + kRowsAlongX * y)] = bits;
    }
  }
}

using BrickBits = std::array<std::uint32_t, shared::kBrickWords>;

/// @param x, y, z lowest voxel of the brick.
BrickBits brick_at(const Rows& rows, int x, int y, int z) {
  BrickBits bits{};
  for (int dy = 0; dy < kBrick; ++dy) {
    for (int dx = 0; dx < kBrick; ++dx) {
      const auto row = static_cast<std::uint32_t>(
          rows[static_cast<std::size_t>(x + dx + kRowsAlongX * (y + dy))] >> z & 0xffu);
      const int word = 2 * (dx / 4) + 4 * (dy / 2), shift = 4 * (dx % 4) + 16 * (dy % 2);
      bits[static_cast<std::size_t>(word)] |= (row & 15u) << shift;
      bits[static_cast<std::size_t>(word + 1)] |= row >> 4 << shift;
    }
  }
  return bits;
}

/// Octants with an opaque voxel. Word w is a quarter of octant w % 4 + 4 (w / 8).
std::uint32_t octants_of(const BrickBits& bits) {
  std::uint32_t octants = 0;
  for (std::size_t word = 0; word < bits.size(); ++word)
    if (bits[word] != 0) octants |= 1u << (word % 4 + 4 * (word / 8));
  return octants;
}

std::uint32_t add_brick(const BrickBits& bits, ChunkOccupancy& out) {
  if (std::ranges::all_of(bits, [](std::uint32_t word) { return word == 0; }))
    return shared::kBrickEmpty;
  if (std::ranges::all_of(bits, [](std::uint32_t word) { return word == ~0u; }))
    return shared::kBrickFull;
  const auto brick = static_cast<std::uint32_t>(out.words.size() / bits.size());
  out.words.insert(out.words.end(), bits.begin(), bits.end());
  return brick | octants_of(bits) << 24;
}

}  // namespace

ChunkOccupancy occupancy_of(std::span<const BlockId> voxels, BlockKind kind) {
  SKERRY_ASSERT(voxels.size() == kPaddedVoxels);
  ChunkOccupancy out;
  Rows rows;
  fill_rows(voxels, kind, rows);
  if (std::ranges::all_of(rows, [](std::uint64_t row) { return row == 0; })) return out;
  if (std::ranges::all_of(rows, [](std::uint64_t row) { return row == ~std::uint64_t{0}; })) {
    out.fill = ChunkOccupancy::Fill::kFull;
    return out;
  }
  out.fill = ChunkOccupancy::Fill::kMixed;
  out.table.reserve(shared::kBricksPerChunk);
  for (int y = 0; y < kChunkEdge; y += kBrick)
    for (int x = 0; x < kChunkEdge; x += kBrick)
      for (int z = 0; z < kChunkEdge; z += kBrick)
        out.table.push_back(add_brick(brick_at(rows, x, y, z), out));
  return out;
}

std::vector<StainedVoxel> stained_voxels_of(std::span<const BlockId> voxels) {
  SKERRY_ASSERT(voxels.size() == kPaddedVoxels);
  std::vector<StainedVoxel> out;
  for (int y = 0; y < kChunkEdge; ++y)
    for (int x = 0; x < kChunkEdge; ++x) {
      const BlockId* row =
          &voxels[static_cast<std::size_t>(1 + kPaddedEdge * (x + 1 + kPaddedEdge * (y + 1)))];
      for (int z = 0; z < kChunkEdge; ++z)
        if (is_stained_glass(row[z]))
          out.push_back({static_cast<std::uint32_t>(z | x << 6 | y << 12), row[z]});
    }
  return out;
}

}  // namespace skerry::world
