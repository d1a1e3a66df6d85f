#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/scene/tiles.h"
#include "engine/render/surface/media_light.h"
#include "engine/render/surface/shade_target.h"

namespace skerry::render {

/// What a frame's opaque surfaces are shaded from.
struct SampleIn {
  const Geometry& geometry;
  const Shadows& shadows;
  const MediaLight& media;
  Tiles tiles;  ///< of the geometry
};

/// Light at fewer pixels than are drawn.
struct SampledLight {
  const ClusteredLights* lights;  ///< null: the frame has none
  const RenderSettings& settings;
};

/// Light of sun, moon and lamps on opaque surfaces, worked out at one pixel of each rate x rate and
/// wherever too few of the four around a pixel are lit alike or those differ. Textures are sampled
/// at every pixel. docs/decisions/0030-light-at-fewer-pixels.md. @pre normals and positions are not
/// kept.
/// @param into becomes what was written.
void add_sample_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                       const SampleIn& on, const SampledLight& light, ShadeTarget& into);

}  // namespace skerry::render
