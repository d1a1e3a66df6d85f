// A renderer and a scene of few blocks, for cases that no seed holds.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/renderer/renderer.h"
#include "shaders/shared/geometry.h"
#include "world/mesh/mesh.h"
#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"

namespace skerry::tools::stability {

/// The block at a voxel of an island's lattice [voxels of the level].
using BlockAt = std::function<world::BlockId(int x, int y, int z)>;

/// A chunk's blocks with the shell about it, as world::mesh_chunk takes them.
std::vector<world::BlockId> padded_chunk(const BlockAt& block_at, world::IVec3 chunk);

/// A chunk meshed as the game does it, and its record without island and quads' place.
struct MeshedChunk {
  shared::Section section{};
  std::vector<shared::Quad> quads;  ///< may be none
};
MeshedChunk mesh_chunk_of(const BlockAt& block_at, world::IVec3 chunk,
                          std::uint32_t voxel_size_log2 = 0);

/// What a drawn frame gave.
struct Frame {
  VkExtent2D size{};
  std::vector<std::uint8_t> rgba;    ///< the picture, rows from the top
  std::vector<glm::vec3> radiance;   ///< with FrameInput::capture, as are those below
  std::vector<float> depth;          ///< empty without geometry
  std::vector<std::uint32_t> words;  ///< of the G-buffer
  std::vector<float> shadow_maps;    ///< layer by layer
  render::FrameReport report;
};

class Stage {
 public:
  /// @param materials empty: game::material_table().
  static Result<std::unique_ptr<Stage>> create(gpu::Device& device,
                                               std::span<const shared::Material> materials = {});

  /// Adds all chunks of a box of chunks, [low, high), that have a face.
  Result<void> add(const BlockAt& block_at, world::IVec3 low, world::IVec3 high,
                   std::uint32_t island = 0, std::uint32_t voxel_size_log2 = 0);
  /// Lets a box of chunks, [low, high), block lights.
  Result<void> add_walls(const BlockAt& block_at, world::IVec3 low, world::IVec3 high,
                         std::uint32_t island = 0);
  /// Draws, waits and copies out.
  Result<Frame> draw(const render::FrameInput& input, const render::RenderSettings& settings,
                     VkExtent2D size);
  render::Renderer& renderer() { return *renderer_; }

 private:
  explicit Stage(gpu::Device& device) : device_(device) {}
  gpu::Device& device_;
  std::unique_ptr<render::Renderer> renderer_;
};

render::FixedPos fixed_at(const glm::dvec3& blocks);
/// A place moved by whole and broken blocks.
render::FixedPos moved(const render::FixedPos& place, const glm::dvec3& blocks);
render::Camera camera_at(const glm::dvec3& blocks, double yaw_deg, double pitch_deg,
                         double fov_deg = 70.0);
/// Ray through a pixel's centre, one block long along the view axis, in double precision.
/// Written from docs/conventions.md, not from what the renderer does.
glm::dvec3 ray_of(const render::Camera& camera, VkExtent2D size, std::uint32_t x, std::uint32_t y);

/// Noon's light from any direction, without a moon.
render::Celestial sun_towards(const glm::dvec3& to_sun);
/// No light at all.
render::Celestial darkness();
/// A full moon in the zenith of a night, as bright as wanted: light from straight above, that
/// leaves walls black.
render::Celestial moon_above(float irradiance);

/// The settings without the light that air and sky send, which sunlit surfaces are mistaken for.
render::RenderSettings without_sky_light(render::RenderSettings settings);

/// What the sun does to surfaces of a frame, found by drawing it three times without_sky_light().
struct Sunlight {
  double lit = 0.0;       ///< pixels of surfaces that are darker under a sun without light
  double shadowed = 0.0;  ///< of surfaces that are brighter without shadows
};
/// @param input with `capture`. Errors: as Stage::draw.
Result<Sunlight> sunlight_of(Stage& stage, const render::FrameInput& input,
                             const render::RenderSettings& settings, VkExtent2D size);
/// Pixels of surfaces that give any light to the eye.
double lit_surfaces(const Frame& frame);

/// Channels that are not finite.
double non_finite_channels(std::span<const glm::vec3> pixels);
/// Pixels of two pictures of one size that are not byte-identical; NaN when the sizes differ.
double different_pixels(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

}  // namespace skerry::tools::stability
