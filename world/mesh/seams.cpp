#include "world/mesh/seams.h"

#include "engine/core/check.h"
#include "world/mesh/chunk_mesh.h"
#include "world/mesh/face_axes.h"
#include "world/mesh/face_slice.h"

namespace skerry::world {

SeamFaces seam_faces(std::span<const BlockId> voxels) {
  SKERRY_ASSERT(voxels.size() == kPaddedVoxels);
  constexpr std::array<int, 3> kSteps{kPaddedEdge, kPaddedEdge * kPaddedEdge, 1};  // x, y, z
  constexpr int kFirst = kPaddedEdge * kPaddedEdge + kPaddedEdge + 1;
  const auto is_opaque = [&](int at) {
    return block_kind(voxels[static_cast<std::size_t>(at)]) == BlockKind::kOpaque;
  };
  SeamFaces out;
  FaceSlice slice;
  for (std::uint32_t face = 0; face < shared::kFaceCount; ++face) {
    const auto [axis, u, v] = axes_of_face(face);
    const bool plus = face % 2 == 0;
    const int plane = plus ? FaceSlice::kEdge - 1 : 0;
    const int beyond = plus ? kSteps[axis] : -kSteps[axis];
    for (int j = 0; j < FaceSlice::kEdge; ++j) {
      for (int i = 0; i < FaceSlice::kEdge; ++i) {
        const int at = kFirst + plane * kSteps[axis] + i * kSteps[u] + j * kSteps[v];
        if (is_opaque(at) && is_opaque(at + beyond))
          slice.set(i, j, voxels[static_cast<std::size_t>(at)]);
      }
    }
    slice.merge(face, plane, FaceSlice::kEdge, FaceSlice::kEdge, out[face]);
  }
  return out;
}

}  // namespace skerry::world
