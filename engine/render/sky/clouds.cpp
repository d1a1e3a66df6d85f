#include "engine/render/sky/clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"
#include "engine/render/sky/sky_model.h"

namespace skerry::render {
namespace {

using gpu::Use;

/// The layer drifts [blocks/s].
constexpr glm::dvec2 kWind{5.0, 2.0};
constexpr std::uint32_t kLightGroup = 4, kColumnGroup = 8;
constexpr std::uint32_t kNoiseEdge = shared::kCloudNoiseEdge;

constexpr VkImageUsageFlags kBaked = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
constexpr VkImageUsageFlags kFilled = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// Radiance of the sky, mean of all directions: a spiral over the sphere.
glm::dvec3 mean_sky(const shared::SkyConstants& sky) {
  constexpr int kDirections = 96;
  constexpr double kGoldenAngle = 2.399963229728653;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kDirections; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / kDirections, r = std::sqrt(1.0 - y * y);
    sum += sky_radiance({r * std::sin(kGoldenAngle * i), y, r * std::cos(kGoldenAngle * i)}, sky);
  }
  return sum / double{kDirections};
}

/// A fixed-point place in a period of `period` blocks, exactly; 0..period.
double in_period(std::int64_t units, double drift_blocks, std::int64_t period) {
  const std::int64_t whole = period * 65536;
  const std::int64_t rest = ((units % whole) + whole) % whole;
  const double place =
      static_cast<double>(rest) / 65536.0 - std::fmod(drift_blocks, static_cast<double>(period));
  const double wrapped = std::fmod(place, static_cast<double>(period));
  return wrapped < 0.0 ? wrapped + static_cast<double>(period) : wrapped;
}

shared::CloudLayer layer_of(const FrameInput& input, const CloudSettings& settings) {
  const FixedPos& camera = input.camera.position;
  const auto at = [&](int axis, double wind) {
    return static_cast<float>(in_period(
        camera[static_cast<std::size_t>(axis)] - input.anchor[static_cast<std::size_t>(axis)],
        wind * input.time_s, shared::kLayerPeriod));
  };
  const double height =
      static_cast<double>(camera[1] - input.anchor[1]) / 65536.0 - settings.altitude;
  return {{at(0, kWind.x), static_cast<float>(height), at(2, kWind.y)},
          settings.thickness,
          settings.density,
          settings.coverage};
}

/// Of the hottest place: a fire's orange.
constexpr glm::vec3 kFlame{1.0f, 0.42f, 0.10f};

shared::CloudVolume volume_of(const CloudVolumeDesc& desc, const PackedVolume& packed,
                              const FixedPos& camera, const CloudSettings& settings,
                              std::uint32_t slot) {
  const glm::dvec3 offset{static_cast<double>(camera[0] - desc.origin[0]) / 65536.0,
                          static_cast<double>(camera[1] - desc.origin[1]) / 65536.0,
                          static_cast<double>(camera[2] - desc.origin[2]) / 65536.0};
  const glm::dmat4 inverse = glm::inverse(desc.blocks_from_index);
  const glm::dvec3 middle(inverse * glm::dvec4(offset, 1.0));
  const auto row = [&](int r) {
    return glm::vec4(inverse[0][r], inverse[1][r], inverse[2][r], middle[r]);
  };
  shared::CloudVolume out{};
  out.index_x = row(0);
  out.index_y = row(1);
  out.index_z = row(2);
  out.low = packed.low;
  out.high = packed.high;
  if (desc.role == CloudRole::kDensity)
    out.extinction = packed.value_range * settings.file_density;
  else
    out.emission = kFlame * settings.file_emission;
  const glm::dvec3 extent(packed.high - packed.low);
  const glm::dmat3 axes(desc.blocks_from_index);
  double diagonal = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    diagonal += glm::dot(axes[axis], axes[axis]) * extent[axis] * extent[axis];
  out.step_blocks = static_cast<float>(std::sqrt(diagonal) / settings.steps);
  out.first_cell = packed.first_cell;
  out.cell_count = packed.cell_count;
  out.cell_low = packed.cell_low;
  out.light_texels = packed.light_texels;
  for (std::uint32_t body = 0; body < shared::kBodyCount; ++body)
    out.light_first[body] =
        static_cast<float>((slot * shared::kBodyCount + body) * shared::kVolumeLightEdge);
  return out;
}

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

}  // namespace

shared::CloudConstants cloud_constants(const FrameInput& input, const CloudSettings& settings,
                                       const shared::SkyConstants& sky,
                                       std::span<const CloudVolumeDesc> volumes,
                                       std::span<const PackedVolume> packed) {
  shared::CloudConstants out{};
  out.lights[0] = {glm::vec3(input.sky.to_sun), input.sky.sun_irradiance};
  out.lights[1] = {glm::vec3(input.sky.to_moon), input.sky.moon_irradiance};
  if (input.sky.sun_casts || input.sky.moon_casts)
    out.sky_above = glm::vec3(mean_sky(sky)) * air_light(input.sky);
  out.shadow_steps = static_cast<float>(settings.shadow_steps);
  out.steps = static_cast<float>(settings.steps);
  out.layer = layer_of(input, settings);
  for (std::size_t v = 0; v < volumes.size(); ++v)
    out.volumes[v] = volume_of(volumes[v], packed[v], input.camera.position, settings,
                               static_cast<std::uint32_t>(v));
  return out;
}

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
  lit_ = {};
  return {};
}

void Clouds::forget() {
  noise_baked_ = false;
  lit_ = {};
}

std::uint64_t Clouds::atlas_bytes() const {
  return (bricks_ ? bricks_.allocated_bytes() : 0) + (cells_ ? cells_.allocated_bytes() : 0);
}

Result<void> Clouds::make_noise() {
  if (billows_) return {};
  noise_baked_ = false;
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

Result<void> Clouds::make_layer(const CloudSettings& settings) {
  if (Result<void> ok = make_noise(); !ok) return ok;
  const auto slices = static_cast<std::uint32_t>(settings.shadow_steps + 1) * shared::kBodyCount;
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
  Result<gpu::Image> made =
      device_.create_image({.name = "cloud volume light",
                            .format = VK_FORMAT_R16_SFLOAT,
                            .extent = {shared::kVolumeLightEdge, shared::kVolumeLightEdge},
                            .usage = kBaked,
                            .depth = static_cast<std::uint32_t>(volumes_.size()) *
                                     shared::kBodyCount * shared::kVolumeLightEdge});
  if (!made) return made.error();
  volume_light_ = *std::move(made);
  return {};
}

Result<void> Clouds::prepare(gpu::Uploader& uploader, const FrameInput& input,
                             const RenderSettings& settings, const shared::SkyConstants& sky) {
  layer_ = settings.clouds.coverage > 0.0f;
  if (layer_)
    if (Result<void> ok = make_layer(settings.clouds); !ok) return ok;
  if (has_volumes() && (input.sky.sun_casts || input.sky.moon_casts))
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
        {"cloud constants", sizeof(constants_),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
         gpu::Memory::kDevice});
    if (!made) return made.error();
    constants_buffer_ = *std::move(made);
  }
  constants_ = cloud_constants(input, settings.clouds, sky, volumes_, packed_);
  uploader.write(constants_buffer_, 0, std::span<const shared::CloudConstants>(&constants_, 1));
  return {};
}

void Clouds::add_noise(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, CloudRefs& refs) {
  refs.weather = graph.import(weather_);
  refs.shapes = graph.import(shapes_);
  refs.billows = graph.import(billows_);
  if (noise_baked_) {
    for (const char* name : {"bake_cloud_noise", "pack_cloud_noise"})
      graph.leave_out(name, "it is kept from an earlier frame");
    return;
  }
  noise_baked_ = true;
  constexpr std::uint32_t kGroups = kNoiseEdge / kColumnGroup;
  gpu::ImageRef noise = graph.create(gpu::ImageDesc{.name = "cloud noise",
                                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                    .extent = {kNoiseEdge, kNoiseEdge},
                                                    .depth = kNoiseEdge});
  graph.add_pass(
      "bake_cloud_noise", [&](gpu::PassBuilder& b) { noise = b.write(noise, Use::kComputeWrite); },
      [noise,
       &pipeline = pipelines.get(gpu::ComputeDesc{"bake_cloud_noise.comp", {}})](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, noise);
        c.dispatch(kGroups, kGroups, kNoiseEdge);
      });
  graph.add_pass(
      "pack_cloud_noise",
      [&](gpu::PassBuilder& b) {
        b.read(noise, Use::kComputeSampled);
        for (gpu::ImageRef* ref : {&refs.weather, &refs.shapes, &refs.billows})
          *ref = b.write(*ref, Use::kComputeWrite);
      },
      [noise, refs,
       &pipeline = pipelines.get(gpu::ComputeDesc{"pack_cloud_noise.comp", {}})](gpu::Commands& c) {
        c.bind(pipeline);
        c.sampled(0, noise, refs.nearest);
        c.storage(1, refs.weather);
        for (std::uint32_t layer = 0; layer < shared::kCloudNoiseLayers; ++layer) {
          c.storage(2, refs.shapes, 0, layer);
          c.storage(3, refs.billows, 0, layer);
          c.push(layer);
          c.dispatch(kGroups, kGroups, 1);
        }
      });
}

void Clouds::add_layer_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t body,
                             CloudRefs& refs) const {
  graph.add_pass(
      body == 0 ? "trace_cloud_layer_sun" : "trace_cloud_layer_moon",
      [&](gpu::PassBuilder& b) {
        b.read(refs.constants, Use::kComputeRead);
        for (const gpu::ImageRef ref : {refs.weather, refs.shapes, refs.billows})
          b.read(ref, Use::kComputeSampled);
        refs.layer_light = b.write(refs.layer_light, Use::kComputeWrite);
      },
      [refs, body, &pipeline = pipelines.get(gpu::ComputeDesc{"trace_cloud_layer.comp", {}})](
          gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, refs.constants);
        c.sampled(1, refs.weather, refs.repeating);
        c.storage(2, refs.layer_light);
        c.sampled(3, refs.shapes, refs.repeating);
        c.sampled(4, refs.billows, refs.repeating);
        c.push(body);
        const std::uint32_t groups = shared::kLayerLightEdge / kColumnGroup;
        c.dispatch(groups, groups, 1);
      });
}

void Clouds::add_volume_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              std::uint32_t bodies, CloudRefs& refs) {
  std::vector<std::pair<shared::CloudLightJob, glm::ivec3>> jobs;
  for (std::uint32_t v = 0; v < refs.volumes; ++v)
    for (std::uint32_t body = 0; body < shared::kBodyCount; ++body) {
      if (!(bodies & 1u << body)) continue;
      const LitAs now{true, constants_.lights[body].to_light, constants_.shadow_steps,
                      constants_.volumes[v].extinction};
      if (lit_[v][body] == now) continue;
      lit_[v][body] = now;
      jobs.push_back({{v, body}, packed_[v].light_texels});
    }
  if (jobs.empty()) {
    graph.leave_out("trace_cloud_volumes", "kept from an earlier frame: the light has not moved");
    return;
  }
  graph.add_pass(
      "trace_cloud_volumes",
      [&](gpu::PassBuilder& b) {
        for (const gpu::ImageRef ref : {refs.cells, refs.bricks}) b.read(ref, Use::kComputeSampled);
        b.read(refs.constants, Use::kComputeRead);
        refs.volume_light = b.write(refs.volume_light, Use::kComputeWrite);
      },
      [refs, jobs, &pipeline = pipelines.get(gpu::ComputeDesc{"trace_cloud_volume.comp", {}})](
          gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(3, refs.constants);
        c.sampled(11, refs.cells, refs.nearest);
        c.sampled(13, refs.bricks, refs.linear);
        c.storage(14, refs.volume_light);
        for (const auto& [job, texels] : jobs) {
          c.push(job);
          c.dispatch(gpu::Commands::groups(static_cast<std::uint32_t>(texels.x), kLightGroup),
                     gpu::Commands::groups(static_cast<std::uint32_t>(texels.y), kLightGroup),
                     gpu::Commands::groups(static_cast<std::uint32_t>(texels.z), kLightGroup));
        }
      });
}

void Clouds::add_light_of_bodies(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                 std::uint32_t bodies, CloudRefs& refs) {
  if (bodies == 0) {
    for (const char* name : {"trace_cloud_layer", "trace_cloud_volumes"})
      graph.leave_out(name, "neither sun nor moon gives light");
    return;
  }
  for (std::uint32_t body = 0; refs.layer && body < shared::kBodyCount; ++body)
    if (bodies & 1u << body) add_layer_light(graph, pipelines, body, refs);
  if (refs.volumes == 0) return;
  refs.volume_light = graph.import(volume_light_);
  add_volume_light(graph, pipelines, bodies, refs);
}

CloudRefs Clouds::add_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene) {
  CloudRefs refs;
  refs.constants = graph.import(constants_buffer_);
  refs.repeating = repeating_;
  refs.linear = linear_;
  refs.nearest = nearest_;
  refs.layer = layer_;
  refs.volumes = static_cast<std::uint32_t>(volumes_.size());
  SKERRY_ASSERT(refs.layer || refs.volumes != 0);
  if (refs.layer) {
    add_noise(graph, pipelines, refs);
    refs.layer_light = graph.import(layer_light_);
  }
  if (refs.volumes != 0) {
    refs.bricks = graph.import(bricks_);
    refs.cells = graph.import(cells_);
  }
  add_light_of_bodies(graph, pipelines, scene.bodies, refs);
  // What there is none of is never read; something is bound so that every binding is valid.
  if (!refs.layer) {
    refs.weather = scene.sky_lut;
    refs.shapes = refs.billows = scene.block_textures;
    refs.layer_light = refs.bricks;
  }
  if (refs.volumes == 0) refs.bricks = refs.cells = refs.layer_light;
  if (!refs.volume_light) refs.volume_light = refs.bricks;
  return refs;
}

}  // namespace skerry::render
