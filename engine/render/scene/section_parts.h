#pragma once
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"

namespace skerry::render {

/// A section of its own, as GeometryStore::add() takes it.
struct SectionPart {
  shared::Section section{};
  std::span<const shared::Quad> quads;
};

/// Splits the mesh of a chunk by the 16^3 voxels in which quads begin, so that culling leaves out
/// what is hidden of a chunk that is seen in part (docs/decisions/0050). Small meshes stay whole.
/// @param section record of the whole. @param sorted replaced: may hold the quads of the parts.
/// @return not empty; together they have the same quads, each in its range and in the same order,
/// and each a tight box.
std::vector<SectionPart> parts_of(const shared::Section& section,
                                  std::span<const shared::Quad> quads,
                                  std::vector<shared::Quad>& sorted);

}  // namespace skerry::render
