#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/sky/cloud_atlas.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/clouds.h"

namespace skerry::render {

/// What there is of clouds before a frame is planned.
struct CloudFacts {
  std::span<const CloudVolumeDesc> volumes;  ///< clouds of files
  std::span<const PackedVolume> packed;      ///< the same in the atlas
  std::uint64_t noise_generation = 0;        ///< of the layer's noise images; 0: there are none
  std::uint64_t light_generation = 0;        ///< of the volumes' light image; 0: there is none
};

/// What the images of clouds hold after a frame has been submitted.
struct CloudHistory {
  /// What a volume's light depends on besides the volume.
  struct LitAs {
    bool valid = false;
    glm::vec3 to_light{0.0f};
    float steps = 0.0f, extinction = 0.0f;
  };
  std::uint64_t noise_generation = 0;  ///< of the images that the noise was baked into; 0: none
  std::uint64_t light_generation = 0;  ///< of the image that `lit` is about
  std::array<std::array<LitAs, shared::kCloudLights>, shared::kMaxCloudVolumes> lit;
};

/// Clouds of one frame.
struct CloudPlan {
  bool layer = false;         ///< the frame has the layer
  bool in_view = true;        ///< else they only cast shadows and are mirrored
  bool volume_light = false;  ///< the volumes' light is sampled
  bool sky = false;           ///< the sky lights them by itself: the way to the zenith is traced
  bool bake_noise = false;    ///< else what an earlier frame baked is kept
  shared::CloudConstants constants{};
  std::vector<shared::CloudLightJob> light_jobs;  ///< volumes whose light is traced afresh
  CloudHistory next;                              ///< generations are those before the frame
};

/// What of a frame's clouds changes from frame to frame. @param sky_lights whether the sky gives
/// light where neither sun nor moon does. @param volumes as they were packed.
shared::CloudConstants cloud_constants(const FrameInput& input, const CloudSettings& settings,
                                       const SkyModel& sky, bool sky_lights,
                                       std::span<const CloudVolumeDesc> volumes,
                                       std::span<const PackedVolume> packed);

/// Decides what of a frame's clouds is made anew. @pre the frame has clouds. A function of its
/// arguments alone. @param sky_lights as for cloud_constants().
CloudPlan plan_clouds(const FrameInput& input, const CloudSettings& settings, const SkyModel& sky,
                      bool sky_lights, const CloudFacts& facts, const CloudHistory& history);

}  // namespace skerry::render
