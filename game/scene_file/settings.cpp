#include "game/scene_file/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/core/check.h"
#include "game/scene_file/parse.h"
#include "world/voxel/coords.h"

namespace skerry::game {
namespace {

constexpr std::array<std::string_view, 2> kShadingNames{"pbr", "flat"};
constexpr std::array<std::string_view, 13> kDebugViewNames{
    "none",     "albedo", "normal", "position", "metadata",    "emissive", "depth",
    "cascades", "shadow", "ao",     "clusters", "light_count", "exposure"};
constexpr std::array<std::string_view, 3> kUploadNames{"update", "staging", "mapped"};
constexpr std::array<std::string_view, 3> kRendererNames{"deferred", "auto", "reference"};
constexpr std::array<std::string_view, 2> kFilterNames{"pixel", "centre"};
constexpr std::array<std::string_view, 2> kToneNames{"aces", "agx"};
constexpr std::array<std::string_view, 2> kSwitchNames{"0", "1"};
constexpr std::array<std::string_view, 3> kIndirectNames{"off", "sky", "full"};

constexpr std::array<std::string_view, 6> kNormalNames{"exact", "oct8",    "oct16",
                                                       "rgb8",  "rgb10a2", "rgba16f"};
constexpr std::array<std::string_view, 3> kPositionNames{"depth", "rgba16f", "rgba32f"};
constexpr std::array<std::string_view, 2> kDepthNames{"d32", "d16"};
constexpr std::array<std::string_view, 3> kSampleNames{"1", "4", "16"};
constexpr std::array<std::string_view, 4> kTileNames{"8", "16", "32", "64"};
constexpr std::array<std::string_view, 2> kResolutionNames{"full", "half"};
constexpr std::array<std::string_view, 3> kPrecisionNames{"8", "16", "32"};
constexpr std::array<std::string_view, 3> kRateNames{"1", "2", "4"};
constexpr std::array<std::string_view, 5> kTapNames{"1", "4", "8", "16", "32"};

constexpr std::array<QualityLevel, 4> kLevels{
    {{"low", 400, 128, 1024, 0.0f, 1, 16, 2, 0.5},
     {"medium", 1000, 192, 2048, 0.0f, 4, 24, 2, 1.0},
     {"high", 2000, 320, 4096, 0.1f, 8, 48, 1, 1.0},
     {"ultra", 4000, 512, 4096, 0.1f, render::kEveryLight, 96, 1, 1.0}}};

std::string listed(std::span<const std::string_view> names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The index of a name among the accepted ones; the error names the nearest.
Result<std::size_t> parse_name(std::string_view text, std::string_view what,
                               std::span<const std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == text) return i;
  }
  return Error{fmt::format("{} cannot be {}: did you mean '{}'? It takes {}", what,
                           quote_text(text), nearest_name(text, names), listed(names))};
}

template <class T>
Result<void> into(const Result<std::int64_t>& parsed, T& field) {
  if (!parsed) return parsed.error();
  field = static_cast<T>(*parsed);
  return {};
}

template <class E>
Result<void> into_name(const Result<std::size_t>& parsed, E& field) {
  if (!parsed) return parsed.error();
  field = static_cast<E>(*parsed);
  return {};
}

template <class T>
Result<void> into_number(const Result<double>& parsed, T& field) {
  if (!parsed) return parsed.error();
  field = static_cast<T>(*parsed);
  return {};
}

Result<void> parse_offset(std::string_view text, Settings& s) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3) {
    return Error{
        fmt::format("world.offset cannot be {}: give whole blocks X,Y,Z", quote_text(text))};
  }
  std::array<std::int64_t, 3> offset{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto part =
        parse_integer(parts[axis], "world.offset", -world::kMaxBlock, world::kMaxBlock);
    if (!part) return part.error();
    offset[axis] = *part;
  }
  s.world_offset = offset;
  return {};
}

Result<void> parse_islands(std::string_view text, Settings& s) {
  if (text == "all") {
    s.world_islands.reset();
    return {};
  }
  std::uint32_t count = 0;
  const Result<void> done =
      into(parse_integer(text, "world.islands ('all' or a count)", 0, 100000), count);
  if (done) s.world_islands = count;
  return done;
}

Result<void> parse_memory_budget(std::string_view text, Settings& s) {
  if (text == "auto") {
    s.memory_budget_mib.reset();
    return {};
  }
  std::uint32_t mib = 0;
  const Result<void> done =
      into(parse_integer(text, "memory.budget ('auto' or MiB)", 8, 1 << 20), mib);
  if (done) s.memory_budget_mib = mib;
  return done;
}

Result<void> parse_exposure(std::string_view text, Settings& s) {
  if (text == "auto") {
    s.exposure_ev.reset();
    return {};
  }
  double stops = 0.0;
  const Result<void> done =
      into_number(parse_number(text, "exposure ('auto' or stops)", -20.0, 20.0), stops);
  if (done) s.exposure_ev = stops;
  return done;
}

Result<void> parse_shadow_size(std::string_view text, Settings& s) {
  const auto size = parse_integer(text, "shadow.size", 256, 8192);
  if (!size) return size.error();
  if ((*size & (*size - 1)) != 0) {
    return Error{fmt::format("shadow.size cannot be {}: give a power of two from 256 to 8192",
                             quote_text(text))};
  }
  s.shadow_size = static_cast<std::uint32_t>(*size);
  return {};
}

Result<void> parse_shadow_taps(std::string_view text, Settings& s) {
  const auto name = parse_name(text, "shadow.taps", kTapNames);
  if (!name) return name.error();
  return into(parse_integer(kTapNames[*name], "shadow.taps", 1, 32), s.shadow_taps);
}

Result<void> parse_samples(std::string_view text, Settings& s) {
  const auto name = parse_name(text, "aa.samples", kSampleNames);
  if (!name) return name.error();
  return into(parse_integer(kSampleNames[*name], "aa.samples", 1, 16), s.aa_samples);
}

Result<void> parse_leave_out(std::string_view text, Settings& s) {
  render::FeatureSet set;
  if (text != "none") {
    for (const std::string& part : split(text, '+')) {
      const auto name = parse_name(part, "leave.out", render::kFeatureNames);
      if (!name) return name.error();
      set.add(static_cast<render::Feature>(*name));
    }
  }
  s.leave_out = set;
  return {};
}

Result<void> parse_cloud_resolution(std::string_view text, Settings& s) {
  const auto name = parse_name(text, "clouds.resolution", kResolutionNames);
  if (!name) return name.error();
  s.clouds.resolution = static_cast<int>(*name) + 1;
  return {};
}

Result<void> parse_cloud_precision(std::string_view text, Settings& s) {
  const auto name = parse_name(text, "clouds.precision", kPrecisionNames);
  if (!name) return name.error();
  s.clouds.precision = 8 << *name;
  return {};
}

Result<void> parse_lights_shadows(std::string_view text, Settings& s) {
  constexpr std::string_view kNearest = "nearest:";
  if (text == "off" || text == "all") {
    s.lights_shadows = text == "all" ? render::kEveryLight : 0;
    return {};
  }
  if (text.starts_with(kNearest))
    return into(parse_integer(text.substr(kNearest.size()), "lights.shadows nearest:", 1, 8),
                s.lights_shadows);
  constexpr std::array<std::string_view, 3> kNames{"off", "nearest:4", "all"};
  return Error{
      fmt::format("lights.shadows cannot be {}: did you mean '{}'? It takes off, "
                  "nearest:1 to nearest:8, all",
                  quote_text(text), nearest_name(text, kNames))};
}

std::string print_lights_shadows(const Settings& s) {
  if (s.lights_shadows == 0) return "off";
  if (s.lights_shadows == render::kEveryLight) return "all";
  return fmt::format("nearest:{}", s.lights_shadows);
}

std::string print_leave_out(const Settings& s) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < render::kFeatureNames.size(); ++i)
    if (s.leave_out.has(static_cast<render::Feature>(i))) names.push_back(render::kFeatureNames[i]);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, "+"));
}

Result<void> parse_renderer(std::string_view text, Settings& s) {
  if (text == "forward") {
    return Error{"renderer=forward is not in this build: use deferred, auto or reference"};
  }
  return into_name(parse_name(text, "renderer", kRendererNames), s.renderer);
}

constexpr SettingKey kKeys[] = {
    {"world.offset", "X,Y,Z: whole blocks, -2^40 to 2^40 each",
     "Moves every island. With the camera moved alike the picture is the same, bit for bit.",
     parse_offset,
     [](const Settings& s) { return fmt::format("{}", fmt::join(s.world_offset, ",")); }},
    {"world.islands", "all, or 0 to 100000",
     "Keeps only so many islands, nearest to the spawn first.", parse_islands,
     [](const Settings& s) {
       return s.world_islands ? std::to_string(*s.world_islands) : std::string("all");
     }},
    {"world.time", "seconds, -1e9 to 1e9", "How long the islands have drifted and turned.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "world.time", -1e9, 1e9), s.world_time_s);
     },
     [](const Settings& s) { return fmt::format("{}", s.world_time_s); }},
    {"sky.moon_phase", "0 to 1", "0 new moon, 0.5 full moon, 1 new moon again.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "sky.moon_phase", 0.0, 1.0), s.moon_phase);
     },
     [](const Settings& s) { return fmt::format("{}", s.moon_phase); }},
    {"view.distance", "blocks, 32 to 16384", "Nothing farther than this is drawn.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "view.distance", kMinViewDistance, kMaxViewDistance),
                   s.view_distance);
     },
     [](const Settings& s) { return std::to_string(s.view_distance); }},
    {"view.detail", "blocks, 32 to 4096",
     "Full detail up to here; each doubling halves the detail.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "view.detail", 32, 4096), s.view_detail);
     },
     [](const Settings& s) { return std::to_string(s.view_detail); }},
    {"aa.samples", "1, 4 or 16",
     "Samples a pixel: the picture is drawn twice or four times as wide and high, and averaged. "
     "For stills; the time grows alike.",
     parse_samples, [](const Settings& s) { return std::to_string(s.aa_samples); }},
    {"render.scale", "0.25 to 1",
     "Edges of the picture that is drawn, as a share of those of the picture that is shown: below "
     "1 "
     "it is enlarged. Text keeps every pixel.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "render.scale", 0.25, 1.0), s.render_scale);
     },
     [](const Settings& s) { return fmt::format("{}", s.render_scale); }},
    {"shadow.enabled", "0 or 1", "Shadows of the sun and the moon.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "shadow.enabled", kSwitchNames), s.shadow_enabled);
     },
     [](const Settings& s) { return std::string(s.shadow_enabled ? "1" : "0"); }},
    {"shadow.size", "a power of two, 256 to 8192", "Texels along the edge of one shadow map.",
     parse_shadow_size, [](const Settings& s) { return std::to_string(s.shadow_size); }},
    {"shadow.cascades", "1 to 4",
     "Shadow maps a light has. Fewer cover the same view distance with larger texels.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "shadow.cascades", 1, 4), s.shadow_cascades);
     },
     [](const Settings& s) { return std::to_string(s.shadow_cascades); }},
    {"shadow.taps", "1, 4, 8, 16 or 32", "Texels of the shadow map that a pixel compares with.",
     parse_shadow_taps, [](const Settings& s) { return std::to_string(s.shadow_taps); }},
    {"shadow.samples", "1 to 1024",
     "Places on the discs of sun and moon that light comes from: so many whole frames are "
     "averaged, "
     "each with shadows of its own. For stills.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "shadow.samples", 1, 1024), s.shadow_samples);
     },
     [](const Settings& s) { return std::to_string(s.shadow_samples); }},
    {"shadow.split", "0 to 1",
     "How the maps share the view distance: 0 evenly, 1 each a multiple of the one before.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "shadow.split", 0.0, 1.0), s.shadow_split);
     },
     [](const Settings& s) { return fmt::format("{}", s.shadow_split); }},
    {"shadow.blur", "blocks, 0 to 1",
     "Largest radius of the shadow filter. It is as wide as the sun's disc blurs a shadow's edge, "
     "one "
     "texel at least; 0: one texel everywhere.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "shadow.blur", 0.0, 1.0), s.shadow_blur);
     },
     [](const Settings& s) { return fmt::format("{}", s.shadow_blur); }},
    {"texture.taps", "1 to 16", "Samples along the long side of a slanted texture, at most.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "texture.taps", 1, 16), s.texture_taps);
     },
     [](const Settings& s) { return std::to_string(s.texture_taps); }},
    {"gbuffer.normal", "exact, oct8, oct16, rgb8, rgb10a2 or rgba16f",
     "For measuring: how normals are kept between drawing and shading. exact: not at all.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "gbuffer.normal", kNormalNames), s.gbuffer.normal);
     },
     [](const Settings& s) {
       return std::string(kNormalNames[static_cast<std::size_t>(s.gbuffer.normal)]);
     }},
    {"gbuffer.position", "depth, rgba16f or rgba32f",
     "For measuring: where shading takes positions from.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "gbuffer.position", kPositionNames), s.gbuffer.position);
     },
     [](const Settings& s) {
       return std::string(kPositionNames[static_cast<std::size_t>(s.gbuffer.position)]);
     }},
    {"gbuffer.depth", "d32 or d16",
     "For measuring: bits of a depth. With 16, positions are wrong by blocks in the distance.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "gbuffer.depth", kDepthNames), s.gbuffer.depth);
     },
     [](const Settings& s) {
       return std::string(kDepthNames[static_cast<std::size_t>(s.gbuffer.depth)]);
     }},
    {"lights.random", "0 to 1000000",
     "For measuring: so many torches on the surfaces that the first view sees.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "lights.random", 0, 1'000'000), s.lights_random);
     },
     [](const Settings& s) { return std::to_string(s.lights_random); }},
    {"lights.held", "0 or 1", "A torch in the hand.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "lights.held", kSwitchNames), s.lights_held);
     },
     [](const Settings& s) { return std::string(s.lights_held ? "1" : "0"); }},
    {"ao.strength", "0 to 0.9",
     "How much light a closed corner of blocks takes; 0: corners are as bright as faces.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "ao.strength", 0.0, 0.9), s.ao_strength);
     },
     [](const Settings& s) { return fmt::format("{}", s.ao_strength); }},
    {"indirect", "off, sky or full",
     "Light of the whole sky, as far as each face sees it; full: weak lamps go with it, which is "
     "cheaper; off: sun, moon and lamps alone.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "indirect", kIndirectNames), s.indirect);
     },
     [](const Settings& s) {
       return std::string(kIndirectNames[static_cast<std::size_t>(s.indirect)]);
     }},
    {"exposure", "auto, or stops from -20 to 20",
     "Metered, or fixed: each stop doubles the brightness.", parse_exposure,
     [](const Settings& s) {
       return s.exposure_ev ? fmt::format("{}", *s.exposure_ev) : std::string("auto");
     }},
    {"exposure.key", "0.01 to 1", "What the meter exposes a landscape under the noon sun to.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "exposure.key", 0.01, 1.0), s.meter.key);
     },
     [](const Settings& s) { return fmt::format("{}", s.meter.key); }},
    {"exposure.min", "stops, -20 to 20", "Darkest light the meter adapts to.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "exposure.min", -20.0, 20.0), s.meter.min_ev);
     },
     [](const Settings& s) { return fmt::format("{}", s.meter.min_ev); }},
    {"exposure.max", "stops, -20 to 20", "Brightest light the meter adapts to; min wins over it.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "exposure.max", -20.0, 20.0), s.meter.max_ev);
     },
     [](const Settings& s) { return fmt::format("{}", s.meter.max_ev); }},
    {"exposure.stride", "1 to 16", "The meter looks at one pixel of each stride x stride.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "exposure.stride", 1, 16), s.meter.stride);
     },
     [](const Settings& s) { return std::to_string(s.meter.stride); }},
    {"bloom.intensity", "0 to 1", "How much of the light over the threshold glows; 0: no bloom.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "bloom.intensity", 0.0, 1.0), s.bloom.intensity);
     },
     [](const Settings& s) { return fmt::format("{}", s.bloom.intensity); }},
    {"bloom.threshold", "0 to 100",
     "Exposed brightness from which on light glows; white is about 4.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "bloom.threshold", 0.0, 100.0), s.bloom.threshold);
     },
     [](const Settings& s) { return fmt::format("{}", s.bloom.threshold); }},
    {"bloom.levels", "1 to 8", "How far light glows: each level doubles it.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "bloom.levels", 1, 8), s.bloom.levels);
     },
     [](const Settings& s) { return std::to_string(s.bloom.levels); }},
    {"clouds.coverage", "0 to 1",
     "Share of the sky that the cloud layer covers; 0: there is no layer.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.coverage", 0.0, 1.0), s.clouds.coverage);
     },
     [](const Settings& s) { return fmt::format("{}", s.clouds.coverage); }},
    {"clouds.altitude", "blocks, -1000000 to 1000000",
     "Where the layer's clouds begin, above the world's origin.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.altitude", -1e6, 1e6), s.clouds.altitude);
     },
     [](const Settings& s) { return fmt::format("{}", s.clouds.altitude); }},
    {"clouds.thickness", "blocks, 1 to 10000",
     "How high the layer's highest clouds reach above that.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.thickness", 1.0, 10000.0), s.clouds.thickness);
     },
     [](const Settings& s) { return fmt::format("{}", s.clouds.thickness); }},
    {"clouds.density", "1/block, 0 to 10000", "Extinction in the middle of the layer's clouds.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.density", 0.0, 1e4), s.clouds.density);
     },
     [](const Settings& s) { return fmt::format("{}", s.clouds.density); }},
    {"clouds.file_density", "1/block, 0 to 10000", "Extinction of density 1 in clouds of files.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.file_density", 0.0, 1e4), s.clouds.file_density);
     },
     [](const Settings& s) { return fmt::format("{}", s.clouds.file_density); }},
    {"clouds.file_emission", "radiance/block, 0 to 10000",
     "What the hottest place of a file's fire sends out.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.file_emission", 0.0, 1e4),
                          s.clouds.file_emission);
     },
     [](const Settings& s) { return fmt::format("{}", s.clouds.file_emission); }},
    {"clouds.steps", "8 to 1024",
     "Steps of a ray through the layer, or through a file's cloud; each looks at four places.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "clouds.steps", 8, 1024), s.clouds.steps);
     },
     [](const Settings& s) { return std::to_string(s.clouds.steps); }},
    {"clouds.shadow_steps", "4 to 128", "Places along the light's way through a cloud.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "clouds.shadow_steps", 4, 128), s.clouds.shadow_steps);
     },
     [](const Settings& s) { return std::to_string(s.clouds.shadow_steps); }},
    {"clouds.resolution", "full or half",
     "A ray through clouds for every pixel, or for every second one each way and along edges.",
     parse_cloud_resolution,
     [](const Settings& s) {
       return std::string(kResolutionNames[static_cast<std::size_t>(s.clouds.resolution - 1)]);
     }},
    {"clouds.precision", "8, 16 or 32", "Bits that a density of a file's cloud is kept in.",
     parse_cloud_precision, [](const Settings& s) { return std::to_string(s.clouds.precision); }},
    {"tone", "aces or agx", "Tone curve: from exposed light to what a display can show.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "tone", kToneNames), s.tone);
     },
     [](const Settings& s) { return std::string(kToneNames[static_cast<std::size_t>(s.tone)]); }},
    {"display.peak", "0.1 to 1",
     "Brightest light of the picture, as a share of the display's white.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "display.peak", kMinDisplayPeak, 1.0), s.display.peak);
     },
     [](const Settings& s) { return fmt::format("{}", s.display.peak); }},
    {"display.black", "0 to 0.2",
     "Darkest sRGB value that can be told from black on the display; black stays black.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "display.black", 0.0, kMaxDisplayBlack), s.display.black);
     },
     [](const Settings& s) { return fmt::format("{}", s.display.black); }},
    {"renderer", "deferred, auto or reference",
     "How the picture is made: on the GPU, or exactly on the CPU (screenshots only). auto is "
     "deferred.",
     parse_renderer,
     [](const Settings& s) {
       return std::string(kRendererNames[static_cast<std::size_t>(s.renderer)]);
     }},
    {"shading", "pbr or flat",
     "flat: light colour times shadow, without the surface's angle to the light.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "shading", kShadingNames), s.shading);
     },
     [](const Settings& s) {
       return std::string(kShadingNames[static_cast<std::size_t>(s.shading)]);
     }},
    {"shading.rate", "1, 2 or 4",
     "Pixels along a block whose light is worked out once where its neighbours agree; textures and "
     "edges keep every pixel.",
     [](std::string_view t, Settings& s) {
       const auto name = parse_name(t, "shading.rate", kRateNames);
       if (!name) return Result<void>(name.error());
       return into(parse_integer(kRateNames[*name], "shading.rate", 1, 4), s.shading_rate);
     },
     [](const Settings& s) { return std::to_string(s.shading_rate); }},
    {"shading.tolerance", "0 to 1",
     "Light that may differ within such a block, as a share of the brightest. 0: every pixel is "
     "lit by itself where light differs at all.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "shading.tolerance", 0.0, 1.0), s.shading_tolerance);
     },
     [](const Settings& s) { return fmt::format("{}", s.shading_tolerance); }},
    {"debug.view",
     "none, albedo, normal, position, metadata, emissive, depth, cascades, shadow, ao, clusters, "
     "light_count or exposure",
     "Shows one ingredient of the picture instead of the picture; exposure: the meter over it.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "debug.view", kDebugViewNames), s.debug_view);
     },
     [](const Settings& s) {
       return std::string(kDebugViewNames[static_cast<std::size_t>(s.debug_view)]);
     }},
    {"lights.shadows", "off, nearest:1 to nearest:8, or all",
     "Walls block lights: none, those that light a pixel most, or all. With nearest:N, the others "
     "are dimmed by as much.",
     parse_lights_shadows, print_lights_shadows},
    {"lights.softness", "1 to 16",
     "Ways looked along to a light that has a size: more give softer shadows.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "lights.softness", 1, 16), s.lights_softness);
     },
     [](const Settings& s) { return std::to_string(s.lights_softness); }},
    {"lights.tile", "8, 16, 32 or 64",
     "Pixels along the tiles that lights are sorted into; changes no picture, only its cost.",
     [](std::string_view t, Settings& s) {
       const auto name = parse_name(t, "lights.tile", kTileNames);
       if (!name) return Result<void>(name.error());
       return into(parse_integer(kTileNames[*name], "lights.tile", 8, 64), s.lights_tile);
     },
     [](const Settings& s) { return std::to_string(s.lights_tile); }},
    {"lights.oracle", "0 or 1",
     "For measuring: every pixel asks every light, instead of those of its cluster.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "lights.oracle", kSwitchNames), s.lights_oracle);
     },
     [](const Settings& s) { return std::string(s.lights_oracle ? "1" : "0"); }},
    {"leave.out",
     "none, or of sun, moon, water, cutouts, stars, discs, haze, lights, clouds, joined by +",
     "Draws as if the scene had none of these.", parse_leave_out, print_leave_out},
    {"upload.path", "update, staging or mapped",
     "How meshes travel to the GPU: vkCmdUpdateBuffer, copies, mapped memory.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "upload.path", kUploadNames), s.upload_path);
     },
     [](const Settings& s) {
       return std::string(kUploadNames[static_cast<std::size_t>(s.upload_path)]);
     }},
    {"upload.budget", "bytes, 65536 to 1073741824", "The most that travels in one frame.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "upload.budget", 65536, 1 << 30), s.upload_budget_bytes);
     },
     [](const Settings& s) { return std::to_string(s.upload_budget_bytes); }},
    {"memory.budget", "auto, or MiB from 8 to 1048576",
     "Most device memory that the world takes; auto: five eighths of what the device has. When it "
     "is full, the farthest detail goes first.",
     parse_memory_budget,
     [](const Settings& s) {
       return s.memory_budget_mib ? std::to_string(*s.memory_budget_mib) : std::string("auto");
     }},
    {"jobs.threads", "0 to 256",
     "Worker threads; 0 takes one a core. The picture does not depend on it.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "jobs.threads", 0, 256), s.jobs_threads);
     },
     [](const Settings& s) { return std::to_string(s.jobs_threads); }},
    {"water.layers", "1 to 4",
     "How many water and glass surfaces one behind another a pixel shows.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "water.layers", 1, 4), s.water_layers);
     },
     [](const Settings& s) { return std::to_string(s.water_layers); }},
    {"reference.samples", "1 to 65536", "Samples a pixel of renderer=reference.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "reference.samples", 1, 65536), s.reference_samples);
     },
     [](const Settings& s) { return std::to_string(s.reference_samples); }},
    {"reference.filter", "pixel or centre",
     "Whether renderer=reference averages geometry over the pixel or samples it at the centre, as "
     "the GPU does.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "reference.filter", kFilterNames), s.reference_filter);
     },
     [](const Settings& s) {
       return std::string(kFilterNames[static_cast<std::size_t>(s.reference_filter)]);
     }},
};

}  // namespace

std::span<const SettingKey> setting_keys() {
  return kKeys;
}

Result<void> apply_setting(std::string_view key, std::string_view value, Settings& settings) {
  std::vector<std::string_view> names;
  for (const SettingKey& entry : kKeys) {
    if (entry.key == key) return entry.parse(value, settings);
    names.push_back(entry.key);
  }
  return Error{fmt::format("there is no setting {}: did you mean '{}'? docs/settings.md lists all",
                           quote_text(key), nearest_name(key, names))};
}

Result<void> apply_setting(std::string_view assignment, Settings& settings) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return Error{
        fmt::format("the setting {} has no value: give KEY=VALUE", quote_text(assignment))};
  }
  return apply_setting(assignment.substr(0, equals), assignment.substr(equals + 1), settings);
}

const QualityLevel& quality_level(Quality quality) {
  return kLevels[static_cast<std::size_t>(quality)];
}

Result<Quality> parse_quality(std::string_view text) {
  std::array<std::string_view, kLevels.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kLevels[i].name;
  const Result<std::size_t> level = parse_name(text, "the quality", names);
  if (!level) return level.error();
  return static_cast<Quality>(*level);
}

Settings settings_of(Quality quality) {
  Settings settings;
  set_quality(quality, settings);
  return settings;
}

void set_quality(Quality quality, Settings& settings) {
  const QualityLevel& level = quality_level(quality);
  settings.view_distance = level.view_distance;
  settings.view_detail = level.view_detail;
  settings.shadow_size = level.shadow_size;
  settings.render_scale = level.render_scale;
  settings.bloom.intensity = level.bloom_intensity;
  settings.lights_shadows = level.lights_shadows;
  settings.clouds.steps = level.cloud_steps;
  settings.clouds.resolution = level.cloud_resolution;
}

std::vector<std::string> assignments_from(Quality quality, const Settings& settings) {
  const Settings level = settings_of(quality);
  std::vector<std::string> assignments;
  for (const SettingKey& entry : kKeys) {
    const std::string value = entry.print(settings);
    if (value != entry.print(level)) assignments.push_back(fmt::format("{}={}", entry.key, value));
  }
  return assignments;
}

}  // namespace skerry::game
