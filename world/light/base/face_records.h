#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"
#include "shaders/shared/indirect.h"
#include "world/voxel/coords.h"

namespace skerry::world {

/// What a record has behind its first kIndirectRecordTexels: a texel each, in this order.
struct RecordParts {
  bool keyed = false;   ///< light from key directions
  bool tinted = false;  ///< tints, where the sky of any face is tinted by glass
  std::uint32_t texels() const {
    return shared::kIndirectRecordTexels + (keyed ? 1u : 0u) + (tinted ? 1u : 0u);
  }
  std::uint32_t before_tint() const { return shared::kIndirectRecordTexels + (keyed ? 1u : 0u); }
  bool operator==(const RecordParts&) const = default;
};

/// Light on the faces of a chunk: how much of the sky they see, and of weak lamps. In the GPU's own
/// words (shaders/shared/indirect.h).
struct ChunkSky {
  std::vector<std::uint32_t> table;  ///< a word a brick: 0, or 1 + which of the stored bricks it is
  /// The stored bricks' masks, then records. Records are counted from 0 in texels of this list.
  std::vector<glm::uvec4> texels;
  RecordParts parts{};  ///< of all its records
  std::uint32_t record_texels() const { return parts.texels(); }
  bool operator==(const ChunkSky&) const = default;
};

/// A face that is drawn. A plant counts as one that looks up from its own voxel.
struct DrawnFace {
  IVec3 voxel{};  ///< chunk-local
  int direction = 0;
  bool plant = false;
};

/// A face direction's own axis and the two after it.
struct FaceAxes {
  explicit FaceAxes(int face)
      : own(face / 2), b((own + 1) % 3), c((own + 2) % 3), sign(face % 2 == 0 ? 1 : -1) {}
  int own, b, c, sign;
};
inline IVec3 axis_vector(int axis, int length) {
  return {axis == 0 ? length : 0, axis == 1 ? length : 0, axis == 2 ? length : 0};
}
inline IVec3 operator+(IVec3 a, IVec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// To the voxel from which a face is lit: the one before it, of a plant its own.
inline IVec3 to_front(const DrawnFace& face) {
  const FaceAxes axes(face.direction);
  return face.plant ? IVec3{} : axis_vector(axes.own, axes.sign);
}

inline bool is_of_plant(const shared::Quad& quad) {
  return shared::surface_face(quad.material) == 6;
}

/// Calls fn(DrawnFace) for each voxel face of a quad; once for a plant's two quads.
template <class Fn>
void for_each_face(const shared::Quad& quad, const Fn& fn) {
  const auto bits = [](std::uint32_t word, int shift) {
    return static_cast<int>(word >> shift & 63u);
  };
  const IVec3 low{bits(quad.geometry, 0), bits(quad.geometry, 6), bits(quad.geometry, 12)};
  const int u = bits(quad.geometry, 18), v = bits(quad.geometry, 24);
  const int face = static_cast<int>(shared::surface_face(quad.material));
  if (face == 7) return;
  if (face == 6) return fn(DrawnFace{low, 2, true});
  // docs/conventions.md: u, v are z, y of x faces; x, z of y faces; x, y of z faces.
  const int along_u = face < 2 ? 2 : 0, along_v = face / 2 == 1 ? 2 : 1;
  for (int j = 0; j <= v; ++j)
    for (int i = 0; i <= u; ++i)
      fn(DrawnFace{low + axis_vector(along_u, i) + axis_vector(along_v, j), face, false});
}

/// A record's last texel if its face sees no sky through glass: white at all corners.
glm::uvec4 white_tint();
/// With a tint for each record if there is one that is not white, else with none.
/// @param all with a tint for each, white or not.
ChunkSky with_tints(const ChunkSky& before, bool all = false);

/// Makes the records of a chunk's faces, in an order that does not depend on that of its quads.
/// @param append adds a face's record to the list. @param parts that it adds.
using AppendRecord = std::function<void(const DrawnFace&, std::vector<glm::uvec4>&)>;
ChunkSky pack_faces(std::span<const shared::Quad> quads, const AppendRecord& append,
                    const RecordParts& parts = {});
/// Alike, but faces that have a record before keep it. @param append of the others, as many texels
/// as those have.
ChunkSky repack_faces(const ChunkSky& before, std::span<const shared::Quad> quads,
                      const AppendRecord& append);

/// Calls fn(voxel, direction, where its record begins in ChunkSky::texels) for each face, by brick.
void for_each_record(const ChunkSky& chunk, const std::function<void(IVec3, int, std::size_t)>& fn);

/// Where a face's record begins in ChunkSky::texels. None: the chunk has no such face.
std::optional<std::size_t> find_record(const ChunkSky& chunk, IVec3 voxel, int direction);

/// A guess for a chunk that has just been edited: faces that were there keep their record, new ones
/// take that of the nearest face, of their own direction if there is one, within two voxels; else
/// they are dark.
ChunkSky inherit_faces(const ChunkSky& before, std::span<const shared::Quad> quads);

/// A chunk's records and, where it has none yet, guesses for more of its faces, as inherit_faces()
/// makes them. @param quads of no plants.
ChunkSky with_faces(const ChunkSky& before, std::span<const shared::Quad> quads);

/// Of some faces those next to which `before` knows light: on the same voxel, or on one that
/// shares an edge with it. As quads of one voxel.
std::vector<shared::Quad> lit_faces(const ChunkSky& before, std::span<const shared::Quad> quads);

}  // namespace skerry::world
