#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "world/light/base/face_records.h"

namespace skerry::world {

/// A face and the block that it is of.
struct BlockFace {
  DrawnFace drawn{};
  std::uint16_t block = 0;
};

/// What an edit changes of a chunk's faces. Faces that are only merged into other quads stay.
struct FaceChanges {
  std::vector<BlockFace> came, went;
  std::vector<BlockFace> turned;  ///< of another block now, which is named
};

/// @param before, now quads of a chunk; a face is in one of them at most. A linear pass over the
/// quads if those that stay keep their order, as those of one mesher do.
FaceChanges face_changes(std::span<const shared::Quad> before, std::span<const shared::Quad> now);

}  // namespace skerry::world
