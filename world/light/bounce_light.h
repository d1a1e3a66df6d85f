#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/core/harmonics.h"
#include "world/light/air_volume.h"
#include "world/light/lamp_light.h"
#include "world/light/sky_rays.h"
#include "world/light/voxel_index.h"

namespace skerry::world {

/// Mean diffuse albedo of a block's faces, linear RGB, by face direction.
using FaceAlbedo = std::array<glm::vec3, 6>;

/// Rec. 709.
inline float luminance(const glm::vec3& c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

/// Ways to the sky that a voxel sees: for each octant a bit a pattern.
using SeenSky = std::array<std::uint16_t, kOctants>;
/// Weak and strong lamps' direct light, by number of the voxel; a voxel without has no entry.
using LampLightMap = std::unordered_map<std::size_t, LampLight>;

/// Light that faces of an island send to each other: of the sky, sun and moon as a function of what
/// they send, and of lamps.
///
/// What a face receives of light from direction w at infinity that others have reflected is a
/// smooth function of w: it is kept as harmonics, so that day and night move without any work here.
/// Its colour is that of its mean. A face looks along half of the 64 lattice vectors of its
/// hemisphere, its neighbours along the other half, and for all reflections but the last along a
/// quarter. A line that does not end at the sky ends at the first voxel that it touches, and what
/// comes from there is the light of the face that it enters through, from the air that it came by.
class BounceLight {
 public:
  /// Of a face: irradiance if light of harmonics e (RGB) comes from infinity is
  /// mean * e[0] + mean / luminance(mean) * sum of shape[i] * e[i + 1], and `lamps` beside it.
  struct Light {
    glm::vec3 mean{0.0f};
    std::array<float, kHarmonics - 1> shape{};  ///< in luminance
    glm::vec3 lamps{0.0f};

    Light& operator+=(const Light& other) { return add(other, 1.0f); }
    Light& operator*=(float factor);
    Light& add(const Light& other, float weight);
  };

  /// @param wanted holds the voxel before each face and that of each plant. Both must outlive this.
  /// @param albedo by block id.
  BounceLight(const LightChunks& chunks, const AirVolume& air, const VoxelIndex& wanted,
              std::span<const FaceAlbedo> albedo);

  /// Times that light is reflected before it reaches a face for good.
  static constexpr int kBounces = 3;
  static constexpr int kSteps = kBounces + 1;
  static constexpr int kParts = 8;
  /// Follows the light. Steps go from 0 to kSteps - 1; the parts of a step may be done at once,
  /// each by one thread. @param seen by number of the voxel. @param lamps direct light.
  void follow(int step, int part, std::span<const SeenSky> seen, const LampLightMap& lamps);
  /// After all steps: what a face receives that was reflected at least once. @param front the voxel
  /// before the face; of a plant, its own, and the face looks up. None: there is no such face.
  const Light* received(IVec3 front, int face) const;

 private:
  struct Face {
    IVec3 front{};
    std::uint16_t block = 0;
    std::uint8_t direction = 0;
  };
  /// A voxel that a line touches after others.
  struct Touched {
    IVec3 offset{};
    std::ptrdiff_t step = 0;  // between the numbers of their bits in `solid_`
    int group = 0;            // those of a group are touched at once
    std::array<std::int8_t, 3> entered{-1, -1, -1};  // faces that the line can come in by
  };
  struct Way {
    IVec3 vector{};
    std::vector<Touched> touched;  // in the order of the line
  };
  Way way_along(IVec3 vector) const;
  void add_face(Face face);
  std::uint32_t number_of(IVec3 front, int face) const;
  bool open(IVec3 voxel, int leaf_set) const;
  bool stopped(IVec3 from, const Way& way, int leaf_set) const;
  Light direct_of(const Face& face, std::span<const SeenSky> seen, const LampLightMap& lamps) const;
  Light gathered_by(const Face& face, const SeenSky& seen, std::span<const Light> leaving,
                    std::uint32_t every) const;
  void add_from(IVec3 from, std::size_t way, float weight, std::span<const Light> leaving,
                Light& sum) const;
  void add_entered(IVec3 voxel, const Touched& touched, float weight,
                   std::span<const Light> leaving, Light& sum) const;
  Light reflected(const Face& face, Light light) const;

  const AirVolume& air_;
  const VoxelIndex& wanted_;
  std::span<const FaceAlbedo> albedo_;
  VoxelBits solid_;        // opaque voxels and leaves
  std::vector<Way> ways_;  // octant * kSkyPatternCount + pattern
  std::vector<Face> faces_;
  std::vector<std::uint32_t> numbers_;           // 1 + of faces_, by voxel and direction; 0: none
  std::array<std::vector<Light>, 2> leaving_{};  // by parity of the step; the last one's: received
};

}  // namespace skerry::world
