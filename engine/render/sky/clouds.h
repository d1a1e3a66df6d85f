#pragma once
#include <span>

#include "engine/gpu/device.h"
#include "engine/gpu/uploader.h"
#include "engine/render/frame/cloud_refs.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"
#include "engine/render/sky/cloud_atlas.h"
#include "shaders/shared/clouds.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// What of a frame's clouds changes from frame to frame. @param volumes as they were packed.
shared::CloudConstants cloud_constants(const FrameInput& input, const CloudSettings& settings,
                                       const shared::SkyConstants& sky,
                                       std::span<const CloudVolumeDesc> volumes,
                                       std::span<const PackedVolume> packed);

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
  bool has_volumes() const { return bricks_.operator bool(); }
  /// Of the volumes: bricks in the atlas, and bytes of atlas and cells.
  std::uint32_t brick_count() const { return brick_count_; }
  std::uint64_t atlas_bytes() const;

  /// Makes what a frame with clouds needs, and takes its constants to the GPU.
  /// @pre the frame has clouds. Errors: out of memory.
  Result<void> prepare(gpu::Uploader& uploader, const FrameInput& input,
                       const RenderSettings& settings, const shared::SkyConstants& sky);
  /// Adds the passes that find out how much light of the frame's bodies comes through.
  /// @pre prepare()
  CloudRefs add_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene);
  /// What add_light() has added was not executed: images that are kept are to be filled again.
  void forget();

 private:
  Result<void> make_layer(const CloudSettings& settings);
  Result<void> make_volume_light();
  Result<void> make_noise();
  void add_noise(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, CloudRefs& refs);
  void add_light_of_bodies(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t bodies,
                           CloudRefs& refs);
  void add_layer_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t body,
                       CloudRefs& refs) const;
  void add_volume_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, std::uint32_t bodies,
                        CloudRefs& refs);

  /// What a volume's light depends on besides the volume.
  struct LitAs {
    bool valid = false;
    glm::vec3 to_light{0.0f};
    float steps = 0.0f, extinction = 0.0f;
    bool operator==(const LitAs&) const = default;
  };

  gpu::Device& device_;
  gpu::Buffer constants_buffer_;
  gpu::Image weather_, shapes_, billows_, layer_light_, cells_, bricks_, volume_light_;
  bool noise_baked_ = false;
  VkSampler repeating_{}, linear_{}, nearest_{};
  std::vector<CloudVolumeDesc> volumes_;  // without bricks and tiles
  std::vector<PackedVolume> packed_;
  std::uint32_t brick_count_ = 0;
  shared::CloudConstants constants_{};
  bool layer_ = false;
  std::array<std::array<LitAs, shared::kBodyCount>, shared::kMaxCloudVolumes> lit_;
};

}  // namespace skerry::render
