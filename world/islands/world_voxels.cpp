// World's voxels: loading, editing, generating with edits.
#include <algorithm>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "engine/core/check.h"
#include "world/generate/generate.h"
#include "world/islands/world_island.h"
#include "world/mesh/mesh.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

IVec3 coarse_voxel(IVec3 voxel, int level) {
  return {voxel.x >> level, voxel.y >> level, voxel.z >> level};
}

// What edits do to a coarse voxel.
struct CoarseEdit {
  int removed = 0, put = 0;  // blocks
  BlockId block = kAir;      // of those put, the one that more than half are, if there is one
  int votes = 0;             // for it (R. Boyer, J. Moore, MJRTY, 1981)
  BlockId glow = kAir;       // of a block that shines for this voxel

  void add(IVec3 voxel, BlockId id, int level) {
    if (!is_solid(id)) {
      ++removed;
      return;
    }
    ++put;
    if (votes == 0) block = id;
    votes += block == id ? 1 : -1;
    // One of so many stands for all of them with as much area: four faces of a block are seen, of a
    // voxel five.
    constexpr std::uint64_t kFaces = 4, kVoxelFaces = 5;
    const std::uint64_t chance = (kFaces << 32) / kVoxelFaces >> 2 * level;
    const bool shines = id < block_types().size() && block_types()[id].emission > 0.0f;
    if (shines && hash3(0x61ce, voxel.x, voxel.y, voxel.z) < chance) glow = id;
  }

  // A voxel is solid where half of its blocks are or more; of what it was that is all that is
  // known.
  BlockId applied_to(BlockId before, int level) const {
    const int half = 1 << (3 * level - 1);
    if (glow != kAir) return glow;
    if (put >= half) return block;
    return removed >= half ? kAir : before;
  }
};

// Whether a chunk of level 0 reaches into the padded chunk `at` of a level.
bool overlaps(IVec3 chunk, IVec3 at, int level) {
  const auto axis = [level](std::int64_t fine, std::int64_t coarse) {
    const std::int64_t low = (coarse * kChunkEdge - 1) * (std::int64_t{1} << level);
    const std::int64_t high = ((coarse + 1) * kChunkEdge + 1) * (std::int64_t{1} << level);
    return (fine + 1) * kChunkEdge > low && fine * kChunkEdge < high;
  };
  return axis(chunk.x, at.x) && axis(chunk.y, at.y) && axis(chunk.z, at.z);
}

// The least box about some voxels of a chunk.
EditedBox box_of(std::uint64_t island, IVec3 chunk, std::span<const VoxelEdit> edits) {
  EditedBox box{island, voxel_of(chunk, edits.front().index), voxel_of(chunk, edits.front().index)};
  for (const VoxelEdit& edit : edits) {
    const IVec3 v = voxel_of(chunk, edit.index);
    box.min = {std::min(box.min.x, v.x), std::min(box.min.y, v.y), std::min(box.min.z, v.z)};
    box.max = {std::max(box.max.x, v.x), std::max(box.max.y, v.y), std::max(box.max.z, v.z)};
  }
  return box;
}

}  // namespace

Chunk chunk_from_padded(std::span<const BlockId> padded) {
  std::vector<BlockId> voxels(kChunkVoxels);
  for (std::size_t y = 0; y < kChunkEdge; ++y) {
    for (std::size_t x = 0; x < kChunkEdge; ++x) {
      const auto row =
          padded.subspan(1 + kPaddedEdge * ((x + 1) + kPaddedEdge * (y + 1)), kChunkEdge);
      std::copy(row.begin(), row.end(),
                voxels.begin() + static_cast<std::ptrdiff_t>(kChunkEdge * (x + kChunkEdge * y)));
    }
  }
  return Chunk::from_voxels(voxels);
}

bool by_layers(const IVec3& a, const IVec3& b) {
  return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
}

void put_into(Chunk& chunk, std::span<const VoxelEdit> edits) {
  for (const VoxelEdit& edit : edits) {
    const IVec3 in = place_in_chunk(edit.index);
    chunk.set(in.x, in.y, in.z, edit.block);
  }
}

std::shared_ptr<const VoxelSource> World::Island::plan() {
  const auto present = [this] {
    const std::lock_guard lock(mutex);
    return source;
  };
  if (auto found = present()) return found;
  const std::lock_guard building(plan_mutex);
  if (auto found = present()) return found;
  auto built = std::make_shared<const IslandGenerator>(made);
  const std::lock_guard lock(mutex);
  return source = std::move(built);
}

void World::Island::apply_edits(IVec3 chunk, int level, std::span<BlockId> padded,
                                bool& any) const {
  // Walked through without the lock: there may be very many, and a frame asks for blocks.
  std::vector<std::pair<IVec3, std::shared_ptr<const ChunkEdits>>> near;
  {
    const std::lock_guard lock(mutex);
    for (const auto& entry : edits)
      if (overlaps(entry.first, chunk, level)) near.emplace_back(entry);
  }
  const auto index_of = [&](IVec3 voxel) -> std::optional<std::size_t> {
    const std::int64_t x = std::int64_t{voxel.x} - std::int64_t{chunk.x} * kChunkEdge + 1;
    const std::int64_t y = std::int64_t{voxel.y} - std::int64_t{chunk.y} * kChunkEdge + 1;
    const std::int64_t z = std::int64_t{voxel.z} - std::int64_t{chunk.z} * kChunkEdge + 1;
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= kPaddedEdge) return std::nullopt;
    return static_cast<std::size_t>(z + kPaddedEdge * (x + kPaddedEdge * y));
  };
  std::unordered_map<std::size_t, CoarseEdit> coarse;
  for (const auto& [edited_chunk, voxels] : near) {
    for (const VoxelEdit& edit : *voxels) {
      const IVec3 voxel = voxel_of(edited_chunk, edit.index);
      const std::optional<std::size_t> at = index_of(coarse_voxel(voxel, level));
      if (!at) continue;
      if (level > 0) {
        coarse[*at].add(voxel, edit.block, level);
        continue;
      }
      padded[*at] = edit.block;
      any = any || edit.block != kAir;
    }
  }
  for (const auto& [at, edit] : coarse) {
    padded[at] = edit.applied_to(padded[at], level);
    any = any || padded[at] != kAir;
  }
}

bool World::Island::put(IVec3 chunk, std::span<const VoxelEdit> newer) {
  std::shared_ptr<const ChunkEdits>& held = edits[chunk];
  ChunkEdits merged = held ? *held : ChunkEdits{};
  merge_edits(merged, newer);
  held = std::make_shared<const ChunkEdits>(std::move(merged));
  bool grown = false;
  for (const VoxelEdit& edit : newer)
    if (edit.block != kAir) grown |= include(spec_, voxel_of(chunk, edit.index));
  if (grown) spec_.bounding_radius = std::max(spec_.bounding_radius, radius_of(spec_));
  if (const auto loaded = chunks.find(chunk); loaded != chunks.end())
    put_into(loaded->second, newer);
  return grown;
}

std::optional<BlockId> World::block_at(std::uint64_t id, IVec3 voxel) const {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return std::nullopt;
  const IVec3 at = chunk_of(voxel);
  const std::lock_guard lock(island->mutex);
  if (const auto loaded = island->chunks.find(at); loaded != island->chunks.end()) {
    return loaded->second.at(index_in_chunk(voxel));
  }
  if (const auto edited = island->edits.find(at); edited != island->edits.end()) {
    if (const auto block = edited_block(*edited->second, index_in_chunk(voxel))) return block;
  }
  const IslandSpec& spec = island->spec_locked();
  const bool in_box = voxel.x >= spec.box_min.x && voxel.x < spec.box_max.x &&
                      voxel.y >= spec.box_min.y && voxel.y < spec.box_max.y &&
                      voxel.z >= spec.box_min.z && voxel.z < spec.box_max.z;
  if (!in_box || (island->may_hold && !island->may_hold->contains(at))) return kAir;
  return std::nullopt;
}

bool World::ensure_chunk(std::uint64_t id, IVec3 chunk) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return false;
  {
    const std::lock_guard lock(island->mutex);
    if (island->chunks.contains(chunk)) return true;
  }
  std::vector<BlockId> padded(kPaddedVoxels);
  const bool any = generate_padded(id, chunk, 0, padded);
  keep_chunk(id, chunk, any ? chunk_from_padded(padded) : Chunk(kAir));
  return true;
}

Chunk World::chunk_now(std::uint64_t id, IVec3 chunk) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return Chunk(kAir);
  {
    const std::lock_guard lock(island->mutex);
    if (const auto loaded = island->chunks.find(chunk); loaded != island->chunks.end())
      return loaded->second;
  }
  std::vector<BlockId> padded(kPaddedVoxels);
  return generate_padded(id, chunk, 0, padded) ? chunk_from_padded(padded) : Chunk(kAir);
}

bool World::set_block(std::uint64_t id, IVec3 voxel, BlockId block) {
  const VoxelEdit edit{static_cast<std::uint32_t>(index_in_chunk(voxel)), block};
  return set_blocks(id, chunk_of(voxel), {&edit, 1});
}

bool World::set_blocks(std::uint64_t id, IVec3 chunk, std::span<const VoxelEdit> edits) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return false;
  if (edits.empty()) return true;
  bool grown = false;
  {
    const std::lock_guard lock(island->mutex);
    grown = island->put(chunk, edits);
  }
  if (grown) {
    const std::lock_guard lock(islands_mutex_);
    grown_.emplace(id, island);
  }
  const std::lock_guard lock(edits_mutex_);
  edits_.push_back(box_of(id, chunk, edits));
  return true;
}

std::vector<EditedBox> World::take_edits() {
  const std::lock_guard lock(edits_mutex_);
  return std::exchange(edits_, {});
}

std::vector<IVec3> World::edited_chunks(std::uint64_t id) const {
  std::vector<IVec3> list;
  const std::shared_ptr<Island> island = find(id);
  if (!island) return list;
  const std::lock_guard lock(island->mutex);
  for (const auto& [chunk, edits] : island->edits) list.push_back(chunk);
  return list;
}

ChunkEdits World::edits(std::uint64_t id, IVec3 chunk) const {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return {};
  const std::lock_guard lock(island->mutex);
  const auto found = island->edits.find(chunk);
  return found == island->edits.end() ? ChunkEdits{} : *found->second;
}

std::vector<IVec3> World::chunks(std::uint64_t id, int level) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return {};
  std::vector<IVec3> list = island->plan()->chunks(level);
  std::vector<std::pair<IVec3, std::shared_ptr<const ChunkEdits>>> edited;
  {
    const std::lock_guard lock(island->mutex);
    if (level == 0) island->may_hold.emplace(list.begin(), list.end());
    edited.assign(island->edits.begin(), island->edits.end());
  }
  for (const auto& [edited_chunk, voxels] : edited) {
    for (const VoxelEdit& edit : *voxels) {
      const IVec3 at = chunk_of(coarse_voxel(voxel_of(edited_chunk, edit.index), level));
      if (list.empty() || list.back() != at) list.push_back(at);
    }
  }
  std::sort(list.begin(), list.end(), by_layers);
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

bool World::generate_padded(std::uint64_t id, IVec3 chunk, int level, std::span<BlockId> out) {
  SKERRY_ASSERT(out.size() == kPaddedVoxels);
  const std::shared_ptr<Island> island = find(id);
  if (!island) {
    std::fill(out.begin(), out.end(), kAir);
    return false;
  }
  bool any = island->plan()->generate_padded(chunk, level, out);
  island->apply_edits(chunk, level, out, any);
  return any;
}

void World::keep_chunk(std::uint64_t id, IVec3 at, Chunk chunk) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return;
  const std::lock_guard lock(island->mutex);
  if (const auto found = island->edits.find(at); found != island->edits.end())
    put_into(chunk, *found->second);
  island->chunks.insert_or_assign(at, std::move(chunk));
}

void World::release_voxels(std::uint64_t id) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return;
  std::map<IVec3, Chunk> dropped;  // freed outside the lock
  const std::lock_guard lock(island->mutex);
  dropped.swap(island->chunks);
}

void World::release_plan(std::uint64_t id) {
  const std::shared_ptr<Island> island = find(id);
  if (!island || island->added) return;
  std::shared_ptr<const VoxelSource> dropped;
  const std::lock_guard lock(island->mutex);
  dropped.swap(island->source);
}

}  // namespace skerry::world
