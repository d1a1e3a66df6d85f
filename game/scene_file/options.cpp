#include "game/scene_file/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "game/scene_file/json_text.h"
#include "game/scene_file/scene_files.h"
#include "game/scene_file/setting_keys.h"
#include "game/scene_file/vdb_options.h"

namespace skerry::game {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 13> kFields{
    "seed",    "world",    "camera", "fov",    "time",   "size",  "quality",
    "ambient", "settings", "lights", "clouds", "import", "blocks"};

/// A scalar as the text a person would have typed, or nothing for other kinds.
std::optional<std::string> scalar_text(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number())
    return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
  if (value.is_boolean()) return std::string(value.get<bool>() ? "1" : "0");
  return std::nullopt;
}

Error field_error(std::string_view field, std::string_view wanted) {
  return Error{fmt::format("the scene's field '{}' has the wrong kind: give {}", field, wanted)};
}

/// A coordinate written as a JSON number: doubles print in exponent form when large, which
/// parse_blocks refuses.
std::optional<std::string> coordinate_text(const json& value) {
  if (value.is_number_float()) return fmt::format("{:.17f}", value.get<double>());
  return scalar_text(value);
}

Result<std::string> camera_text(const json& value) {
  if (!value.is_array() || value.size() != 5) return field_error("camera", "[X, Y, Z, YAW, PITCH]");
  std::string text;
  for (std::size_t i = 0; i < 5; ++i) {
    const auto part = i < 3 ? coordinate_text(value[i]) : scalar_text(value[i]);
    if (!part || value[i].is_boolean()) return field_error("camera", "five numbers or strings");
    text += (i ? "," : "") + *part;
  }
  return text;
}

/// An object as KEY=VALUE.
Result<void> read_assignments(const std::string& field, const json& value,
                              std::vector<std::string>& out) {
  if (!value.is_object()) return field_error(field, "an object of key: value");
  for (const auto& [key, entry] : value.items()) {
    const auto text = scalar_text(entry);
    if (!text) return field_error(field + "." + quote_text(key), "a string or a number");
    out.push_back(key + "=" + *text);
  }
  return {};
}

Error unknown_field(const std::string& key) {
  std::vector<std::string_view> names(kFields.begin(), kFields.end());
  names.insert(names.end(), std::begin(kExpectationFields), std::end(kExpectationFields));
  return Error{fmt::format("the scene has an unknown field {}: did you mean '{}'?", quote_text(key),
                           nearest_name(key, names))};
}

Result<void> read_field(const std::string& key, const json& value, SceneText& scene) {
  if (key == "settings") return read_assignments(key, value, scene.settings);
  if (key == "import") return read_assignments(key, value, scene.import);
  if (key == "lights") {
    Result<std::vector<WorldLight>> lights = read_lights(value);
    if (!lights) return lights.error();
    scene.lights = *std::move(lights);
    return {};
  }
  if (key == "blocks") {
    Result<std::vector<BlockBox>> blocks = read_blocks(value);
    if (!blocks) return blocks.error();
    scene.blocks = *std::move(blocks);
    return {};
  }
  if (key == "clouds") {
    Result<std::vector<CloudFile>> clouds = read_clouds(value);
    if (!clouds) return clouds.error();
    scene.clouds = *std::move(clouds);
    return {};
  }
  if (std::count(std::begin(kExpectationFields), std::end(kExpectationFields), key) != 0)
    return read_expectation(key, value, scene.expectations);
  if (key == "camera") {
    Result<std::string> camera = camera_text(value);
    if (!camera) return camera.error();
    scene.camera = *camera;
    return {};
  }
  std::optional<std::string>* const texts[] = {&scene.seed,    &scene.world,  nullptr,
                                               &scene.fov,     &scene.time,   &scene.size,
                                               &scene.quality, &scene.ambient};
  const auto field = std::find(kFields.begin(), kFields.end(), key);
  if (field == kFields.end()) return unknown_field(key);
  if ((key == "world" || key == "ambient") && !value.is_string())
    return field_error(key, "a path in quotation marks");
  const auto text = scalar_text(value);
  if (!text || value.is_boolean()) return field_error(key, "a string or a number");
  *texts[field - kFields.begin()] = *text;
  return {};
}

/// The field given last, if any.
const std::string* chosen(const std::optional<std::string>& under,
                          const std::optional<std::string>& over) {
  if (over) return &*over;
  return under ? &*under : nullptr;
}

Result<void> apply_settings(const SceneText& under, const SceneText& over, Settings& settings) {
  for (const SceneText* text : {&under, &over}) {
    for (const std::string& assignment : text->settings) {
      if (const auto done = apply_setting(assignment, settings); !done) return done;
    }
  }
  return {};
}

}  // namespace

std::string shell_word(std::string_view text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '.' || c == ',' || c == '-' || c == '+' || c == ':' || c == '=' || c == '/' ||
           c == '@';
  });
  if (plain) return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

Result<SceneText> parse_scene(std::string_view json_text) {
  const Result<json> root = parse_json(json_text);
  if (!root) return Error{"the scene " + root.error().message};
  if (!root->is_object())
    return Error{"the scene is not a JSON object: put the fields between { and }"};
  SceneText scene;
  for (const auto& [key, value] : root->items()) {
    if (const auto done = read_field(key, value, scene); !done) return done.error();
  }
  return scene;
}

namespace {

Result<void> apply_imports(const SceneText& under, const SceneText& over, SceneOptions& scene) {
  const bool own_world = over.seed || over.world;
  for (const SceneText* text : {&under, &over}) {
    if (text == &under && own_world) continue;
    for (const std::string& assignment : text->import)
      if (const auto done = apply_import(assignment, scene.import); !done) return done;
    if (!text->import.empty() && (!scene.world || !is_vdb(*scene.world)))
      return Error{"--import is for worlds that are .vdb files: give --world FILE.vdb"};
  }
  return {};
}

Result<void> check_ambient(const std::string& text) {
  if (text == kAmbientSky || ends_in(text, ".hdr") || ends_in(text, ".exr")) return {};
  return Error{
      fmt::format("the panorama cannot be {}: give a file FILE.hdr or FILE.exr, or sky for none",
                  quote_text(text))};
}

/// A source named in `over` replaces the one of `under`, whichever kind it is.
Result<void> choose_source(const SceneText& under, const SceneText& over, SceneOptions& scene) {
  const SceneText& named = over.seed || over.world ? over : under;
  if (named.seed && named.world)
    return Error{"a seed and a world were given: give one of the two, a saved world has its own"};
  if (named.seed) scene.seed_text = *named.seed;
  if (named.world && named.world->empty())
    return Error{"the world's path is empty: give the file of a saved world"};
  scene.world = named.world;
  return {};
}

}  // namespace

void find_world_beside(const std::string& scene_file, SceneText& scene) {
  if (!scene.world || scene.world->empty()) return;
  scene.world = file_of_scene(scene_file, *scene.world);
}

void find_ambient_beside(const std::string& scene_file, SceneText& scene) {
  if (!scene.ambient || scene.ambient->empty() || *scene.ambient == kAmbientSky) return;
  scene.ambient = file_of_scene(scene_file, *scene.ambient);
}

Result<SceneOptions> make_scene(const SceneText& under, const SceneText& over) {
  SceneOptions scene;
  if (const auto source = choose_source(under, over, scene); !source) return source.error();
  if (const auto done = apply_imports(under, over, scene); !done) return done.error();
  if (const auto* text = chosen(under.camera, over.camera)) {
    const auto camera = parse_camera(*text);
    if (!camera) return camera.error();
    scene.camera = *camera;
  }
  if (const auto* text = chosen(under.fov, over.fov)) {
    const auto fov = parse_number(*text, "the field of view", 0.1, 175.0);
    if (!fov) return fov.error();
    scene.fov_deg = *fov;
  }
  if (const auto* text = chosen(under.time, over.time)) {
    const auto time = parse_time_of_day(*text);
    if (!time) return time.error();
    scene.time_of_day_s = *time;
  }
  if (const auto* text = chosen(under.size, over.size)) {
    const auto size = parse_size(*text);
    if (!size) return size.error();
    scene.size = *size;
  }
  if (const auto* text = chosen(under.quality, over.quality)) {
    const auto quality = parse_quality(*text);
    if (!quality) return quality.error();
    scene.quality = *quality;
    scene.quality_named = true;
  }
  if (const auto* text = chosen(under.ambient, over.ambient)) {
    if (Result<void> fits = check_ambient(*text); !fits) return fits.error();
    scene.ambient = *text;
  }
  scene.lights = under.lights;
  scene.lights.insert(scene.lights.end(), over.lights.begin(), over.lights.end());
  scene.blocks = under.blocks;
  scene.blocks.insert(scene.blocks.end(), over.blocks.begin(), over.blocks.end());
  scene.clouds = under.clouds;
  scene.clouds.insert(scene.clouds.end(), over.clouds.begin(), over.clouds.end());
  scene.settings = settings_of(scene.quality);
  if (const auto done = apply_settings(under, over, scene.settings); !done) return done.error();
  scene.assigned = under.settings;
  scene.assigned.insert(scene.assigned.end(), over.settings.begin(), over.settings.end());
  return scene;
}

std::string shot_command(const SceneOptions& scene) {
  std::string command = "skerry shot";
  const bool file_clouds = std::any_of(scene.clouds.begin(), scene.clouds.end(),
                                       [](const CloudFile& cloud) { return cloud.of_scene_file; });
  if ((!scene.lights.empty() || !scene.blocks.empty() || file_clouds) && scene.scene_file)
    command += " --scene " + shell_word(*scene.scene_file);
  command += scene.world ? " --world " + shell_word(*scene.world)
                         : " --seed " + shell_word(scene.seed_text);
  if (scene.world && is_vdb(*scene.world))
    for (const std::string& assignment : import_assignments(scene.import))
      command += " --import " + shell_word(assignment);
  if (scene.camera) command += " --camera " + format_camera(*scene.camera);
  command += fmt::format(" --fov {} --time {} --size {}x{} --quality {}", scene.fov_deg,
                         format_time_of_day(scene.time_of_day_s), scene.size.width,
                         scene.size.height, quality_level(scene.quality).name);
  for (const std::string& assignment : assignments_from(scene.quality, scene.settings)) {
    // Of play alone.
    constexpr std::string_view kOfPlay[] = {"frames.", "sound.", "ui.", "play."};
    if (std::any_of(std::begin(kOfPlay), std::end(kOfPlay),
                    [&](std::string_view group) { return assignment.starts_with(group); }))
      continue;
    command += " --set " + shell_word(assignment);
  }
  if (scene.ambient) command += " --ambient " + shell_word(*scene.ambient);
  for (const CloudFile& cloud : scene.clouds)
    if (!cloud.of_scene_file) command += " --cloud " + shell_word(format_cloud(cloud));
  return command;
}

}  // namespace skerry::game
