#pragma once
#include <vector>

#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// A shader's own specialization constants and those of shaders/include/post/picture.glsl and
/// tonemap.glsl: which tone curve, and whether it is fitted to a display.
std::vector<gpu::SpecConstant> with_picture(std::vector<gpu::SpecConstant> own,
                                            const SceneRefs& scene);

}  // namespace skerry::render
