#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/jobs.h"
#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/render/renderer/renderer.h"
#include "game/scene_file/options.h"
#include "game/sections/level_blends.h"
#include "game/sections/section_cuts.h"
#include "game/view/island_light.h"
#include "game/view/key_fades.h"
#include "game/view/light_field.h"
#include "game/view/scene_cache.h"
#include "game/view/sky_light_feed.h"
#include "game/view/view_fit.h"
#include "world/islands/world.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// A world and the renderer that shows it: streams islands in around the camera, hands chunk
/// meshes to the GPU and draws. Shared by shot, bench and play. The frame thread calls everything
/// here; generation and meshing run on jobs.
class SceneView {
 public:
  /// @param cache shared with other views, see there; null: none.
  /// Errors: no memory on the device; those of open_world.
  static Result<std::unique_ptr<SceneView>> create(gpu::Device& device, const SceneOptions& options,
                                                   SceneCache* cache = nullptr);
  /// Shows a world that is open already.
  static Result<std::unique_ptr<SceneView>> create(gpu::Device& device, const SceneOptions& options,
                                                   std::shared_ptr<world::World> world,
                                                   SceneCache* cache = nullptr);
  ~SceneView();

  /// The camera the options ask for: given, or the seed's spawn view at eye height.
  const render::Camera& start_camera() const { return start_camera_; }
  world::World& world() { return *world_; }
  const world::Streamer& streamer() const { return *streamer_; }
  render::Renderer& renderer() { return *renderer_; }
  Settings& settings() { return settings_; }  ///< may be changed between frames

  /// A block to outline, and how far it is dug.
  struct MarkedBlock {
    std::uint64_t island = 0;
    glm::dvec3 min{}, max{};  ///< box in the island's lattice [blocks]
    double dug = 0.0;         ///< 0 .. 1
  };
  struct Moment {
    render::Camera camera;
    double time_of_day_s = 43200.0;
    double world_time_s = 0.0;
    bool freeze_culling = false;
    bool capture = false;      ///< see render::FrameInput
    bool may_lag = false;      ///< likewise
    bool count_pixels = true;  ///< likewise
    /// What the eye has adapted to; the frame is metered for it nonetheless. None: as metered.
    std::optional<double> exposure_ev = {};
    std::optional<MarkedBlock> marked = {};
  };

  /// Waits until all that belongs to a moment is generated and meshed, then queues it in an
  /// order that does not depend on threads. The next draw() uploads everything at once.
  /// What memory does not hold is left out, the farthest detail first (notices() says so).
  /// @param blend_s see stream(). Errors: out of memory for a frame's own tables.
  Result<void> load_completely(const Moment& moment, std::optional<double> blend_s = {});
  /// Takes in what the workers have ready, within the frame's budget. Waits for nothing, but the
  /// first call for the programs that frames are expected to need.
  /// What memory does not hold is left out, the farthest detail first (notices() says so).
  /// @param blend_s seconds since the last call, over which levels of detail change pixel by pixel
  /// (LevelBlends); none: at once. Errors: out of memory for a frame's own tables.
  Result<void> stream(const Moment& moment, std::optional<double> blend_s = {});
  /// Whether levels of detail are changing.
  bool blending() const { return !blends_.idle(); }
  /// Whether everything within view distance has been handed to the renderer.
  bool complete() const { return streamer_->complete() && waiting_.empty(); }
  /// Whether the light that stays on faces is that of the world as it is, and the renderer has it.
  bool light_settled() const {
    return (!island_light_ || island_light_->settled()) && sky_light_.idle();
  }
  /// Seconds that threads have looked for that light so far.
  double light_seconds() const { return island_light_ ? island_light_->work_seconds() : 0.0; }
  /// Lines for the player since the last call: that memory is full, and what is shown instead.
  std::vector<std::string> notices() { return std::exchange(notices_, {}); }
  /// Of the last draw: lights handed to the renderer, and what it took to gather them.
  std::size_t lights() const { return lights_.lights.size(); }
  double gather_ms() const { return gather_ms_; }

  /// See render::Renderer::draw. A fixed exposure in the settings goes over the moment's.
  Result<std::uint64_t> draw(
      const Moment& moment, VkExtent2D size,
      const std::function<void(VkCommandBuffer, gpu::Image& picture)>& after = {},
      std::span<const VkSemaphoreSubmitInfo> waits = {},
      std::span<const VkSemaphoreSubmitInfo> signals = {});
  /// What an eye adapts to that has looked at the newest finished frame. That frame's own exposure
  /// plays no part in it, so nothing feeds back. @param ev before; none: the eye sees for the first
  /// time. @return `ev` if nothing was metered.
  std::optional<double> adapted_ev(std::optional<double> ev, double seconds) const;

 private:
  SceneView(const SceneOptions& options, std::shared_ptr<world::World> world, SceneCache* cache);
  struct IslandEntry {
    world::IslandSpec spec;
    std::uint32_t sections = 0;  // resident ones that name this slot; a slot without may be reused
    bool far = false;            // shown as one far section: no occupancy, no lamps
    int level = 0;               // of detail
  };
  struct ResidentSection {
    std::vector<render::SectionId> parts;
    world::SeamFaces seams;
    std::uint8_t closed = 0;    // at which faces `seams` are drawn, a bit each
    std::uint8_t to_close = 0;  // likewise, once its island's levels have changed
    std::optional<render::SectionId> closing;
    std::uint32_t blend = 0;  // shared::Section::blend
    bool shown = true;
    bool chosen = true;   // to be shown; else it may be on its way out
    bool leaves = false;  // the streamer has removed it; it is there until its island has blended
  };
  bool occupancy_wanted() const;
  Result<void> follow_settings();
  ViewFit::Distances asked() const;
  void update_streamer(const render::Camera& camera, double world_time_s);
  void take_in(world::StreamUpdate update);
  void add_waiting(std::uint64_t most_bytes);
  bool is_full() const;
  bool show_less(const render::Camera& camera);
  Result<void> restart_with_less(const render::Camera& camera, const std::string& why);
  Result<void> add_section(const world::ReadySection& ready);
  void release_island(const world::IslandLevel& row);
  void begin_to_stream();
  bool light_due();
  void load_light(const Moment& moment);
  void find_light(const Moment& moment, bool now);
  IslandLight::NearIslands islands_to_light(const Moment& moment, bool now);
  std::map<world::IslandLevel, SkyLightFeed::NearIsland> near_islands(const Moment& moment) const;
  bool hand_over_light(const Moment& moment, std::uint64_t most_bytes);
  render::IndirectStore* indirect_store();
  void open_to_sky(std::uint32_t slot);
  void refuse_light(const std::string& why);
  void remove_section(const world::SectionKey& key);
  void leave_section(const world::SectionKey& key);
  struct Choosing {
    bool keep = true;
    std::optional<double> blend_s = {};
  };
  void choose_levels(const render::Camera& camera, double world_time_s, const Choosing& how);
  void choose_cuts(const render::Camera& camera, double world_time_s, bool keep);
  void choose_section(const world::SectionKey& key, bool chosen);
  void tell_left(const std::set<world::IslandLevel>& coming);
  void apply_blends();
  void show_section(const world::SectionKey& key, ResidentSection& section, bool shown);
  void blend_section(ResidentSection& section, std::uint32_t blend);
  void close_section(const world::SectionKey& key, ResidentSection& section, std::uint8_t seams);
  void forget_blends();
  std::vector<double> nearest_of_levels(const render::Camera& camera,
                                        const world::IslandSpec& spec) const;
  Result<std::uint32_t> island_slot(const world::SectionKey& key);
  void place_islands(double world_time_s);
  std::vector<PlacedIsland> placed_islands(const render::FixedPos& camera) const;
  void gather_lights(const Moment& moment, VkExtent2D size, bool in_the_open);
  bool lights_count_in_the_open(std::uint32_t medium) const;
  struct Medium {
    world::BlockId block = world::kAir;            // translucent, or air
    std::optional<render::MediumSurface> surface;  // where it ends above, in what light passes
  };
  Medium medium_at(const render::Camera& camera) const;
  std::optional<render::BlockMarker> marker_of(const Moment& moment) const;
  render::FrameInput empty_input(const Moment& moment) const;
  render::FrameInput frame_input(const Moment& moment, VkExtent2D size);
  void expect_frame(const Moment& moment);
  double reach(const render::FixedPos& camera) const;
  double kept_reach(const render::FixedPos& camera);

  Settings settings_;
  SceneCache* cache_;  // null: none
  std::unique_ptr<Jobs> jobs_;
  std::shared_ptr<world::World> world_;
  std::unique_ptr<world::Streamer> streamer_;
  std::unique_ptr<render::Renderer> renderer_;
  render::Camera start_camera_;
  std::vector<IslandEntry> islands_;                          // by GPU slot
  std::size_t first_free_slot_ = 0;                           // no free one is lower
  std::map<world::IslandLevel, std::uint32_t> island_slots_;  // slots
  std::map<world::IslandLevel, std::uint32_t> near_slots_;    // of them, those that are not far
  SectionCuts cuts_;
  LevelBlends blends_;
  bool blends_levels_ = false;           // in this call of stream() or load_completely()
  std::set<world::SectionKey> fresh_;    // have come since levels were last chosen
  std::vector<world::SectionKey> left_;  // shown ones that leave since
  struct Chosen {
    std::vector<world::SectionKey> came, went;
  };
  std::map<std::uint64_t, Chosen> chosen_;  // by island, since blends_ was last told
  /// By island: sections whose seams are due when its levels have changed.
  std::map<std::uint64_t, std::set<world::SectionKey>> to_close_;
  VkExtent2D size_;                                  // of the last frame, or as asked for
  std::vector<render::IslandPlacement> placements_;  // of the last frame, by slot
  std::vector<shared::Quad> quads_by_part_;          // working memory of add_section()
  /// Resident chunks; without a section, what is known of them is which voxels are opaque.
  std::map<world::SectionKey, ResidentSection> sections_;
  std::deque<world::ReadySection> waiting_;  // for memory or the next frame; nearest islands first
  bool streams_ = false;                     // stream() has been called
  int frames_without_light_ = 0;             // that stream() was called for
  bool more_next_frame_ = false;             // what waits was enough for one frame
  ViewFit fit_;
  ViewFit::Distances asked_before_;
  int frames_since_lowered_ = 0;
  std::vector<std::string> notices_;
  render::OccupancyStore* occupancy_ = nullptr;   // the renderer's; null: not wanted so far
  render::IndirectStore* indirect_ = nullptr;     // the renderer's; null: no light so far
  std::unique_ptr<WorkerThreads> light_threads_;  // of island_light_
  std::unique_ptr<IslandLight> island_light_;     // none: not wanted so far
  SkyLightFeed sky_light_;                        // what island_light_ has found
  KeyFades key_fades_;                            // of what the renderer has of it
  std::map<world::IslandLevel, glm::vec3> key_directions_;  // as last looked at
  bool light_refused_ = false;     // for want of memory, and that has been said
  bool islands_left_out_ = false;  // and that has been said
  bool weak_lamps_kept_ = false;   // by island_light_, not by light_field_
  bool cloud_volumes_ = false;     // what lamps light in the air, too
  LightField light_field_;
  FrameLights lights_;  // of the last frame
  double gather_ms_ = 0.0;
  double reach_ = 0.0;  // of the last frame
};

}  // namespace skerry::game
