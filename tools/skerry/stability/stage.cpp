#include "tools/skerry/stability/stage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "engine/gpu/transfer/readback.h"
#include "game/view/materials.h"
#include "world/mesh/occupancy.h"

namespace skerry::tools::stability {
namespace {

template <class T>
std::vector<T> texels_of(const render::Captured& image) {
  std::vector<T> out(image.texels.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), image.texels.data(), out.size() * sizeof(T));
  return out;
}

}  // namespace

std::vector<world::BlockId> padded_chunk(const BlockAt& block_at, world::IVec3 chunk) {
  constexpr int kChunk = static_cast<int>(shared::kChunkEdge);
  std::vector<world::BlockId> voxels(world::kPaddedVoxels);
  std::size_t index = 0;
  for (int y = -1; y <= kChunk; ++y)
    for (int x = -1; x <= kChunk; ++x)
      for (int z = -1; z <= kChunk; ++z)
        voxels[index++] =
            block_at(chunk.x * kChunk + x, chunk.y * kChunk + y, chunk.z * kChunk + z);
  return voxels;
}

MeshedChunk mesh_chunk_of(const BlockAt& block_at, world::IVec3 chunk,
                          std::uint32_t voxel_size_log2) {
  constexpr int kChunk = static_cast<int>(shared::kChunkEdge);
  const std::vector<world::BlockId> voxels = padded_chunk(block_at, chunk);
  world::MeshScratch scratch;
  world::ChunkMesh mesh;
  world::mesh_chunk(voxels, scratch, mesh);
  MeshedChunk out;
  const int edge = kChunk << voxel_size_log2;
  out.section.origin = {chunk.x * edge, chunk.y * edge, chunk.z * edge};
  out.section.voxel_size_log2 = voxel_size_log2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.section.bounds_min |= std::uint32_t{mesh.bounds_min[axis]} << (7 * axis);
    out.section.bounds_max |= std::uint32_t{mesh.bounds_max[axis]} << (7 * axis);
  }
  std::copy(mesh.range_end.begin(), mesh.range_end.end(), out.section.range_end);
  out.quads = std::move(mesh.quads);
  return out;
}

Result<std::unique_ptr<Stage>> Stage::create(gpu::Device& device,
                                             std::span<const shared::Material> materials) {
  std::unique_ptr<Stage> stage(new Stage(device));
  const std::vector<shared::Material> built_in = game::material_table();
  render::RendererDesc desc;
  desc.materials = materials.empty() ? std::span<const shared::Material>(built_in) : materials;
  desc.upload_budget_bytes = UINT64_MAX;
  desc.arena_quads = 1u << 12;
  Result<std::unique_ptr<render::Renderer>> made = render::Renderer::create(device, desc);
  if (!made) return made.error();
  stage->renderer_ = *std::move(made);
  return stage;
}

Result<void> Stage::add(const BlockAt& block_at, world::IVec3 low, world::IVec3 high,
                        std::uint32_t island, std::uint32_t voxel_size_log2) {
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z) {
        MeshedChunk chunk = mesh_chunk_of(block_at, {x, y, z}, voxel_size_log2);
        if (chunk.quads.empty()) continue;
        chunk.section.island = island;
        const Result<render::SectionId> added =
            renderer_->geometry().add(renderer_->mesh_uploader(), chunk.section, chunk.quads);
        if (!added) return added.error();
      }
  return {};
}

Result<void> Stage::add_walls(const BlockAt& block_at, world::IVec3 low, world::IVec3 high,
                              std::uint32_t island) {
  const Result<render::OccupancyStore*> store = renderer_->occupancy();
  if (!store) return store.error();
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  const render::IslandChunks box{
      {low.x, low.y, low.z}, {high.x - low.x, high.y - low.y, high.z - low.z}, 0};
  if (Result<void> begun = (*store)->begin_island(uploader, island, box); !begun) return begun;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z) {
        const world::ChunkOccupancy chunk = world::occupancy_of(padded_chunk(block_at, {x, y, z}));
        if (chunk.fill == world::ChunkOccupancy::Fill::kEmpty) continue;
        const render::OccupancyBits bits{chunk.fill == world::ChunkOccupancy::Fill::kFull,
                                         chunk.table, chunk.words};
        if (Result<void> added = (*store)->add(uploader, island, {x, y, z}, bits); !added)
          return added;
      }
  return {};
}

Result<Frame> Stage::draw(const render::FrameInput& input, const render::RenderSettings& settings,
                          VkExtent2D size) {
  if (const Result<std::uint64_t> drawn = renderer_->draw(input, settings, size); !drawn)
    return drawn.error();
  renderer_->finish();
  Frame frame;
  frame.size = size;
  frame.report = renderer_->report().value();
  const Result<std::vector<std::byte>> picture = gpu::read_back(device_, renderer_->picture(), 4);
  if (!picture) return picture.error();
  frame.rgba.resize(picture->size());
  std::memcpy(frame.rgba.data(), picture->data(), picture->size());
  if (!input.capture) return frame;
  for (const std::uint64_t halves :
       texels_of<std::uint64_t>(renderer_->captured(render::Capture::kRadiance)))
    frame.radiance.emplace_back(glm::unpackHalf4x16(halves));
  frame.depth = texels_of<float>(renderer_->captured(render::Capture::kDepth));
  frame.words = texels_of<std::uint32_t>(renderer_->captured(render::Capture::kSurfaces));
  frame.shadow_maps = texels_of<float>(renderer_->captured(render::Capture::kShadowMaps));
  return frame;
}

render::FixedPos fixed_at(const glm::dvec3& blocks) {
  return moved({}, blocks);
}

render::FixedPos moved(const render::FixedPos& place, const glm::dvec3& blocks) {
  const world::WorldPos to = world::moved({place[0], place[1], place[2]}, blocks);
  return {to.x, to.y, to.z};
}

render::Camera camera_at(const glm::dvec3& blocks, double yaw_deg, double pitch_deg,
                         double fov_deg) {
  return {fixed_at(blocks), yaw_deg, pitch_deg, fov_deg};
}

glm::dvec3 ray_of(const render::Camera& camera, VkExtent2D size, std::uint32_t x, std::uint32_t y) {
  const double yaw = glm::radians(camera.yaw_deg), pitch = glm::radians(camera.pitch_deg);
  const glm::dvec3 forward{std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                           std::cos(yaw) * std::cos(pitch)};
  // From the yaw, so that looking straight up or down has a right, too.
  const glm::dvec3 right{-std::cos(yaw), 0.0, std::sin(yaw)};
  const glm::dvec3 up = glm::cross(right, forward);
  const double tan_y = std::tan(glm::radians(camera.fov_deg) / 2.0);
  const double tan_x = tan_y * size.width / size.height;
  return forward + right * (((x + 0.5) / size.width * 2.0 - 1.0) * tan_x) +
         up * ((1.0 - (y + 0.5) / size.height * 2.0) * tan_y);
}

render::Celestial sun_towards(const glm::dvec3& to_sun) {
  render::Celestial sky = render::celestial_at(render::kDaySeconds / 2.0, 0.0);
  sky.to_sun = glm::normalize(to_sun);
  return sky;
}

render::Celestial darkness() {
  render::Celestial sky = render::celestial_at(0.0, 0.0);  // midnight at new moon
  return sky;
}

render::Celestial moon_above(float irradiance) {
  render::Celestial sky = darkness();
  sky.to_moon = {0.0, 1.0, 0.0};
  sky.moon_irradiance = glm::vec3(irradiance);
  sky.moon_casts = true;
  return sky;
}

render::RenderSettings without_sky_light(render::RenderSettings settings) {
  settings.indirect = render::Indirect::kOff;
  settings.leave_out.add(render::Feature::kHaze);
  return settings;
}

Result<Sunlight> sunlight_of(Stage& stage, const render::FrameInput& input,
                             const render::RenderSettings& asked, VkExtent2D size) {
  const render::RenderSettings settings = without_sky_light(asked);
  const auto frame = stage.draw(input, settings, size);
  if (!frame) return frame.error();
  render::FrameInput changed = input;
  changed.sky.sun_irradiance = glm::vec3(0.0f);
  changed.sky.sun_casts = false;
  const auto dark = stage.draw(changed, settings, size);
  if (!dark) return dark.error();
  render::RenderSettings open = settings;
  open.shadow_enabled = false;
  const auto unshadowed = stage.draw(input, open, size);
  if (!unshadowed) return unshadowed.error();
  Sunlight out;
  for (std::size_t i = 0; i < frame->words.size(); ++i) {
    if (frame->words[i] == 0) continue;
    out.lit += frame->radiance[i].x > 2.0f * dark->radiance[i].x;
    out.shadowed += unshadowed->radiance[i].x > 2.0f * frame->radiance[i].x;
  }
  return out;
}

double lit_surfaces(const Frame& frame) {
  double count = 0.0;
  for (std::size_t i = 0; i < frame.words.size(); ++i)
    count += frame.words[i] != 0 && frame.radiance[i] != glm::vec3(0.0f);
  return count;
}

double non_finite_channels(std::span<const glm::vec3> pixels) {
  double count = 0.0;
  for (const glm::vec3& p : pixels)
    count += !std::isfinite(p.x) + !std::isfinite(p.y) + !std::isfinite(p.z);
  return count;
}

double different_pixels(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::quiet_NaN();
  double count = 0.0;
  for (std::size_t i = 0; i + 4 <= a.size(); i += 4) count += std::memcmp(&a[i], &b[i], 4) != 0;
  return count;
}

}  // namespace skerry::tools::stability
