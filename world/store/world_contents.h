// What a world file holds of its world besides voxels.
#pragma once
#include <optional>
#include <string>

#include "world/islands/world.h"
#include "world/voxel/island.h"
#include "world/voxel/motion_state.h"

namespace skerry::world {

inline constexpr int kWorldFileVersion = 3;  ///< of the tables

/// What a world is made of. Fixed when its file is made.
struct WorldInfo {
  std::string name;       ///< for people; at most 200 bytes
  std::string seed_text;  ///< as typed; at most 4096 bytes
  WorldDesc desc;
  bool operator==(const WorldInfo&) const;
};

/// An island as its file has it. Generated islands without edits have no row.
struct IslandRow {
  IslandSpec spec;
  bool added = false;                      ///< no seed made it: all its chunks are in the file
  std::optional<MotionState> motion = {};  ///< of an island that left its course
};

}  // namespace skerry::world
