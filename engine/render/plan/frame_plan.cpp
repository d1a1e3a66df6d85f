#include "engine/render/plan/frame_plan.h"

#include "engine/render/frame/frame_choices.h"

namespace skerry::render {

bool FramePlan::shows_channel() const {
  return geometry && render::shows_channel(settings);
}

bool FramePlan::lights() const {
  const bool wanted = !shows_channel() || settings.debug_view == DebugView::kClusters ||
                      settings.debug_view == DebugView::kLightCount;
  return geometry && wanted && contents.features.has(Feature::kLights);
}

bool FramePlan::sampled() const {
  const GBufferStore& store = settings.gbuffer;
  const bool stored =
      store.normal != NormalStore::kExact || store.position != PositionStore::kDepth;
  return geometry && settings.shading_rate > 1 && samples_per_edge(settings) == 1 && !stored &&
         !shows_channel();
}

}  // namespace skerry::render
