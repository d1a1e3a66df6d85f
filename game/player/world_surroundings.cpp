#include "game/player/world_surroundings.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "world/voxel/chunk.h"

namespace skerry::game {
namespace {

constexpr double kMargin =
    64.0;  // blocks around what the player can reach in which islands are known
constexpr double kLoadRadius = 12.0;  // blocks around the player in which chunks are loaded

world::IVec3 floored(const glm::dvec3& p) {
  const glm::ivec3 v(glm::floor(p));
  return {v.x, v.y, v.z};
}

/// The lowest voxel that a chunk and an island's box share, if any.
std::optional<world::IVec3> shared_voxel(const world::IVec3& chunk, const world::IslandSpec& spec) {
  const auto lowest = [](int c, int min) { return std::max(c * world::kChunkEdge, min); };
  const world::IVec3 voxel{lowest(chunk.x, spec.box_min.x), lowest(chunk.y, spec.box_min.y),
                           lowest(chunk.z, spec.box_min.z)};
  const auto in = [](int v, int c, int max) { return v < (c + 1) * world::kChunkEdge && v < max; };
  if (!in(voxel.x, chunk.x, spec.box_max.x) || !in(voxel.y, chunk.y, spec.box_max.y) ||
      !in(voxel.z, chunk.z, spec.box_max.z)) {
    return std::nullopt;
  }
  return voxel;
}

}  // namespace

ChunkLoader::ChunkLoader(world::World& world) : world_(world), thread_([this] { work(); }) {}

ChunkLoader::~ChunkLoader() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ChunkLoader::request(std::uint64_t island, world::IVec3 chunk) {
  {
    const std::lock_guard lock(mutex_);
    if (!waiting_.insert({island, chunk}).second) return;
    queue_.push_back({island, chunk});
  }
  wake_.notify_one();
}

void ChunkLoader::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || !queue_.empty(); });
    if (stop_) return;
    const Task task = queue_.front();
    queue_.pop_front();
    lock.unlock();
    world_.ensure_chunk(task.island, task.chunk);
    lock.lock();
    waiting_.erase(task);
  }
}

void WorldSurroundings::refresh(world::WorldPos place, double reach_blocks, double time_s) {
  islands_ = world_.islands_near(place, reach_blocks + kMargin, time_s);
  std::sort(islands_.begin(), islands_.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  for (const world::IslandSpec& spec : islands_) load_chunks(spec, place, time_s);
}

void WorldSurroundings::load_chunks(const world::IslandSpec& spec, world::WorldPos place,
                                    double time_s) {
  const world::Pose pose = pose_of(spec, time_s);
  const glm::dvec3 lattice =
      glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin);
  if (glm::length(lattice) > spec.bounding_radius + kLoadRadius) return;
  const world::IVec3 first = world::chunk_of(floored(lattice - kLoadRadius));
  const world::IVec3 last = world::chunk_of(floored(lattice + kLoadRadius));
  for (world::IVec3 chunk{0, first.y, 0}; chunk.y <= last.y; ++chunk.y) {
    for (chunk.x = first.x; chunk.x <= last.x; ++chunk.x) {
      for (chunk.z = first.z; chunk.z <= last.z; ++chunk.z) {
        const std::optional<world::IVec3> voxel = shared_voxel(chunk, spec);
        if (!voxel || world_.block_at(spec.id, *voxel)) continue;
        loader_.request(spec.id, chunk);
      }
    }
  }
}

world::Pose WorldSurroundings::pose_of(const world::IslandSpec& spec, double time_s) const {
  const std::optional<world::Pose> pose = world_.pose(spec.id, time_s);
  return pose ? *pose : world::pose_at(spec, time_s);
}

const world::IslandSpec* WorldSurroundings::spec_of(std::uint64_t island) const {
  const auto found = std::lower_bound(
      islands_.begin(), islands_.end(), island,
      [](const world::IslandSpec& spec, std::uint64_t id) { return spec.id < id; });
  return found != islands_.end() && found->id == island ? &*found : nullptr;
}

void WorldSurroundings::islands_near(world::WorldPos place, double radius_blocks, double time_s,
                                     std::vector<std::uint64_t>& out) const {
  out.clear();
  for (const world::IslandSpec& spec : islands_) {
    const glm::dvec3 away = world::difference_blocks(place, pose_of(spec, time_s).origin);
    if (glm::length(away) <= spec.bounding_radius + radius_blocks) out.push_back(spec.id);
  }
}

std::optional<world::Pose> WorldSurroundings::pose(std::uint64_t island, double time_s) const {
  const world::IslandSpec* spec = spec_of(island);
  if (!spec) return std::nullopt;
  return pose_of(*spec, time_s);
}

std::optional<world::BlockId> WorldSurroundings::block(std::uint64_t island,
                                                       world::IVec3 voxel) const {
  return world_.block_at(island, voxel);
}

}  // namespace skerry::game
