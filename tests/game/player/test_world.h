// Islands made of functions, for tests of players and of what they do.
#pragma once
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <vector>

#include "game/player/edit_history.h"
#include "game/player/player.h"

namespace skerry::game {

inline world::WorldPos at_blocks(double x, double y, double z) {
  return world::moved({}, {x, y, z});
}

/// Pose of time, block of voxel; what was edited goes over it.
class TestWorld : public Surroundings, public BlockEditor {
 public:
  struct Island {
    std::function<world::Pose(double)> pose;
    std::function<std::optional<world::BlockId>(world::IVec3)> block;
    double radius = 64.0;
    std::map<world::IVec3, world::BlockId> edits = {};
  };
  std::vector<Island> islands;
  bool refuses = false;

  void islands_near(world::WorldPos place, double radius, double time_s,
                    std::vector<std::uint64_t>& out) const override {
    out.clear();
    for (std::size_t i = 0; i < islands.size(); ++i) {
      const auto to = world::difference_blocks(place, islands[i].pose(time_s).origin);
      if (glm::length(to) <= islands[i].radius + radius) out.push_back(i);
    }
  }
  std::optional<world::Pose> pose(std::uint64_t island, double time_s) const override {
    if (island >= islands.size()) return std::nullopt;
    return islands[island].pose(time_s);
  }
  std::optional<world::BlockId> block(std::uint64_t island, world::IVec3 voxel) const override {
    const auto edited = islands[island].edits.find(voxel);
    return edited != islands[island].edits.end() ? edited->second : islands[island].block(voxel);
  }
  bool set_block(std::uint64_t island, world::IVec3 voxel, world::BlockId block) override {
    if (refuses) return false;
    islands[island].edits[voxel] = block;
    return true;
  }
};

inline world::Pose still(world::WorldPos origin) {
  return {origin, glm::dquat(1.0, 0.0, 0.0, 0.0)};
}

inline world::Pose turning(world::WorldPos origin, double rad_per_s, double time_s) {
  return {origin, glm::angleAxis(rad_per_s * time_s, glm::dvec3(0.0, 1.0, 0.0))};
}

/// Stone below y = 0.
inline std::optional<world::BlockId> plain(world::IVec3 v) {
  return v.y < 0 ? world::block::kStone : world::block::kAirBlock;
}

/// A hash of a voxel, for random worlds.
inline std::uint32_t voxel_hash(world::IVec3 v, std::uint32_t seed) {
  std::uint32_t h = seed;
  for (const int c : {v.x, v.y, v.z})
    h = (h ^ static_cast<std::uint32_t>(c + 1000)) * 2654435761u, h ^= h >> 15;
  return h;
}

inline glm::dvec3 lattice_of(const world::Pose& pose, world::WorldPos place) {
  return glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin);
}

}  // namespace skerry::game
