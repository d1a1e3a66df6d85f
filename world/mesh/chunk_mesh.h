// What the mesher gives, and the memory it works in.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "shaders/shared/geometry.h"

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

}  // namespace skerry::world
