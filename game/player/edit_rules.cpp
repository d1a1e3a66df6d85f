#include "game/player/edit_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "world/islands/dig.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::IVec3;

constexpr int kUp = 2, kDown = 3;
constexpr std::array<int, 4> kSides{0, 1, 4, 5};

/// @param gone counts as air.
bool holds(const Surroundings& around, std::uint64_t island, IVec3 voxel,
           std::optional<IVec3> gone) {
  if (voxel == gone) return false;
  const std::optional<BlockId> block = around.block(island, voxel);
  return block && world::is_solid(*block);
}

/// Whether a block has at a voxel what it needs beside it.
bool is_held(const Surroundings& around, std::uint64_t island, IVec3 voxel, BlockId block,
             std::optional<IVec3> gone) {
  const world::Support needed = world::support_of(block);
  if (needed == world::Support::kNone) return true;
  if (holds(around, island, beyond_face(voxel, kDown), gone)) return true;
  return needed == world::Support::kFace &&
         std::any_of(kSides.begin(), kSides.end(), [&](int side) {
           return holds(around, island, beyond_face(voxel, side), gone);
         });
}

/// Whether a solid of another island reaches into a voxel: looked for at its middle and a little
/// inside of its corners.
bool other_island_in(const Surroundings& around, const Pick& pick, IVec3 voxel, double time_s) {
  const std::optional<world::Pose> pose = around.pose(pick.island, time_s);
  if (!pose) return true;
  const glm::dvec3 middle{voxel.x + 0.5, voxel.y + 0.5, voxel.z + 0.5};
  std::vector<std::uint64_t> near;
  around.islands_near(world::moved(pose->origin, pose->rotation * middle), 1.0, time_s, near);
  for (const std::uint64_t island : near) {
    const std::optional<world::Pose> other = around.pose(island, time_s);
    if (island == pick.island || !other) continue;
    for (int corner = 0; corner < 9; ++corner) {
      constexpr double kInset = 0.45;  // from the middle
      const glm::dvec3 offset =
          corner == 8 ? glm::dvec3(0.0)
                      : kInset * glm::dvec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                            (corner & 4) != 0 ? 1 : -1);
      const world::WorldPos place = world::moved(pose->origin, pose->rotation * (middle + offset));
      const glm::ivec3 at = glm::floor(glm::conjugate(other->rotation) *
                                       world::difference_blocks(place, other->origin));
      if (holds(around, island, {at.x, at.y, at.z}, std::nullopt)) return true;
    }
  }
  return false;
}

}  // namespace

EditAct dig_act(const Surroundings& around, std::uint64_t island, IVec3 voxel) {
  const std::optional<BlockId> block = around.block(island, voxel);
  if (!block || !world::can_dig(*block)) return {};
  EditAct act{{island, voxel, *block, world::kAir}};
  for (const int face : {kUp, kSides[0], kSides[1], kSides[2], kSides[3]}) {
    const IVec3 neighbour = beyond_face(voxel, face);
    const std::optional<BlockId> there = around.block(island, neighbour);
    if (there && is_held(around, island, neighbour, *there, std::nullopt) &&
        !is_held(around, island, neighbour, *there, voxel))
      act.push_back({island, neighbour, *there, world::kAir});
  }
  return act;
}

EditAct place_act(const Surroundings& around, const Pick& pick, BlockId block, double time_s) {
  if (block == world::kAir) return {};
  const bool in_place = world::can_replace(pick.block);
  const IVec3 voxel = in_place ? pick.voxel : beyond_face(pick.voxel, pick.face);
  const std::optional<BlockId> there = around.block(pick.island, voxel);
  if (!there || *there == block || !world::can_replace(*there)) return {};
  if (!is_held(around, pick.island, voxel, block, std::nullopt)) return {};
  if (other_island_in(around, pick, voxel, time_s)) return {};
  return {{pick.island, voxel, *there, block}};
}

bool leaves_free(const Player& player, const Surroundings& around, std::uint64_t island,
                 IVec3 voxel) {
  const std::optional<world::Pose> pose = around.pose(island, player.tick_time_s());
  if (!pose) return true;
  const glm::dvec3 feet =
      glm::conjugate(pose->rotation) * world::difference_blocks(player.feet(), pose->origin);
  return !box_overlaps([voxel](IVec3 at) { return at == voxel; }, lattice_pos(feet));
}

}  // namespace skerry::game
