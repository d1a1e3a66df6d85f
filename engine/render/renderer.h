#pragma once
#include <volk.h>

#include <array>
#include <cstdint>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/gpu/frame_graph.h"
#include "engine/gpu/uploader.h"
#include "engine/render/camera.h"
#include "engine/render/celestial.h"
#include "engine/render/cloud_atlas.h"
#include "engine/render/geometry_store.h"
#include "engine/render/occupancy_store.h"
#include "engine/render/settings.h"
#include "shaders/shared/clusters.h"
#include "shaders/shared/exposure.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/geometry.h"
#include "shaders/shared/light.h"

namespace skerry::render {

/// Where an island is this frame. Its index in FrameInput::islands is what Section::island holds.
struct IslandPlacement {
  FixedPos origin{};                        ///< of its lattice
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< world from lattice
  double bounding_radius = 0.0;             ///< blocks about the origin
};

/// The block that a player points at: an outline over the picture, and cracks as it is dug.
struct BlockMarker {
  std::uint32_t island = 0;       ///< index of FrameInput::islands
  glm::dvec3 min{0.0}, max{1.0};  ///< box in its lattice [blocks]
  float dug = 0.0f;               ///< 0 .. 1
};

/// What a frame can be asked to copy out for measuring, besides the picture.
enum class Capture : std::uint8_t {
  kRadiance,   ///< RGBA16F, before exposure
  kDepth,      ///< D32, reverse-Z; absent from a frame without geometry, or with another depth
  kSurfaces,   ///< R32_UINT, the G-buffer's words; absent likewise
  kShadowMaps  ///< D32 layers, all cascades of the sun, then of the moon; absent when nothing casts
};

/// An image copied out of a frame: texels of its own format, rows from the top, layer by layer.
struct Captured {
  VkExtent2D size{};
  std::uint32_t layers = 0;  ///< 0: the frame had no such image
  std::vector<std::byte> texels;
};

/// A texel broken on purpose, to see that no pass hands on what is not finite.
struct Fault {
  enum class In : std::uint8_t {
    kSkyTable,       ///< before anything samples it
    kShaded,         ///< scene radiance, before water is looked through
    kLookedThrough,  ///< scene radiance, before it is developed
  };
  In in = In::kShaded;
  glm::uvec2 texel{};
  float value = 0.0f;  ///< of all four channels
};

/// Everything that decides one picture besides the resident geometry. Plain values, const once
/// built.
struct FrameInput {
  Camera camera;
  FixedPos anchor{};  ///< moves with the world's offset; pictures depend on differences to it alone
  std::span<const IslandPlacement> islands;  ///< at most shared::kMaxIslands
  Celestial sky{};
  std::span<const shared::Light> lights;  ///< finite, in an order that does not depend on threads
  std::span<const std::uint32_t> light_islands;  ///< indices of `islands`, see shared::Light
  /// Which of how many frames that average into one picture, drawn one after another; in each, sun
  /// and moon light from another place of their discs. The last one develops the picture.
  std::uint32_t part = 0, parts = 1;
  /// Picture = tone curve(radiance * 2^-EV). None: as the meter finds this very frame.
  std::optional<float> exposure_ev = 0.0f;
  bool meter = false;               ///< meter the frame even though its exposure is given
  double time_s = 0.0;              ///< seconds of play: water ripples
  std::uint32_t camera_medium = 0;  ///< block id the camera is in, if translucent; else 0
  bool freeze_culling =
      false;             ///< keep culling with the camera of the frame in which this became true
  bool capture = false;  ///< copy out what Capture names; the picture is made by way of radiance
  std::optional<BlockMarker> marker;  ///< not drawn over debug views
  std::optional<Fault> fault;         ///< implies the way by radiance, too
};

/// Numbers of a frame the GPU has finished. Times are sums over its parts.
struct FrameReport {
  std::vector<gpu::PassTime> passes;
  double gpu_ms = 0.0;
  shared::CullStats camera{};
  shared::CullStats shadows{};  ///< sums over the cascades drawn
  shared::PixelStats pixels{};
  float exposure_ev = 0.0f;  ///< that the picture was developed at
  /// What the meter asks for; none if it was not asked, or every pixel it looked at was as good as
  /// black.
  std::optional<float> metered_ev;
  std::uint32_t lights = 0;        ///< whose range the view touches
  shared::ClusterWork clusters{};  ///< that those were sorted into; none under the oracle
  gpu::FrameCounts counts{};       ///< of the frame's graph
  int pipelines_created = 0;       ///< since the renderer was made
  std::uint64_t memory_bytes = 0;  ///< of the device, in use when the frame was recorded
};

struct RendererDesc {
  std::span<const shared::Material> materials;  ///< indexed by block id
  gpu::UploadPath upload_path = gpu::UploadPath::kUpdateBuffer;
  std::uint64_t upload_budget_bytes = 4u << 20;  ///< chunk meshes a frame
  std::uint32_t arena_quads = 1u << 20;          ///< to begin with
};

/// Draws frames: owns what lives longer than one (geometry, textures, shadow maps, the picture) and
/// assembles each frame's graph.
class Renderer {
 public:
  static Result<std::unique_ptr<Renderer>> create(gpu::Device& device, const RendererDesc& desc);
  ~Renderer();  ///< waits for the GPU

  GeometryStore& geometry();
  /// Which voxels are opaque: for corners and traced lights. Made when first asked for; a renderer
  /// that is never asked has none, and draws neither. Errors: out of memory.
  Result<OccupancyStore*> occupancy();
  gpu::Uploader& mesh_uploader();
  /// Clouds of files, in the place of all before. @param volumes what they point to is not kept.
  /// Errors: see Clouds::set_volumes.
  Result<void> set_clouds(std::span<const CloudVolumeDesc> volumes, CloudPrecision precision);
  /// Bytes of chunk meshes that one frame may upload, from now on.
  void set_upload_budget(std::uint64_t bytes);
  const gpu::FrameGraph& graph() const;  ///< of the last frame, for --explain
  int pipelines_created() const;

  /// Records and submits one frame. Two are in flight; waits for the one before last.
  /// @param after records into the same command buffer behind the frame, e.g. the copy to a window;
  /// @param waits, signals for the swapchain.
  /// @return the timeline value that completes the frame. Errors: size over the device's limit, out
  /// of memory.
  Result<std::uint64_t> draw(
      const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
      const std::function<void(VkCommandBuffer, gpu::Image& picture)>& after = {},
      std::span<const VkSemaphoreSubmitInfo> waits = {},
      std::span<const VkSemaphoreSubmitInfo> signals = {});

  /// RGBA8 picture of the last frame.
  gpu::Image& picture();
  /// What the last frame, drawn with FrameInput::capture, has copied out. Waits for it.
  Captured captured(Capture what);
  /// The newest frame that has completed; empty before the third draw unless finish() was called.
  const std::optional<FrameReport>& report() const;
  /// Waits for all frames and takes in their numbers.
  void finish();
  /// Shadow maps are drawn afresh in the next frame, whatever has been kept.
  void forget_shadows();

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace skerry::render
