// How sound comes from its sources to the listener: through air round corners, or through walls.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "game/sound/sound_room.h"

namespace skerry::game {

struct SoundPath {
  bool open = true;      ///< by air or water; else through a wall
  double length = 0.0;   ///< blocks
  glm::dvec3 arrival{};  ///< where it comes from, seen from the listener: of length 1, or 0 here
  double loss_db = 0.0;  ///< besides distance
  double cutoff_hz = 20000.0;  ///< of a low-pass

  /// Amplitude: 1 at a block's distance, falling with distance and loss.
  double gain() const;
};

/// Cut-off of what is heard through a wall, or under water [Hz].
inline constexpr double kWallCutoffHz = 350.0, kWaterCutoffHz = 700.0;
/// What a turn round a corner costs [dB a right angle].
inline constexpr double kCornerLossDb = 6.0;

/// Paths from many sources to one listener. What is not in the line of sight is found by one flood
/// from the listener's voxel over the 26 neighbours, round no corner that both ways would cut,
/// which all sources share; the way is then pulled tight. It serves until something changes or the
/// listener has gone beyond the voxels beside its own, or out of its sight, and spreads no further
/// than it is asked for. Not found within kMostLength or kMostCells: through the wall.
class SoundPaths {
 public:
  static constexpr int kMostLength = 48;    ///< blocks
  static constexpr int kMostCells = 60000;  ///< that a flood reaches
  /// Costs of a step to a neighbour by face, edge and corner: tenths of a block.
  static constexpr int kFaceCost = 10, kEdgeCost = 14, kCornerCost = 17;

  /// @param room outlives this; its changes are noticed.
  explicit SoundPaths(const SoundRoom& room) : room_(room) {}

  void listen_at(const glm::dvec3& place) { listener_ = place; }
  SoundPath path_from(const glm::dvec3& source);
  /// Cost of the shortest way over voxels from where the flood began [tenths of a block]; -1: none
  /// found.
  int way_cost(world::IVec3 cell);
  /// How often a flood began.
  std::uint64_t floods() const { return floods_; }

 private:
  bool flood_serves() const;
  void begin_flood();
  /// On to where the cost of a voxel is final.
  void flood_to(std::size_t cell);
  void reach(std::size_t from, int cost);
  /// Corners from the listener to a voxel, both ends included.
  std::vector<glm::dvec3> corners_to(world::IVec3 cell, const glm::dvec3& source) const;
  SoundPath tight_path(world::IVec3 cell, const glm::dvec3& source) const;

  const SoundRoom& room_;
  glm::dvec3 listener_{};
  world::IVec3 flooded_from_{-1, -1, -1};
  std::uint64_t flooded_revision_ = 0, floods_ = 0;
  std::vector<std::uint16_t> cost_;  // kUnreached, or from flooded_from_
  std::vector<std::uint8_t> step_;   // which neighbour of the voxel before it is; maybe kFromOpen
  std::vector<std::vector<std::uint32_t>> due_;  // voxels by cost
  std::size_t flooded_cost_ = 0;                 // what costs less is final
  int reached_ = 0;                              // voxels that are
};

}  // namespace skerry::game
