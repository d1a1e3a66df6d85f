#pragma once
#include <vector>

#include "engine/gpu/pipeline.h"
#include "engine/render/scene_refs.h"

namespace skerry::render {

/// A shader's own specialization constants and those of the light functions it includes
/// (shaders/include/lighting.glsl, shadow.glsl): which bodies shine, and how their maps are
/// filtered, if there are maps.
std::vector<gpu::SpecConstant> with_light(std::vector<gpu::SpecConstant> own,
                                          const SceneRefs& scene, bool shadows);

}  // namespace skerry::render
