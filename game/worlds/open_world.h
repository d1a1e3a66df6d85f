// Where the world of a scene comes from: a seed, or a file.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "world/islands/world.h"

namespace skerry::game {

/// The world that a scene shows: of its file, if it names one, else of its seed. Nothing is
/// written. Errors: a file that cannot be read, and why. What is damaged in it is reported on
/// stderr.
Result<std::unique_ptr<world::World>> open_world(const SceneOptions& options);
/// The same. @param damage gets a line for each thing that is damaged; nothing is printed.
Result<std::unique_ptr<world::World>> open_world(const SceneOptions& options,
                                                 std::vector<std::string>& damage);

/// A scene as the player left a saved world: camera, time, world time. What else one asks for goes
/// over it. Errors: as above.
Result<SceneText> scene_of_world(const std::filesystem::path& path);

/// Where the player's worlds are: $XDG_DATA_HOME/skerry/worlds. Empty when there is no such place.
std::filesystem::path worlds_dir();
/// A file name in worlds_dir() for a new world of that name; none is there yet.
std::filesystem::path new_world_path(const std::string& name);

}  // namespace skerry::game
