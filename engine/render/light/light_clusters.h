#pragma once
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/clusters.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/light.h"

namespace skerry::render {

struct CameraView;

/// A bit for each kind among them, and shared::kLightPanesBit if one of them has panes.
std::uint32_t light_kinds(std::span<const shared::Light> lights);

/// The lights whose range touches a view, in their order; directional ones always. Those without
/// intensity light nothing and are left out.
std::vector<shared::Light> lights_in_view(std::span<const shared::Light> lights,
                                          const shared::CullView& view);

/// A picture to be cut into clusters.
struct ClusterPicture {
  VkExtent2D size{};         ///< pixels
  glm::uvec4 layers_area{};  ///< see shared::FrameConstants
  /// Slices of depth that show something in every tile, a bit each: the first about a camera in a
  /// translucent block.
  std::uint32_t marked_slices = 0;
  std::uint32_t tile_edge = 16;  ///< pixels along a cluster's tile: 8, 16, 32 or 64
};

/// All slices of depth up to where the farthest light ends, a bit each: where a medium that fills
/// the open may be lit.
std::uint32_t slices_lit(std::span<const shared::Light> lights);

/// The most lights of a picture that a device can sort.
std::uint32_t most_lights(const gpu::DeviceLimits& limits, const ClusterPicture& picture);

/// The grid for a picture. @param entries that there is room for. @param least_chunk_words that one
/// invocation looks through, a bit a light.
shared::ClusterGrid cluster_grid(const CameraView& camera, const ClusterPicture& picture,
                                 std::uint32_t light_count, std::uint64_t entries,
                                 std::uint32_t least_chunk_words);

/// A frame's lights, sorted: what a pass needs that includes shaders/include/light/clustered.glsl.
struct ClusteredLights {
  gpu::BufferRef grid, reaches, clusters, entries;
  gpu::BufferRef lights;       ///< texels of shared::Light[], then of shared::LightPane[]
  gpu::BufferRef tile_depths;  ///< shared::TileDepths[8x8 tile]
  std::uint32_t kinds = 0;     ///< bit a kind that the frame has; 0: there are none
  bool panes = false;          ///< some light has any
  /// Nothing is sorted: every pixel asks every light. The lights stand in for what is then never
  /// read, so that every binding is valid.
  bool oracle = false;
  gpu::BufferRef shafts;  ///< shared::TileShafts[8x8 tile], see ShaftPass; empty: nothing is known

  /// For a frame without lights: buffers that are never read.
  static ClusteredLights none(const SceneRefs& scene);
  std::vector<gpu::SpecConstant> with_lights(std::vector<gpu::SpecConstant> own) const {
    return with_kinds(std::move(own), kinds);
  }
  /// Of a pass that includes shaders/include/light/light_panes.glsl.
  std::vector<gpu::SpecConstant> with_panes(std::vector<gpu::SpecConstant> own) const;
  /// For a pass that tells tiles apart that some light reaches.
  LampReads tile_reads() const;
  /// Of a pass that asks only how many lights a cluster has.
  void declare_counts(gpu::PassBuilder& builder) const;
  auto count_bindings() const {
    return std::tuple{gpu::storage<shared::kLightGridBinding>(grid),
                      gpu::storage<shared::kClustersBinding>(clusters)};
  }
  void declare(gpu::PassBuilder& builder) const;
  auto bindings() const {
    return std::tuple{count_bindings(), gpu::texels<shared::kLightsBinding>(lights),
                      gpu::storage<shared::kLightEntriesBinding>(entries)};
  }
  /// Of a pass that includes shaders/include/light/blocked_lights.glsl, beside bindings().
  auto reach_binding() const { return gpu::storage<shared::kLightReachBinding>(reaches); }
  /// Of one that includes shafts.glsl with SKERRY_SHAFTS besides.
  auto shaft_binding() const {
    return gpu::storage<shared::kTileShaftsBinding>(shafts ? shafts : reaches);
  }

 private:
  std::vector<gpu::SpecConstant> with_kinds(std::vector<gpu::SpecConstant> own,
                                            std::uint32_t bits) const;
};

/// Depths of what a frame shows.
struct ClusterDepths {
  gpu::ImageRef surfaces, depth;        ///< of the G-buffer
  bool depth16 = false;                 ///< see DepthStore
  std::array<gpu::ImageRef, 4> layers;  ///< of translucent surfaces
  std::uint32_t layer_count = 0;
};

/// Sorts lights into the clusters of the picture's pyramid that show a surface (docs/lights.md):
/// counted, then listed, so that no list has a cap. Owns what outlives a frame: the lights and the
/// room for their lists.
class LightClusters {
 public:
  explicit LightClusters(gpu::Device& device) : device_(device) {}

  /// Takes a frame's lights to the GPU. More than most_lights() are cut off, and said so once.
  /// @param lights not empty, in view. Errors: out of memory.
  Result<void> upload(gpu::Uploader& uploader, std::span<const shared::Light> lights,
                      std::span<const shared::LightReach> reaches,
                      std::span<const shared::LightPane> panes, const CameraView& camera,
                      const ClusterPicture& picture);
  /// Takes as many lights of these kinds as most views have for uploaded, so that add() asks for
  /// the programs and the memory they need. @param kinds see light_kinds().
  void suppose(std::uint32_t kinds, const ClusterPicture& picture);
  /// Makes room for the lights of most views, if there is memory.
  void reserve();
  /// Adds the passes that sort what was uploaded last. @param oracle see ClusteredLights.
  ClusteredLights add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                      const ClusterDepths& depths, bool oracle);
  /// What was found, after add(): shared::ClusterWork; empty under the oracle.
  gpu::BufferRef work() const { return work_; }
  /// What a frame found that used `grid`: makes room for as many entries from the next upload on.
  void learn(const shared::ClusterGrid& grid, const shared::ClusterWork& found);
  /// Of the last upload().
  const shared::ClusterGrid& grid() const { return grid_; }

 private:
  Result<void> reserve(gpu::Buffer& buffer, const char* name, std::uint64_t size_bytes,
                       bool texels = false);
  Result<void> reserve_lights(std::uint64_t count, std::uint64_t panes);
  std::uint64_t roomy(std::uint64_t size_bytes) const;
  std::uint32_t least_chunk_words() const;

  gpu::Device& device_;
  gpu::Buffer grid_buffer_, lights_, reaches_, entries_;
  shared::ClusterGrid grid_{};
  std::uint32_t kinds_ = 0;  // see light_kinds()
  std::uint64_t wanted_entries_ = 0;
  bool said_too_many_ = false, said_no_room_ = false;
  gpu::BufferRef work_;
};

}  // namespace skerry::render
