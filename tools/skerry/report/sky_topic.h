#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "tools/skerry/report/measure_topic.h"

namespace skerry::tools {

/// measure_scene() for CostOf::kSkyTables: makes the tables of the atmosphere at each point's
/// TopicPoint::sky_degree, and a small picture of all directions by them, under the scene's sun
/// from the world's height. The judge is a picture by paths at random
/// (tools/reference/air_paths.h).
/// @param name of the scene.
SceneRows measure_sky(const Topic& topic, const std::string& name, const game::SceneOptions& scene,
                      const std::function<void(double, std::string_view)>& progress);

}  // namespace skerry::tools
