#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "world/mesh/mesh.h"

namespace skerry::world {

/// Glowing blocks of one id that shine as one light. What glows is what is drawn: the light of a
/// chunk mesh is the light of its emissive faces, at every level of detail.
struct Emitter {
  glm::vec3 place{};  ///< of the light, in voxels from the chunk's lowest corner
  BlockId block = kAir;
  /// Faces drawn [voxel faces]. A plant has none but its two crossed quads and counts as one.
  std::uint16_t faces = 0;
  /// All of its faces look the same way: what is behind them takes half the sphere.
  bool one_way = false;
  bool operator==(const Emitter&) const = default;
};

/// Blocks of one id within a cell of so many voxels along an edge, aligned to the chunk, shine as
/// one light: they touch, at a corner at least. Plants shine each for itself.
inline constexpr int kEmitterCell = 2;

/// The lights of a chunk mesh: cells ascend in y, then x, then z, ids within a cell ascend. A light
/// stands inside a block that shines, nine tenths of the way from its middle to the middle of its
/// faces: under a face, so that no block lights its own. Of several blocks, inside the one nearest
/// to the middle of the faces of all; when several are, a hash of the cell chooses, so that lights
/// do not all lean to one side. @param out replaced.
void find_emitters(const ChunkMesh& mesh, std::vector<Emitter>& out);

}  // namespace skerry::world
