#pragma once
#include <cstdint>
#include <span>

#include "world/generate/biome.h"

namespace skerry::world {

struct Tree {
  std::int16_t x, y, z;  ///< the lowest trunk voxel
  TreeKind kind;
  std::uint8_t height;  ///< of the trunk, blocks
  std::uint8_t spread;  ///< crown radius, blocks
  std::uint32_t seed;
};

/// How far any part of a tree is from its trunk, sideways and up.
inline constexpr int kTreeReach = 9;
inline constexpr int kTreeHeight = 28;

/// A padded chunk being filled. Coordinates are voxels of its level, from the lattice origin.
struct Canvas {
  int x0, y0, z0;  ///< voxel of out[0]
  int level;
  std::span<BlockId> out;

  BlockId* find(int x, int y, int z) const;
};

/// The shape of a tree of this kind; the caller sets its place.
Tree grown(TreeKind kind, std::uint32_t seed);

/// Draws what of the tree lies in the canvas. Leaves take air only; trunks also replace leaves and
/// plants.
void draw_tree(const Tree& tree, const Canvas& canvas);

}  // namespace skerry::world
