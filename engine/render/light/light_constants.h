#pragma once
#include <optional>
#include <vector>

#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// A shader's own specialization constants and those of the light functions it includes
/// (shaders/include/lighting.glsl, shadow.glsl): which bodies shine, and how their maps are
/// filtered, if there are maps.
std::vector<gpu::SpecConstant> with_light(std::vector<gpu::SpecConstant> own,
                                          const SceneRefs& scene, bool shadows);

/// The clouds that sun or moon may stand behind; none if neither gives light.
std::optional<CloudRefs> clouds_before_light(const SceneRefs& scene);
/// Adds what the light functions under clouds are specialised by, if there are clouds.
std::vector<gpu::SpecConstant> with_clouds(std::vector<gpu::SpecConstant> own,
                                           const std::optional<CloudRefs>& clouds);

}  // namespace skerry::render
