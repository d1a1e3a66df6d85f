#pragma once
#include <cstddef>
#include <memory>
#include <utility>

#include "engine/gpu/device/device.h"
#include "engine/gpu/program/pipeline.h"
#include "world/light/light_cache.h"

namespace skerry::game {

/// What views of scenes on one device hand on to those after them, in a process that loads many:
/// what they would make again with the same result. A view that is played in has none: its world
/// changes, and it is loaded once. Outlives its views; the device outlives it. One frame thread for
/// all of its views.
struct SceneCache {
  static constexpr std::size_t kLightBytes = std::size_t{256} << 20;

  /// @param known light of another cache, to hand on light alone.
  explicit SceneCache(gpu::Device& device, std::shared_ptr<world::LightCache> known =
                                               std::make_shared<world::LightCache>(kLightBytes))
      : pipelines(device), light(std::move(known)) {}
  gpu::Pipelines pipelines;
  const std::shared_ptr<world::LightCache> light;
};

}  // namespace skerry::game
