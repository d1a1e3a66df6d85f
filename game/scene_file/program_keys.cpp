#include "game/scene_file/setting_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "game/scene_file/parse.h"
#include "game/scene_file/setting_values.h"

namespace skerry::game {
namespace {

constexpr std::array<std::string_view, 2> kShadingNames{"pbr", "flat"};
constexpr std::array<std::string_view, 13> kDebugViewNames{
    "none",     "albedo", "normal", "position", "metadata",    "emissive", "depth",
    "cascades", "shadow", "ao",     "clusters", "light_count", "exposure"};
constexpr std::array<std::string_view, 3> kSyncNames{"off", "on", "adaptive"};
constexpr std::array<std::string_view, 3> kUploadNames{"update", "staging", "mapped"};
constexpr std::array<std::string_view, 3> kRendererNames{"deferred", "auto", "reference"};
constexpr std::array<std::string_view, 2> kFilterNames{"pixel", "centre"};
constexpr std::array<std::string_view, 2> kMirrorNames{"sky", "world"};
constexpr std::array<std::string_view, 4> kRateNames{"1", "2", "3", "4"};
constexpr std::array<std::string_view, 4> kTileNames{"8", "16", "32", "64"};

Result<void> parse_memory_budget(std::string_view text, Settings& s) {
  if (text != "auto")
    return into(parse_integer(text, "memory.budget ('auto' or MiB)", 8, 1 << 20),
                s.memory_budget_mib);
  s.memory_budget_mib.reset();
  return {};
}

Result<void> parse_wanted_rate(std::string_view text, Settings& s) {
  using F = FrameSettings;
  if (text != "auto")
    return into(parse_integer(text, "frames.wanted ('auto' or frames a second)", F::kLeastRate,
                              F::kMostRate),
                s.frames.wanted);
  s.frames.wanted.reset();
  return {};
}

Result<void> parse_frame_cap(std::string_view text, Settings& s) {
  using F = FrameSettings;
  if (text == "off" || text == "display") {
    s.frames.cap = text == "off" ? F::kNoCap : F::kDisplayCap;
    return {};
  }
  return into(parse_integer(text, "frames.cap ('display', 'off' or frames a second)", F::kLeastRate,
                            F::kMostRate),
              s.frames.cap);
}

std::string print_frame_cap(const Settings& s) {
  if (s.frames.cap == FrameSettings::kNoCap) return "off";
  if (s.frames.cap == FrameSettings::kDisplayCap) return "display";
  return std::to_string(s.frames.cap);
}

Result<void> parse_lights_shadows(std::string_view text, Settings& s) {
  constexpr std::string_view kNearest = "nearest:";
  if (text == "off" || text == "all") {
    s.render.lights_shadows = text == "all" ? render::kEveryLight : 0;
    return {};
  }
  if (text.starts_with(kNearest))
    return into(parse_integer(text.substr(kNearest.size()), "lights.shadows nearest:", 1, 8),
                s.render.lights_shadows);
  constexpr std::array<std::string_view, 3> kNames{"off", "nearest:4", "all"};
  return Error{
      fmt::format("lights.shadows cannot be {}: did you mean '{}'? It takes off, "
                  "nearest:1 to nearest:8, all",
                  quote_text(text), nearest_name(text, kNames))};
}

std::string print_lights_shadows(const Settings& s) {
  if (s.render.lights_shadows == 0) return "off";
  if (s.render.lights_shadows == render::kEveryLight) return "all";
  return fmt::format("nearest:{}", s.render.lights_shadows);
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
  s.render.leave_out = set;
  return {};
}

std::string print_leave_out(const Settings& s) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < render::kFeatureNames.size(); ++i)
    if (s.render.leave_out.has(static_cast<render::Feature>(i)))
      names.push_back(render::kFeatureNames[i]);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, "+"));
}

Result<void> parse_renderer(std::string_view text, Settings& s) {
  if (text == "forward") {
    return Error{"renderer=forward is not in this build: use deferred, auto or reference"};
  }
  return into_name(parse_name(text, "renderer", kRendererNames), s.renderer);
}

constexpr SettingKey kProgramKeys[] = {
    {"renderer", "deferred, auto or reference",
     "How the picture is made: on the GPU, or exactly on the CPU (screenshots only). auto is "
     "deferred.",
     parse_renderer, [](const Settings& s) { return name_of(kRendererNames, s.renderer); }},
    {"shading", "pbr or flat",
     "flat: light colour times shadow, without the surface's angle to the light.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "shading", kShadingNames), s.render.shading);
     },
     [](const Settings& s) { return name_of(kShadingNames, s.render.shading); }},
    {"shading.rate", "1, 2, 3 or 4",
     "Pixels along a square that takes its light from its corners where they are lit alike; "
     "textures and edges keep every pixel.",
     [](std::string_view t, Settings& s) {
       return into_listed(t, "shading.rate", kRateNames, s.render.shading_rate);
     },
     [](const Settings& s) { return std::to_string(s.render.shading_rate); }},
    {"shading.tolerance", "0 to 1",
     "Light that may differ between such corners, as a share of the brightest. 0: every pixel is "
     "lit by itself.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "shading.tolerance", 0.0, 1.0),
                          s.render.shading_tolerance);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.shading_tolerance); }},
    {"debug.view",
     "none, albedo, normal, position, metadata, emissive, depth, cascades, shadow, ao, clusters, "
     "light_count or exposure",
     "Shows one ingredient of the picture instead of the picture; exposure: the meter over it.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "debug.view", kDebugViewNames), s.render.debug_view);
     },
     [](const Settings& s) { return name_of(kDebugViewNames, s.render.debug_view); }},
    {"lights.shadows", "off, nearest:1 to nearest:8, or all",
     "Walls block lights: none, those that light a pixel most, or all. With nearest:N, the others "
     "are dimmed by as much.",
     parse_lights_shadows, print_lights_shadows},
    {"lights.softness", "1 to 16",
     "Ways looked along to a light that has a size: more give softer shadows.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "lights.softness", 1, 16), s.render.lights_softness);
     },
     [](const Settings& s) { return std::to_string(s.render.lights_softness); }},
    {"lights.tile", "8, 16, 32 or 64",
     "Pixels along the tiles that lights are sorted into; changes no picture, only its cost.",
     [](std::string_view t, Settings& s) {
       return into_listed(t, "lights.tile", kTileNames, s.render.lights_tile);
     },
     [](const Settings& s) { return std::to_string(s.render.lights_tile); }},
    {"lights.oracle", "0 or 1",
     "For measuring: every pixel asks every light, instead of those of its cluster.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "lights.oracle", kSwitchNames), s.render.lights_oracle);
     },
     [](const Settings& s) { return name_of(kSwitchNames, s.render.lights_oracle); }},
    {"leave.out",
     "none, or of sun, moon, water, cutouts, stars, discs, haze, lights, clouds, joined by +",
     "Draws as if the scene had none of these.", parse_leave_out, print_leave_out},
    {"upload.path", "update, staging or mapped",
     "How meshes travel to the GPU: vkCmdUpdateBuffer, copies, mapped memory.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "upload.path", kUploadNames), s.upload_path);
     },
     [](const Settings& s) { return name_of(kUploadNames, s.upload_path); }},
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
     "Worker threads; 0 takes one a core, from 8 cores on three quarters of them. The picture does "
     "not depend on it.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "jobs.threads", 0, 256), s.jobs_threads);
     },
     [](const Settings& s) { return std::to_string(s.jobs_threads); }},
    {"frames.wanted", "auto, or frames a second from 5 to 1000",
     "What quality auto aims at; auto: 30 on a CPU, as often as the display refreshes on a GPU.",
     parse_wanted_rate,
     [](const Settings& s) {
       return s.frames.wanted ? std::to_string(*s.frames.wanted) : std::string("auto");
     }},
    {"frames.cap", "display, off, or frames a second from 5 to 1000",
     "Most frames that play draws; display: as often as it refreshes.", parse_frame_cap,
     print_frame_cap},
    {"frames.unfocused", "frames a second, 1 to 1000",
     "Most frames that play draws while another window has the focus.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "frames.unfocused", 1, FrameSettings::kMostRate),
                   s.frames.unfocused);
     },
     [](const Settings& s) { return std::to_string(s.frames.unfocused); }},
    {"frames.sync", "off, on or adaptive",
     "Vertical sync. off: frames never wait for the display; on: always; adaptive: late ones do "
     "not.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "frames.sync", kSyncNames), s.frames.sync);
     },
     [](const Settings& s) { return name_of(kSyncNames, s.frames.sync); }},
    {"water.layers", "1 to 4",
     "How many water and glass surfaces one behind another a pixel shows.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "water.layers", 1, 4), s.render.water_layers);
     },
     [](const Settings& s) { return std::to_string(s.render.water_layers); }},
    {"water.mirror", "sky or world",
     "What water and glass mirror: the sky as far as they see it, or the world about them as well.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "water.mirror", kMirrorNames), s.render.water_mirror);
     },
     [](const Settings& s) { return name_of(kMirrorNames, s.render.water_mirror); }},
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
     [](const Settings& s) { return name_of(kFilterNames, s.reference_filter); }},
};

}  // namespace

std::span<const SettingKey> program_keys() {
  return kProgramKeys;
}

}  // namespace skerry::game
