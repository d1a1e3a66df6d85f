#pragma once
#include <span>

#include "engine/render/frame/phases.h"
#include "engine/render/scene/cull_pass.h"

namespace skerry::gpu {
class Image;
}

namespace skerry::render {

/// Of a body's cascade. @param body 0 the sun, 1 the moon. @param index 0..kCascadeCount - 1.
const char* shadow_pass_name(int body, int index);

/// One cascade to draw this frame. Cascades whose kept map is still right are not in the list.
struct ShadowDraw {
  std::uint32_t view = 0;   ///< index of its matrix, island table and draw lists
  std::uint32_t layer = 0;  ///< of the map
  const char* name = "";    ///< pass name, contains "shadow"
  bool cutouts = false;     ///< alpha-tested quads may be in it
  VkRect2D area{};          ///< texels to draw; the others keep what they show
  bool clear = true;        ///< the area first
};

/// Depth of what the light sees, one pass a cascade. Opaque quads need no fragment shader; cut-outs
/// are alpha-tested.
struct ShadowPass {
  /// @param maps the kept D32 array, or null when nothing casts.
  static Shadows add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const CulledDraws& draws, gpu::ImageRef maps,
                     std::span<const ShadowDraw> cascades);
};

}  // namespace skerry::render
