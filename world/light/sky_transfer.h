#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/face_records.h"
#include "world/light/bounce_light.h"
#include "world/light/glass_tints.h"
#include "world/light/opening_ray_ways.h"
#include "world/light/opening_rays.h"

namespace skerry::world {

/// How much of the sky each drawn face of an island sees, past the island's own voxels, what weak
/// lamps give it, and what other faces reflect to it. A function of the island's voxels and of the
/// key directions (BounceLight) alone, whatever the order of calls and the threads.
///
/// A face sees the sky along one of the 64 lattice vectors of its hemisphere when the line from its
/// middle along it (line_voxels), over and over again, passes air only. Where few of them do, rays
/// say more of it (OpeningRays). A line's voxels hang together by their faces: what is sealed off
/// by blocks that meet at faces, edges or corners sees no sky at all. Leaves stop a ray in half of
/// their voxels. Stained glass stops none, and takes of the light along each what Beer's law says.
/// A face's corner has the mean of the voxels about it that are in front of the face and connected
/// to each other by their faces, each as if it were before a face.
class SkyTransfer {
 public:
  /// @param albedo by block id; empty: no light is followed from face to face. It must outlive
  /// this. @param bounces how often light is followed, see BounceLight. @param spare blocks about
  /// the island in which edit() can follow what is built. @param keys see BounceLight.
  explicit SkyTransfer(LightChunks chunks, std::span<const FaceAlbedo> albedo = {},
                       int bounces = BounceLight::kBounces, int spare = 0,
                       const KeyDirections& keys = {});
  SkyTransfer(const SkyTransfer&) = delete;  // its parts refer to each other
  SkyTransfer& operator=(const SkyTransfer&) = delete;
  /// Looks along an octant's vectors. Octants may be looked along at once, each by one thread.
  void look(int octant);
  /// Spreads the light of weak lamps. Once, on any thread, beside octants too.
  void spread_lamps();
  /// Follows light from face to face, after all octants have been looked along and lamps spread:
  /// see BounceLight::follow. Nothing without albedo.
  void follow_bounces(int step, int part);
  bool has_bounces() const { return bounces_.has_value(); }
  int bounce_steps() const { return bounces_ ? bounces_->steps() : 0; }
  using Skies = std::map<IVec3, std::shared_ptr<const ChunkSky>>;
  /// After all of that. Chunks without a face are left out.
  const Skies& make_faces();
  const Skies& faces() const { return skies_; }
  /// Memory that is kept for edits.
  std::size_t bytes() const;

  /// After make_faces() or edit(): the light of a body is to be followed from another direction.
  /// Then follow_key() as follow_bounces(), then take_key(). @pre has_bounces()
  void set_key(std::size_t slot, const glm::vec3& to_body);
  void follow_key(std::size_t slot, int step, int part);
  const Skies& take_key(std::size_t slot);

  /// After make_faces(): brings all of it up to date with chunks of which some have been edited.
  /// What comes out is what a new one would find of them, bit for bit; what it costs depends on
  /// what the edit changes. Chunks that are the same object have not changed. Others may have come
  /// or gone.
  /// @return false: this would be no less work than to begin anew; nothing can be asked any more.
  bool edit(LightChunks chunks);

  /// Of one voxel beside a face, for tests: a bit a pattern. @pre it is beside one.
  std::uint16_t seen(IVec3 voxel, std::size_t fan) const {
    return seen_.of(wanted_.of(voxel), fan);
  }
  bool asked(IVec3 voxel) const { return wanted_.has(voxel); }

 private:
  using Corners = std::array<BounceLight::Light, 4>;
  /// A lamp that spreads its light. @see spread
  struct Lamp {
    WeakLamp lamp;        // from the lattice's origin
    float within = 0.0f;  // voxels: beyond it gives nothing
    bool weak = false;
    bool reaches(IVec3 voxel) const {
      const glm::vec3 off =
          glm::vec3(static_cast<float>(voxel.x) + 0.5f, static_cast<float>(voxel.y) + 0.5f,
                    static_cast<float>(voxel.z) + 0.5f) -
          lamp.place;
      return off.x * off.x + off.y * off.y + off.z * off.z < within * within;
    }
  };
  struct Around;
  struct View;
  class Edit;
  Around around(IVec3 front, const FaceAxes& axes) const;
  void look_along(std::size_t fan, int pattern, const VoxelBits& open, VoxelBits& passed);
  struct PassedRow;
  template <bool forward>
  void look_from_row(std::size_t fan, int pattern, int x, int y, std::span<const PassedRow> rows,
                     const VoxelBits& open, VoxelBits& passed);
  static std::vector<Lamp> lamps_of(const LightChunk& chunk, IVec3 at);
  /// Calls fn(voxel) for each whose view is kept and that a lamp can light.
  /// @param from, to of those alone that are in this box.
  template <class Fn>
  void for_each_reached(const Lamp& lamp, const Fn& fn, glm::vec3 from = glm::vec3(-1e9f),
                        glm::vec3 to = glm::vec3(1e9f)) const {
    const VoxelBits& wanted = wanted_.chosen();
    const glm::ivec3 origin = vector_of(wanted.low()), size = vector_of(wanted.size());
    const glm::vec3 least = glm::max(lamp.lamp.place - lamp.within, from),
                    most = glm::min(lamp.lamp.place + lamp.within, to);
    const glm::ivec3 low = glm::max(glm::ivec3(glm::floor(least)) - origin, glm::ivec3(0)),
                     high = glm::min(glm::ivec3(glm::floor(most)) - origin, size - 1);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        for (int word = low.z / 64; word <= high.z / 64 && low.z <= high.z; ++word) {
          std::uint64_t left = wanted.row(x, y)[word];
          if (word == low.z / 64) left &= ~std::uint64_t{0} << low.z % 64;
          if (word == high.z / 64) left &= ~std::uint64_t{0} >> (63 - high.z % 64);
          for (; left != 0; left &= left - 1) {
            const IVec3 voxel{origin.x + x, origin.y + y,
                              origin.z + word * 64 + std::countr_zero(left)};
            if (lamp.reaches(voxel)) fn(voxel);
          }
        }
  }
  void spread(const Lamp& lamp, LampLightMap& into) const;
  Corners bounced(const Around& around, int face, bool plant) const;
  View view_of(IVec3 voxel, int face);
  glm::uvec4 tint_corners(const Around& around, int face, std::span<View> views) const;
  RecordParts record_parts() const { return {bounces_ && bounces_->is_keyed(), tints_.any()}; }
  ChunkSky faces_of(IVec3 chunk, std::span<const shared::Quad> quads);
  /// Its texels: those of record_parts().
  void append_record(IVec3 front, int face, bool plant, std::vector<glm::uvec4>& texels);

  LightChunks chunks_;
  AirVolume air_;
  LatticeLines lines_;
  VoxelIndex wanted_;  // voxels whose view is kept
  SeenSky seen_;
  GlassTints tints_;
  OpeningRayWays ways_;
  OpeningRays openings_;
  LampLightMap lamp_light_;  // of weak lamps
  LampLightMap all_lamps_;   // whose light is followed further
  std::optional<BounceLight> bounces_;
  Skies skies_;
  std::size_t most_numbers_ = 0;  // of voxels, that edits may make
};

}  // namespace skerry::world
