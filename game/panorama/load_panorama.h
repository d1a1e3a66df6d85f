// The option --ambient: a panorama of a file as the sky. docs/settings.md.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/render/sky/panorama_sky.h"
#include "game/scene_file/options.h"

namespace skerry::game {

/// The file of a scene's panorama; none: the sky is the air's.
std::optional<std::string> panorama_file(const SceneOptions& scene);

/// The panorama that a scene asks for, as its settings place it; null: none.
/// Errors, naming the file: it cannot be read; not a panorama.
Result<std::shared_ptr<const render::PanoramaSky>> load_panorama(const SceneOptions& scene);

}  // namespace skerry::game
