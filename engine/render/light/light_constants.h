#pragma once
#include <optional>
#include <vector>

#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// A shader's own specialization constants and those of the light functions it includes
/// (shaders/include/surface/lighting.glsl, shadow.glsl, sky.glsl): which bodies shine, how their
/// maps are filtered, if there are maps, and whether the sky is a panorama.
std::vector<gpu::SpecConstant> with_light(std::vector<gpu::SpecConstant> own,
                                          const SceneRefs& scene, bool shadows);

/// What visibility.glsl's binding of shadow maps gets: the maps, or without any some array of
/// images that is never read.
gpu::ImageRef maps_or_others(const SceneRefs& scene, gpu::ImageRef maps);

/// The clouds that sun or moon may stand behind, for cloud_light.glsl. If there are none, or
/// neither gives light, others that let all light through are bound in their place and never read.
CloudRefs clouds_before_light(const SceneRefs& scene);

}  // namespace skerry::render
