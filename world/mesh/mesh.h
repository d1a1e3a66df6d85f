#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/blocks.h"

namespace skerry::world {

/// A meshed chunk: quads in range order (shaders/shared/geometry.h), and where each range ends.
struct ChunkMesh {
  std::vector<shared::Quad> quads;
  std::array<std::uint32_t, shared::kRangeCount> range_end{};
  std::array<std::uint8_t, 3> bounds_min{};  ///< tight box of the faces in voxels, 0..64
  std::array<std::uint8_t, 3>
      bounds_max{};  ///< its upper corner; a lone flat face gives a flat box
};

/// Working memory of mesh_chunk; one a thread, reused between calls.
class MeshScratch {
 public:
  MeshScratch();
  ~MeshScratch();
  MeshScratch(const MeshScratch&) = delete;
  MeshScratch& operator=(const MeshScratch&) = delete;
  struct Buffers;
  Buffers& buffers() { return *buffers_; }

 private:
  std::unique_ptr<Buffers> buffers_;
};

inline constexpr int kPaddedEdge = 66;
inline constexpr std::size_t kPaddedVoxels = std::size_t{kPaddedEdge} * kPaddedEdge * kPaddedEdge;

/// Turns one padded chunk into merged quads.
/// @param voxels kPaddedVoxels block ids, index z + 66 x + 66^2 y; the shell comes from the
///   neighbours.
/// @param out replaced. Pass the same object again to spare its memory's first touch.
/// A face is drawn where a block meets one that does not hide it: opaque hides every kind's face;
/// cut-out and translucent blocks hide faces of their own id only; plants hide nothing and give one
/// quad for each diagonal. Faces of one id merge into rectangles: runs along one axis, then equal
/// runs of neighbouring rows.
/// Within a range quads are ordered by where they end: y, then x, then z. Every CPU gives the same
/// quads in the same order. Ids of 256 and more take a path that is some ten times slower.
void mesh_chunk(std::span<const BlockId> voxels, MeshScratch& scratch, ChunkMesh& out);

/// Same, for chunks with at most 256 different ids: `voxels` index `palette`. Reads half the
/// memory, and takes no time when the palette tells that nothing can be seen (all of it opaque, or
/// one id that is no plant).
/// @param palette distinct ids; @pre every index is below its size.
void mesh_chunk(std::span<const std::uint8_t> voxels, std::span<const BlockId> palette,
                MeshScratch& scratch, ChunkMesh& out);

}  // namespace skerry::world
