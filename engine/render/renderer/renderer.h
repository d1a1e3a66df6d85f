#pragma once
#include <volk.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/frame_report.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/indirect_store.h"
#include "engine/render/scene/geometry_store.h"
#include "engine/render/scene/occupancy_store.h"
#include "engine/render/sky/cloud_atlas.h"
#include "engine/render/sky/panorama_sky.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

struct RendererDesc {
  std::span<const shared::Material> materials;  ///< indexed by block id
  gpu::UploadPath upload_path = gpu::UploadPath::kUpdateBuffer;
  std::uint64_t upload_budget_bytes = 4u << 20;  ///< chunk meshes a frame
  std::uint32_t arena_quads = 1u << 20;          ///< to begin with
  /// Most bytes of the world's tables on the device; 0: five eighths of its memory, so that a
  /// frame's images and tables have the rest.
  std::uint64_t world_budget_bytes = 0;
  /// Of the same device, shared with other renderers; outlives them. Null: the renderer has its
  /// own.
  gpu::Pipelines* pipelines = nullptr;
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
  /// How much of the sky each face sees. Made when first asked for; a renderer that is never asked
  /// has none, and draws no light of the sky. Errors: out of memory.
  Result<IndirectStore*> indirect();
  gpu::Uploader& mesh_uploader();
  /// Bytes of the world's tables: what is resident in them, and the most that may be.
  struct WorldMemory {
    std::uint64_t used = 0, limit = 0;
  };
  WorldMemory world_memory() const;
  /// Waits for the GPU; then what has been removed may be overwritten.
  void reclaim();
  /// Begins with an empty world that may take `bytes`: all sections and islands are gone, and their
  /// memory is the device's again. Waits for the GPU. geometry() and occupancy() are other objects
  /// from now on. Errors: out of memory.
  Result<void> restart_world(std::uint64_t bytes);
  /// Clouds of files, in the place of all before. @param volumes what they point to is not kept.
  /// Errors: see Clouds::set_volumes.
  Result<void> set_clouds(std::span<const CloudVolumeDesc> volumes, CloudPrecision precision);
  /// A panorama in place of the air's sky, for all frames from now on; null: none. Waits for the
  /// GPU. Errors: out of memory.
  Result<void> set_panorama(std::shared_ptr<const PanoramaSky> panorama);
  /// Bytes of chunk meshes that one frame may upload, from now on.
  void set_upload_budget(std::uint64_t bytes);
  const gpu::FrameGraph& graph() const;  ///< of the last frame, for --explain
  /// Whether reports name the time of each pass, as they do to begin with, or of the whole frame,
  /// which costs less on some drivers: see FrameGraph::time_passes.
  void time_passes(bool each);
  /// From now on each frame asks for the programs that later ones can need as settings and world
  /// are, and worker threads make them: docs/frame.md. Until then a frame asks for its own alone. A
  /// frame that may lag is drawn by earlier settings as long as programs for its own are missing.
  void foresee_programs();
  /// Has worker threads make the programs that a frame will need, so that it waits for fewer. While
  /// no section is resident some are supposed to be, and what comes otherwise has been made for
  /// nothing. Light of the sky is supposed to be found by then. Where there is no memory for the
  /// frame nothing is made: draw() will say so.
  void expect(const FrameInput& input, const RenderSettings& settings, VkExtent2D size);
  bool lagged() const;  ///< whether the last frame was drawn so
  /// Pipelines that frames have used, and those of them that a frame had to wait for; with shared
  /// ones, frames of all renderers.
  int pipelines_created() const;
  int programs_made() const;
  /// Pipelines that worker threads have still to make for the frames so far and those foreseen.
  std::size_t programs_to_come() const;
  void wait_for_programs();  ///< until there are none
  /// Makes one of those that frames wait for or expect on this thread. @return false: none is left
  /// to begin with.
  bool make_program();

  /// From now on each pass of a frame is submitted by itself and waited for: a driver that compiles
  /// a program at its first use takes seconds for a first frame. @param progress is called before
  /// each with the number of passes done and of all, and may submit work of its own; empty: frames
  /// are submitted whole, as they are to begin with.
  void step_frames(std::function<void(std::uint32_t done, std::uint32_t all)> progress);

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
  void invalidate_shadows();
  /// The next frame of `aa=temporal` is mixed with none before it.
  void invalidate_history();

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace skerry::render
