#include "game/worlds/gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <optional>

#include "engine/platform/files.h"
#include "game/scene_file/cloud_files.h"
#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

constexpr std::string_view kIslandKey = "Island";

/// Islands turn about the vertical only, so pitch stays.
double turned_yaw(const glm::dquat& rotation, double yaw_deg) {
  const double yaw = glm::radians(yaw_deg);
  const glm::dvec3 ahead = rotation * glm::dvec3{std::sin(yaw), 0.0, std::cos(yaw)};
  return glm::degrees(std::atan2(ahead.x, ahead.z));
}

Error no_command(std::string_view why) {
  return Error{fmt::format(
      "cannot enter the picture: {}; take it with Skerry, by F2 or in photo mode", why)};
}

/// Settings that say where a picture was taken, not how it was drawn.
bool is_of_place(std::string_view assignment) {
  constexpr std::string_view kGroups[] = {
      "world.",           "sky.",           "ambient.",    "clouds.coverage", "clouds.altitude",
      "clouds.thickness", "clouds.density", "clouds.file_"};
  return std::any_of(std::begin(kGroups), std::end(kGroups),
                     [&](std::string_view group) { return assignment.starts_with(group); });
}

/// Takes an option's value into a scene. @return false: there is no such option.
Result<bool> take_option(std::string_view option, const std::string& value, SceneText& scene) {
  constexpr std::string_view kDrawn[] = {"--size", "--quality"};
  if (std::find(std::begin(kDrawn), std::end(kDrawn), option) != std::end(kDrawn)) return true;
  if (option == "--set") {
    if (is_of_place(value)) scene.settings.push_back(value);
    return true;
  }
  if (option == "--import") {
    scene.import.push_back(value);
    return true;
  }
  if (option == "--cloud") {
    auto cloud = parse_cloud(value);
    if (!cloud) return cloud.error();
    scene.clouds.push_back(*std::move(cloud));
    return true;
  }
  const std::pair<std::string_view, std::optional<std::string> SceneText::*> kTexts[] = {
      {"--seed", &SceneText::seed},     {"--world", &SceneText::world},
      {"--camera", &SceneText::camera}, {"--fov", &SceneText::fov},
      {"--time", &SceneText::time},     {"--ambient", &SceneText::ambient}};
  for (const auto& [name, field] : kTexts) {
    if (option != name) continue;
    scene.*field = value;
    return true;
  }
  return false;
}

}  // namespace

Result<std::vector<std::string>> shell_words(std::string_view command) {
  std::vector<std::string> words;
  bool in_word = false, quoted = false;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (!quoted && c == ' ') {
      in_word = false;
      continue;
    }
    if (!std::exchange(in_word, true)) words.emplace_back();
    if (c == '\'') {
      quoted = !quoted;
    } else if (!quoted && c == '\\') {
      if (++i == command.size()) return Error{"a command ends with a backslash"};
      words.back() += command[i];
    } else {
      words.back() += c;
    }
  }
  if (quoted) return Error{"a command has a quote without an end"};
  return words;
}

Result<SceneText> place_of_command(std::string_view command) {
  if (command.size() > kMaxCommandBytes) return no_command("its command is too long");
  const Result<std::vector<std::string>> words = shell_words(command);
  if (!words) return no_command(words.error().message);
  if (words->size() < 2 || (*words)[0] != "skerry" || (*words)[1] != "shot")
    return no_command("it does not hold the command that draws it");
  SceneText scene;
  for (std::size_t i = 2; i < words->size(); i += 2) {
    const std::string& option = (*words)[i];
    if (i + 1 == words->size())
      return no_command(fmt::format("{} has no value", quote_text(option)));
    const Result<bool> taken = take_option(option, (*words)[i + 1], scene);
    if (!taken) return taken.error();
    if (!*taken) return no_command(fmt::format("play has no option {}", quote_text(option)));
  }
  return scene;
}

Result<SceneOptions> place_of_picture(std::span<const platform::PngText> text) {
  const auto command = std::find_if(text.begin(), text.end(), [](const platform::PngText& entry) {
    return entry.key == "Command";
  });
  if (command == text.end()) return no_command("it does not hold the command that draws it");
  const Result<SceneText> place = place_of_command(command->text);
  if (!place) return place.error();
  return make_scene(*place, {});
}

SceneOptions at_place(const SceneOptions& played, const SceneOptions& place) {
  SceneOptions out = played;
  out.seed_text = place.seed_text;
  out.world = place.world;
  out.import = place.import;
  out.camera = place.camera;
  out.time_of_day_s = place.time_of_day_s;
  out.clouds = place.clouds;
  out.ambient = place.ambient;
  out.lights.clear();
  Settings& to = out.settings;
  const Settings& from = place.settings;
  to.world_offset = from.world_offset;
  to.world_islands = from.world_islands;
  to.world_time_s = from.world_time_s;
  to.moon_phase = from.moon_phase;
  to.ambient = from.ambient;
  const auto kept = to.render.clouds;
  to.render.clouds = from.render.clouds;
  to.render.clouds.steps = kept.steps;
  to.render.clouds.shadow_steps = kept.shadow_steps;
  to.render.clouds.resolution = kept.resolution;
  to.render.clouds.precision = kept.precision;
  return out;
}

IslandView seen_from(std::uint64_t island, const world::Pose& pose, const CameraPlace& eye) {
  const glm::dquat lattice_from_world = glm::conjugate(pose.rotation);
  const glm::dvec3 from_origin = world::difference_blocks(eye.position, pose.origin);
  return {island,
          {world::moved({}, lattice_from_world * from_origin),
           turned_yaw(lattice_from_world, eye.yaw_deg), eye.pitch_deg}};
}

CameraPlace seen_in_world(const IslandView& view, const world::Pose& pose) {
  const glm::dvec3 from_origin = world::difference_blocks(view.eye.position, {});
  return {world::moved(pose.origin, pose.rotation * from_origin),
          turned_yaw(pose.rotation, view.eye.yaw_deg), view.eye.pitch_deg};
}

platform::PngText text_of(const IslandView& view) {
  return {std::string(kIslandKey), fmt::format("{} {}", view.island, format_camera(view.eye))};
}

std::optional<IslandView> island_view_of(std::span<const platform::PngText> text) {
  const auto entry = std::find_if(
      text.begin(), text.end(), [](const platform::PngText& one) { return one.key == kIslandKey; });
  if (entry == text.end()) return std::nullopt;
  const std::string_view words = entry->text;
  const std::size_t space = words.find(' ');
  if (space == std::string_view::npos || words.size() > kMaxCommandBytes) return std::nullopt;
  IslandView view;
  const char* const end = words.data() + space;
  const auto read = std::from_chars(words.data(), end, view.island);
  const Result<CameraPlace> eye = parse_camera(words.substr(space + 1));
  if (read.ec != std::errc() || read.ptr != end || !eye) return std::nullopt;
  view.eye = *eye;
  return view;
}

std::vector<std::filesystem::path> list_pictures(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code code;
  for (std::filesystem::directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code))
    if (at->path().extension() == ".png" && at->is_regular_file(code)) found.push_back(at->path());
  // Their names begin with the time.
  std::sort(found.begin(), found.end(), std::greater<>());
  return found;
}

std::filesystem::path pictures_dir() {
  const std::filesystem::path data = platform::data_dir();
  return data.empty() ? data : data / "screenshots";
}

}  // namespace skerry::game
