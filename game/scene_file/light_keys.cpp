#include "game/scene_file/setting_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "game/scene_file/parse.h"
#include "game/scene_file/setting_values.h"

namespace skerry::game {
namespace {

constexpr std::array<std::string_view, 3> kAntialiasingNames{"off", "edge", "temporal"};
constexpr std::array<std::string_view, 3> kSampleNames{"1", "4", "16"};
constexpr std::array<std::string_view, 5> kTapNames{"1", "4", "8", "16", "32"};
constexpr std::array<std::string_view, 6> kNormalNames{"exact", "oct8",    "oct16",
                                                       "rgb8",  "rgb10a2", "rgba16f"};
constexpr std::array<std::string_view, 3> kPositionNames{"depth", "rgba16f", "rgba32f"};
constexpr std::array<std::string_view, 2> kDepthNames{"d32", "d16"};
constexpr std::array<std::string_view, 3> kIndirectNames{"off", "sky", "full"};

Result<void> parse_shadow_size(std::string_view text, Settings& s) {
  const auto size = parse_integer(text, "shadow.size", 256, 8192);
  if (!size) return size.error();
  if ((*size & (*size - 1)) != 0) {
    return Error{fmt::format("shadow.size cannot be {}: give a power of two from 256 to 8192",
                             quote_text(text))};
  }
  s.render.shadow_size = static_cast<std::uint32_t>(*size);
  return {};
}

constexpr SettingKey kLightKeys[] = {
    {"aa", "off, edge or temporal",
     "Smooth edges of blocks, leaves and plants. edge: each pixel at an edge shows both sides by "
     "the share that they cover; temporal: the same, mixed with earlier frames.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "aa", kAntialiasingNames), s.render.aa);
     },
     [](const Settings& s) { return name_of(kAntialiasingNames, s.render.aa); }},
    {"aa.samples", "1, 4 or 16",
     "Samples a pixel: the picture is drawn twice or four times as wide and high, and averaged. "
     "For stills; the time grows alike.",
     [](std::string_view t, Settings& s) {
       return into_listed(t, "aa.samples", kSampleNames, s.render.aa_samples);
     },
     [](const Settings& s) { return std::to_string(s.render.aa_samples); }},
    {"render.scale", "0.25 to 1",
     "Edges of the picture that is drawn, as a share of those of the picture that is shown: below "
     "1 it is enlarged. Text keeps every pixel.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "render.scale", 0.25, 1.0), s.render.render_scale);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.render_scale); }},
    {"shadow.enabled", "0 or 1", "Shadows of the sun and the moon.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "shadow.enabled", kSwitchNames), s.render.shadow_enabled);
     },
     [](const Settings& s) { return name_of(kSwitchNames, s.render.shadow_enabled); }},
    {"shadow.size", "a power of two, 256 to 8192", "Texels along the edge of one shadow map.",
     parse_shadow_size, [](const Settings& s) { return std::to_string(s.render.shadow_size); }},
    {"shadow.cascades", "1 to 4",
     "Shadow maps a light has. Fewer cover the same view distance with larger texels.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "shadow.cascades", 1, 4), s.render.shadow_cascades);
     },
     [](const Settings& s) { return std::to_string(s.render.shadow_cascades); }},
    {"shadow.taps", "1, 4, 8, 16 or 32", "Texels of the shadow map that a pixel compares with.",
     [](std::string_view t, Settings& s) {
       return into_listed(t, "shadow.taps", kTapNames, s.render.shadow_taps);
     },
     [](const Settings& s) { return std::to_string(s.render.shadow_taps); }},
    {"shadow.samples", "1 to 1024",
     "Places on the discs of sun and moon that light comes from: so many whole frames are "
     "averaged, each with shadows of its own. For stills.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "shadow.samples", 1, 1024), s.shadow_samples);
     },
     [](const Settings& s) { return std::to_string(s.shadow_samples); }},
    {"shadow.split", "0 to 1",
     "How the maps share the view distance: 0 evenly, 1 each a multiple of the one before.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "shadow.split", 0.0, 1.0), s.render.shadow_split);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.shadow_split); }},
    {"shadow.blur", "blocks, 0 to 1",
     "Largest radius of the shadow filter. It is as wide as the sun's disc blurs a shadow's edge, "
     "one texel at least; 0: one texel everywhere.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "shadow.blur", 0.0, 1.0), s.render.shadow_blur);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.shadow_blur); }},
    {"texture.taps", "1 to 16", "Samples along the long side of a slanted texture, at most.",
     [](std::string_view t, Settings& s) {
       return into(parse_integer(t, "texture.taps", 1, 16), s.render.texture_taps);
     },
     [](const Settings& s) { return std::to_string(s.render.texture_taps); }},
    {"gbuffer.normal", "exact, oct8, oct16, rgb8, rgb10a2 or rgba16f",
     "For measuring: how normals are kept between drawing and shading. exact: not at all.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "gbuffer.normal", kNormalNames), s.render.gbuffer.normal);
     },
     [](const Settings& s) { return name_of(kNormalNames, s.render.gbuffer.normal); }},
    {"gbuffer.position", "depth, rgba16f or rgba32f",
     "For measuring: where shading takes positions from.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "gbuffer.position", kPositionNames),
                        s.render.gbuffer.position);
     },
     [](const Settings& s) { return name_of(kPositionNames, s.render.gbuffer.position); }},
    {"gbuffer.depth", "d32 or d16",
     "For measuring: bits of a depth. With 16, positions are wrong by blocks in the distance.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "gbuffer.depth", kDepthNames), s.render.gbuffer.depth);
     },
     [](const Settings& s) { return name_of(kDepthNames, s.render.gbuffer.depth); }},
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
     [](const Settings& s) { return name_of(kSwitchNames, s.lights_held); }},
    {"ao.strength", "0 to 0.9",
     "How much light a closed corner of blocks takes; 0: corners are as bright as faces.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "ao.strength", 0.0, 0.9), s.render.ao_strength);
     },
     [](const Settings& s) { return fmt::format("{}", s.render.ao_strength); }},
    {"indirect", "off, sky or full",
     "Light of the whole sky, as far as each face sees it; full: weak lamps go with it, which is "
     "cheaper; off: sun, moon and lamps alone.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "indirect", kIndirectNames), s.render.indirect);
     },
     [](const Settings& s) { return name_of(kIndirectNames, s.render.indirect); }},
};

}  // namespace

std::span<const SettingKey> light_keys() {
  return kLightKeys;
}

}  // namespace skerry::game
