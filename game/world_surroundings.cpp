#include "game/world_surroundings.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "world/chunk.h"

namespace skerry::game {
namespace {

constexpr double kMargin =
    64.0;  // blocks around what the player can reach in which islands are known
constexpr double kLoadRadius = 12.0;  // blocks around the player in which chunks are loaded

bool inside(const world::IVec3& v, const world::IVec3& min, const world::IVec3& max) {
  return v.x >= min.x && v.y >= min.y && v.z >= min.z && v.x < max.x && v.y < max.y && v.z < max.z;
}

world::IVec3 floored(const glm::dvec3& p) {
  const glm::ivec3 v(glm::floor(p));
  return {v.x, v.y, v.z};
}

/// Whether any of a chunk's voxels is in an island's box.
bool touches_box(const world::IVec3& chunk, const world::IslandSpec& spec) {
  const auto apart = [](int c, int min, int max) {
    return (c + 1) * world::kChunkEdge <= min || c * world::kChunkEdge >= max;
  };
  return !apart(chunk.x, spec.box_min.x, spec.box_max.x) &&
         !apart(chunk.y, spec.box_min.y, spec.box_max.y) &&
         !apart(chunk.z, spec.box_min.z, spec.box_max.z);
}

}  // namespace

void WorldSurroundings::refresh(world::WorldPos place, double reach_blocks, double time_s) {
  islands_ = world_.islands_near(place, reach_blocks + kMargin, time_s);
  std::sort(islands_.begin(), islands_.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  for (const world::IslandSpec& spec : islands_) load_chunks(spec, place, time_s);
}

void WorldSurroundings::load_chunks(const world::IslandSpec& spec, world::WorldPos place,
                                    double time_s) {
  const world::Pose pose = world::pose_at(spec, time_s);
  const glm::dvec3 lattice =
      glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin);
  if (glm::length(lattice) > spec.bounding_radius + kLoadRadius) return;
  const world::IVec3 first = world::chunk_of(floored(lattice - kLoadRadius));
  const world::IVec3 last = world::chunk_of(floored(lattice + kLoadRadius));
  for (world::IVec3 chunk{0, first.y, 0}; chunk.y <= last.y; ++chunk.y) {
    for (chunk.x = first.x; chunk.x <= last.x; ++chunk.x) {
      for (chunk.z = first.z; chunk.z <= last.z; ++chunk.z) {
        const world::IVec3 corner{chunk.x * world::kChunkEdge, chunk.y * world::kChunkEdge,
                                  chunk.z * world::kChunkEdge};
        if (!touches_box(chunk, spec) || world_.block_at(spec.id, corner)) continue;
        const std::lock_guard lock(loading_mutex_);
        if (!loading_.insert({spec.id, chunk}).second) continue;
        loader_.submit([this, id = spec.id, chunk] {
          world_.ensure_chunk(id, chunk);
          const std::lock_guard done(loading_mutex_);
          loading_.erase({id, chunk});
        });
      }
    }
  }
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
    const glm::dvec3 away = world::difference_blocks(place, world::pose_at(spec, time_s).origin);
    if (glm::length(away) <= spec.bounding_radius + radius_blocks) out.push_back(spec.id);
  }
}

std::optional<world::Pose> WorldSurroundings::pose(std::uint64_t island, double time_s) const {
  const world::IslandSpec* spec = spec_of(island);
  if (!spec) return std::nullopt;
  return world::pose_at(*spec, time_s);
}

std::optional<world::BlockId> WorldSurroundings::block(std::uint64_t island,
                                                       world::IVec3 voxel) const {
  const world::IslandSpec* spec = spec_of(island);
  // Outside the box there is nothing to load, and nothing to be held by.
  if (!spec || !inside(voxel, spec->box_min, spec->box_max)) return world::kAir;
  return world_.block_at(island, voxel);
}

}  // namespace skerry::game
