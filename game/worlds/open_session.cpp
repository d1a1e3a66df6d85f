#include "game/worlds/open_session.h"

#include <utility>

#include "engine/platform/files.h"
#include "game/worlds/open_world.h"
#include "game/worlds/vdb_world.h"
#include "world/store/world_file.h"

namespace skerry::game {

Result<std::unique_ptr<Session>> open_session(const SceneOptions& options) {
  if (options.world && !is_vdb(*options.world)) return Session::open(*options.world);
  Result<std::unique_ptr<world::World>> made = open_world(options);
  if (!made) return made.error();
  return Session::play(*std::move(made), options.settings.world_time_s);
}

Result<std::unique_ptr<Session>> create_session(const std::filesystem::path& path,
                                                const world::WorldInfo& info) {
  if (const auto made = platform::make_dirs(path.parent_path()); !made) return made.error();
  if (const auto made = world::WorldFile::create(path, info); !made) return made.error();
  return Session::open(path);
}

}  // namespace skerry::game
