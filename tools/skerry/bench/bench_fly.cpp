#include "tools/skerry/bench/bench_fly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "engine/core/clock.h"
#include "game/input/controls.h"
#include "game/player/player.h"
#include "game/player/world_surroundings.h"
#include "game/view/scene_view.h"
#include "game/worlds/open_session.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

constexpr double kSpeed = 48.0, kSeconds = 60.0;  // blocks/s: four times a player's usual flight
constexpr double kAboveStart = 32.0;              // blocks
constexpr double kFlyPitchDeg = -12.0;
constexpr double kLongestStart = 120.0;  // s; what has no geometry in view is never playable
constexpr double kDayRate = 24.0;        // seconds of day a second, as in play
constexpr std::size_t kWorst = 8;        // frames that are listed one by one

/// What a frame took, and where.
struct Frame {
  double at_s = 0.0, ms = 0.0, stream_ms = 0.0, draw_ms = 0.0, gpu_ms = 0.0;
  double cpu_ms = 0.0;  // that this thread worked, rather than waited
  std::uint64_t pending_bytes = 0, world_bytes = 0;
  double holes = 0.0;  // see holes()
  int programs = 0;    // that it waited for
  std::uint64_t allocations = 0;
  std::string allocated;  // what the last of them was for
  std::vector<gpu::PassTime> passes;
};

/// Share of an arena that is free, but not in its largest free run.
double holes(const gpu::OffsetArena& arena) {
  const std::uint32_t taken = arena.used() + arena.waiting() + arena.largest_free();
  return static_cast<double>(arena.capacity() - taken) / static_cast<double>(arena.capacity());
}

world::WorldPos place_of(const render::FixedPos& p) {
  return {p[0], p[1], p[2]};
}

/// Someone who flies straight ahead, always at the same places at the same times.
class Flight {
 public:
  Flight(game::SceneView& view, const BenchFlyOptions& options)
      : view_(view),
        size_{options.scene.size.width, options.scene.size.height},
        speed_(options.speed.value_or(kSpeed)),
        start_s_(options.scene.settings.world_time_s),
        day_(options.scene.time_of_day_s) {
    moment_.camera = view.start_camera();
    moment_.count_pixels = false;
    moment_.may_lag = true;
    moment_.camera.pitch_deg = kFlyPitchDeg;
    start_ = world::moved(place_of(moment_.camera.position), {0.0, kAboveStart, 0.0});
    go_to(0.0);
  }

  /// As who stood there for a while: all is in view, and no program is still being made.
  Result<void> begin(gpu::Device& device) {
    if (Result<void> loaded = view_.load_completely(moment_); !loaded) return loaded;
    view_.renderer().foresee_programs();
    for (int i = 0; i < 8; ++i) {
      const Result<std::uint64_t> value = view_.draw(moment_, size_);
      if (!value) return value.error();
      device.wait(*value);
      moment_.exposure_ev = view_.adapted_ev(moment_.exposure_ev, 0.0);
    }
    view_.renderer().wait_for_programs();
    return {};
  }

  Result<void> fly(const gpu::Device& device, double seconds) {
    const Stopwatch flight;
    double last_s = 0.0;
    for (double at_s = 0.0; at_s < seconds;) {
      go_to(at_s);
      Frame frame;
      frame.at_s = at_s;
      const double cpu_s = thread_seconds();
      const int programs = view_.renderer().programs_made();
      const std::uint64_t allocations = device.allocations();
      Stopwatch watch;
      const Result<void> done = view_.stream(moment_, at_s - std::exchange(last_s, at_s));
      if (!done) return done;
      frame.stream_ms = watch.milliseconds();
      watch.restart();
      const Result<std::uint64_t> value = view_.draw(moment_, size_);
      if (!value) return value.error();
      frame.draw_ms = watch.milliseconds();
      moment_.exposure_ev = view_.adapted_ev(moment_.exposure_ev, frame.draw_ms * 1e-3);
      frame.cpu_ms = (thread_seconds() - cpu_s) * 1e3;
      frame.world_bytes = view_.renderer().world_memory().used;
      frame.holes = holes(view_.renderer().geometry().arena());
      frame.pending_bytes = view_.renderer().mesh_uploader().pending_bytes();
      frame.programs = view_.renderer().programs_made() - programs;
      frame.allocations = device.allocations() - allocations;
      if (frame.allocations != 0) frame.allocated = device.last_allocation();
      // The newest report is of the frame that the one before had to wait for.
      if (const auto& report = view_.renderer().report(); report && !frames_.empty()) {
        frames_.back().passes = report->passes;
        frames_.back().gpu_ms = report->gpu_ms;
      }
      const double now_s = flight.seconds();
      frame.ms = (now_s - at_s) * 1e3;
      day_.turn(kDayRate * (now_s - at_s));
      at_s = now_s;
      frames_.push_back(std::move(frame));
    }
    view_.renderer().finish();
    return {};
  }
  const std::vector<Frame>& frames() const { return frames_; }

 private:
  void go_to(double at_s) {
    const double yaw = glm::radians(moment_.camera.yaw_deg);
    const glm::dvec3 ahead{std::sin(yaw), 0.0, std::cos(yaw)};
    const world::WorldPos at = world::moved(start_, ahead * (speed_ * at_s));
    moment_.camera.position = {at.x, at.y, at.z};
    moment_.time_of_day_s = day_.time_of_day_s();
    moment_.world_time_s = start_s_ + at_s;
  }

  game::SceneView& view_;
  VkExtent2D size_;
  double speed_, start_s_;
  game::DayClock day_;
  game::SceneView::Moment moment_;
  world::WorldPos start_;
  std::vector<Frame> frames_;
};

/// Median of each pass over the frames that ran it.
std::map<std::string, double> usual_passes(const std::vector<Frame>& frames) {
  std::map<std::string, std::vector<double>> all;
  for (const Frame& frame : frames)
    for (const gpu::PassTime& pass : frame.passes) all[pass.name].push_back(pass.ms);
  std::map<std::string, double> usual;
  for (auto& [name, ms] : all) usual[name] = spread_of(ms).median;
  return usual;
}

/// The pass that took most beyond what it usually takes.
std::pair<std::string, double> slow_pass(const Frame& frame,
                                         const std::map<std::string, double>& usual) {
  std::pair<std::string, double> slowest{"-", 0.0};
  for (const gpu::PassTime& pass : frame.passes)
    if (const double beyond = pass.ms - usual.at(pass.name); beyond > slowest.second)
      slowest = {pass.name, beyond};
  return slowest;
}

nlohmann::ordered_json hitches_of(const std::vector<Frame>& frames, double limit_ms) {
  std::vector<const Frame*> slow;
  for (const Frame& frame : frames)
    if (frame.ms > limit_ms) slow.push_back(&frame);
  const std::map<std::string, double> usual = usual_passes(frames);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Frame* frame : slow) {
    const auto [pass, beyond_ms] = slow_pass(*frame, usual);
    rows.push_back({{"at_s", frame->at_s},
                    {"ms", frame->ms},
                    {"stream_ms", frame->stream_ms},
                    {"draw_ms", frame->draw_ms},
                    {"cpu_ms", frame->cpu_ms},
                    {"gpu_ms", frame->gpu_ms},
                    {"pending_bytes", frame->pending_bytes},
                    {"programs_made", frame->programs},
                    {"allocations", frame->allocations},
                    {"slow_pass", pass},
                    {"slow_pass_beyond_ms", beyond_ms}});
  }
  std::sort(slow.begin(), slow.end(), [](const Frame* a, const Frame* b) { return a->ms > b->ms; });
  slow.resize(std::min(slow.size(), kWorst));
  for (const Frame* frame : slow) {
    const auto [pass, beyond_ms] = slow_pass(*frame, usual);
    fmt::print(
        "  at {:5.2f} s {:8.1f} ms: streaming {:.1f}, drawing {:.1f}, of both on the CPU "
        "{:.1f}; GPU {:.1f}, most beyond the usual {} by {:.1f}; {} KiB to upload; {} programs "
        "made, {} allocations\n",
        frame->at_s, frame->ms, frame->stream_ms, frame->draw_ms, frame->cpu_ms, frame->gpu_ms,
        pass, beyond_ms, frame->pending_bytes / 1024, frame->programs, frame->allocations);
  }
  return rows;
}

/// The frames that allocated device memory, which a flight should have done before its second half.
nlohmann::ordered_json allocations_of(const std::vector<Frame>& frames) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Frame& frame : frames) {
    if (frame.allocations == 0) continue;
    rows.push_back(
        {{"at_s", frame.at_s}, {"allocations", frame.allocations}, {"last", frame.allocated}});
    if (frame.at_s > 0.5 * frames.back().at_s)
      fmt::print("  at {:5.2f} s {} allocations, the last for '{}'\n", frame.at_s,
                 frame.allocations, frame.allocated);
  }
  return rows;
}

/// How many took over twice the median of the frames about them: late ones, as against those of a
/// second in which all frames have more to draw.
std::size_t late_frames(const std::vector<double>& ms) {
  constexpr std::size_t kAbout = 15;  // on each side
  std::vector<double> about;
  std::size_t late = 0;
  for (std::size_t i = 0; i < ms.size(); ++i) {
    const auto first = ms.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, kAbout));
    const auto last = ms.begin() + static_cast<std::ptrdiff_t>(std::min(i + kAbout + 1, ms.size()));
    about.assign(first, last);
    const auto middle = about.begin() + std::ssize(about) / 2;
    std::nth_element(about.begin(), middle, about.end());
    late += ms[i] > 2.0 * *middle ? 1 : 0;
  }
  return late;
}

void add_numbers(nlohmann::ordered_json& row, const std::vector<Frame>& frames) {
  std::vector<double> ms, cpu_ms;
  std::uint64_t world_bytes = 0;
  double most_holes = 0.0;
  int programs = 0;
  std::uint64_t allocations = 0, late_allocations = 0;
  for (const Frame& frame : frames) {
    ms.push_back(frame.ms);
    cpu_ms.push_back(frame.cpu_ms);
    world_bytes = std::max(world_bytes, frame.world_bytes);
    most_holes = std::max(most_holes, frame.holes);
    programs += frame.programs;
    allocations += frame.allocations;
    if (frame.at_s > 0.5 * frames.back().at_s) late_allocations += frame.allocations;
  }
  const Spread spread = spread_of(ms);
  row["frames"] = ms.size();
  row["ms_median"] = spread.median;
  row["ms_p99"] = spread.p99;
  row["ms_max"] = spread.max;
  row["frames_over_2x"] = spread.over_twice;
  row["frames_late"] = late_frames(ms);
  row["cpu_ms_median"] = spread_of(std::move(cpu_ms)).median;
  row["programs_made"] = programs;
  row["allocations"] = allocations;
  row["allocations_second_half"] = late_allocations;
  row["world_bytes"] = world_bytes;
  row["arena_holes"] = most_holes;
}

void print(const nlohmann::ordered_json& row, std::uint64_t chunks_made) {
  const auto number = [&](const char* key) { return row.at(key).get<double>(); };
  const auto count = [&](const char* key) { return row.at(key).get<std::uint64_t>(); };
  fmt::print(
      "{} | {}x{} | {:.0f} blocks/s for {:.0f} s | {} frames | median {:.2f} ms, p99 {:.2f}, "
      "max {:.1f} | {} over twice the median, {} over twice that of 31 about them | CPU {:.2f} ms "
      "| {} programs made | {} allocations, "
      "{} of them in "
      "the second half | world {:.0f} MiB at most, {:.1f}% of its quads' room in holes | {} | {} "
      "chunks made\n",
      row.at("name").get<std::string>(), row.at("size")[0].get<int>(), row.at("size")[1].get<int>(),
      number("speed"), number("seconds"), count("frames"), number("ms_median"), number("ms_p99"),
      number("ms_max"), count("frames_over_2x"), count("frames_late"), number("cpu_ms_median"),
      count("programs_made"), count("allocations"), count("allocations_second_half"),
      number("world_bytes") / (1 << 20), 100.0 * number("arena_holes"),
      row.at("device").get<std::string>(), chunks_made);
}

std::string name_of(const game::SceneOptions& scene) {
  return scene.world ? "world " + *scene.world : "seed " + scene.seed_text.substr(0, 20);
}

/// Whether the voxels that surround a place are loaded: someone may stand and walk there.
bool is_ground_known(game::WorldSurroundings& around, world::WorldPos place, double time_s) {
  constexpr double kStep = 8.0;
  std::vector<std::uint64_t> islands;
  around.islands_near(place, kStep, time_s, islands);
  for (const std::uint64_t island : islands) {
    const std::optional<world::Pose> pose = around.pose(island, time_s);
    if (!pose) continue;
    const glm::dvec3 lattice =
        glm::conjugate(pose->rotation) * world::difference_blocks(place, pose->origin);
    for (int i = 0; i < 27; ++i) {
      const glm::dvec3 at = lattice + kStep * glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const world::IVec3 voxel{static_cast<std::int32_t>(std::floor(at.x)),
                               static_cast<std::int32_t>(std::floor(at.y)),
                               static_cast<std::int32_t>(std::floor(at.z))};
      if (!around.block(island, voxel)) return false;
    }
  }
  return true;
}

/// When there was what to be seen of a world, by the watch.
struct Started {
  double first_ms = 0.0;     // the first picture
  double playable_ms = 0.0;  // ground to stand on
  double coarse_ms = 0.0;    // something of every island
  double complete_ms = 0.0;  // everything
  int frames = 0;            // until it was playable
  std::size_t islands = 0;
};

/// Draws until everything is there. Errors: nothing can be seen; it takes too long; no memory.
Result<Started> wait_until_complete(gpu::Device& device, game::SceneView& view,
                                    const BenchFlyOptions& options, const Stopwatch& watch) {
  game::WorldSurroundings around(view.world());
  const game::SceneView::Moment moment{view.start_camera(),
                                       static_cast<double>(options.scene.time_of_day_s),
                                       options.scene.settings.world_time_s};
  const world::WorldPos eye = place_of(moment.camera.position);
  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  Started out;
  bool known = false;
  while (out.playable_ms == 0.0 || out.coarse_ms == 0.0 || out.complete_ms == 0.0) {
    if (watch.seconds() > kLongestStart)
      return Error{fmt::format("after {:.0f} s {}", kLongestStart,
                               out.playable_ms == 0.0
                                   ? "nothing can be seen: choose a --camera with an island in view"
                                   : "not all of the view is there: lower view.distance")};
    around.refresh(eye, 0.0, moment.world_time_s);
    // Once the ground is known its meshes are made, and handed over by the next call but one.
    const bool was_known = std::exchange(known, is_ground_known(around, eye, moment.world_time_s));
    if (Result<void> done = view.stream(moment); !done) return done.error();
    const Result<std::uint64_t> value = view.draw(moment, size);
    if (!value) return value.error();
    const bool handed_over = view.renderer().mesh_uploader().pending_bytes() == 0;
    const world::Streamer::Stats stats = view.streamer().stats();
    const bool playable =
        was_known && handed_over && view.renderer().geometry().sections_resident() != 0;
    const bool first = out.first_ms == 0.0, now_playable = out.playable_ms == 0.0 && playable,
               now_coarse =
                   out.coarse_ms == 0.0 && handed_over && stats.islands != 0 && stats.unshown == 0,
               now_complete = out.complete_ms == 0.0 && playable && view.complete();
    if (out.playable_ms == 0.0) ++out.frames;
    if (!first && !now_playable && !now_coarse && !now_complete) continue;
    device.wait(*value);
    if (first) out.first_ms = watch.milliseconds();
    if (now_playable) out.playable_ms = watch.milliseconds();
    if (now_coarse) out.coarse_ms = watch.milliseconds();
    if (now_complete) out.complete_ms = watch.milliseconds();
    out.islands = stats.islands;
  }
  return out;
}

}  // namespace

int bench_fly(const BenchFlyOptions& options) {
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(**device, options.scene);
  if (!view) return fail(kFailed, view.error());
  Flight flight(**view, options);
  if (Result<void> begun = flight.begin(**device); !begun) return fail(kFailed, begun.error());
  const double seconds = options.seconds.value_or(kSeconds);
  if (Result<void> flown = flight.fly(**device, seconds); !flown)
    return fail(kFailed, flown.error());

  nlohmann::ordered_json row{{"name", name_of(options.scene)},
                             {"device", (*device)->info().name},
                             {"size", {options.scene.size.width, options.scene.size.height}},
                             {"speed", options.speed.value_or(kSpeed)},
                             {"seconds", seconds}};
  add_numbers(row, flight.frames());
  print(row, (*view)->streamer().stats().chunks_made);
  row["allocated"] = allocations_of(flight.frames());
  row["hitches"] = hitches_of(flight.frames(), 2.0 * row["ms_median"].get<double>());
  if (Result<void> written = write_rows(options.json, nlohmann::ordered_json::array({row}));
      !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

int bench_start(const BenchFlyOptions& options) {
  const Stopwatch watch;
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  const double device_ms = watch.milliseconds();
  Result<std::unique_ptr<game::Session>> session = game::open_session(options.scene);
  if (!session) return fail(kFailed, session.error());
  const double open_ms = watch.milliseconds();
  Result<std::unique_ptr<game::SceneView>> view =
      game::SceneView::create(**device, options.scene, (*session)->world());
  if (!view) return fail(kFailed, view.error());
  const double view_ms = watch.milliseconds();

  const Result<Started> started = wait_until_complete(**device, **view, options, watch);
  if (!started) return fail(kFailed, started.error());
  const game::PictureSize size = options.scene.size;
  (*view)->renderer().finish();
  fmt::print(
      "{} | {}x{} | playable after {:.0f} ms, {} frames | {} islands: all coarse after {:.0f} ms, "
      "complete after {:.0f} | device {:.0f} ms, world {:.0f}, renderer {:.0f}, first picture "
      "{:.0f} | {}\n",
      name_of(options.scene), size.width, size.height, started->playable_ms, started->frames,
      started->islands, started->coarse_ms, started->complete_ms, device_ms, open_ms - device_ms,
      view_ms - open_ms, started->first_ms - view_ms, (*device)->info().name);
  const nlohmann::ordered_json row{{"name", name_of(options.scene)},
                                   {"device", (*device)->info().name},
                                   {"size", {size.width, size.height}},
                                   {"device_ms", device_ms},
                                   {"open_ms", open_ms},
                                   {"view_ms", view_ms},
                                   {"first_picture_ms", started->first_ms},
                                   {"playable_ms", started->playable_ms},
                                   {"frames", started->frames},
                                   {"islands", started->islands},
                                   {"coarse_ms", started->coarse_ms},
                                   {"complete_ms", started->complete_ms}};
  if (Result<void> written = write_rows(options.json, nlohmann::ordered_json::array({row}));
      !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
