#include "world/motion/split.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "engine/core/check.h"

namespace skerry::world {
namespace {

constexpr int kSplitEdge = BitBrick::kEdge;
constexpr std::uint64_t kFirstZ = 0x0101'0101'0101'0101, kLastZ = 0x8080'8080'8080'8080;

BitBrick operator&(const BitBrick& a, const BitBrick& b) {
  BitBrick out;
  for (int y = 0; y < kSplitEdge; ++y) out.layers[y] = a.layers[y] & b.layers[y];
  return out;
}
BitBrick without(const BitBrick& a, const BitBrick& b) {
  BitBrick out;
  for (int y = 0; y < kSplitEdge; ++y) out.layers[y] = a.layers[y] & ~b.layers[y];
  return out;
}
void add_to(BitBrick& a, const BitBrick& b) {
  for (int y = 0; y < kSplitEdge; ++y) a.layers[y] |= b.layers[y];
}

/// All of `solid` that hangs together with `seeds` inside the brick.
BitBrick flooded(const BitBrick& solid, const BitBrick& seeds) {
  BitBrick reached = seeds & solid;
  for (bool grown = true; grown;) {
    grown = false;
    for (int y = 0; y < kSplitEdge; ++y) {
      const std::uint64_t own = reached.layers[y];
      std::uint64_t next = own | own << 8 | own >> 8 | (own & ~kLastZ) << 1 | (own & ~kFirstZ) >> 1;
      if (y > 0) next |= reached.layers[y - 1];
      if (y + 1 < kSplitEdge) next |= reached.layers[y + 1];
      next &= solid.layers[y];
      grown |= next != own;
      reached.layers[y] = next;
    }
  }
  return reached;
}

/// Voxels of the six neighbouring bricks that touch voxels of a brick.
struct Beside {
  IVec3 step;
  BitBrick voxels;
};
std::array<Beside, 6> beside(const BitBrick& b) {
  std::array<Beside, 6> out{{{{1, 0, 0}, {}},
                             {{-1, 0, 0}, {}},
                             {{0, 1, 0}, {}},
                             {{0, -1, 0}, {}},
                             {{0, 0, 1}, {}},
                             {{0, 0, -1}, {}}}};
  for (int y = 0; y < kSplitEdge; ++y) {
    out[0].voxels.layers[y] = b.layers[y] >> 56;
    out[1].voxels.layers[y] = b.layers[y] << 56;
    out[4].voxels.layers[y] = (b.layers[y] & kLastZ) >> 7;
    out[5].voxels.layers[y] = (b.layers[y] & kFirstZ) << 7;
  }
  out[2].voxels.layers[0] = b.layers[kSplitEdge - 1];
  out[3].voxels.layers[kSplitEdge - 1] = b.layers[0];
  return out;
}

IVec3 operator+(const IVec3& a, const IVec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// The sides that grow, and where each has been.
class Sides {
 public:
  explicit Sides(const SolidGrid& grid) : grid_(grid) {}

  void begin(IVec3 voxel) {
    BitBrick seed;
    seed.set(voxel.x & 7, voxel.y & 7, voxel.z & 7, true);
    sides_.push_back({sides_.size(), 0, {{brick_of(voxel), seed}}});
  }

  /// Grows until at most one side is not done, and no done one is larger than that.
  void grow() {
    while (true) {
      std::vector<std::size_t> growing;
      std::uint64_t largest = 0;
      for (std::size_t s = 0; s < sides_.size(); ++s) {
        if (sides_[s].root != s) continue;
        if (sides_[s].queue.empty()) largest = std::max(largest, sides_[s].voxels);
        if (!sides_[s].queue.empty()) growing.push_back(s);
      }
      if (growing.empty()) return;
      if (growing.size() == 1 && sides_[growing.front()].voxels >= largest) {
        // Alone or the largest by now: either way it is what remains.
        rest_ = growing.front();
        return;
      }
      for (const std::size_t s : growing)
        if (sides_[s].root == s && !sides_[s].queue.empty()) step(s);
    }
  }

  std::vector<Fragment> fragments() {
    std::vector<std::size_t> roots;
    for (std::size_t s = 0; s < sides_.size(); ++s)
      if (sides_[s].root == s && sides_[s].voxels != 0) roots.push_back(s);
    if (rest_ == kNone && !roots.empty())
      rest_ = *std::max_element(roots.begin(), roots.end(), [&](std::size_t a, std::size_t b) {
        return sides_[a].voxels < sides_[b].voxels;
      });
    std::map<std::size_t, Fragment> made;
    for (const auto& [at, visits] : visited_) {
      for (const Visit& visit : visits) {
        const std::size_t root = find(visit.side);
        if (root != rest_) add_to(made[root].bricks[at], visit.voxels);
      }
    }
    std::vector<Fragment> out;
    for (auto& [root, fragment] : made) {
      MassSum sum;
      for (const auto& [at, voxels] : fragment.bricks) sum.add(at, voxels, 1);
      fragment.mass = sum.mass();
      out.push_back(std::move(fragment));
    }
    return out;
  }

  std::size_t bricks_looked_at() const { return bricks_; }

 private:
  static constexpr std::size_t kNone = SIZE_MAX;
  struct Wave {
    IVec3 brick;
    BitBrick seeds;
  };
  struct Side {
    std::size_t root;      // itself, or a side it has met
    std::uint64_t voxels;  // of a root: reached so far, all its sides together
    std::deque<Wave> queue;
  };
  struct Visit {
    std::size_t side;
    BitBrick voxels;
  };

  std::size_t find(std::size_t s) {
    while (sides_[s].root != s) s = sides_[s].root = sides_[sides_[s].root].root;
    return s;
  }

  void step(std::size_t side) {
    const Wave wave = std::move(sides_[side].queue.front());
    sides_[side].queue.pop_front();
    const BitBrick* solid = grid_.brick(wave.brick);
    if (!solid) return;
    std::vector<Visit>& visits = visited_[wave.brick];
    BitBrick reached = flooded(*solid, wave.seeds);
    for (const Visit& visit : visits)
      if (find(visit.side) == side) reached = without(reached, visit.voxels);
    if (!reached.any()) return;
    ++bricks_;
    // What hangs together inside a brick is reached as a whole, so sides that meet share all of it.
    for (const Visit& visit : visits) {
      const std::size_t other = find(visit.side);
      if (other == side || !(visit.voxels & reached).any()) continue;
      reached = without(reached, visit.voxels);
      sides_[other].root = side;
      sides_[side].voxels += sides_[other].voxels;
      sides_[side].queue.insert(sides_[side].queue.end(), sides_[other].queue.begin(),
                                sides_[other].queue.end());
      sides_[other].queue.clear();
    }
    if (!reached.any()) return;
    visits.push_back({side, reached});
    sides_[side].voxels += static_cast<std::uint64_t>(reached.count());
    for (const Beside& next : beside(reached)) {
      if (!next.voxels.any()) continue;
      const IVec3 at = wave.brick + next.step;
      const BitBrick* there = grid_.brick(at);
      if (there && (*there & next.voxels).any()) sides_[side].queue.push_back({at, next.voxels});
    }
  }

  const SolidGrid& grid_;
  std::vector<Side> sides_;
  std::unordered_map<IVec3, std::vector<Visit>, IVec3Hash> visited_;
  std::size_t rest_ = kNone, bricks_ = 0;
};

/// Blocks of an island's chunks, unpacked when first looked at.
class Blocks {
 public:
  Blocks(World& world, std::uint64_t island) : world_(world), island_(island) {}
  BlockId at(IVec3 voxel) {
    const IVec3 chunk = chunk_of(voxel);
    std::vector<BlockId>& blocks = chunks_[chunk];
    if (blocks.empty()) {
      blocks.resize(kChunkVoxels);
      world_.chunk_now(island_, chunk).unpack(blocks);
    }
    return blocks[index_in_chunk(voxel)];
  }

 private:
  World& world_;
  std::uint64_t island_;
  std::unordered_map<IVec3, std::vector<BlockId>, IVec3Hash> chunks_;
};

/// Voxels on their way from one lattice to another.
class Move {
 public:
  Move(Blocks& blocks, IVec3 shift) : blocks_(blocks), shift_(shift) {}

  void take(IVec3 voxel) {
    const BlockId block = blocks_.at(voxel);
    taken_[chunk_of(voxel)].push_back({static_cast<std::uint32_t>(index_in_chunk(voxel)), kAir});
    const IVec3 to{voxel.x - shift_.x, voxel.y - shift_.y, voxel.z - shift_.z};
    made_.try_emplace(chunk_of(to), kChunkVoxels, kAir).first->second[index_in_chunk(to)] = block;
  }

  std::map<IVec3, Chunk> made() const {
    std::map<IVec3, Chunk> chunks;
    for (const auto& [at, blocks] : made_) chunks.emplace(at, Chunk::from_voxels(blocks));
    return chunks;
  }
  /// Air for each voxel taken.
  std::map<IVec3, ChunkEdits>& taken() {
    for (auto& [chunk, edits] : taken_)
      std::sort(edits.begin(), edits.end(),
                [](const VoxelEdit& a, const VoxelEdit& b) { return a.index < b.index; });
    return taken_;
  }

 private:
  Blocks& blocks_;
  IVec3 shift_;
  std::map<IVec3, std::vector<BlockId>> made_;
  std::map<IVec3, ChunkEdits> taken_;
};

}  // namespace

SplitSearch find_fragments(const SolidGrid& grid, std::span<const IVec3> removed) {
  Sides sides(grid);
  std::vector<IVec3> seeds;
  for (const IVec3& voxel : removed) {
    for (const IVec3& step : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0},
                              IVec3{0, 0, 1}, IVec3{0, 0, -1}})
      if (grid.at(voxel + step)) seeds.push_back(voxel + step);
  }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  if (seeds.size() < 2) return {};
  for (const IVec3& seed : seeds) sides.begin(seed);
  sides.grow();
  return {sides.fragments(), sides.bricks_looked_at()};
}

std::optional<LoosePiece> copy_piece(World& world, std::uint64_t island, const Fragment& fragment) {
  Blocks blocks(world, island);
  const glm::dvec3 middle = glm::floor(fragment.mass.centre);
  const IVec3 shift{static_cast<std::int32_t>(middle.x), static_cast<std::int32_t>(middle.y),
                    static_cast<std::int32_t>(middle.z)};
  Move move(blocks, shift);
  MassSum sum;
  for (const auto& [brick, voxels] : fragment.bricks) {
    BitBrick left;  // someone may have dug since the fragment was found
    for (int y = 0; y < kSplitEdge; ++y) {
      for (std::uint64_t layer = voxels.layers[y]; layer != 0; layer &= layer - 1) {
        const int bit = std::countr_zero(layer);
        IVec3 v{brick.x * kSplitEdge + bit / kSplitEdge, brick.y * kSplitEdge + y,
                brick.z * kSplitEdge + bit % kSplitEdge};
        if (!is_solid(blocks.at(v))) continue;
        left.layers[y] |= layer & -layer;
        move.take(v);
        // Plants and water go along with what they stand on.
        for (++v.y; blocks.at(v) != kAir && !is_solid(blocks.at(v)); ++v.y) move.take(v);
      }
    }
    if (left.any()) sum.add(brick, left, 1);
  }
  if (move.taken().empty()) return std::nullopt;
  LoosePiece piece;
  piece.voxels = std::make_shared<const StoredVoxels>(move.made());
  piece.shift = middle;
  piece.spec = fitted({}, *piece.voxels);
  piece.mass = sum.mass();
  piece.mass.centre -= middle;
  piece.taken = std::move(move.taken());
  return piece;
}

BrokenOff break_off(World& world, std::uint64_t island, const LoosePiece& piece, const Pose& at) {
  IslandSpec spec = piece.spec;
  spec.id = world.unused_id();
  spec.origin = moved(at.origin, at.rotation * piece.shift);
  spec.yaw_rad = 2.0 * std::atan2(at.rotation.y, at.rotation.w);
  const bool added = world.add_island(spec, piece.voxels);
  SKERRY_ASSERT(added);
  BrokenOff off{spec.id, piece.mass, piece.shift, {}};
  for (const auto& [chunk, edits] : piece.taken) {
    world.set_blocks(island, chunk, edits);
    off.changed.push_back(chunk);
  }
  return off;
}

}  // namespace skerry::world
