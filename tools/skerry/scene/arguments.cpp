#include "tools/skerry/scene/arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/scene_file/parse.h"
#include "game/worlds/open_world.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

std::string help_of(const CLI::App& command) {
  std::string path = command.get_name();
  for (const CLI::App* above = command.get_parent(); above; above = above->get_parent()) {
    path = above->get_name() + " " + path;
  }
  return path + " --help";
}

// What a saved world says about the scene goes below what was asked for.
std::optional<Refusal> read_world(const std::string& path, game::SceneText& from_file) {
  Result<game::SceneText> saved = game::scene_of_world(path);
  if (!saved) return Refusal{kFailed, saved.error()};
  if (!from_file.camera) from_file.camera = saved->camera;
  if (!from_file.time) from_file.time = saved->time;
  from_file.settings.insert(from_file.settings.begin(), saved->settings.begin(),
                            saved->settings.end());
  return std::nullopt;
}

}  // namespace

void add_scene_options(CLI::App& command, SceneArguments& a) {
  command.add_option("--seed", a.text.seed, "World seed: a number or any text");
  command.add_option("--world", a.text.world, "Saved world (docs/saving.md); excludes --seed")
      ->type_name("PATH");
  command
      .add_option("--import", a.text.import,
                  "How a .vdb file given as --world becomes land: grid, scale, size, threshold or "
                  "up (docs/openvdb.md); may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--cloud", a.clouds,
                  "Fog of a .vdb file as a cloud, at a place in blocks; may be repeated")
      ->type_name("FILE.vdb[@X,Y,Z[,SCALE]]")
      ->allow_extra_args(false);
  command
      .add_option("--ambient", a.text.ambient,
                  "Equirectangular panorama in place of the sky (docs/settings.md), or sky")
      ->type_name("FILE.hdr|FILE.exr|sky");
  command.add_option("--scene", a.scene_file, "JSON file with a scene (docs/settings.md)")
      ->type_name("FILE");
  command
      .add_option("--camera", a.text.camera,
                  "Place in blocks, then degrees (default: the seed's spawn view)")
      ->type_name("X,Y,Z,YAW,PITCH");
  command.add_option("--fov", a.text.fov, "Vertical field of view, 0.1 to 175 (default 70)")
      ->type_name("DEG");
  command.add_option("--time", a.text.time, "Time of day (default 12:00)")->type_name("HH:MM[:SS]");
  command.add_option("--size", a.text.size, "Picture or window size (default 1280x720)")
      ->type_name("WxH");
  command
      .add_option("--quality", a.text.quality,
                  "low, medium, high or ultra (default medium); of play also auto, its default")
      ->type_name("LEVEL");
  command.add_option("--set", a.text.settings, "One setting (docs/settings.md); may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--renderer", a.renderer, "Short for --set renderer=R")->type_name("R");
  command.add_option("--shading", a.shading, "Short for --set shading=S")->type_name("S");
  command
      .add_option("--device", a.device,
                  "Vulkan device, as 'skerry devices' counts (default: the best)")
      ->type_name("N");
  command.add_flag("--validate", a.validate,
                   "Turn the Vulkan validation layer on; any message exits with 3");
}

std::optional<Refusal> resolve(const SceneArguments& a, bool needs_source,
                               game::SceneOptions& scene) {
  if (needs_source && !a.text.seed && !a.text.world && !a.scene_file) {
    return usage({"there is nothing to draw: give --seed N, --world PATH or --scene FILE.json"});
  }
  game::SceneText from_file = a.usual;
  if (a.scene_file) {
    const auto file = platform::read_text(*a.scene_file, game::kMaxSceneBytes);
    if (!file) return Refusal{kFailed, file.error()};
    const auto parsed = game::parse_scene(*file);
    if (!parsed) {
      return usage({fmt::format("cannot use {}: {}", game::quote_text(*a.scene_file),
                                parsed.error().message)});
    }
    from_file = *parsed;
    game::find_world_beside(*a.scene_file, from_file);
    game::find_ambient_beside(*a.scene_file, from_file);
    game::find_beside(*a.scene_file, from_file.clouds);
  }
  game::SceneText typed = a.text;
  if (a.renderer) typed.settings.push_back("renderer=" + *a.renderer);
  if (a.shading) typed.settings.push_back("shading=" + *a.shading);
  for (const std::string& text : a.clouds) {
    const auto cloud = game::parse_cloud(text);
    if (!cloud) return usage(cloud.error());
    typed.clouds.push_back(*cloud);
  }
  auto made = game::make_scene(from_file, typed);
  if (!made) return usage(made.error());
  if (made->world) {
    if (const auto refusal = read_world(*made->world, from_file)) return refusal;
    made = game::make_scene(from_file, typed);
    if (!made) return usage(made.error());
  }
  scene = *std::move(made);
  scene.validate = a.validate;
  scene.scene_file = a.scene_file;
  return parse_device(a.device, scene.device);
}

bool take_auto(SceneArguments& arguments) {
  constexpr const char* kAuto = "auto";
  game::SceneText& usual = arguments.usual;
  const bool usually_auto = !usual.quality || *usual.quality == kAuto;
  const bool typed_auto = arguments.text.quality && *arguments.text.quality == kAuto;
  if (arguments.text.quality && !(typed_auto && usually_auto)) usual.settings.clear();
  if (typed_auto || usually_auto) usual.quality.reset();
  if (typed_auto) arguments.text.quality.reset();
  return typed_auto;
}

std::optional<Refusal> check_draws_frames(const game::SceneOptions& scene) {
  if (scene.settings.renderer != game::RendererKind::kReference) return std::nullopt;
  return usage({"renderer=reference draws screenshots only: use skerry shot, or deferred"});
}

std::optional<Refusal> parse_device(const std::optional<std::string>& text,
                                    std::optional<std::uint32_t>& index) {
  if (!text) return std::nullopt;
  const auto parsed = game::parse_integer(*text, "--device", 0, 1023);
  if (!parsed) return usage(parsed.error());
  index = static_cast<std::uint32_t>(*parsed);
  return std::nullopt;
}

std::optional<Refusal> check_leftovers(const CLI::App& command) {
  const std::vector<std::string> leftovers = command.remaining();
  if (leftovers.empty()) return std::nullopt;
  const std::string& first = leftovers.front();
  if (!first.starts_with("-")) {
    return usage(
        {fmt::format("did not expect {}: see {}", game::quote_text(first), help_of(command))});
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string_view typed = std::string_view(first).substr(0, first.find('='));
  return usage(
      {fmt::format("there is no option {}: did you mean '{}'? See {}", game::quote_text(typed),
                   game::nearest_name(typed, candidates), help_of(command))});
}

std::optional<Refusal> check_output(const std::optional<std::string>& path) {
  if (!path) return std::nullopt;
  const auto writable = check_writable(*path);
  if (!writable) return Refusal{kFailed, writable.error()};
  return std::nullopt;
}

Refusal usage(Error error) {
  return {kUsage, std::move(error)};
}

int refuse(const Refusal& refusal) {
  return fail(refusal.status, refusal.error);
}

}  // namespace skerry::tools
