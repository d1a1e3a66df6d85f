#include "engine/render/light/light_clusters.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/core/check.h"
#include "engine/core/log.h"
#include "engine/render/frame/camera.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {
namespace {

using gpu::Use;
using shared::kLightTexels, shared::kPaneTexels;

static_assert(sizeof(shared::Light) == kLightTexels * sizeof(glm::uvec4));
static_assert(sizeof(shared::LightPane) == kPaneTexels * sizeof(glm::uvec4));

constexpr VkBufferUsageFlags kTable =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
/// Room for lists to begin with. What a frame wants beyond is made for later ones.
constexpr std::uint64_t kEntriesPerLight = 64, kLeastEntries = 1u << 17, kFirstEntries = 1u << 22;
/// Of words of 32 lights. A GPU waits for each light in turn, so that few at a stretch are best; on
/// a CPU each invocation more costs, and lavapipe ends one after 65,535 rounds of its loops,
/// without a word.
constexpr std::uint32_t kLeastChunkWords = 1, kLeastChunkWordsOnCpu = 8, kMostChunks = 16;
/// Lights of most views: so many are sorted without lists that grow.
constexpr std::uint32_t kUsualLights = 2048;
constexpr std::uint64_t kUsualEntries = 1u << 20;
/// Lists never take more: what does not fit is looked for among all lights.
constexpr std::uint64_t kMostEntryBytes = 512u << 20;

std::uint32_t groups(std::uint32_t threads, std::uint32_t group) {
  return gpu::Commands::groups(threads, group);
}

std::uint32_t bins_of(const ClusterPicture& picture) {
  const std::uint32_t edge = picture.tile_edge * shared::kBinClusters;
  return groups(picture.size.width, edge) * groups(picture.size.height, edge);
}

std::uint64_t most_entries(const gpu::DeviceLimits& limits) {
  return std::min(kMostEntryBytes, limits.max_storage_range) / sizeof(std::uint32_t);
}

}  // namespace

std::uint32_t light_kinds(std::span<const shared::Light> lights) {
  std::uint32_t kinds = 0;
  for (const shared::Light& light : lights) {
    kinds |= 1u << (light.kind & shared::kLightKindMask);
    if (light.pane_count != 0) kinds |= shared::kLightPanesBit;
  }
  return kinds;
}

std::vector<shared::Light> lights_in_view(std::span<const shared::Light> lights,
                                          const shared::CullView& view) {
  std::vector<shared::Light> out;
  for (const shared::Light& light : lights) {
    if (light.intensity == glm::vec3(0.0f)) continue;
    bool inside = true;
    if ((light.kind & shared::kLightKindMask) != shared::kLightDirectional) {
      for (const glm::vec4& plane : view.planes) {
        const float distance = glm::dot(glm::vec3(plane), light.position) + plane.w;
        const float rounding = 1e-4f * (1.0f + light.range + glm::length(light.position));
        inside = inside && distance >= -light.range - rounding;
      }
    }
    if (inside) out.push_back(light);
  }
  return out;
}

std::uint32_t most_lights(const gpu::DeviceLimits& limits, const ClusterPicture& picture) {
  // A dispatch has a row of bins for each word of 32 lights, and a device takes 65,535 rows.
  // Under the oracle the lights are bound in place of lists that are never read.
  const std::uint64_t by_lights =
      std::min(limits.max_storage_range / sizeof(shared::Light), limits.max_texels / kLightTexels);
  const std::uint64_t words = limits.max_storage_range / sizeof(std::uint32_t) / bins_of(picture);
  return static_cast<std::uint32_t>(
      std::min(by_lights, 32 * std::min<std::uint64_t>(words, 65535)));
}

std::uint32_t slices_lit(std::span<const shared::Light> lights) {
  constexpr std::uint32_t kAll = (1u << shared::kClusterSlices) - 1u;
  float reach = 1.0f;
  for (const shared::Light& light : lights) {
    if ((light.kind & shared::kLightKindMask) == shared::kLightDirectional) return kAll;
    reach = std::max(reach, glm::length(light.position) + light.range);
  }
  // Two slices an octave from one block on; one more for what rounding does.
  const auto last = static_cast<std::uint32_t>(2.0f * std::log2(reach)) + 2u;
  return last >= shared::kClusterSlices ? kAll : (2u << last) - 1u;
}

shared::ClusterGrid cluster_grid(const CameraView& camera, const ClusterPicture& picture,
                                 std::uint32_t light_count, std::uint64_t entries,
                                 std::uint32_t least_chunk_words) {
  shared::ClusterGrid g{};
  g.right = camera.right;
  g.up = camera.up;
  g.forward = camera.forward;
  g.tan_half = {camera.tan_half_x, camera.tan_half_y};
  g.size = {picture.size.width, picture.size.height};
  g.near_plane = kNearPlane;
  SKERRY_ASSERT(std::has_single_bit(picture.tile_edge) && picture.tile_edge >= shared::kTileEdge);
  g.edge_log2 = static_cast<std::uint32_t>(std::countr_zero(picture.tile_edge));
  g.tiles_x = groups(g.size.x, picture.tile_edge);
  g.tiles_y = groups(g.size.y, picture.tile_edge);
  g.bins_x = groups(g.tiles_x, shared::kBinClusters);
  g.bins_y = groups(g.tiles_y, shared::kBinClusters);
  g.light_count = light_count;
  g.light_words = groups(light_count, 32);
  g.chunk_words = std::max(least_chunk_words, groups(g.light_words, kMostChunks));
  g.chunks = groups(g.light_words, g.chunk_words);
  g.layers_area = picture.layers_area;
  g.marked_slices = picture.marked_slices;
  // The counter that hands out room has 32 bits: even if every light reached every cluster it must
  // not wrap.
  const std::uint64_t clusters = std::uint64_t{g.tiles_x} * g.tiles_y * shared::kClusterSlices;
  while (clusters * ((light_count >> g.unit_log2) + std::uint64_t{1}) >= (std::uint64_t{1} << 32))
    ++g.unit_log2;
  g.capacity = static_cast<std::uint32_t>(entries >> g.unit_log2);
  return g;
}

std::vector<gpu::SpecConstant> ClusteredLights::with_panes(
    std::vector<gpu::SpecConstant> own) const {
  return with_kinds(std::move(own), kinds | (panes ? shared::kLightPanesBit : 0u));
}

std::vector<gpu::SpecConstant> ClusteredLights::with_kinds(std::vector<gpu::SpecConstant> own,
                                                           std::uint32_t bits) const {
  if (kinds == 0) return own;
  own.push_back({shared::kLitConstant, 1});
  own.push_back({shared::kLightKindsConstant, bits});
  if (oracle) own.push_back({shared::kOracleConstant, 1});
  if (shafts) own.push_back({shared::kShaftsConstant, 1});
  return own;
}

ClusteredLights ClusteredLights::none(const SceneRefs& scene) {
  ClusteredLights out;
  out.grid = scene.frame;
  out.lights = scene.islands;
  out.reaches = out.clusters = out.entries = out.tile_depths = scene.materials;
  return out;
}

LampReads ClusteredLights::tile_reads() const {
  return {.grid = grid,
          .clusters = clusters,
          .depths = tile_depths,
          .lit = kinds != 0,
          .oracle = oracle};
}

void ClusteredLights::declare_counts(gpu::PassBuilder& builder) const {
  builder.read(grid, Use::kComputeRead);
  builder.read(clusters, Use::kComputeRead);
}

void ClusteredLights::declare(gpu::PassBuilder& builder) const {
  declare_counts(builder);
  builder.read(reaches, Use::kComputeRead);
  if (shafts) builder.read(shafts, Use::kComputeRead);
  builder.read(lights, Use::kComputeRead);
  builder.read(entries, Use::kComputeRead);
}

Result<void> LightClusters::reserve(gpu::Buffer& buffer, const char* name, std::uint64_t size_bytes,
                                    bool texels) {
  if (buffer && buffer.size_bytes() >= size_bytes) return {};
  Result<gpu::Buffer> made = device_.create_buffer(
      {name, size_bytes, texels ? kTable | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT : kTable,
       gpu::Memory::kDevice, texels});
  if (!made) return made.error();
  buffer = *std::move(made);
  return {};
}

/// Lights come and go: what most worlds need is not outgrown by each that comes.
std::uint64_t LightClusters::roomy(std::uint64_t size_bytes) const {
  std::uint64_t bytes = std::uint64_t{1} << 20;
  while (bytes < size_bytes) bytes *= 4;
  return std::max<std::uint64_t>(std::min(bytes, device_.limits().max_storage_range), size_bytes);
}

Result<void> LightClusters::reserve_lights(std::uint64_t count, std::uint64_t panes) {
  const std::uint64_t wanted = count * sizeof(shared::Light) + panes * sizeof(shared::LightPane);
  const std::uint64_t most = device_.limits().max_texels * (sizeof(shared::Light) / kLightTexels);
  return reserve(lights_, "lights", std::min(roomy(wanted), std::max(most, wanted)), true);
}

std::uint32_t LightClusters::least_chunk_words() const {
  const bool cpu = device_.info().type == VK_PHYSICAL_DEVICE_TYPE_CPU;
  return cpu ? kLeastChunkWordsOnCpu : kLeastChunkWords;
}

void LightClusters::suppose(std::uint32_t kinds, const ClusterPicture& picture) {
  kinds_ = kinds;
  grid_ = cluster_grid({}, picture, kUsualLights, kUsualEntries, least_chunk_words());
}

void LightClusters::reserve() {
  (void)reserve(entries_, "light lists", kUsualEntries * sizeof(std::uint32_t));
  (void)reserve_lights(kUsualLights, 0);
  (void)reserve(reaches_, "reach of lights", roomy(kUsualLights * sizeof(shared::LightReach)));
  (void)reserve(grid_buffer_, "cluster grid", sizeof(grid_));
}

Result<void> LightClusters::upload(gpu::Uploader& uploader, std::span<const shared::Light> lights,
                                   std::span<const shared::LightReach> reaches,
                                   std::span<const shared::LightPane> panes,
                                   const CameraView& camera, const ClusterPicture& picture) {
  SKERRY_ASSERT(!lights.empty());
  const std::uint32_t most = most_lights(device_.limits(), picture);
  if (lights.size() > most) {
    if (!said_too_many_)
      log_error(
          fmt::format("cannot light a picture with {} lights: this device can sort {} at "
                      "{}x{} pixels; the others stay dark, use fewer lights in view",
                      lights.size(), most, picture.size.width, picture.size.height));
    said_too_many_ = true;
    lights = lights.first(most);
  }
  // Panes that find no room colour nothing.
  std::vector<shared::Light> without;
  if (lights.size() * kLightTexels + panes.size() * kPaneTexels > device_.limits().max_texels) {
    without.assign(lights.begin(), lights.end());
    for (shared::Light& light : without) light.pane_count = 0;
    lights = without;
    panes = {};
  }
  kinds_ = light_kinds(lights);
  const std::uint64_t room = std::clamp(
      std::max(wanted_entries_, std::min(lights.size() * kEntriesPerLight, kFirstEntries)),
      kLeastEntries, most_entries(device_.limits()));
  if (Result<void> ok = reserve(entries_, "light lists", room * sizeof(std::uint32_t)); !ok)
    return ok;
  if (Result<void> ok = reserve_lights(lights.size(), panes.size()); !ok) return ok;
  if (!reaches.empty()) {
    if (Result<void> ok = reserve(reaches_, "reach of lights", roomy(reaches.size_bytes())); !ok)
      return ok;
    uploader.write(reaches_, 0, reaches);
  }
  if (Result<void> ok = reserve(grid_buffer_, "cluster grid", sizeof(grid_)); !ok) return ok;
  grid_ = cluster_grid(camera, picture, static_cast<std::uint32_t>(lights.size()),
                       entries_.size_bytes() / sizeof(std::uint32_t), least_chunk_words());
  uploader.write(lights_, 0, lights);
  if (!panes.empty()) uploader.write(lights_, lights.size_bytes(), panes);
  uploader.write(grid_buffer_, 0, std::span<const shared::ClusterGrid>(&grid_, 1));
  return {};
}

void LightClusters::learn(const shared::ClusterGrid& grid, const shared::ClusterWork& found) {
  if (found.units <= grid.capacity) return;
  const std::uint64_t wanted = std::uint64_t{found.units} << grid.unit_log2;
  wanted_entries_ = std::max(wanted_entries_, wanted + wanted / 4);
  if (wanted <= most_entries(device_.limits()) || said_no_room_) return;
  said_no_room_ = true;
  log_warning(fmt::format(
      "the lights' lists would take {} MiB of the {} MiB they may: where they do not fit, every "
      "light is asked, which is slow; use fewer lights or shorter ranges",
      wanted * sizeof(std::uint32_t) >> 20,
      most_entries(device_.limits()) * sizeof(std::uint32_t) >> 20));
}

}  // namespace skerry::render
