#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "tools/skerry/report/measure_topic.h"

namespace skerry::tools {

/// measure_scene() for CostOf::kStoredLight: finds the light that stays on the scene's surfaces at
/// each point's TopicPoint::light, and compares pictures of irradiance with the CPU reference's.
/// @param name of the scene. Errors: those of draw_shade().
Result<SceneRows> measure_stored_light(
    const Topic& topic, const std::string& name, const game::SceneOptions& scene,
    const std::function<void(double, std::string_view)>& progress);

}  // namespace skerry::tools
