#include "world/motion/solid_grid.h"

#include <algorithm>
#include <utility>

#include "world/islands/world.h"
#include "world/voxel/edits.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr int kGridEdge = BitBrick::kEdge;

// Bits of a layer with a neighbour below, or above, along z in the same brick.
constexpr std::uint64_t kNotFirstZ = 0xfefe'fefe'fefe'fefe, kNotLastZ = 0x7f7f'7f7f'7f7f'7f7f;

IVec3 chunk_of_brick(IVec3 brick) {
  return {brick.x >> 3, brick.y >> 3, brick.z >> 3};
}

}  // namespace

std::size_t IVec3Hash::operator()(const IVec3& v) const {
  const auto part = [](std::int32_t axis) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(axis)) & 0x1f'ffff;
  };
  return mix64(part(v.x) | part(v.y) << 21 | part(v.z) << 42);
}

SolidGrid::SolidGrid(std::vector<IVec3> chunks, Fill fill) : fill_(std::move(fill)) {
  for (const IVec3& chunk : chunks) slots_.try_emplace(chunk);
}

SolidGrid SolidGrid::of_island(World& world, std::uint64_t island,
                               const std::atomic<bool>* stopped) {
  return {world.chunks(island, 0), [&world, island, stopped](IVec3 chunk, std::span<BlockId> out) {
            if (stopped && *stopped) return false;
            const Chunk now = world.chunk_now(island, chunk);
            if (now.is_uniform() && now.at(0) == kAir) return false;
            now.unpack(out);
            return true;
          }};
}

void SolidGrid::look_at(IVec3 chunk, Slot& slot) const {
  slot.looked_at = true;
  thread_local std::vector<BlockId> blocks(kChunkVoxels);
  if (!fill_(chunk, blocks)) return;
  auto made = std::make_unique<ChunkBits>();
  bool any = false;
  for (int y = 0; y < kChunkEdge; ++y) {
    for (int x = 0; x < kChunkEdge; ++x) {
      for (int z = 0; z < kChunkEdge; ++z) {
        if (!is_solid(blocks[voxel_index(x, y, z)])) continue;
        made->bricks[brick_index({x >> 3, y >> 3, z >> 3})].set(x & 7, y & 7, z & 7, true);
        any = true;
      }
    }
  }
  if (any) slot.bits = std::move(made);
}

const SolidGrid::ChunkBits* SolidGrid::bits(IVec3 chunk) const {
  const auto found = slots_.find(chunk);
  if (found == slots_.end()) return nullptr;
  if (!found->second.looked_at) look_at(chunk, found->second);
  return found->second.bits.get();
}

const BitBrick* SolidGrid::brick(IVec3 at) const {
  const ChunkBits* chunk = bits(chunk_of_brick(at));
  return chunk ? &chunk->bricks[brick_index(at)] : nullptr;
}

bool SolidGrid::at(IVec3 voxel) const {
  const BitBrick* found = brick(brick_of(voxel));
  return found && found->at(voxel.x & 7, voxel.y & 7, voxel.z & 7);
}

bool SolidGrid::set(IVec3 voxel, bool solid) {
  const IVec3 chunk = chunk_of(voxel);
  if (!solid && !bits(chunk)) return false;
  Slot& slot = slots_[chunk];
  if (!slot.looked_at) look_at(chunk, slot);
  if (!slot.bits) slot.bits = std::make_unique<ChunkBits>();
  BitBrick& brick = slot.bits->bricks[brick_index(brick_of(voxel))];
  if (brick.at(voxel.x & 7, voxel.y & 7, voxel.z & 7) == solid) return false;
  brick.set(voxel.x & 7, voxel.y & 7, voxel.z & 7, solid);
  return true;
}

void SolidGrid::clear(IVec3 at, const BitBrick& voxels) {
  if (!bits(chunk_of_brick(at))) return;
  BitBrick& brick = slots_[chunk_of_brick(at)].bits->bricks[brick_index(at)];
  for (int y = 0; y < kGridEdge; ++y) brick.layers[y] &= ~voxels.layers[y];
}

void SolidGrid::complete() {
  for (auto& [chunk, slot] : slots_)
    if (!slot.looked_at) look_at(chunk, slot);
}

std::vector<IVec3> SolidGrid::solid_bricks() {
  complete();
  std::vector<IVec3> found;
  for (const auto& [chunk, slot] : slots_) {
    if (!slot.bits) continue;
    for (int i = 0; i < kBricks * kBricks * kBricks; ++i) {
      if (!slot.bits->bricks[static_cast<std::size_t>(i)].any()) continue;
      found.push_back({chunk.x * kBricks + i / kBricks % kBricks,
                       chunk.y * kBricks + i / (kBricks * kBricks),
                       chunk.z * kBricks + i % kBricks});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

BitBrick SolidGrid::surface_of(IVec3 at) const {
  static const BitBrick kNothing;
  const auto or_nothing = [&](int dx, int dy, int dz) -> const BitBrick& {
    const BitBrick* found = brick({at.x + dx, at.y + dy, at.z + dz});
    return found ? *found : kNothing;
  };
  const BitBrick& own = or_nothing(0, 0, 0);
  BitBrick out;
  if (!own.any()) return out;
  const BitBrick &lx = or_nothing(-1, 0, 0), &hx = or_nothing(1, 0, 0);
  const BitBrick &ly = or_nothing(0, -1, 0), &hy = or_nothing(0, 1, 0);
  const BitBrick &lz = or_nothing(0, 0, -1), &hz = or_nothing(0, 0, 1);
  for (int y = 0; y < kGridEdge; ++y) {
    const std::uint64_t layer = own.layers[y];
    // Each term: where the neighbour on one side is solid.
    const std::uint64_t inner = (layer << 8 | lx.layers[y] >> 56) &
                                (layer >> 8 | hx.layers[y] << 56) &
                                ((layer << 1 & kNotFirstZ) | (lz.layers[y] >> 7 & ~kNotFirstZ)) &
                                ((layer >> 1 & kNotLastZ) | (hz.layers[y] << 7 & ~kNotLastZ)) &
                                (y > 0 ? own.layers[y - 1] : ly.layers[kGridEdge - 1]) &
                                (y + 1 < kGridEdge ? own.layers[y + 1] : hy.layers[0]);
    out.layers[y] = layer & ~inner;
  }
  return out;
}

void MassSum::add(IVec3 brick, const BitBrick& voxels, int sign) {
  for (int y = 0; y < kGridEdge; ++y) {
    for (std::uint64_t layer = voxels.layers[y]; layer != 0; layer &= layer - 1) {
      const int bit = std::countr_zero(layer);
      const std::int64_t x = std::int64_t{brick.x} * kGridEdge + bit / kGridEdge;
      const std::int64_t z = std::int64_t{brick.z} * kGridEdge + bit % kGridEdge;
      count_ += sign;
      x_ += sign * x;
      y_ += sign * (std::int64_t{brick.y} * kGridEdge + y);
      z_ += sign * z;
      xx_zz_ += sign * (x * x + z * z);
    }
  }
}

Mass MassSum::mass() const {
  if (count_ == 0) return {};
  const auto n = static_cast<double>(count_);
  const glm::dvec3 mean{static_cast<double>(x_) / n, static_cast<double>(y_) / n,
                        static_cast<double>(z_) / n};
  // Parallel axes: about the centre; and each block is a cube, not a point.
  const double points = static_cast<double>(xx_zz_) - n * (mean.x * mean.x + mean.z * mean.z);
  return {static_cast<std::uint64_t>(count_), mean + 0.5, points + n / 6.0};
}

}  // namespace skerry::world
