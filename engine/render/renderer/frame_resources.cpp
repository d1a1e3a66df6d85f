#include "engine/render/renderer/frame_resources.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>
#include <utility>
#include <vector>

#include "engine/render/frame/frame_choices.h"
#include "engine/render/scene/block_textures.h"
#include "engine/render/scene/grow_buffer.h"
#include "shaders/shared/exposure.h"

namespace skerry::render {
namespace {

constexpr VkBufferUsageFlags kTable =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
    VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

// Tables begin with what most worlds need, so that none grows in a flight.
constexpr std::uint64_t kLeastBytes = std::uint64_t{1} << 16;

/// What is brighter than a half can hold is the brightest half.
std::vector<glm::u16vec4> half_texels(const Panorama& panorama) {
  constexpr float kMostHalf = 65504.0f;
  std::vector<glm::u16vec4> out;
  out.reserve(panorama.texels.size());
  for (const glm::vec3& texel : panorama.texels)
    out.push_back(glm::packHalf(glm::vec4(glm::min(texel, kMostHalf), 1.0f)));
  return out;
}

}  // namespace

Result<void> FrameResources::reserve(gpu::Buffer& buffer, const char* name,
                                     std::uint64_t size_bytes, ReadBy read_by) {
  if (buffer && buffer.size_bytes() >= size_bytes) return {};
  const std::uint64_t size =
      std::max({size_bytes, buffer ? buffer.size_bytes() * 2 : 0, kLeastBytes});
  const bool texels = read_by == ReadBy::kTexels;
  Result<gpu::Buffer> made = device_->create_buffer(
      {name, size, texels ? kTable | kTexelTableUsage : kTable, gpu::Memory::kDevice, texels});
  if (!made) return made.error();
  buffer = *std::move(made);
  return {};
}

template <class T>
Result<void> FrameResources::upload(gpu::Uploader& uploader, gpu::Buffer& to, const char* name,
                                    std::span<const T> values, ReadBy read_by) {
  const std::size_t bytes = std::max<std::size_t>(values.size_bytes(), sizeof(T));
  if (Result<void> ok = reserve(to, name, bytes, read_by); !ok) return ok;
  if (!values.empty()) uploader.write(to, 0, values);
  return {};
}

Result<void> FrameResources::create_indices(gpu::Uploader& uploader) {
  std::vector<std::uint16_t> index(shared::kMaxQuadsPerDraw * 6);
  for (std::uint32_t quad = 0; quad < shared::kMaxQuadsPerDraw; ++quad)
    for (std::uint32_t i = 0; i < 6; ++i)
      index[quad * 6 + i] =
          static_cast<std::uint16_t>(quad * 4 + std::array<std::uint32_t, 6>{0, 1, 2, 0, 2, 3}[i]);
  Result<gpu::Buffer> made = device_->create_buffer(
      {"quad indices", index.size() * 2,
       VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::kDevice});
  if (!made) return made.error();
  indices_ = *std::move(made);
  uploader.write(indices_, 0, std::span<const std::uint16_t>(index));
  return {};
}

Result<void> FrameResources::create_textures(gpu::Uploader& uploader) {
  const BlockTextures textures = render::block_textures();
  const auto create = [&](gpu::Image& into, const char* name, VkFormat format,
                          const std::vector<std::byte>& texels) -> Result<void> {
    Result<gpu::Image> image = device_->create_image(
        {.name = name,
         .format = format,
         .extent = {textures.edge, textures.edge},
         .mips = textures.mips,
         .layers = textures.layers,
         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
         .array = true});
    if (!image) return image.error();
    into = *std::move(image);
    return uploader.fill_image(into, texels);
  };
  if (Result<void> ok = create(block_textures_, "block textures", VK_FORMAT_R16G16B16A16_SFLOAT,
                               linear_texels(textures));
      !ok)
    return ok;
  return create(block_coverage_, "block coverage", VK_FORMAT_R16_SFLOAT, coverage_texels(textures));
}

Result<void> FrameResources::create_images(gpu::Uploader& uploader) {
  if (Result<void> ok = create_textures(uploader); !ok) return ok;
  Result<gpu::Image> image =
      device_->create_image({.name = "sky table",
                             .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                             .extent = {shared::kSkyLutWidth, shared::kSkyLutHeight},
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                      VK_IMAGE_USAGE_TRANSFER_DST_BIT});
  if (!image) return image.error();
  sky_lut_ = *std::move(image);

  image = device_->create_image({.name = "no volume",
                                 .format = VK_FORMAT_R8_UNORM,
                                 .extent = {1, 1},
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                 .depth = 1});
  if (!image) return image.error();
  no_volume_ = *std::move(image);
  image = device_->create_image({.name = "no words",
                                 .format = VK_FORMAT_R32_UINT,
                                 .extent = {1, 1},
                                 .usage = VK_IMAGE_USAGE_STORAGE_BIT});
  if (!image) return image.error();
  no_words_ = *std::move(image);
  image = device_->create_image({.name = "no depths",
                                 .format = VK_FORMAT_R32_UINT,
                                 .extent = {1, 1},
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
  if (!image) return image.error();
  no_depths_ = *std::move(image);
  image = device_->create_image({.name = "no layers",
                                 .format = VK_FORMAT_R32_UINT,
                                 .extent = {1, 1},
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                 .array = true});
  if (!image) return image.error();
  no_layers_ = *std::move(image);
  return {};
}

Result<void> FrameResources::create_samplers() {
  const std::array<std::pair<VkSampler*, gpu::SamplerDesc>, 4> samplers{{
      {&block_sampler_,
       {.mip = VK_SAMPLER_MIPMAP_MODE_LINEAR, .address = VK_SAMPLER_ADDRESS_MODE_REPEAT}},
      {&lut_sampler_, {}},
      {&panorama_sampler_, {.address = VK_SAMPLER_ADDRESS_MODE_REPEAT}},
      {&point_sampler_, {.mag = VK_FILTER_NEAREST, .min = VK_FILTER_NEAREST}},
  }};
  for (const auto& [sampler, desc] : samplers) {
    Result<VkSampler> got = device_->sampler(desc);
    if (!got) return got.error();
    *sampler = *got;
  }
  return {};
}

Result<void> FrameResources::create(gpu::Uploader& uploader,
                                    std::span<const shared::Material> materials) {
  if (Result<void> ok = create_indices(uploader); !ok) return ok;
  if (Result<void> ok = upload(uploader, materials_, "materials", materials); !ok) return ok;
  if (Result<void> ok = reserve(pixel_stats_, "pixel stats", sizeof(shared::PixelStats)); !ok)
    return ok;
  if (Result<void> ok = ensure_seen(uploader, 1); !ok) return ok;
  if (Result<void> ok = create_images(uploader); !ok) return ok;
  Result<gpu::Buffer> texels =
      device_->create_buffer({"no texels", 16, kTexelTableUsage, gpu::Memory::kDevice, true});
  if (!texels) return texels.error();
  no_texels_ = *std::move(texels);
  return create_samplers();
}

Result<void> FrameResources::set_panorama(gpu::Uploader& uploader, const Panorama* panorama) {
  if (!panorama) {
    panorama_ = {};
    return {};
  }
  const std::vector<glm::u16vec4> texels = half_texels(*panorama);
  Result<gpu::Image> image = device_->create_image(
      {.name = "panorama",
       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
       .extent = {panorama->columns, panorama->rows},
       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
  if (!image) return image.error();
  if (Result<void> ok = uploader.fill_image(*image, std::as_bytes(std::span(texels))); !ok)
    return ok;
  panorama_ = *std::move(image);
  return {};
}

Result<void> FrameResources::upload(gpu::Uploader& uploader, const FrameTables& tables,
                                    const FrameInput& input, const SkyModel& sky, bool bake_sky) {
  // Where every pixel is black, any exposure is right.
  shared::Exposure given{};
  given.ev = input.exposure_ev.value_or(0.0f);
  const std::array<Result<void>, 5> done{
      upload(uploader, exposure_, "exposure", std::span<const shared::Exposure>(&given, 1)),
      upload(uploader, frame_, "frame constants",
             std::span<const shared::FrameConstants>(&tables.constants, 1)),
      upload(uploader, sky_, "sky constants",
             std::span<const shared::SkyConstants>(&sky.constants, 1)),
      upload(uploader, islands_, "island transforms",
             std::span<const shared::IslandTransform>(tables.islands), ReadBy::kTexels),
      upload(uploader, views_, "cull views", std::span<const shared::CullView>(tables.views)),
  };
  for (const Result<void>& one : done)
    if (!one) return one.error();
  if (!bake_sky) return {};
  const SkyScattering scattering = scattering_of_bodies(sky);
  return upload(uploader, sky_scattering_, "sky scattering",
                std::span<const shared::SkyScatter>(scattering));
}

Result<void> FrameResources::upload_light_islands(gpu::Uploader& uploader,
                                                  const FrameInput& input) {
  return upload(uploader, light_islands_, "light islands", input.light_islands);
}

Result<void> FrameResources::upload_skies(gpu::Uploader& uploader,
                                          std::span<const glm::uvec4> irradiance) {
  return upload(uploader, island_skies_, "skies of islands", irradiance, ReadBy::kTexels);
}

Result<void> FrameResources::ensure_seen(gpu::Uploader& uploader, std::uint32_t sections) {
  const std::uint64_t bytes = std::uint64_t{sections} * sizeof(std::uint32_t);
  if (seen_ && seen_.size_bytes() >= bytes) return {};
  if (Result<void> ok = reserve(seen_, "sections seen", bytes); !ok) return ok;
  const std::vector<std::uint32_t> none(seen_.size_bytes() / sizeof(std::uint32_t));
  uploader.write(seen_, 0, std::span<const std::uint32_t>(none));
  return {};
}

SceneRefs FrameResources::import(gpu::FrameGraph& graph, const FrameInput& input,
                                 const RenderSettings& settings, VkExtent2D size,
                                 const FrameTables& tables) {
  SceneRefs s;
  s.frame = graph.import(frame_);
  s.sky = graph.import(sky_);
  s.sky_scattering = graph.import(sky_scattering_);
  s.islands = graph.import(islands_);
  s.clip_from_source = tables.matrices;
  s.edge_growth = tables.edge_growth;
  s.views = graph.import(views_);
  s.materials = graph.import(materials_);
  s.indices = graph.import(indices_);
  s.pixel_stats = graph.import(pixel_stats_);
  s.exposure = graph.import(exposure_);
  s.block_textures = graph.import(block_textures_);
  s.block_coverage = graph.import(block_coverage_);
  s.panorama = bool{panorama_};
  s.sky_lut = graph.import(s.panorama ? panorama_ : sky_lut_);
  s.sky_sampler = s.panorama ? panorama_sampler_ : lut_sampler_;
  s.no_volume = graph.import(no_volume_);
  s.no_words = graph.import(no_words_);
  s.no_depths = graph.import(no_depths_);
  s.no_layers = graph.import(no_layers_);
  s.block_sampler = block_sampler_;
  s.lut_sampler = lut_sampler_;
  s.point_sampler = point_sampler_;
  s.islands_per_view = static_cast<std::uint32_t>(input.islands.size());
  s.size = size;
  s.layers_area = tables.constants.layers_area;
  s.count_pixels = input.count_pixels;
  s.tone = settings.tone;
  s.calibrated = settings.display != DisplaySettings{};
  s.shadow_taps = static_cast<std::uint32_t>(settings.shadow_taps);
  s.shadow_cascades = static_cast<std::uint32_t>(settings.shadow_cascades);
  s.samples_per_edge = static_cast<std::uint32_t>(samples_per_edge(settings));
  s.shadow_blur = shadow_blur(input, settings) > 0.0f;
  for (std::uint32_t body = 0; body < shared::kBodyCount; ++body)
    if (tables.constants.bodies[body].irradiance != glm::vec3(0.0f)) s.bodies |= 1u << body;
  return s;
}

}  // namespace skerry::render
