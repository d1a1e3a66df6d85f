#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <map>
#include <span>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/face_records.h"
#include "world/light/lamp_light.h"
#include "world/light/sky_rays.h"

namespace skerry::world {

/// How much of the sky each drawn face of an island sees, past the island's own voxels. A function
/// of the island's voxels alone, whatever the order of calls and the threads.
///
/// A voxel sees the sky along one of 128 lattice vectors when the line to the next voxel along it,
/// to the next but one and so on, touches air only. Such a line's voxels hang together by their
/// faces: what is sealed off by blocks that meet at faces, edges or corners sees no sky at all.
/// Leaves stop a ray in half of their voxels. A face's corner has the mean of the voxels about it
/// that are in front of the face and connected to each other by their faces.
class SkyTransfer {
 public:
  explicit SkyTransfer(const LightChunks& chunks);
  /// Looks along an octant's vectors. Octants may be looked along at once, each by one thread.
  void look(int octant);
  /// Spreads the light of weak lamps. Once, on any thread, beside octants too.
  void spread_lamps();
  /// After all octants have been looked along and lamps spread. Chunks without a face are left out.
  std::map<IVec3, ChunkSky> faces() const;

  /// Of one voxel beside a face, for tests: a bit a pattern. @pre it is beside one.
  std::uint16_t seen(IVec3 voxel, int octant) const { return seen_[index_of(voxel)][octant]; }
  bool asked(IVec3 voxel) const { return wanted_.at(voxel); }

 private:
  using Seen = std::array<std::uint16_t, kOctants>;
  void want(IVec3 voxel);
  std::size_t index_of(IVec3 voxel) const;
  void look_along(int octant, int pattern, const VoxelBits& open, VoxelBits& passed);
  ChunkSky faces_of(IVec3 chunk, std::span<const shared::Quad> quads) const;
  void append_record(IVec3 front, int face, std::vector<glm::uvec4>& texels) const;
  void spread(const WeakLamp& lamp);

  const LightChunks& chunks_;
  AirVolume air_;
  VoxelBits wanted_;                  // voxels whose view is kept
  std::vector<std::uint32_t> ranks_;  // before each word of `wanted_`, how many are kept
  std::vector<Seen> seen_;
  std::unordered_map<std::size_t, LampLight> lamp_light_;  // of voxels that a lamp reaches
};

}  // namespace skerry::world
