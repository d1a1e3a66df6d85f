#include "game/scene_file/setting_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "game/scene_file/parse.h"
#include "game/scene_file/setting_values.h"

namespace skerry::game {
namespace {

constexpr std::array<std::string_view, 2> kToneNames{"aces", "agx"};
constexpr std::array<std::string_view, 2> kResolutionNames{"full", "half"};
constexpr std::array<std::string_view, 3> kPrecisionNames{"8", "16", "32"};

Result<void> parse_exposure(std::string_view text, Settings& s) {
  if (text != "auto")
    return into_number(parse_number(text, "exposure ('auto' or stops)", -20.0, 20.0),
                       s.exposure_ev);
  s.exposure_ev.reset();
  return {};
}

Result<void> parse_cloud_resolution(std::string_view text, Settings& s) {
  const auto name = parse_name(text, "clouds.resolution", kResolutionNames);
  if (!name) return name.error();
  s.render.clouds.resolution = static_cast<int>(*name) + 1;
  return {};
}

Result<void> parse_cloud_precision(std::string_view text, Settings& s) {
  const auto name = parse_name(text, "clouds.precision", kPrecisionNames);
  if (!name) return name.error();
  s.render.clouds.precision = 8 << *name;
  return {};
}

constexpr SettingKey kPictureKeys[] = {
    {"exposure", "auto, or stops from -20 to 20",
     "Metered, or fixed: each stop doubles the brightness.", parse_exposure,
     [](const Settings& s) {
       return s.exposure_ev ? fmt::format("{}", *s.exposure_ev) : std::string("auto");
     }},
    {"exposure.key", "0.01 to 1", "What the meter exposes a landscape under the noon sun to.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "exposure.key", 0.01, 1.0), s.render.meter.key);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.meter.key); }},
    {"exposure.min", "stops, -20 to 20", "Darkest light the meter adapts to.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "exposure.min", -20.0, 20.0), s.render.meter.min_ev);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.meter.min_ev); }},
    {"exposure.max", "stops, -20 to 20", "Brightest light the meter adapts to; min wins over it.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "exposure.max", -20.0, 20.0), s.render.meter.max_ev);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.meter.max_ev); }},
    {"exposure.stride", "1 to 16", "The meter looks at one pixel of each stride x stride.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "exposure.stride", 1, 16), s.render.meter.stride);
     },
     [](const Settings& s) { return std::to_string(s.render.meter.stride); }},
    {"bloom.intensity", "0 to 1", "How much of the light over the threshold glows; 0: no bloom.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "bloom.intensity", 0.0, 1.0), s.render.bloom.intensity);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.bloom.intensity); }},
    {"bloom.threshold", "0 to 100",
     "Exposed brightness from which on light glows; white is about 4.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "bloom.threshold", 0.0, 100.0), s.render.bloom.threshold);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.bloom.threshold); }},
    {"bloom.levels", "1 to 8", "How far light glows: each level doubles it.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "bloom.levels", 1, 8), s.render.bloom.levels);
     },
     [](const Settings& s) { return std::to_string(s.render.bloom.levels); }},
    {"clouds.coverage", "0 to 1",
     "Share of the sky that the cloud layer covers; 0: there is no layer.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.coverage", 0.0, 1.0), s.render.clouds.coverage);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.clouds.coverage); }},
    {"clouds.altitude", "blocks, -1000000 to 1000000",
     "Where the layer's clouds begin, above the world's origin.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.altitude", -1e6, 1e6), s.render.clouds.altitude);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.clouds.altitude); }},
    {"clouds.thickness", "blocks, 1 to 10000",
     "How high the layer's highest clouds reach above that.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.thickness", 1.0, 10000.0),
                          s.render.clouds.thickness);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.clouds.thickness); }},
    {"clouds.density", "1/block, 0 to 10000", "Extinction in the middle of the layer's clouds.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.density", 0.0, 1e4), s.render.clouds.density);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.clouds.density); }},
    {"clouds.file_density", "1/block, 0 to 10000", "Extinction of density 1 in clouds of files.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.file_density", 0.0, 1e4),
                          s.render.clouds.file_density);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.clouds.file_density); }},
    {"clouds.file_emission", "radiance/block, 0 to 10000",
     "What the hottest place of a file's fire sends out.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "clouds.file_emission", 0.0, 1e4),
                          s.render.clouds.file_emission);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.clouds.file_emission); }},
    {"clouds.steps", "8 to 1024",
     "Steps of a ray through the layer, or through a file's cloud; each looks at four places.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "clouds.steps", 8, 1024), s.render.clouds.steps);
     },
     [](const Settings& s) { return std::to_string(s.render.clouds.steps); }},
    {"clouds.shadow_steps", "4 to 128", "Places along the light's way through a cloud.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "clouds.shadow_steps", 4, 128), s.render.clouds.shadow_steps);
     },
     [](const Settings& s) { return std::to_string(s.render.clouds.shadow_steps); }},
    {"clouds.resolution", "full or half",
     "A ray through clouds for every pixel, or for every second one each way and along edges.",
     parse_cloud_resolution,
     [](const Settings& s) { return name_of(kResolutionNames, s.render.clouds.resolution - 1); }},
    {"clouds.precision", "8, 16 or 32", "Bits that a density of a file's cloud is kept in.",
     parse_cloud_precision,
     [](const Settings& s) { return std::to_string(s.render.clouds.precision); }},
    {"tone", "aces or agx", "Tone curve: from exposed light to what a display can show.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "tone", kToneNames), s.render.tone);
     },
     [](const Settings& s) { return name_of(kToneNames, s.render.tone); }},
    {"display.peak", "0.1 to 1",
     "Brightest light of the picture, as a share of the display's white.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "display.peak", kMinDisplayPeak, 1.0),
                          s.render.display.peak);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.display.peak); }},
    {"display.black", "0 to 0.2",
     "Darkest sRGB value that can be told from black on the display; black stays black.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "display.black", 0.0, kMaxDisplayBlack),
                          s.render.display.black);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.display.black); }},
};

}  // namespace

std::span<const SettingKey> picture_keys() {
  return kPictureKeys;
}

}  // namespace skerry::game
