#pragma once
#include <filesystem>
#include <memory>

#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "game/session/session.h"

namespace skerry::game {

/// A session on options.world where it was left, or on a world of the options' seed, volumes and
/// time that is saved nowhere. Errors: those of open_world and of Session::open.
Result<std::unique_ptr<Session>> open_session(const SceneOptions& options);

/// Makes a world's file, its folder if need be, then opens it. Errors: those of WorldFile::create.
Result<std::unique_ptr<Session>> create_session(const std::filesystem::path& path,
                                                const world::WorldInfo& info);

}  // namespace skerry::game
