#pragma once
#include <cstdint>
#include <vector>

#include "world/generate/biome.h"
#include "world/voxel/island.h"

namespace skerry::world {

/// IslandSpec::archetype of generated islands: the family of silhouettes.
enum class Archetype : std::uint8_t {
  kPlateau,
  kCrescent,
  kSpires,
  kTerraces,
  kTwin,
  kButtes,
  kVolcano,
  kRidge,
  kShard,
  kArches,
  kCount
};

/// Empty blocks between an island's outline and its box: room for ragged cliffs and leaning crowns.
inline constexpr int kBoxMargin = 10;
/// Room above the highest ground for trees and arches.
inline constexpr int kTreeRoom = 30;
/// Room below the deepest rock for hanging crystals.
inline constexpr int kKeelRoom = 8;

/// Limits of an island's rock, in blocks from the lattice origin.
struct Extent {
  int radius;  ///< of the outline, horizontally
  int top;     ///< no ground is higher
  int depth;   ///< no rock is lower than -depth
  int sphere;  ///< radius about the lattice origin that holds everything, trees and crystals too
};
Extent extent_of(Archetype archetype, int radius);

/// Part of an outline, a disc. Lengths in blocks.
struct Lobe {
  int x, z, radius;
};

/// Ground raised by `height` inside a disc, with a cliff of width `cliff` around it, gentler
/// towards `ramp` so that it can be climbed.
struct Butte {
  int x, z, radius, height;
  int cliff;       ///< width of the rise, blocks
  int ramp;        ///< direction of the way up, 1/1024 turn
  int ramp_width;  ///< length of that way, blocks
};

/// A cone with concave flanks. `power` 1 is straight, 2 steepens towards the top.
struct Peak {
  int x, z, radius, height, power;
};

/// A bowl filled to `level` (water fills voxels below it), with a shore around it.
struct Lake {
  int x, z, radius;
  int level;  ///< kLevelFromGround: taken from the ground at the centre
  int depth;
};
inline constexpr int kLevelFromGround = -10000;

/// A stone bow from one foot on the ground to another, `rise` above the line between them.
struct Arch {
  int x0, z0, x1, z1, rise, thickness;
};

/// The design of one island, before any noise.
struct Shape {
  Archetype archetype{};
  Biome biome{};
  Extent extent{};
  std::uint32_t seed = 0;
  std::vector<Lobe> lobes;
  std::vector<Lobe> bites;  ///< taken out of the outline
  std::vector<Butte> buttes;
  std::vector<Peak> peaks;
  std::vector<Lake> lakes;
  std::vector<Arch> arches;
  std::vector<int> streams;  ///< directions in which lava runs down from the centre, 1/1024 turn
  int rim = 2;               ///< height of the ground at the edge
  int roll = 4;              ///< strength of gentle hills
  int crags = 0;             ///< strength of ridged mountains
  int lean = 0;              ///< strength of the tilt of the whole top, blocks over the radius
  int warp = 0;              ///< how far noise moves the outline
};
Shape shape_of(const IslandSpec& spec);

}  // namespace skerry::world
