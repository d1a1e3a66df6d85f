#include "engine/render/sky/clouds.h"

#include <fmt/format.h>
#include <shader_names.h>

#include <array>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {
namespace {

using gpu::Use;

constexpr std::uint32_t kColumnGroup = 8;
constexpr std::uint32_t kNoiseEdge = shared::kCloudNoiseEdge;
constexpr std::array<const char*, shared::kCloudLights> kLayerPasses{
    "trace_cloud_layer_sun", "trace_cloud_layer_moon", "trace_cloud_layer_sky"};

constexpr VkImageUsageFlags kBaked = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
constexpr VkImageUsageFlags kFilled = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// Of the bricks' image. Errors: the device cannot filter it.
Result<VkFormat> brick_format(gpu::Device& device, CloudPrecision precision) {
  const VkFormat format = precision == CloudPrecision::k8    ? VK_FORMAT_R8_UNORM
                          : precision == CloudPrecision::k16 ? VK_FORMAT_R16_SFLOAT
                                                             : VK_FORMAT_R32_SFLOAT;
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical(), format, &properties);
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT))
    return Error{
        fmt::format("this device cannot blend between clouds' values of {} bits: use "
                    "clouds.precision=8 or 16",
                    static_cast<int>(precision))};
  return format;
}

/// What bake_cloud_noise.comp declares. @param layer of the packed images.
auto noise_bindings(gpu::ImageRef noise, const CloudRefs& refs, std::uint32_t layer) {
  return std::tuple{gpu::storage<shared::kCloudNoiseBinding>(noise),
                    gpu::storage<shared::kCloudWeatherBinding>(refs.weather),
                    gpu::storage<shared::kCloudShapesBinding>(refs.shapes, layer),
                    gpu::storage<shared::kCloudBillowsBinding>(refs.billows, layer)};
}

}  // namespace

Result<void> Clouds::set_volumes(gpu::Uploader& uploader, std::span<const CloudVolumeDesc> volumes,
                                 CloudPrecision precision) {
  Result<CloudAtlas> atlas = pack_clouds(volumes, precision, device_.limits().max_volume_edge);
  if (!atlas) return atlas.error();
  std::vector<CloudVolumeDesc> kept;
  std::vector<PackedVolume> packed;
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    if (atlas->volumes[v].value_range == 0.0f) continue;  // there is nothing in it
    kept.push_back({volumes[v].origin, volumes[v].blocks_from_index, volumes[v].role, {}, {}});
    packed.push_back(atlas->volumes[v]);
  }
  gpu::Image bricks, cells;
  if (!kept.empty()) {
    const Result<VkFormat> format = brick_format(device_, precision);
    if (!format) return format.error();
    const auto filled = [&](gpu::Image& image, const char* name, VkFormat of, glm::uvec3 size,
                            std::uint32_t mips, std::span<const std::byte> texels) -> Result<void> {
      Result<gpu::Image> made = device_.create_image({.name = name,
                                                      .format = of,
                                                      .extent = {size.x, size.y},
                                                      .mips = mips,
                                                      .usage = kFilled,
                                                      .depth = size.z});
      if (!made) return made.error();
      image = *std::move(made);
      return uploader.fill_image(image, texels);
    };
    if (Result<void> ok =
            filled(bricks, "cloud bricks", *format, atlas->brick_texels, 1, atlas->bricks);
        !ok)
      return ok;
    if (Result<void> ok = filled(cells, "cloud cells", VK_FORMAT_R8G8B8A8_UNORM, atlas->cells,
                                 shared::kCloudCellLevels, atlas->cell_texels);
        !ok)
      return ok;
  }
  volumes_ = std::move(kept);
  packed_ = std::move(packed);
  bricks_ = std::move(bricks);
  cells_ = std::move(cells);
  brick_count_ = atlas->brick_count;
  volume_light_ = {};
  ++light_generation_;
  return {};
}

CloudFacts Clouds::facts() const {
  return {volumes_, packed_, noise_generation_, light_generation_};
}

Result<void> Clouds::make_noise() {
  if (billows_) return {};
  ++noise_generation_;
  const auto make = [&](gpu::Image& image, const char* name, std::uint32_t layers) -> Result<void> {
    Result<gpu::Image> made = device_.create_image({.name = name,
                                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                    .extent = {kNoiseEdge, kNoiseEdge},
                                                    .layers = layers,
                                                    .usage = kBaked});
    if (!made) return made.error();
    image = *std::move(made);
    return {};
  };
  if (Result<void> ok = make(weather_, "cloud weather", 1); !ok) return ok;
  if (Result<void> ok = make(shapes_, "cloud shapes", shared::kCloudNoiseLayers); !ok) return ok;
  return make(billows_, "cloud billows", shared::kCloudNoiseLayers);
}

Result<void> Clouds::make_layer(std::uint32_t shadow_steps) {
  if (Result<void> ok = make_noise(); !ok) return ok;
  const auto slices = (shadow_steps + 1) * shared::kCloudLights;
  if (layer_light_ && layer_light_.desc().depth == slices) return {};
  layer_light_ = {};
  Result<gpu::Image> made =
      device_.create_image({.name = "cloud layer light",
                            .format = VK_FORMAT_R16_SFLOAT,
                            .extent = {shared::kLayerLightEdge, shared::kLayerLightEdge},
                            .usage = kBaked,
                            .depth = slices});
  if (!made) return made.error();
  layer_light_ = *std::move(made);
  return {};
}

Result<void> Clouds::make_volume_light() {
  if (volume_light_) return {};
  ++light_generation_;
  Result<gpu::Image> made =
      device_.create_image({.name = "cloud volume light",
                            .format = VK_FORMAT_R16_SFLOAT,
                            .extent = {shared::kVolumeLightEdge, shared::kVolumeLightEdge},
                            .usage = kBaked,
                            .depth = static_cast<std::uint32_t>(volumes_.size()) *
                                     shared::kCloudLights * shared::kVolumeLightEdge});
  if (!made) return made.error();
  volume_light_ = *std::move(made);
  return {};
}

Result<void> Clouds::prepare(gpu::Uploader& uploader, const CloudPlan& plan) {
  if (plan.layer)
    if (Result<void> ok = make_layer(static_cast<std::uint32_t>(plan.constants.shadow_steps)); !ok)
      return ok;
  if (plan.volume_light)
    if (Result<void> ok = make_volume_light(); !ok) return ok;
  const std::array<std::pair<VkSampler*, gpu::SamplerDesc>, 3> samplers{{
      {&repeating_, {.address = VK_SAMPLER_ADDRESS_MODE_REPEAT}},
      {&linear_, {}},
      {&nearest_, {.mag = VK_FILTER_NEAREST, .min = VK_FILTER_NEAREST}},
  }};
  for (const auto& [sampler, desc] : samplers) {
    Result<VkSampler> got = device_.sampler(desc);
    if (!got) return got.error();
    *sampler = *got;
  }
  if (!constants_buffer_) {
    Result<gpu::Buffer> made = device_.create_buffer(
        {"cloud constants", sizeof(shared::CloudConstants),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
         gpu::Memory::kDevice});
    if (!made) return made.error();
    constants_buffer_ = *std::move(made);
  }
  uploader.write(constants_buffer_, 0, std::span<const shared::CloudConstants>(&plan.constants, 1));
  return {};
}

void Clouds::add_noise(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, bool bake,
                       CloudRefs& refs) {
  refs.weather = graph.import(weather_);
  refs.shapes = graph.import(shapes_);
  refs.billows = graph.import(billows_);
  if (!bake) {
    for (const char* name : {"bake_cloud_noise", "pack_cloud_noise"})
      graph.leave_out(name, "it is kept from an earlier frame");
    return;
  }
  constexpr std::uint32_t kGroups = kNoiseEdge / kColumnGroup;
  gpu::ImageRef noise = graph.create(gpu::ImageDesc{.name = "cloud noise",
                                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                    .extent = {kNoiseEdge, kNoiseEdge},
                                                    .depth = kNoiseEdge});
  const auto declare_packed = [&](gpu::PassBuilder& b) {
    for (gpu::ImageRef* ref : {&refs.weather, &refs.shapes, &refs.billows})
      *ref = b.write(*ref, Use::kComputeWrite);
  };
  graph.add_pass(
      "bake_cloud_noise",
      [&](gpu::PassBuilder& b) {
        noise = b.write(noise, Use::kComputeWrite);
        declare_packed(b);
      },
      [noise, refs,
       program = gpu::compute(pipelines, programs::kBakeCloudNoise)](gpu::Commands& c) {
        // What is packed is not written.
        gpu::bind(c, program, noise_bindings(noise, refs, 0), gpu::constants(std::uint32_t{0}));
        c.dispatch(kGroups, kGroups, kNoiseEdge);
      });
  graph.add_pass(
      "pack_cloud_noise",
      [&](gpu::PassBuilder& b) {
        b.read(noise, Use::kComputeRead);
        declare_packed(b);
      },
      [noise, refs,
       program = gpu::compute(pipelines, programs::kBakeCloudNoise, {{shared::kPackConstant, 1}})](
          gpu::Commands& c) {
        for (std::uint32_t layer = 0; layer < shared::kCloudNoiseLayers; ++layer) {
          gpu::bind(c, program, noise_bindings(noise, refs, layer), gpu::constants(layer));
          c.dispatch(kGroups, kGroups, 1);
        }
      });
}

void Clouds::add_layer_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t light,
                             CloudRefs& refs) const {
  graph.add_pass(
      kLayerPasses[light],
      [&](gpu::PassBuilder& b) {
        b.read(refs.constants, Use::kComputeRead);
        refs.declare_media(b);
        refs.layer_light = b.write(refs.layer_light, Use::kComputeWrite);
      },
      [refs, light,
       program = gpu::compute(pipelines, programs::kTraceCloudLight,
                              {{shared::kCloudLayerConstant, 1}})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kCloudsBinding>(refs.constants),
                  refs.media_bindings(), gpu::storage<shared::kTargetBinding>(refs.layer_light),
                  gpu::constants(shared::CloudLightJob{0, light}));
        const std::uint32_t groups = shared::kLayerLightEdge / kColumnGroup;
        c.dispatch(groups, groups, 1);
      });
}

void Clouds::add_volume_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              std::span<const shared::CloudLightJob> light_jobs, CloudRefs& refs) {
  std::vector<std::pair<shared::CloudLightJob, glm::uvec3>> jobs;
  for (const shared::CloudLightJob& job : light_jobs)
    jobs.emplace_back(job, packed_[job.volume].light_texels);
  if (jobs.empty()) {
    graph.leave_out("trace_cloud_volumes", "kept from an earlier frame: the light has not moved");
    return;
  }
  graph.add_pass(
      "trace_cloud_volumes",
      [&](gpu::PassBuilder& b) {
        b.read(refs.constants, Use::kComputeRead);
        refs.declare_media(b);
        refs.volume_light = b.write(refs.volume_light, Use::kComputeWrite);
      },
      [refs, jobs,
       program = gpu::compute(pipelines, programs::kTraceCloudLight)](gpu::Commands& c) {
        for (const auto& [job, texels] : jobs) {
          gpu::bind(c, program, gpu::storage<shared::kCloudsBinding>(refs.constants),
                    refs.media_bindings(), gpu::storage<shared::kTargetBinding>(refs.volume_light),
                    gpu::constants(job));
          c.dispatch(gpu::Commands::groups(texels.x, kColumnGroup),
                     gpu::Commands::groups(texels.y, kColumnGroup), texels.z);
        }
      });
}

void Clouds::add_all_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t bodies,
                           const CloudPlan& plan, CloudRefs& refs) {
  const std::uint32_t lights = bodies | (plan.sky ? 1u << shared::kCloudZenith : 0u);
  if (lights == 0) {
    for (const char* name : {"trace_cloud_layer", "trace_cloud_volumes"})
      graph.leave_out(name, "neither sun, moon nor sky gives light");
    return;
  }
  for (std::uint32_t light = 0; refs.layer && light < shared::kCloudLights; ++light)
    if (lights & 1u << light) add_layer_light(graph, pipelines, light, refs);
  if (!plan.volume_light) return;
  refs.volume_light = graph.import(volume_light_);
  add_volume_light(graph, pipelines, plan.light_jobs, refs);
}

CloudRefs Clouds::add_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const CloudPlan& plan) {
  CloudRefs refs;
  refs.constants = graph.import(constants_buffer_);
  refs.repeating = repeating_;
  refs.linear = linear_;
  refs.nearest = nearest_;
  refs.layer = plan.layer;
  refs.sky = plan.sky;
  refs.volumes = static_cast<std::uint32_t>(volumes_.size());
  SKERRY_ASSERT(refs.layer || refs.volumes != 0);
  if (refs.layer) {
    add_noise(graph, pipelines, plan.bake_noise, refs);
    refs.layer_light = graph.import(layer_light_);
  }
  // What there is none of is never read; something is bound so that every binding is valid.
  if (!refs.layer) {
    refs.weather = scene.sky_lut;
    refs.shapes = refs.billows = scene.block_textures;
    refs.layer_light = scene.no_volume;
  }
  refs.bricks = refs.volumes != 0 ? graph.import(bricks_) : scene.no_volume;
  refs.cells = refs.volumes != 0 ? graph.import(cells_) : scene.no_volume;
  add_all_light(graph, pipelines, scene.bodies, plan, refs);
  if (!refs.volume_light) refs.volume_light = refs.bricks;
  return refs;
}

}  // namespace skerry::render
