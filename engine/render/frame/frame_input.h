#pragma once
#include <volk.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/frame/camera.h"
#include "engine/render/frame/celestial.h"
#include "shaders/shared/light.h"

namespace skerry::render {

/// The land of an island as what it hides from others: an ellipsoid in its lattice [blocks].
struct IslandLand {
  glm::vec3 centre{0.0f}, half{0.0f};  ///< half its extent; 0: it hides nothing
};

/// A direction from which reflected light of sun and moon has been followed on an island.
struct KeyedBody {
  glm::vec3 direction{0.0f};  ///< unit, in the lattice
  float weight = 0.0f;        ///< of that light, 0..1; 0: there is none
};

/// Where an island is this frame. Its index in FrameInput::islands is what Section::island holds.
struct IslandPlacement {
  FixedPos origin{};                        ///< of its lattice
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< world from lattice
  double bounding_radius = 0.0;             ///< blocks about the origin
  bool far = false;  ///< so small in the picture that its heading may be rounded for its sky
  int level = 0;     ///< of detail: edges of its voxels are 2^level blocks
  IslandLand land{};
  std::array<KeyedBody, 2> keyed{};  ///< by slot of its records; the weights sum to at most 1
};

/// The block that a player points at: an outline over the picture, and cracks as it is dug.
struct BlockMarker {
  std::uint32_t island = 0;       ///< index of FrameInput::islands
  glm::dvec3 min{0.0}, max{1.0};  ///< box in its lattice [blocks]
  float dug = 0.0f;               ///< 0 .. 1
};

/// What a frame can be asked to copy out for measuring, besides the picture.
enum class Capture : std::uint8_t {
  kRadiance,  ///< RGBA16F, before exposure
  kDepth,     ///< D32, reverse-Z; absent from a frame without geometry, or with another depth
  kSurfaces,  ///< R32_UINT, the G-buffer's words, 0 for the sky; absent likewise
  /// D32 layers, all cascades of the sun, then of the moon; after them layers of a body that has
  /// set. Frames that may lag leave another order behind. Absent when nothing casts.
  kShadowMaps
};

/// An image copied out of a frame: texels of its own format, rows from the top, layer by layer.
struct Captured {
  VkExtent2D size{};
  std::uint32_t layers = 0;  ///< 0: the frame had no such image
  std::vector<std::byte> texels;
};

/// A texel broken on purpose, to see that no pass hands on what is not finite.
struct Fault {
  enum class In : std::uint8_t {
    kSkyTable,       ///< before anything samples it
    kShaded,         ///< scene radiance, before water is looked through
    kLookedThrough,  ///< scene radiance, before it is developed
  };
  In in = In::kShaded;
  glm::uvec2 texel{};
  float value = 0.0f;  ///< of all four channels
};

/// The face above the camera through which light enters the medium that the camera is in.
struct MediumSurface {
  std::uint32_t island = 0;  ///< index into FrameInput::islands
  glm::ivec3 block{};        ///< in the lattice of the island; its upper face is meant
  float share = 1.0f;        ///< of the light that enters there, which reaches the camera, 0..1
};

/// Everything that decides one picture besides the resident geometry. Plain values, const once
/// built.
struct FrameInput {
  Camera camera;
  FixedPos anchor{};  ///< moves with the world's offset; pictures depend on differences to it alone
  std::span<const IslandPlacement> islands;  ///< at most shared::kMaxIslands
  double reach_blocks = 1000.0;  ///< all islands in view end within; shadow maps reach as far
  Celestial sky{};
  std::span<const shared::Light> lights;  ///< finite, in an order that does not depend on threads
  std::span<const std::uint32_t> light_islands;       ///< indices of `islands`, see shared::Light
  std::span<const shared::LightReach> light_reaches;  ///< see shared::Light
  std::span<const shared::LightPane> light_panes;     ///< see shared::Light
  /// Which of how many frames that average into one picture, drawn one after another; in each, sun
  /// and moon light from another place of their discs. The last one develops the picture.
  std::uint32_t part = 0, parts = 1;
  /// Picture = tone curve(radiance * 2^-EV). None: as the meter finds this very frame.
  std::optional<float> exposure_ev = 0.0f;
  bool meter = false;               ///< meter the frame even though its exposure is given
  double time_s = 0.0;              ///< seconds of play: water ripples
  std::uint32_t camera_medium = 0;  ///< block id the camera is in, if translucent; else 0
  std::optional<MediumSurface> medium_surface;  ///< none: no light of the sky enters from above
  bool freeze_culling =
      false;  ///< keep culling with the camera of the frame in which this became true
  /// While programs for these settings are being made in the background, the frame may be drawn by
  /// the settings of an earlier one: see Renderer::foresee_programs. Coarse shadow maps may show
  /// what was a few frames ago: see plan_shadows().
  bool may_lag = false;
  bool count_pixels = true;  ///< FrameReport::pixels are wanted
  bool capture = false;  ///< copy out what Capture names; the picture is made by way of radiance
  std::optional<BlockMarker> marker;  ///< not drawn over debug views
  std::optional<Fault> fault;         ///< implies the way by radiance, too
};

}  // namespace skerry::render
