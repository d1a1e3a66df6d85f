#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/bounce_light.h"
#include "world/light/face_records.h"

namespace skerry::world {

/// How much of the sky each drawn face of an island sees, past the island's own voxels, what weak
/// lamps give it, and what other faces reflect to it. A function of the island's voxels alone,
/// whatever the order of calls and the threads.
///
/// A voxel sees the sky along one of 128 lattice vectors when the line to the next voxel along it,
/// to the next but one and so on, touches air only. Such a line's voxels hang together by their
/// faces: what is sealed off by blocks that meet at faces, edges or corners sees no sky at all.
/// Leaves stop a ray in half of their voxels. A face's corner has the mean of the voxels about it
/// that are in front of the face and connected to each other by their faces.
class SkyTransfer {
 public:
  /// @param albedo by block id; empty: no light is followed from face to face. Both must outlive
  /// this.
  explicit SkyTransfer(const LightChunks& chunks, std::span<const FaceAlbedo> albedo = {});
  /// Looks along an octant's vectors. Octants may be looked along at once, each by one thread.
  void look(int octant);
  /// Spreads the light of weak lamps. Once, on any thread, beside octants too.
  void spread_lamps();
  /// Follows light from face to face, after all octants have been looked along and lamps spread:
  /// see BounceLight::follow. Nothing without albedo.
  void follow_bounces(int step, int part);
  bool has_bounces() const { return bounces_.has_value(); }
  /// After all of that. Chunks without a face are left out.
  std::map<IVec3, ChunkSky> faces() const;

  /// Of one voxel beside a face, for tests: a bit a pattern. @pre it is beside one.
  std::uint16_t seen(IVec3 voxel, int octant) const { return seen_[wanted_.of(voxel)][octant]; }
  bool asked(IVec3 voxel) const { return wanted_.has(voxel); }

 private:
  using Corners = std::array<BounceLight::Light, 4>;
  struct Around;
  void look_along(int octant, int pattern, const VoxelBits& open, VoxelBits& passed);
  void spread(const WeakLamp& lamp, float within, LampLightMap& into) const;
  Corners bounced(const Around& around, int face) const;
  ChunkSky faces_of(IVec3 chunk, std::span<const shared::Quad> quads) const;
  void append_record(IVec3 front, int face, std::vector<glm::uvec4>& texels) const;

  const LightChunks& chunks_;
  AirVolume air_;
  VoxelIndex wanted_;          // voxels whose view is kept
  std::vector<SeenSky> seen_;  // by their numbers
  LampLightMap lamp_light_;    // of weak lamps
  LampLightMap all_lamps_;     // whose light is followed further
  std::optional<BounceLight> bounces_;
};

}  // namespace skerry::world
