#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <set>
#include <span>
#include <vector>

#include "world/stream/stream.h"

namespace skerry::world {

/// A chunk at a level: a node of an island's tree of sections. Its eight children are the chunks of
/// the level below that it covers.
struct TreeNode {
  std::int32_t level = 0;  ///< a voxel's edge is 2^level blocks
  IVec3 chunk;
  auto operator<=>(const TreeNode&) const = default;
};

/// Which of an island's sections are drawn, so that each place is drawn at one level.
struct SectionCut {
  std::vector<bool> drawn;          ///< by section
  std::vector<std::uint8_t> seams;  ///< by section: bit i: at face i another level is drawn
  std::set<TreeNode> split;         ///< nodes that are drawn finer
  double slack = 0.0;               ///< blocks by which the camera may move without another cut
};

/// @param sections of one island, none of them far, none twice; each level that occurs is there as
///   a whole.
/// @param camera in lattice axes [blocks].
/// @param nearest by level: how near a section may come that is drawn at it [blocks]; ascending.
/// @param before the last cut's `split`: nodes change only 5% beyond their limits. Null: nothing
///   was drawn before.
SectionCut cut_of(std::span<const TreeNode> sections, const glm::dvec3& camera,
                  std::span<const double> nearest, const std::set<TreeNode>* before);

}  // namespace skerry::world
