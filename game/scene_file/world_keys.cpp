#include "game/scene_file/setting_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "game/scene_file/parse.h"
#include "game/scene_file/setting_values.h"
#include "world/voxel/coords.h"

namespace skerry::game {
namespace {

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
  if (text != "all")
    return into(parse_integer(text, "world.islands ('all' or a count)", 0, 100000),
                s.world_islands);
  s.world_islands.reset();
  return {};
}

constexpr std::array<std::string_view, 3> kOcclusionNames{"off", "auto", "always"};

constexpr SettingKey kWorldKeys[] = {
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
    {"ambient.yaw", "degrees, -360 to 360",
     "Where the middle of a panorama (--ambient) lies, as a camera's yaw. When it is read.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "ambient.yaw", -360.0, 360.0), s.ambient.yaw_deg);
     },
     [](const Settings& s) { return fmt::format("{}", s.ambient.yaw_deg); }},
    {"ambient.scale", "radiance, 0 to 1000000",
     "What 1 in a panorama's file is; 1 is a white sheet under the noon sun.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "ambient.scale", 0.0, 1e6), s.ambient.scale);
     },
     [](const Settings& s) { return fmt::format("{}", s.ambient.scale); }},
    {"ambient.peak", "radiance, 0 to 1000000",
     "Brighter places of a panorama's file count as this: takes the light of its own sun away.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "ambient.peak", 0.0, 1e6), s.ambient.peak);
     },
     [](const Settings& s) { return fmt::format("{}", s.ambient.peak); }},
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
    {"view.error", "pixels, 0 to 16",
     "Far ends of islands are drawn so coarse that their surface is off by no more; 0: each island "
     "is drawn in the detail that its nearest part asks for.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "view.error", 0.0, 16.0), s.view_error);
     },
     [](const Settings& s) { return fmt::format("{}", s.view_error); }},
    {"view.occlusion", "off, auto or always",
     "Leaves out what is hidden behind the rest; auto: where much is in view. Same picture.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "view.occlusion", kOcclusionNames), s.render.occlusion);
     },
     [](const Settings& s) { return name_of(kOcclusionNames, s.render.occlusion); }},
};

}  // namespace

std::span<const SettingKey> world_keys() {
  return kWorldKeys;
}

}  // namespace skerry::game
