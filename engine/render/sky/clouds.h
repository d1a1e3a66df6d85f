#pragma once
#include <span>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/frame/cloud_refs.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/sky/cloud_atlas.h"
#include "engine/render/sky/cloud_plan.h"

namespace skerry::render {

/// Clouds on the GPU: the layer's noise, volumes' bricks, and how much light comes through either.
/// Nothing is made before a frame has clouds.
class Clouds {
 public:
  explicit Clouds(gpu::Device& device) : device_(device) {}

  /// Takes the place of all volumes so far, which stay as they are if it fails.
  /// @param volumes what they point to is not kept. Errors: those of pack_clouds; out of memory;
  /// the device cannot filter this precision.
  Result<void> set_volumes(gpu::Uploader& uploader, std::span<const CloudVolumeDesc> volumes,
                           CloudPrecision precision);
  /// Of the volumes: bricks in the atlas.
  std::uint32_t brick_count() const { return brick_count_; }

  /// What there is now, for plan_clouds().
  CloudFacts facts() const;

  /// Makes what a frame with clouds needs, and takes its constants to the GPU. Errors: out of
  /// memory.
  Result<void> prepare(gpu::Uploader& uploader, const CloudPlan& plan);
  /// Adds the passes that find out how much light of the frame's bodies and sky comes through.
  /// @pre prepare()
  CloudRefs add_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                      const CloudPlan& plan);

 private:
  Result<void> make_layer(std::uint32_t shadow_steps);
  Result<void> make_volume_light();
  Result<void> make_noise();
  void add_noise(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, bool bake, CloudRefs& refs);
  void add_all_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t bodies,
                     const CloudPlan& plan, CloudRefs& refs);
  void add_layer_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t light,
                       CloudRefs& refs) const;
  void add_volume_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                        std::span<const shared::CloudLightJob> light_jobs, CloudRefs& refs);

  gpu::Device& device_;
  gpu::Buffer constants_buffer_;
  gpu::Image weather_, shapes_, billows_, layer_light_, cells_, bricks_, volume_light_;
  VkSampler repeating_{}, linear_{}, nearest_{};
  std::vector<CloudVolumeDesc> volumes_;  // without bricks and tiles
  std::vector<PackedVolume> packed_;
  std::uint32_t brick_count_ = 0;
  std::uint64_t noise_generation_ = 0, light_generation_ = 0;  // see CloudFacts
};

}  // namespace skerry::render
