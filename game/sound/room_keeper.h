#pragma once
#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

#include "game/sound/sound_room.h"
#include "world/islands/world.h"

namespace skerry::game {

/// A voxel that was changed, and what it is now.
struct VoxelChange {
  std::uint64_t island = 0;
  world::IVec3 voxel;
  world::BlockId block = world::kAir;
};

/// Where two islands touch.
struct IslandContact {
  glm::dvec3 at{};     ///< in the room [blocks]
  double speed = 0.0;  ///< of one along the other [blocks/s]
};

/// Keeps the voxels of a world around a listener. They lie in the lattice of the listener's island,
/// or in the world's axes; other islands are sampled at the voxels' middles. Voxels that are not
/// loaded are air. Reads the world, so it may work on any thread.
class RoomKeeper {
 public:
  struct Listener {
    world::WorldPos eye;
    std::optional<std::uint64_t> island;  ///< whose lattice is used, if it is still there
    double time_s = 0.0;                  ///< of the world
  };
  /// Reads anew when the listener has come far from the middle or to another island, or after
  /// kRefreshSeconds, in which islands move and chunks are loaded.
  void follow(world::World& world, const Listener& listener, double seconds);
  static constexpr double kRefreshSeconds = 0.5;
  /// At once, where the island is the listener's.
  void change(const VoxelChange& change);
  /// The next follow() reads anew.
  void forget() {
    island_.reset();
    valid_ = false;
  }

  const SoundRoom& room() const { return room_; }
  const std::vector<IslandContact>& contacts() const { return contacts_; }
  glm::dvec3 room_place(world::WorldPos place) const;
  glm::dvec3 world_direction(const glm::dvec3& in_room) const { return pose_.rotation * in_room; }
  /// The lattice voxel of a cell: the same wherever the room is.
  world::IVec3 lattice(world::IVec3 cell) const {
    return {cell.x + corner_.x, cell.y + corner_.y, cell.z + corner_.z};
  }

 private:
  void read(world::World& world, const Listener& listener);
  void read_own(world::World& world, std::uint64_t island);
  void read_other(world::World& world, std::uint64_t island, double time_s);
  void note_contact(world::World& world, std::uint64_t other, const glm::dvec3& at, double time_s);

  SoundRoom room_;
  std::vector<IslandContact> contacts_;
  std::optional<std::uint64_t> island_;
  world::Pose pose_;
  world::IVec3 corner_;  // lattice voxel of cell (0, 0, 0)
  bool valid_ = false;
  double age_s_ = 0.0;
};

}  // namespace skerry::game
