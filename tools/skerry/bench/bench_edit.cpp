#include "tools/skerry/bench/bench_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/clock.h"
#include "game/player/edit_rules.h"
#include "game/player/interaction.h"
#include "game/player/world_surroundings.h"
#include "game/view/scene_view.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"
#include "world/light/air_volume.h"

namespace skerry::tools {
namespace {

constexpr int kWarmUpFrames = 6, kEditRounds = 24, kMostFrames = 600;
constexpr double kTurnDeg = 15.0, kPitchDeg = -50.0;

/// Times of one kind of edit.
struct Kind {
  std::string_view name;
  std::vector<double> frames, ms, light_ms, work_ms;
};

/// A loaded scene and someone who edits what lies before them.
class Editing {
 public:
  Editing(gpu::Device& device, game::SceneView& view, const game::SceneOptions& scene)
      : device_(device),
        view_(view),
        editor_(view.world()),
        around_(view.world()),
        size_{scene.size.width, scene.size.height},
        moment_{view.start_camera(), static_cast<double>(scene.time_of_day_s),
                scene.settings.world_time_s} {
    moment_.camera.pitch_deg = kPitchDeg;
    const render::FixedPos& at = moment_.camera.position;
    eye_ = {at[0], at[1], at[2]};
    around_.refresh(eye_, 0.0, moment_.world_time_s);
  }

  /// Looks at the next place, draws it, and times frames on the way.
  Result<void> turn() {
    moment_.camera.yaw_deg += kTurnDeg;
    for (int i = 0; i < kWarmUpFrames; ++i) {
      const Stopwatch watch;
      const Result<std::uint64_t> value = frame();
      if (!value) return value.error();
      device_.wait(*value);
      if (i > 0) frame_ms_.push_back(watch.milliseconds());
    }
    return {};
  }
  std::optional<game::Pick> pick() const {
    return game::pick_block(around_, eye_,
                            game::view_direction(moment_.camera.yaw_deg, moment_.camera.pitch_deg),
                            game::kHandReach, moment_.world_time_s);
  }
  game::EditAct dig() const {
    const auto at = pick();
    return at ? game::dig_act(around_, at->island, at->voxel) : game::EditAct{};
  }
  game::EditAct place(world::BlockId block) const {
    const auto at = pick();
    return at ? game::place_act(around_, *at, block, moment_.world_time_s) : game::EditAct{};
  }

  /// Acts that each place a block above an island, where no chunk has been before: in the middle of
  /// the chunk above each of its columns of chunks.
  std::vector<game::EditAct> builds_in_new_chunks(std::uint64_t island) const {
    std::map<std::pair<int, int>, int> tops;
    for (const world::IVec3& chunk : view_.world().chunks(island, 0)) {
      int& top = tops.try_emplace({chunk.x, chunk.z}, chunk.y).first->second;
      top = std::max(top, chunk.y);
    }
    std::vector<game::EditAct> out;
    constexpr int kHalf = world::kChunkEdge / 2;
    for (const auto& [column, top] : tops) {
      const world::IVec3 low = world::corner_of({column.first, top + 1, column.second});
      const world::IVec3 voxel{low.x + kHalf, low.y, low.z + kHalf};
      out.push_back({{island, voxel, world::kAir, world::block::kStone}});
    }
    return out;
  }

  /// Does an act and draws until a picture shows it. @return whether it was done.
  Result<bool> time(const game::EditAct& act, Kind& kind) {
    if (act.empty()) return false;
    const Stopwatch watch;
    work_before_s_ = view_.light_seconds();
    const std::uint64_t shown = view_.renderer().geometry().changes().version();
    if (!history_.perform(act, editor_)) return false;
    for (int frames = 1; frames <= kMostFrames; ++frames) {
      const Result<std::uint64_t> value = frame();
      if (!value) return value.error();
      if (view_.renderer().geometry().changes().version() == shown ||
          view_.renderer().mesh_uploader().pending_bytes() != 0)
        continue;
      device_.wait(*value);
      kind.ms.push_back(watch.milliseconds());
      kind.frames.push_back(frames);
      return settle(watch, kind);
    }
    return Error{
        fmt::format("an edit was not drawn within {} frames; this is a fault of the "
                    "program, please report it",
                    kMostFrames)};
  }
  const std::vector<double>& frame_ms() const { return frame_ms_; }

 private:
  /// Draws until all light that the edit changes is in a picture.
  Result<bool> settle(const Stopwatch& watch, Kind& kind) {
    for (int frames = 1; frames <= kMostFrames; ++frames) {
      const bool settled =
          view_.light_settled() && view_.renderer().mesh_uploader().pending_bytes() == 0;
      const Result<std::uint64_t> value = frame();
      if (!value) return value.error();
      device_.wait(*value);
      if (!settled) continue;
      kind.light_ms.push_back(watch.milliseconds());
      kind.work_ms.push_back((view_.light_seconds() - work_before_s_) * 1e3);
      return true;
    }
    return Error{
        fmt::format("light was not settled within {} frames after an edit; this is a fault of the "
                    "program, please report it",
                    kMostFrames)};
  }
  Result<std::uint64_t> frame() {
    if (const auto done = view_.stream(moment_); !done) return done.error();
    return view_.draw(moment_, size_);
  }

  gpu::Device& device_;
  game::SceneView& view_;
  game::WorldEditor editor_;
  game::WorldSurroundings around_;
  game::EditHistory history_;
  VkExtent2D size_;
  game::SceneView::Moment moment_;
  world::WorldPos eye_;
  std::vector<double> frame_ms_;
  double work_before_s_ = 0.0;
};

nlohmann::ordered_json report(const Kind& kind, const gpu::Device& device, VkExtent2D size,
                              double frame_ms) {
  const Spread frames = spread_of(kind.frames), ms = spread_of(kind.ms),
               light = spread_of(kind.light_ms), work = spread_of(kind.work_ms);
  const double most_frames = *std::max_element(kind.frames.begin(), kind.frames.end());
  const double most_ms = *std::max_element(kind.ms.begin(), kind.ms.end());
  fmt::print(
      "{:<16} {:>5} {:>7.0f} {:>6.0f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} "
      "{:>9.1f} {:>9.1f}\n",
      kind.name, kind.ms.size(), frames.median, most_frames, ms.median, ms.p90, most_ms,
      light.median, light.p90, work.median, work.p90, frame_ms);
  return {{"name", kind.name},
          {"device", device.info().name},
          {"size", {size.width, size.height}},
          {"edits", kind.ms.size()},
          {"frames_median", frames.median},
          {"frames_most", most_frames},
          {"ms_median", ms.median},
          {"ms_p90", ms.p90},
          {"ms_most", most_ms},
          {"light_ms_median", light.median},
          {"light_ms_p90", light.p90},
          {"light_work_ms_median", work.median},
          {"light_work_ms_p90", work.p90},
          {"frame_ms_median", frame_ms}};
}

}  // namespace

int bench_edit(const BenchEditOptions& options) {
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(**device, options.scene);
  if (!view) return fail(kFailed, view.error());
  if (Result<void> loaded = (*view)->load_completely(
          {(*view)->start_camera(), static_cast<double>(options.scene.time_of_day_s),
           options.scene.settings.world_time_s});
      !loaded)
    return fail(kFailed, loaded.error());

  Editing editing(**device, **view, options.scene);
  Kind dug{"dig", {}, {}, {}, {}}, torch{"place a torch", {}, {}, {}, {}},
      taken{"take it back", {}, {}, {}, {}}, new_chunk{"in a new chunk", {}, {}, {}, {}};
  for (int round = 0; round < kEditRounds; ++round) {
    if (Result<void> turned = editing.turn(); !turned) return fail(kFailed, turned.error());
    const auto timed = [&](const game::EditAct& act, Kind& kind) -> Result<bool> {
      return editing.time(act, kind);
    };
    Result<bool> done = timed(editing.dig(), dug);
    if (done && *done) done = timed(editing.place(world::block::kTorch), torch);
    if (done && *done) done = timed(editing.dig(), taken);
    if (!done) return fail(kFailed, done.error());
  }
  if (const std::optional<game::Pick> at = editing.pick()) {
    // The island outgrows what is kept of it by the first one.
    Kind first{"", {}, {}, {}, {}};
    for (const game::EditAct& act : editing.builds_in_new_chunks(at->island))
      if (Result<bool> done = editing.time(act, first.ms.empty() ? first : new_chunk); !done)
        return fail(kFailed, done.error());
  }
  (*view)->renderer().finish();
  if (taken.ms.empty())
    return fail(kFailed, {"nothing lies within reach of this view; give --camera near ground"});

  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  const double frame_ms = spread_of(editing.frame_ms()).median;
  fmt::print("{:<16} {:>5} {:>7} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "edit", "count",
             "frames", "most", "median", "p90", "most", "light", "p90", "frame");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Kind* kind : {&dug, &torch, &taken, &new_chunk})
    if (!kind->ms.empty()) rows.push_back(report(*kind, **device, size, frame_ms));
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
