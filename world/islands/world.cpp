#include "world/islands/world.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

#include "engine/core/check.h"
#include "world/islands/world_island.h"
#include "world/mesh/mesh.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kMaxIslandLimit = 100'000;
// Above this many islands, those that hold nothing are dropped.
constexpr std::size_t kMaxKnownIslands = 32'768;
// An island that moved so far since it was last noted may have come near someone.
constexpr double kNotedBlocks = 24.0;

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

}  // namespace

IslandSpec World::Island::spec() const {
  const std::lock_guard lock(mutex);
  return spec_;
}

Pose World::Island::pose(double time_s) const {
  const std::lock_guard lock(mutex);
  return track ? track->at(time_s) : pose_at(spec_, time_s);
}

bool World::Island::idle() const {
  const std::lock_guard lock(mutex);
  return chunks.empty() && edits.empty() && !source && !track;
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
  if (!desc_.generated) return spawn_on_added();
  Spawn spawn = spawn_of(desc_.seed);
  spawn.feet = spawn.feet + origin();
  return spawn;
}

// The added island with the largest box; on it the column nearest to the middle that has ground.
Spawn World::spawn_on_added() const {
  Spawn spawn;
  spawn.feet = origin();
  std::shared_ptr<Island> largest;
  double volume = 0.0;
  for (const auto& [id, island] : special()) {
    const IslandSpec spec = island->spec();
    const IVec3 &low = spec.box_min, &high = spec.box_max;
    const double size =
        (double{1} * high.x - low.x) * (double{1} * high.y - low.y) * (double{1} * high.z - low.z);
    if (!island->added || !(size > volume)) continue;
    volume = size;
    largest = island;
  }
  if (!largest) return spawn;
  const IslandSpec spec = largest->spec();
  const double middle_x = 0.5 * (double{1} * spec.box_min.x + spec.box_max.x);
  const double middle_z = 0.5 * (double{1} * spec.box_min.z + spec.box_max.z);
  std::optional<IVec3> best;
  double nearest = 0.0;
  std::vector<BlockId> padded(kPaddedVoxels), blocks(kChunkVoxels);
  for (const IVec3& at : largest->plan()->chunks(0)) {  // from below
    bool any = largest->plan()->generate_padded(at, 0, padded);
    largest->apply_edits(at, 0, padded, any);
    chunk_from_padded(padded).unpack(blocks);
    for (std::uint32_t i = 0; i < kChunkVoxels; ++i) {
      if (!is_solid(blocks[i])) continue;
      const IVec3 v = voxel_of(at, i);
      const double away = std::hypot(v.x + 0.5 - middle_x, v.z + 0.5 - middle_z);
      if (best && (away > nearest || (away == nearest && v.y < best->y))) continue;
      best = v;
      nearest = away;
    }
  }
  if (!best) return spawn;
  const Pose pose = largest->pose(0.0);
  spawn.feet =
      moved(pose.origin, pose.rotation * glm::dvec3{best->x + 0.5, best->y + 1.0, best->z + 0.5});
  spawn.island = spec.id;
  return spawn;
}

std::vector<IslandSpec> World::islands_near(WorldPos centre, double radius_blocks,
                                            double time_s) const {
  struct Found {
    double distance;
    IslandSpec spec;
  };
  std::vector<Found> found;
  const auto consider = [&](const IslandSpec& spec, const Pose& pose) {
    const double distance = length(difference_blocks(pose.origin, centre));
    if (distance - spec.bounding_radius <= radius_blocks) found.push_back({distance, spec});
  };
  const IslandMap elsewhere = special();
  for (const auto& [id, island] : elsewhere) consider(island->spec(), island->pose(time_s));
  if (desc_.generated) {
    for (IslandSpec& spec :
         islands_within(desc_.seed, centre - origin(), radius_blocks + kMaxIslandDriftBlocks)) {
      if ((allowed_ && !allowed_->contains(spec.id)) || elsewhere.contains(spec.id)) continue;
      spec.origin = spec.origin + origin();
      consider(spec, pose_at(spec, time_s));
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.distance, a.spec.id) < std::tie(b.distance, b.spec.id);
  });
  std::vector<IslandSpec> specs;
  specs.reserve(found.size());
  for (const Found& f : found) specs.push_back(f.spec);
  remember(specs);
  return specs;
}

void World::remember(const std::vector<IslandSpec>& specs) const {
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

World::IslandMap World::special() const {
  const std::lock_guard lock(islands_mutex_);
  IslandMap islands = special_;
  islands.insert(grown_.begin(), grown_.end());
  return islands;
}

std::optional<IslandSpec> World::island(std::uint64_t id) const {
  const std::shared_ptr<Island> island = find(id);
  return island ? std::optional(island->spec()) : std::nullopt;
}

std::optional<Pose> World::pose(std::uint64_t id, double time_s) const {
  const std::shared_ptr<Island> island = find(id);
  return island ? std::optional(island->pose(time_s)) : std::nullopt;
}

IslandPoses World::poses(double time_s) const {
  IslandPoses poses;
  poses.time_s_ = time_s;
  const std::lock_guard lock(islands_mutex_);
  for (const auto& [id, island] : special_) poses.off_course_.emplace(id, island->pose(time_s));
  return poses;
}

Pose IslandPoses::of(const IslandSpec& spec) const {
  if (!off_course_.empty())
    if (const auto found = off_course_.find(spec.id); found != off_course_.end())
      return found->second;
  return pose_at(spec, time_s_);
}

bool World::add_island(const IslandSpec& spec, std::shared_ptr<const VoxelSource> source) {
  SKERRY_ASSERT(source != nullptr);
  {
    const std::lock_guard lock(islands_mutex_);
    const auto [at, is_new] = islands_.try_emplace(spec.id);
    if (!is_new) return false;
    at->second = std::make_shared<Island>(spec, std::move(source));
    special_.emplace(spec.id, at->second);
  }
  revision_.fetch_add(1, std::memory_order_acq_rel);
  return true;
}

std::vector<std::uint64_t> World::added_islands() const {
  std::vector<std::uint64_t> ids;
  for (const auto& [id, island] : special())
    if (island->added) ids.push_back(id);
  return ids;
}

bool World::is_added(std::uint64_t id) const {
  const std::shared_ptr<Island> island = find(id);
  return island && island->added;
}

bool World::is_as_generated(std::uint64_t id) const {
  const std::shared_ptr<Island> island = find(id);
  if (!island || island->added) return false;
  const std::lock_guard lock(island->mutex);
  return island->edits.empty();
}

std::vector<std::uint64_t> World::changed_islands() const {
  std::vector<std::uint64_t> ids;
  {
    const std::lock_guard lock(islands_mutex_);
    for (const auto& [id, island] : islands_) {
      const std::lock_guard island_lock(island->mutex);
      if (island->added || island->track || !island->edits.empty()) ids.push_back(id);
    }
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::uint64_t World::unused_id() const {
  const std::lock_guard lock(islands_mutex_);
  for (std::uint64_t count = special_.size() + 1;; ++count) {
    // Ids of a seed's islands are hashes, too: to hit one that nobody has come near yet takes the
    // luck of one in 2^64.
    const std::uint64_t id = mix64(mix64(desc_.seed ^ 0x69736c616e647321u) + count);
    if (!islands_.contains(id)) return id;
  }
}

bool World::meet(std::uint64_t id, WorldPos place) {
  if (find(id)) return true;
  if (!desc_.generated || (allowed_ && !allowed_->contains(id))) return false;
  constexpr double kSamePlaceBlocks = 1.0;
  std::vector<IslandSpec> specs = islands_within(desc_.seed, place - origin(), kSamePlaceBlocks);
  std::erase_if(specs, [&](const IslandSpec& spec) { return spec.id != id; });
  for (IslandSpec& spec : specs) spec.origin = spec.origin + origin();
  remember(specs);
  return !specs.empty();
}

bool World::move_island(std::uint64_t id, std::int64_t tick, const Pose& pose) {
  const std::shared_ptr<Island> island = find(id);
  if (!island) return false;
  bool first = false, far = false;
  {
    const std::lock_guard lock(island->mutex);
    first = !island->track;
    if (first) island->track = std::make_unique<PoseTrack>();
    island->track->push(tick, pose);
    far = first || length(difference_blocks(pose.origin, island->noted)) > kNotedBlocks;
    if (far) island->noted = pose.origin;
  }
  if (!far) return true;
  if (first) {
    const std::lock_guard lock(islands_mutex_);
    special_.emplace(id, island);
  }
  revision_.fetch_add(1, std::memory_order_acq_rel);
  return true;
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
