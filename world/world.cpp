#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/check.h"
#include "world/generate/generate.h"
#include "world/mesh/mesh.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kMaxIslandLimit = 100'000;
// Above this many known islands, those that hold nothing are forgotten.
constexpr std::size_t kMaxKnownIslands = 32'768;

double length(const glm::dvec3& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// Ids of the `count` islands nearest to the world's own origin. The plan lists every island whose
// centre is within the radius, so a list that reaches the radius with enough centres has them all.
std::unordered_set<std::uint64_t> nearest_ids(std::uint64_t seed, std::uint32_t count) {
  std::unordered_set<std::uint64_t> ids;
  if (count == 0) return ids;
  for (double radius = 1024.0;; radius *= 2.0) {
    const std::vector<IslandSpec> specs = islands_within(seed, {}, radius);
    if (specs.size() < count) continue;
    if (length(difference_blocks(specs[count - 1].origin, {})) > radius) continue;
    for (std::uint32_t i = 0; i < count; ++i) ids.insert(specs[i].id);
    return ids;
  }
}

bool by_layers(const IVec3& a, const IVec3& b) {
  return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
}

std::int32_t floor_div32(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(floor_div(a, b));
}

// The coarse voxel that shows the block at `voxel`, if its centre is there (see generate_padded).
std::optional<IVec3> shown_at(IVec3 voxel, int level) {
  const std::int32_t edge = 1 << level;
  const std::int32_t half = edge / 2;
  const auto centred = [&](std::int32_t v) { return floor_mod(v, edge) == half; };
  if (!centred(voxel.x) || !centred(voxel.y) || !centred(voxel.z)) return std::nullopt;
  return IVec3{floor_div32(voxel.x, edge), floor_div32(voxel.y, edge), floor_div32(voxel.z, edge)};
}

// Whether a chunk of level 0 reaches into the padded chunk `at` of a level.
bool overlaps(IVec3 chunk, IVec3 at, int level) {
  const auto axis = [level](std::int64_t fine, std::int64_t coarse) {
    const std::int64_t low = (coarse * kChunkEdge - 1) * (std::int64_t{1} << level);
    const std::int64_t high = ((coarse + 1) * kChunkEdge + 1) * (std::int64_t{1} << level);
    return (fine + 1) * kChunkEdge > low && fine * kChunkEdge < high;
  };
  return axis(chunk.x, at.x) && axis(chunk.y, at.y) && axis(chunk.z, at.z);
}

void set_in(Chunk& chunk, IVec3 voxel, BlockId block) {
  const auto in = [](std::int32_t v) { return static_cast<int>(floor_mod(v, kChunkEdge)); };
  chunk.set(in(voxel.x), in(voxel.y), in(voxel.z), block);
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

IVec3 chunk_of(IVec3 voxel) {
  return {floor_div32(voxel.x, kChunkEdge), floor_div32(voxel.y, kChunkEdge),
          floor_div32(voxel.z, kChunkEdge)};
}

std::size_t index_in_chunk(IVec3 voxel) {
  const auto in = [](std::int32_t v) { return static_cast<int>(floor_mod(v, kChunkEdge)); };
  return voxel_index(in(voxel.x), in(voxel.y), in(voxel.z));
}

struct World::Island {
  explicit Island(const IslandSpec& island_spec) : spec(island_spec) {}

  using Edits = std::map<IVec3, BlockId>;  // by voxel

  std::shared_ptr<const IslandGenerator> plan();
  void apply_edits(IVec3 chunk, int level, std::span<BlockId> padded, bool& any) const;
  bool idle() const;

  const IslandSpec spec;
  std::mutex plan_mutex;     // held while the plan is built
  mutable std::mutex mutex;  // guards everything below; never held for long
  std::shared_ptr<const IslandGenerator> generator;
  std::map<IVec3, Chunk> chunks;            // loaded, level 0
  std::optional<std::set<IVec3>> may_hold;  // level-0 chunks that are not plain air, if known
  std::map<IVec3, Edits> edits;             // by level-0 chunk
};

std::shared_ptr<const IslandGenerator> World::Island::plan() {
  const auto present = [this] {
    const std::lock_guard lock(mutex);
    return generator;
  };
  if (auto found = present()) return found;
  const std::lock_guard building(plan_mutex);
  if (auto found = present()) return found;
  auto built = std::make_shared<const IslandGenerator>(spec);
  const std::lock_guard lock(mutex);
  return generator = std::move(built);
}

void World::Island::apply_edits(IVec3 chunk, int level, std::span<BlockId> padded,
                                bool& any) const {
  const std::lock_guard lock(mutex);
  for (const auto& [edited_chunk, voxels] : edits) {
    if (!overlaps(edited_chunk, chunk, level)) continue;
    for (const auto& [voxel, id] : voxels) {
      const std::optional<IVec3> shown = shown_at(voxel, level);
      if (!shown) continue;
      const std::int64_t x = std::int64_t{shown->x} - std::int64_t{chunk.x} * kChunkEdge + 1;
      const std::int64_t y = std::int64_t{shown->y} - std::int64_t{chunk.y} * kChunkEdge + 1;
      const std::int64_t z = std::int64_t{shown->z} - std::int64_t{chunk.z} * kChunkEdge + 1;
      if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= kPaddedEdge) continue;
      padded[static_cast<std::size_t>(z + kPaddedEdge * (x + kPaddedEdge * y))] = id;
      any = any || id != kAir;
    }
  }
}

bool World::Island::idle() const {
  const std::lock_guard lock(mutex);
  return chunks.empty() && edits.empty() && !generator;
}

World::World(const WorldDesc& desc) : desc_(desc) {
  for (const std::int64_t axis : desc.offset_blocks) {
    SKERRY_ASSERT(axis >= -kMaxBlock && axis <= kMaxBlock);
  }
  if (!desc.island_limit) return;
  SKERRY_ASSERT(*desc.island_limit <= kMaxIslandLimit);
  allowed_ = nearest_ids(desc.seed, *desc.island_limit);
}

World::~World() = default;

WorldPos World::origin() const {
  return {desc_.offset_blocks[0] * kUnitsPerBlock, desc_.offset_blocks[1] * kUnitsPerBlock,
          desc_.offset_blocks[2] * kUnitsPerBlock};
}

Spawn World::spawn() const {
  Spawn spawn = spawn_of(desc_.seed);
  spawn.feet = spawn.feet + origin();
  return spawn;
}

std::vector<IslandSpec> World::islands_near(WorldPos centre, double radius_blocks,
                                            double time_s) const {
  struct Found {
    double distance;
    IslandSpec spec;
  };
  std::vector<Found> found;
  for (IslandSpec& spec :
       islands_within(desc_.seed, centre - origin(), radius_blocks + kMaxIslandDriftBlocks)) {
    if (allowed_ && !allowed_->contains(spec.id)) continue;
    spec.origin = spec.origin + origin();
    const double distance = length(difference_blocks(pose_at(spec, time_s).origin, centre));
    if (distance - spec.bounding_radius <= radius_blocks) found.push_back({distance, spec});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.distance, a.spec.id) < std::tie(b.distance, b.spec.id);
  });
  std::vector<IslandSpec> specs;
  specs.reserve(found.size());
  for (const Found& f : found) specs.push_back(f.spec);
  know(specs);
  return specs;
}

void World::know(const std::vector<IslandSpec>& specs) const {
  const std::lock_guard lock(islands_mutex_);
  for (const IslandSpec& spec : specs) {
    auto& island = islands_[spec.id];
    if (!island) island = std::make_shared<Island>(spec);
  }
  if (islands_.size() <= kMaxKnownIslands + specs.size()) return;
  std::unordered_set<std::uint64_t> wanted;
  for (const IslandSpec& spec : specs) wanted.insert(spec.id);
  std::erase_if(islands_, [&](const auto& entry) {
    return !wanted.contains(entry.first) && entry.second.use_count() == 1 && entry.second->idle();
  });
}

std::shared_ptr<World::Island> World::find(std::uint64_t id) const {
  const std::lock_guard lock(islands_mutex_);
  const auto found = islands_.find(id);
  return found == islands_.end() ? nullptr : found->second;
}

std::optional<IslandSpec> World::island(std::uint64_t id) const {
  const std::shared_ptr<Island> island = find(id);
  return island ? std::optional(island->spec) : std::nullopt;
}

std::optional<Pose> World::pose(std::uint64_t id, double time_s) const {
  const std::shared_ptr<Island> island = find(id);
  return island ? std::optional(pose_at(island->spec, time_s)) : std::nullopt;
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
    const auto block = edited->second.find(voxel);
    if (block != edited->second.end()) return block->second;
  }
  const IslandSpec& spec = island->spec;
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

bool World::set_block(std::uint64_t id, IVec3 voxel, BlockId block) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return false;
  const IVec3 at = chunk_of(voxel);
  {
    const std::lock_guard lock(island->mutex);
    island->edits[at].insert_or_assign(voxel, block);
    if (const auto loaded = island->chunks.find(at); loaded != island->chunks.end()) {
      set_in(loaded->second, voxel, block);
    }
  }
  const std::lock_guard lock(edits_mutex_);
  edits_.push_back({id, voxel});
  return true;
}

std::vector<BlockEdit> World::take_edits() {
  const std::lock_guard lock(edits_mutex_);
  return std::exchange(edits_, {});
}

std::vector<IVec3> World::chunks(std::uint64_t id, int level) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return {};
  std::vector<IVec3> list = island->plan()->chunks(level);
  const std::lock_guard lock(island->mutex);
  if (level == 0) island->may_hold.emplace(list.begin(), list.end());
  for (const auto& [edited_chunk, voxels] : island->edits) {
    for (const auto& [voxel, block] : voxels) {
      if (const auto shown = shown_at(voxel, level)) list.push_back(chunk_of(*shown));
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
  if (const auto found = island->edits.find(at); found != island->edits.end()) {
    for (const auto& [voxel, block] : found->second) set_in(chunk, voxel, block);
  }
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
  if (!island) return;
  std::shared_ptr<const IslandGenerator> dropped;
  const std::lock_guard lock(island->mutex);
  dropped.swap(island->generator);
}

World::Usage World::usage() const {
  Usage usage;
  const std::lock_guard lock(islands_mutex_);
  usage.islands = islands_.size();
  for (const auto& [id, island] : islands_) {
    const std::lock_guard island_lock(island->mutex);
    usage.chunks += island->chunks.size();
    for (const auto& [at, chunk] : island->chunks) usage.bytes += chunk.size_bytes();
  }
  return usage;
}

}  // namespace skerry::world
