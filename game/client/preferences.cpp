#include "game/client/preferences.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/pace/quality_front.h"
#include "game/scene_file/setting_keys.h"

namespace skerry::game {
namespace {

/// What the screen shows. Everything else belongs to a scene, not to a player.
constexpr std::string_view kKept[] = {
    "view.distance",  "view.detail",    "render.scale",     "shadow.enabled",  "shadow.size",
    "lights.shadows", "ao.strength",    "indirect",         "bloom.intensity", "aa",
    "aa.samples",     "water.layers",   "display.peak",     "display.black",   "clouds.coverage",
    "frames.wanted",  "frames.cap",     "frames.unfocused", "frames.sync",     "sound.master",
    "sound.effects",  "sound.ambience", "sound.interface",  "sound.captions",  "ui.scale",
    "ui.language",    "play.sprint",    "play.crouch",      "play.repeat"};

constexpr std::string_view kAuto = "auto";  // as a quality: play chooses

bool is_kept(std::string_view assignment) {
  const std::string_view key = assignment.substr(0, assignment.find('='));
  return std::find(std::begin(kKept), std::end(kKept), key) != std::end(kKept);
}

/// Whether a scene with nothing but this can be made.
bool holds(const SceneText& part, ReadPreferences& read) {
  const Result<SceneOptions> made = make_scene(part, {});
  if (!made) read.problems.push_back("settings.json: " + made.error().message);
  return static_cast<bool>(made);
}

}  // namespace

ReadPreferences read_preferences(std::string_view json_text) {
  ReadPreferences read;
  const Result<SceneText> scene = parse_scene(json_text);
  if (!scene) {
    read.problems.push_back("settings.json: " + scene.error().message + "; the usual ones hold");
    return read;
  }
  SceneText quality, fov;
  quality.quality = scene->quality;
  fov.fov = scene->fov;
  if (scene->quality == kAuto || holds(quality, read)) read.scene.quality = scene->quality;
  if (holds(fov, read)) read.scene.fov = scene->fov;
  for (const std::string& assignment : scene->settings) {
    SceneText one;
    one.settings.push_back(assignment);
    if (is_kept(assignment) && holds(one, read)) read.scene.settings.push_back(assignment);
  }
  return read;
}

void take_preferences(const Settings& from, Settings& into) {
  for (const SettingKey& entry : setting_keys())
    if (is_kept(entry.key)) (void)entry.parse(entry.print(from), into);  // its own text is valid
}

std::string print_preferences(const SceneOptions& scene) {
  nlohmann::json root;
  root["quality"] = std::string(scene.quality_auto ? kAuto : quality_level(scene.quality).name);
  root["fov"] = scene.fov_deg;
  root["settings"] = nlohmann::json::object();
  const auto keep = [&root](const std::string& assignment) {
    const std::size_t sign = assignment.find('=');
    if (is_kept(assignment))
      root["settings"][assignment.substr(0, sign)] = assignment.substr(sign + 1);
  };
  for (const std::string& assignment : assignments_from(scene.quality, scene.settings))
    if (!scene.quality_auto || !is_chosen_by_front(assignment.substr(0, assignment.find('='))))
      keep(assignment);
  if (scene.quality_auto) std::for_each(scene.pinned.begin(), scene.pinned.end(), keep);
  return root.dump(2) + "\n";
}

std::filesystem::path preferences_path() {
  const std::filesystem::path folder = platform::config_dir();
  return folder.empty() ? folder : folder / "settings.json";
}

ReadPreferences load_preferences(const std::filesystem::path& path) {
  std::error_code code;
  if (path.empty() || !std::filesystem::exists(path, code)) return {};
  const Result<std::string> text = platform::read_text(path, kMaxSceneBytes);
  if (text) return read_preferences(*text);
  ReadPreferences read;
  read.problems.push_back(text.error().message + "; the usual settings hold");
  return read;
}

Result<void> save_preferences(const std::filesystem::path& path, const SceneOptions& scene) {
  if (path.empty())
    return Error{
        "cannot save the settings: there is no folder for them; set HOME or XDG_CONFIG_HOME"};
  if (const Result<void> made = platform::make_dirs(path.parent_path()); !made) return made;
  if (!load_preferences(path).problems.empty())
    if (Result<void> kept = keep_as_old(path); !kept) return kept;
  return write_text(path, print_preferences(scene));
}

}  // namespace skerry::game
