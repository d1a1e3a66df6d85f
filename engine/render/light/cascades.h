#pragma once
#include <volk.h>
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "engine/render/frame/fixed_pos.h"

namespace skerry::render {

inline constexpr int kCascadeCount = 4;  ///< a light has at most

/// What a set of cascades depends on.
struct CascadeInput {
  glm::dvec3 to_light{0.0, 1.0, 0.0};  ///< towards the light, any length but zero
  FixedPos camera{};
  FixedPos
      anchor{};  ///< moves with the world (its offset): cascades depend on camera - anchor alone
  FixedPos pivot{};  ///< from the anchor: the place about which the grids of texels turn
  double near_blocks =
      1.0;  ///< where the practical split begins; cascade 0 covers from 0 nevertheless
  double far_blocks = 1000.0;           ///< radius of the last cascade: the view distance
  double caster_reach_blocks = 2512.0;  ///< how far towards the light beyond a cascade's sphere
                                        ///< something may stand and still cast
  /// How far the widest shadow filter reaches from the shaded point; some texels are spared beyond.
  double filter_blocks = 0.25;
  int map_size = 2048;  ///< texels along an edge, 64..16384
  double split = 0.98;  ///< see cascade_radii
  int count =
      kCascadeCount;  ///< of cascades, 1..kCascadeCount; few cover the same with coarser maps
};

/// What a shadow map shows. Two equal keys of one light give the same map, so a map may be kept
/// while its key and the scene stay.
struct CascadeKey {
  std::array<std::int64_t, 3> cell{};  ///< snapped light-space centre, in snap steps from the pivot
  FixedPos pivot{};                    ///< CascadeInput::pivot
  std::array<std::int64_t, 9> light_axes{};  ///< right, up, towards the light; units of 2^-52
  std::int64_t texel_units = 0;              ///< edge of a texel, 1/65536 block
  std::int64_t depth_units = 0;              ///< length of the depth range, 1/65536 block
  std::int64_t back_units = 0;               ///< of it behind the centre, away from the light
  int map_size = 0;
  bool operator==(const CascadeKey&) const = default;
};

/// One orthographic shadow map. It covers every point within `radius` of the camera, whatever the
/// camera looks at.
struct Cascade {
  glm::mat4 clip_from_world;  ///< camera-relative world [blocks] to clip: x right, y down, depth 1
                              ///< towards the light and 0 at the far side
  /// The same map from positions relative to `centre`. A function of the key alone, so maps drawn
  /// with it are equal to the last bit wherever the camera stands in the snap cell.
  glm::mat4 clip_from_centre;
  FixedPos centre{};          ///< absolute place near the middle of the covered sphere, units
  float radius = 0.0f;        ///< blocks from the camera up to which this cascade is complete
  float texel_blocks = 0.0f;  ///< edge of a texel
  float depth_blocks = 0.0f;  ///< blocks between depth 1 and depth 0
  /// Camera-relative planes, dot(xyz, p) + w >= 0 inside, xyz unit: left, right, bottom, top, far
  /// side, towards the light. What lies wholly outside one of them cannot show in the map.
  std::array<glm::vec4, 6> planes{};
  CascadeKey key;
};

/// The planes of a part of the map, in the order of Cascade::planes, a texel outside of it: what
/// can show in the part is inside. @param part texels, within the map.
std::array<glm::vec4, 6> planes_about(const Cascade& cascade, const VkRect2D& part);

/// Radii of the cascades [blocks]: the practical split (Zhang 2006) between near and far; the last
/// is far exactly. @param split lambda: 0 evenly spaced .. 1 each a constant multiple of the last.
std::vector<double> cascade_radii(double near_blocks, double far_blocks, int count, double split);

/// Right, up and backward (towards the light) axes of a light's view, orthonormal and right-handed.
/// Right is celestial pole x light: continuous wherever a sun or moon can stand, and everywhere
/// else but at the two poles of the sky, where a fixed axis takes over.
std::array<glm::dvec3, 3> light_axes(glm::dvec3 to_light);

/// Cascades as spheres about the camera. Each map's centre is snapped to a grid of 1/16 of its
/// width (whole texels) that is fixed in the world and turned to the light about the pivot: moving
/// the camera moves the window by whole texels or not at all, and turning the light moves texels
/// across what is near the pivot by little. Snapping is exact in 128-bit integers at any distance.
/// Asserts finite input, 0 < near < far, map_size and count in range.
std::vector<Cascade> make_cascades(const CascadeInput& input);

/// One of those. Asserts 0 <= index < input.count too.
Cascade make_cascade(const CascadeInput& input, int index);

/// The cascade whose map was made by a key of the same light, as seen from where the camera is now.
/// Its radius is what the map still covers about the camera, below 0 if the camera has left it.
Cascade cascade_of(const CascadeKey& key, const CascadeInput& input);

}  // namespace skerry::render
