#include "game/scene_file/scene_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string_view>

#include "engine/render/light/lights.h"
#include "game/scene_file/emission.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

using nlohmann::json;

constexpr float kDirectionalReach = 1000.0f;  // blocks, of a directional light without a range

constexpr float kLeastRange = 0.01f;  // blocks, of a light too weak to reach anything

constexpr std::array<std::string_view, 10> kLightFields{
    "kind", "position", "intensity", "color", "power", "range", "axis", "size", "cone", "dual"};

/// A kind, and what it has besides a strength and a range. All of it but `dual` must be given.
struct Kind {
  std::string_view name;
  std::uint32_t kind;
  std::string_view fields;
};
constexpr std::array<Kind, shared::kLightKindCount> kKinds{
    {{"point", shared::kLightPoint, "position"},
     {"spot", shared::kLightSpot, "position axis cone dual"},
     {"tube", shared::kLightTube, "position axis size"},
     {"sphere", shared::kLightSphere, "position size"},
     {"directional", shared::kLightDirectional, "axis"}}};

bool has_field(const Kind& kind, std::string_view field) {
  return kind.fields.find(field) != std::string_view::npos;
}

Error wrong_field(std::string_view field, std::string_view wanted) {
  return Error{fmt::format("'{}' is wrong: give {}", field, wanted)};
}

Result<float> number(const json& value, std::string_view field) {
  if (!value.is_number()) return wrong_field(field, "a number");
  return static_cast<float>(value.get<double>());
}

template <std::size_t N>
Result<std::array<float, N>> numbers(const json& value, std::string_view field,
                                     std::string_view wanted) {
  std::array<float, N> out{};
  if (!value.is_array() || value.size() != N) return wrong_field(field, wanted);
  for (std::size_t i = 0; i < N; ++i) {
    if (!value[i].is_number()) return wrong_field(field, wanted);
    out[i] = static_cast<float>(value[i].get<double>());
  }
  return out;
}

Result<glm::vec3> vector(const json& value, std::string_view field, std::string_view wanted) {
  const Result<std::array<float, 3>> v = numbers<3>(value, field, wanted);
  if (!v) return v.error();
  return glm::vec3((*v)[0], (*v)[1], (*v)[2]);
}

/// Blocks as a JSON number, or as a text where a number would not hold all digits.
Result<std::int64_t> light_coordinate(const json& value) {
  if (value.is_string()) return parse_blocks(value.get<std::string>(), "'position'");
  if (value.is_number_float())
    return parse_blocks(fmt::format("{:.17f}", value.get<double>()), "'position'");
  if (value.is_number()) return parse_blocks(value.dump(), "'position'");
  return wrong_field("position", "[X, Y, Z] in blocks");
}

Result<world::WorldPos> position(const json& value) {
  if (!value.is_array() || value.size() != 3) return wrong_field("position", "[X, Y, Z] in blocks");
  std::array<std::int64_t, 3> units{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Result<std::int64_t> part = light_coordinate(value[i]);
    if (!part) return part.error();
    units[i] = *part;
  }
  return world::WorldPos{units[0], units[1], units[2]};
}

Result<void> read_strength(const json& value, const Kind& kind, shared::Light& into) {
  const bool spread = value.contains("color") || value.contains("power");
  if (spread == value.contains("intensity"))
    return Error{
        "its strength is missing or given twice: give 'intensity', or 'color' and 'power'"};
  if (!spread) {
    constexpr std::string_view kWanted = "a number or [R, G, B]";
    const json& given = value.at("intensity");
    const Result<glm::vec3> rgb = given.is_number()
                                      ? Result(glm::vec3(static_cast<float>(given.get<double>())))
                                      : vector(given, "intensity", kWanted);
    if (!rgb) return rgb.error();
    into.intensity = *rgb;
    return {};
  }
  if (kind.kind == shared::kLightDirectional || !value.contains("color") ||
      !value.contains("power"))
    return Error{
        "'color' and 'power' go together, and not with a directional light: give "
        "'intensity' instead"};
  const Result<glm::vec3> color = vector(value.at("color"), "color", "[R, G, B] from 0 to 1");
  if (!color) return color.error();
  for (int c = 0; c < 3; ++c)
    if (!((*color)[c] >= 0.0f && (*color)[c] <= 1.0f))
      return wrong_field("color", "[R, G, B] from 0 to 1");
  const Result<float> power = number(value.at("power"), "power");
  if (!power) return power.error();
  into.intensity = *color * (*power / (4.0f * std::numbers::pi_v<float>));
  return {};
}

Result<void> read_cone(const json& value, shared::Light& into) {
  constexpr std::string_view kWanted = "[INNER, OUTER] in degrees, 0 <= INNER <= OUTER <= 180";
  const Result<std::array<float, 2>> cone = numbers<2>(value, "cone", kWanted);
  if (!cone) return cone.error();
  const auto [inner, outer] = *cone;
  if (!(inner >= 0.0f && inner <= outer && outer <= 180.0f)) return wrong_field("cone", kWanted);
  into.cos_inner = std::cos(glm::radians(inner));
  into.cos_outer = std::cos(glm::radians(outer));
  return {};
}

Result<void> read_shape(const json& value, const Kind& kind, shared::Light& into) {
  if (has_field(kind, "axis")) {
    const Result<glm::vec3> axis = vector(value.at("axis"), "axis", "[X, Y, Z]");
    if (!axis) return axis.error();
    into.axis = *axis;
  }
  if (has_field(kind, "size")) {
    const Result<float> size = number(value.at("size"), "size");
    if (!size) return size.error();
    into.size = *size;
  }
  if (has_field(kind, "cone")) {
    if (Result<void> read = read_cone(value.at("cone"), into); !read) return read;
    if (value.contains("dual")) {
      if (!value.at("dual").is_boolean()) return wrong_field("dual", "true or false");
      if (value.at("dual").get<bool>()) into.kind |= shared::kLightDualBit;
    }
  }
  return {};
}

Result<void> check_light_fields(const json& value, const Kind& kind) {
  for (const auto& [field, entry] : value.items()) {
    if (Result<void> known = check_field(field, kLightFields); !known) return known;
    constexpr std::array<std::string_view, 5> kOfSome{"position", "axis", "size", "cone", "dual"};
    const bool of_some = std::find(kOfSome.begin(), kOfSome.end(), field) != kOfSome.end();
    if (of_some && !has_field(kind, field))
      return Error{fmt::format("a {} light has no '{}': leave it out", kind.name, field)};
  }
  for (const std::string& field : split(kind.fields, ' '))
    if (field != "dual" && !value.contains(field))
      return Error{fmt::format("a {} light needs '{}': add it", kind.name, field)};
  return {};
}

Result<const Kind*> kind_of(const json& value) {
  std::array<std::string_view, kKinds.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kKinds[i].name;
  if (!value.is_object() || !value.contains("kind") || !value.at("kind").is_string())
    return Error{"it has no kind: give an object with 'kind', e.g. {\"kind\": \"point\", ...}"};
  const std::string name = value.at("kind").get<std::string>();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    return Error{fmt::format("there is no kind {}: did you mean '{}'?", quote_text(name),
                             nearest_name(name, names))};
  return &kKinds[static_cast<std::size_t>(found - names.begin())];
}

Result<WorldLight> read_light(const json& value) {
  const Result<const Kind*> kind = kind_of(value);
  if (!kind) return kind.error();
  if (Result<void> known = check_light_fields(value, **kind); !known) return known.error();
  WorldLight out;
  out.light.kind = (*kind)->kind;
  if (Result<void> read = read_strength(value, **kind, out.light); !read) return read.error();
  if (Result<void> read = read_shape(value, **kind, out.light); !read) return read.error();
  if (value.contains("position")) {
    const Result<world::WorldPos> place = position(value.at("position"));
    if (!place) return place.error();
    out.position = *place;
  }
  out.light.range = kDirectionalReach;
  if (value.contains("range")) {
    const Result<float> range = number(value.at("range"), "range");
    if (!range) return range.error();
    out.light.range = *range;
  }
  const Result<shared::Light> checked = render::checked_light(out.light);
  if (!checked) return checked.error();
  out.light = *checked;
  if (!value.contains("range") && out.light.kind != shared::kLightDirectional)
    out.light.range =
        std::clamp(light_range(out.light.intensity), kLeastRange, render::kMaxLightRange);
  return out;
}

}  // namespace

Result<std::vector<WorldLight>> read_lights(const json& value) {
  if (!value.is_array()) return Error{"the scene's field 'lights' is wrong: give a list of lights"};
  std::vector<WorldLight> out;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Result<WorldLight> light = read_light(value[i]);
    if (!light) return Error{fmt::format("the scene's light {}: {}", i + 1, light.error().message)};
    out.push_back(*light);
  }
  return out;
}

namespace {

constexpr std::int64_t kMostBlocks = std::int64_t{1} << 20;  // of all boxes

Result<world::BlockId> read_block(const json& value) {
  const auto types = world::block_types();
  std::vector<std::string_view> names;
  for (const world::BlockType& type : types) names.push_back(type.name);
  if (!value.is_string()) return Error{"'block' is wrong: give a block's name, e.g. \"glass\""};
  const auto& name = value.get_ref<const std::string&>();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    return Error{fmt::format("there is no block {}: did you mean '{}'?", quote_text(name),
                             nearest_name(name, names))};
  return static_cast<world::BlockId>(at - names.begin());
}

Result<std::array<std::int64_t, 3>> read_place(const json& value, std::string_view field) {
  const Error wrong{fmt::format("'{}' is wrong: give [X, Y, Z] in whole blocks", field)};
  if (!value.is_array() || value.size() != 3) return wrong;
  std::array<std::int64_t, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!value[axis].is_number_integer()) return wrong;
    // Numbers over 2^63 - 1 are unsigned ones to the library.
    const bool far = value[axis].is_number_unsigned() &&
                     value[axis].get<std::uint64_t>() > std::uint64_t{world::kMaxBlock};
    place[axis] = far ? world::kMaxBlock + 1 : value[axis].get<std::int64_t>();
    if (place[axis] > world::kMaxBlock || place[axis] < -world::kMaxBlock) return wrong;
  }
  return place;
}

Result<BlockBox> read_box(const json& value) {
  constexpr std::array<std::string_view, 3> kBoxFields{"block", "from", "to"};
  if (!value.is_object() || !value.contains("block") || !value.contains("from"))
    return Error{
        "it lacks a block or a place: give {\"block\": NAME, \"from\": [X, Y, Z], \"to\": [X, Y, "
        "Z]}"};
  if (const Result<void> known = check_fields(value, kBoxFields); !known) return known.error();
  const Result<world::BlockId> block = read_block(value.at("block"));
  if (!block) return block.error();
  const auto from = read_place(value.at("from"), "from");
  if (!from) return from.error();
  const auto to = value.contains("to") ? read_place(value.at("to"), "to") : from;
  if (!to) return to.error();
  BlockBox out{*block, *from, *to};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (out.from[axis] > out.to[axis]) std::swap(out.from[axis], out.to[axis]);
  return out;
}

/// kMostBlocks + 1: more than that.
std::int64_t blocks_in(const BlockBox& box) {
  std::int64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t edge = box.to[axis] - box.from[axis] + 1;
    if (edge > kMostBlocks / count) return kMostBlocks + 1;
    count *= edge;
  }
  return count;
}

}  // namespace

Result<std::vector<BlockBox>> read_blocks(const json& value) {
  if (!value.is_array()) return Error{"the scene's field 'blocks' has the wrong kind: give a list"};
  std::vector<BlockBox> out;
  std::int64_t left = kMostBlocks;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Result<BlockBox> box = read_box(value[i]);
    if (!box) return Error{fmt::format("blocks[{}]: {}", i, box.error().message)};
    left -= blocks_in(*box);
    if (left < 0)
      return Error{
          fmt::format("blocks[{}]: a scene puts {} blocks at most into its world", i, kMostBlocks)};
    out.push_back(*box);
  }
  return out;
}

}  // namespace skerry::game
