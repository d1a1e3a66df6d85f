#include "game/worlds/open_world.h"

#include <fmt/format.h>

#include "engine/core/log.h"
#include "engine/platform/files.h"
#include "game/scene_file/parse.h"
#include "game/session/saved_play.h"
#include "game/worlds/vdb_world.h"
#include "world/store/world_file.h"

namespace skerry::game {

Result<std::unique_ptr<world::World>> open_world(const SceneOptions& options) {
  std::vector<std::string> damage;
  auto world = open_world(options, damage);
  for (const std::string& line : damage) log_warning(line);
  return world;
}

Result<std::unique_ptr<world::World>> open_world(const SceneOptions& options,
                                                 std::vector<std::string>& damage) {
  if (!options.world) {
    return std::make_unique<world::World>(world::WorldDesc{world::seed_from_text(options.seed_text),
                                                           options.settings.world_offset,
                                                           options.settings.world_islands});
  }
  if (is_vdb(*options.world)) return world_of_vdb(*options.world, options.import);
  auto file = world::WorldFile::open(*options.world, world::WorldFile::Mode::kRead);
  if (!file) return file.error();
  world::LoadedWorld loaded = world::load_world(**file);
  damage = (*file)->damage();
  return std::move(loaded.world);
}

Result<SceneText> scene_of_world(const std::filesystem::path& path) {
  if (is_vdb(path)) return SceneText();  // it has no player yet
  auto file = world::WorldFile::open(path, world::WorldFile::Mode::kRead);
  if (!file) return file.error();
  SceneText scene;
  const std::optional<SavedPlay> play = saved_play(**file);
  if (!play) return scene;
  scene.camera = format_camera(play->eye);
  scene.time = format_time_of_day(static_cast<int>(play->time_of_day_s));
  scene.settings.push_back(fmt::format("world.time={}", play->world_time_s));
  return scene;
}

std::filesystem::path worlds_dir() {
  const std::filesystem::path data = platform::data_dir();
  return data.empty() ? data : data / "worlds";
}

std::filesystem::path new_world_path(const std::string& name) {
  constexpr std::size_t kLongestName = 64;
  std::string stem;
  for (const char c : name.substr(0, kLongestName)) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (plain || (!stem.empty() && stem.back() != '_')) stem += plain ? c : '_';
  }
  if (stem.empty()) stem = "world";
  const std::filesystem::path dir = worlds_dir();
  std::error_code code;
  for (int count = 1;; ++count) {
    const std::filesystem::path path =
        dir / (count == 1 ? stem + ".skerry" : fmt::format("{}_{}.skerry", stem, count));
    if (!std::filesystem::exists(path, code)) return path;
  }
}

}  // namespace skerry::game
