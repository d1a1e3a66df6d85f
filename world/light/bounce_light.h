#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "engine/core/harmonics.h"
#include "world/light/air_volume.h"
#include "world/light/base/marked.h"
#include "world/light/base/seen_sky.h"
#include "world/light/body_rays.h"
#include "world/light/glass_tints.h"
#include "world/light/lamp_light.h"
#include "world/light/lattice_lines.h"
#include "world/light/opening_ray_ways.h"
#include "world/light/voxel_index.h"

namespace skerry::world {

/// Mean diffuse albedo of a block's faces, linear RGB, by face direction.
using FaceAlbedo = std::array<glm::vec3, 6>;

/// Of what a face under level water would send out into the air without it, the share that gets
/// there, if light falls evenly on the water: by Fresnel's, Snell's and Beer's laws for a wide
/// level bed of albedo 0.45, whose light the surface mirrors back in part. shaders/include/surface/
/// under_water.glsl has the same of the way down. @param blocks from the surface to the face.
glm::vec3 left_by_water(float blocks);

/// Directions, unit, in the lattice, from which the light of sun or moon is followed as it is, by
/// slot: one is shown while the other is followed anew. None: the slot is not in use.
using KeyDirections = std::array<std::optional<glm::vec3>, 2>;

/// Light that faces of an island send to each other: of the sky, sun and moon as a function of what
/// they send, of lamps, and of a body in each of some key directions.
///
/// What a face receives of light from direction w at infinity that others have reflected is a
/// smooth function of w: it is kept as harmonics, so that day and night move without any work here.
/// Its colour is that of its mean. A face looks along half of the 64 lattice vectors of its
/// hemisphere, its neighbours along the other half, and for all reflections but the last along a
/// quarter. Where none of its lines sees the sky, in caves and rooms, it looks along rays of
/// OpeningRaySet in their place, 48 and 16: lattice vectors meet the same bright places from all
/// faces of a wall, which shows where there is no other light (decision 0089). A line or ray that
/// does not end at the sky ends at the first voxel that it comes to, and what comes from there is
/// the light of the face that it enters through, from the air that it came by. Harmonics blur the
/// edges of sun and shade, which do not move as smoothly as what is reflected of the sky: from a
/// key direction, each face has what BodyRays say.
///
/// What leaves a face under level water has passed that twice: left_by_water().
///
/// Where lines end and what leaves each face at each step are kept, so that after an edit only that
/// is worked out again which it changes. What leaves a face is rounded between the steps
/// (PackedLight): what an edit changes far away by less than that has no effect at all.
class BounceLight {
 public:
  /// Of a face: irradiance if light of harmonics e (RGB) comes from infinity is
  /// mean * e[0] + mean / luminance(mean) * sum of shape[i] * e[i + 1], and `lamps` beside it.
  struct Light {
    glm::vec3 mean{0.0f};
    std::array<float, kHarmonics - 1> shape{};  ///< in luminance
    glm::vec3 lamps{0.0f};
    /// If a body of irradiance 1 stands in a slot's key direction, and nothing else sends light.
    std::array<glm::vec3, std::tuple_size_v<KeyDirections>> keyed{glm::vec3(0.0f), glm::vec3(0.0f)};

    Light& operator+=(const Light& other) { return add(other, 1.0f); }
    Light& operator*=(float factor);
    Light& add(const Light& other, float weight);
    /// What is left of it after something that takes a share of each colour.
    Light& tint(const glm::vec3& left);
  };
  using Number = std::uint32_t;  ///< of a face

  /// Times that light is reflected before it reaches a face for good.
  static constexpr int kBounces = 3;
  static constexpr int kSteps = kBounces + 1;

  /// @param wanted holds the voxel before each face and that of each plant. All but the chunks must
  /// outlive this. @param albedo by block id. @param bounces 1 to kBounces, fewer for comparison.
  BounceLight(const LightChunks& chunks, const AirVolume& air, const LatticeLines& lines,
              OpeningRayWays& ways, const VoxelIndex& wanted, const GlassTints& tints,
              std::span<const FaceAlbedo> albedo, int bounces = kBounces,
              const KeyDirections& keys = {});

  /// One more than bounces.
  int steps() const { return steps_; }
  static constexpr int kParts = 8;
  /// Follows the light. Steps go from 0 to steps() - 1; the parts of a step may be done at once,
  /// each by one thread. @param lamps direct light.
  void follow(int step, int part, const SeenSky& seen, const LampLightMap& lamps);
  /// Share of the light on the ground below a plant that the plant takes, and sends its own for.
  static constexpr float kUnderPlant = 0.25f;
  /// After all steps: what a face receives that was reflected at least once. @param front the voxel
  /// before the face; of a plant, its own, and the face looks up. @param plant whether that is
  /// asked of a plant rather than the ground below it. None: there is no such face.
  std::optional<Light> received(IVec3 front, int face, bool plant) const;
  /// Directions of the faces before which a voxel is, a bit each. @pre its number is `wanted`'s.
  std::uint32_t faces_before(std::size_t number) const {
    std::uint32_t out = 0;
    for (std::size_t direction = 0; direction < 6; ++direction)
      out |= numbers_[number * 6 + direction] != 0 ? 1u << direction : 0u;
    return out;
  }

  // --- Another key direction, after all that has changed has been followed ---

  /// Whether any slot is in use.
  bool is_keyed() const { return bodies_[0] || bodies_[1]; }
  /// @param to_body in place of what the slot had.
  void set_key(std::size_t slot, const glm::vec3& to_body);
  /// Follows the light of that slot alone, by steps and parts as follow().
  void follow_key(std::size_t slot, int step, int part);

  // --- After an edit: first voxels, then water, faces, lines and light ---

  /// Numbers of voxels have changed, or there are more of them.
  void move_voxels(std::span<const VoxelIndex::Moved> moved);
  /// A number has been handed out, or its voxel has become opaque: no face is before it.
  void forget_voxel(std::size_t number);
  /// Whether an edit may change how deep faces lie under water. @param changed voxels that are of
  /// other blocks now. @param surfaces whether upper or lower faces of water have come or gone.
  bool moves_water(std::span<const IVec3> changed, bool surfaces) const;
  /// Looks for water once more.
  void take_water(const LightChunks& chunks);
  /// A drawn face has come, or its block has changed. @return whether it is new.
  bool set_face(IVec3 front, int direction, std::uint16_t block, bool plant);
  void remove_face(IVec3 front, int direction, bool plant);

  /// What comes along a line or a ray: 1 + number of the face at which it ends.
  using Source = std::uint32_t;
  static constexpr Source kNothing = 0;
  /// @param last as LatticeLines::end_of has it.
  Source source_at(IVec3 last, std::size_t way) const;
  /// Sets it for the faces before which a voxel is.
  void set_line(IVec3 voxel, std::size_t way, Source source);
  /// Looks along all lines and rays of the faces before which a voxel is.
  void look_from(IVec3 voxel, const SeenSky& seen);
  /// Tells the ways where rays begin, once they are to know.
  void add_origins() const;
  /// A ray from a face may end elsewhere or pass other glass, if the face has rays.
  void follow_ray(IVec3 front, int face, std::size_t ray);
  /// The faces before which a voxel is may see the sky along more or fewer lines: rays take their
  /// places, or they those of rays.
  void choose_rays(IVec3 voxel, const SeenSky& seen);
  /// The direct light of the faces before which a voxel is has changed.
  void relight(IVec3 voxel);
  /// Glass leaves another share of what comes along lines of the faces before which a voxel is.
  void retint(IVec3 voxel);
  /// A voxel may stop the light of bodies in key directions now, or no longer.
  void shade_behind(IVec3 voxel);

  struct Changed {
    IVec3 front{};
    int direction = 0;
  };
  /// Works out what has changed since follow(). @return faces that receive other light.
  std::vector<Changed> follow_changes(const SeenSky& seen, const LampLightMap& lamps);
  /// Whether edits have left so much behind that it is time to begin anew.
  bool is_worn() const { return more_count_ > kSpare; }
  /// Memory that is kept for edits.
  std::size_t bytes() const;

 private:
  static constexpr std::size_t kPatterns = shared::kSkyPatternCount;
  static constexpr std::size_t kFirstLines = kPatterns;     // of a face: a quarter of its 64
  static constexpr std::size_t kLastLines = 2 * kPatterns;  // half of them
  static constexpr std::size_t kLines = kFirstLines + kLastLines;
  static constexpr std::size_t kFirstRays = 16, kLastRays = kLines;  // these include those
  struct Face {
    IVec3 front{};
    std::uint16_t block = 0;
    std::uint8_t direction = 0;
    std::uint8_t depth = 0;  // in voxels, of the voxel before it under water; 0: it is in the air
    bool ground = false;     // a block's face
    bool plant = false;      // a plant stands there; on a block's face it shares its light
    bool rays = false;       // it looks along rays in place of lines
  };
  /// Light in 24 bytes: to 1/512 of its brightest channel, shape to 1/254 of its greatest.
  struct PackedLight {
    std::uint32_t mean = 0, lamps = 0;
    std::array<std::uint32_t, std::tuple_size_v<KeyDirections>> keyed{};
    std::array<std::int8_t, kHarmonics - 1> shape{};
    bool operator==(const PackedLight&) const = default;
  };
  static PackedLight packed(const Light& light);
  static Light unpacked(const PackedLight& light);

  Face* face_at(IVec3 front, int direction);
  Number number_of(IVec3 front, int direction) const;
  std::uint32_t first_of(const Face& face, std::uint32_t every) const;
  template <class Fn>
  void for_each_line(const Face& face, std::size_t quarter, std::size_t pattern,
                     const Fn& fn) const;
  Source look(IVec3 from, std::size_t way) const;
  void look_along(Number number, const SeenSky& seen);
  void look_along_ray(Number number, std::size_t ray);
  void look_again(Number number, const SeenSky& seen);
  bool has_rays(const Face& face, const SeenSky& seen) const {
    return seen.lines_of_face(wanted_.of(face.front), face.direction) == 0;
  }
  Source source_of(IVec3 voxel, int entered) const;
  std::span<const Source> sources_of(Number number, int step) const;
  void make_room();
  Light lost_to_glass(std::size_t voxel, const Face& face, const SeenSky& seen) const;
  Light direct_of(const Face& face, const SeenSky& seen, const LampLightMap& lamps) const;
  template <class Fn>
  void for_each_sender(Number number, int step, const Fn& fn) const;
  Light gathered(Number number, int step) const;
  bool exists(Number number) const { return faces_[number].ground || faces_[number].plant; }
  void look_at_bodies(Number number);
  PackedLight light_of(Number number, int step, const SeenSky& seen,
                       const LampLightMap& lamps) const;
  bool comes_from(Number number, int step, const Marked& changed) const;
  void list_readers();
  void add_reader(Source source, Number reader);
  Light reflected(const Face& face, Light light) const;

  /// A voxel of water and how many voxels of it there are up to its surface, its own included.
  struct Water {
    IVec3 voxel{};
    std::uint8_t depth = 0;
  };
  std::vector<Water> find_water(const LightChunks& chunks) const;
  std::uint8_t depth_of(IVec3 voxel) const;
  glm::vec3 left_of(const Face& face) const;

  bool is_last(int step) const { return step == steps_ - 1; }

  int steps_;
  const AirVolume& air_;
  const LatticeLines& lines_;
  OpeningRayWays& ways_;
  const VoxelIndex& wanted_;
  const GlassTints& tints_;
  std::span<const FaceAlbedo> albedo_;
  std::vector<Face> faces_;
  std::vector<Water> water_;  // by voxel
  float voxel_blocks_ = 1.0f;
  std::array<std::optional<BodyRays>, std::tuple_size_v<KeyDirections>> bodies_;  // by slot
  /// By slot and face: direct light, shared exponent; empty: the slot is not in use.
  std::array<std::vector<std::uint32_t>, std::tuple_size_v<KeyDirections>> from_body_;
  std::vector<Number> free_faces_;
  std::vector<Number> numbers_;  // 1 + of faces_, by voxel and direction; 0: none
  // By face: of lines, those of the first reflections, then of the last; or of rays.
  std::vector<std::array<Source, kLines>> sources_;
  std::vector<std::uint64_t> glass_on_rays_;  // a bit each; empty: there is no stained glass
  // Of each face those with a line or a ray to it, and some that had one: from `first_reader_` to
  // that of the next face; then what edits have added. Made when the first edit is followed.
  std::vector<std::uint32_t> first_reader_;
  std::vector<Number> readers_;
  std::unordered_map<Number, std::vector<Number>> more_readers_;
  std::size_t more_count_ = 0;
  std::array<std::vector<PackedLight>, kSteps> leaving_;  // by step; the last one's: received
  static constexpr std::size_t kSpare = 1'000'000;
  Marked relit_, relooked_;  // faces whose direct light, whose lines have changed
};

}  // namespace skerry::world
