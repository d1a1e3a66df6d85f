#include "tools/skerry/bench/bench_frame.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <map>

#include "engine/core/clock.h"
#include "game/input/controls.h"
#include "game/view/scene_view.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

constexpr int kFrameWarmUp = 8;
constexpr int kMinFrames = 30, kMaxFrames = 600;
constexpr double kMaxSeconds = 8.0;
constexpr int kPassFrames = 30;   // whose passes are timed
constexpr int kReportedLate = 2;  // frames in flight
constexpr double kTurnDegPerFrame = 0.5;
constexpr double kAdaptSeconds = 1.0 / 30.0;  // that the eye has for a frame

double now_ms() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double peak_rss_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// What was measured of frames, in order.
struct Timings {
  std::vector<double> frames;                         ///< [ms]
  std::vector<double> cpu;                            ///< of them, that the frame thread computes
  std::map<std::string, std::vector<double>> passes;  ///< on the GPU, of frames like the first ones
  int programs_made = 0;                              ///< that frames waited for
  std::uint64_t allocations = 0;                      ///< of device memory
};

/// As in play, where the eye has adapted to earlier frames, nobody sees counts of pixels, and
/// passes are not timed by themselves: timers cost, too.
Result<Timings> time_frames(const gpu::Device& device, game::SceneView& view,
                            game::SceneView::Moment moment, const BenchFrameOptions& options) {
  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  game::DayClock clock(options.scene.time_of_day_s);
  Timings out;
  view.renderer().foresee_programs();
  view.renderer().time_passes(false);
  double last = now_ms();
  const double start = last;
  for (int i = 0; i < kFrameWarmUp + kMaxFrames; ++i) {
    moment.camera.yaw_deg += kTurnDegPerFrame;
    const int programs = view.renderer().programs_made();
    const std::uint64_t allocations = device.allocations();
    const double cpu_s = thread_seconds();
    if (Result<std::uint64_t> drawn = view.draw(moment, size); !drawn) return drawn.error();
    moment.exposure_ev = view.adapted_ev(moment.exposure_ev, kAdaptSeconds);
    const double cpu_ms = (thread_seconds() - cpu_s) * 1e3;
    if (i < kFrameWarmUp) view.renderer().wait_for_programs();
    const double now = now_ms();
    clock.turn(options.clock_rate * (now - last) * 1e-3);
    moment.time_of_day_s = clock.time_of_day_s();
    if (i >= kFrameWarmUp) {
      out.programs_made += view.renderer().programs_made() - programs;
      out.allocations += device.allocations() - allocations;
      out.frames.push_back(now - last);
      out.cpu.push_back(cpu_ms);
    }
    last = now;
    if (i >= kFrameWarmUp + kMinFrames && now - start > kMaxSeconds * 1000.0) break;
  }
  view.renderer().finish();
  return out;
}

/// The beginning of the turn again, with a timer behind each pass.
Result<void> time_passes(game::SceneView& view, game::SceneView::Moment moment, VkExtent2D size,
                         Timings& out) {
  moment.exposure_ev = view.adapted_ev({}, 0.0);
  view.renderer().time_passes(true);
  for (int i = 0; i < kReportedLate + kPassFrames; ++i) {
    moment.camera.yaw_deg += kTurnDegPerFrame;
    if (Result<std::uint64_t> drawn = view.draw(moment, size); !drawn) return drawn.error();
    if (i < kReportedLate) continue;
    for (const gpu::PassTime& pass : view.renderer().report()->passes)
      out.passes[pass.name].push_back(pass.ms);
  }
  return {};
}

/// Medians by pass, and their total. A pass that ran in some frames only (a shadow map drawn once)
/// counts by its mean over all frames.
nlohmann::ordered_json pass_times(const Timings& timings) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  double total = 0.0;
  for (const auto& [name, samples] : timings.passes) {
    double sum = 0.0;
    for (const double sample : samples) sum += sample;
    out[name] = samples.size() == kPassFrames ? spread_of(samples).median : sum / kPassFrames;
    total += out[name].get<double>();
  }
  out["total"] = total;
  return out;
}

nlohmann::ordered_json row_of(const game::SceneOptions& scene, const gpu::Device& device,
                              render::Renderer& renderer, const Timings& timings,
                              double clock_rate) {
  const Spread ms = spread_of(timings.frames);
  const game::Settings& settings = scene.settings;
  return {{"name", fmt::format("seed {} {:02}:{:02}", scene.seed_text.substr(0, 20),
                               scene.time_of_day_s / 3600, scene.time_of_day_s / 60 % 60)},
          {"device", device.info().name},
          {"size", {scene.size.width, scene.size.height}},
          {"distance", settings.view_distance},
          {"shadows", settings.render.shadow_enabled ? settings.render.shadow_size : 0},
          {"clock_rate", clock_rate},
          {"frames", timings.frames.size()},
          {"ms_median", ms.median},
          {"ms_p10", ms.p10},
          {"ms_p99", ms.p99},
          {"ms_max", ms.max},
          {"frames_over_2x", ms.over_twice},
          {"cpu_ms_median", spread_of(timings.cpu).median},
          {"fps_median", 1000.0 / ms.median},
          {"programs_made", timings.programs_made},
          {"allocations", timings.allocations},
          {"quads_resident", renderer.geometry().quads_resident()},
          {"quads_drawn", renderer.report()->camera.quads},
          {"gpu_memory_bytes", device.memory_total()},
          {"peak_rss_mib", peak_rss_mib()},
          {"gpu_ms", pass_times(timings)}};
}

void print(const nlohmann::ordered_json& row) {
  const auto number = [&](const char* key) { return row.at(key).get<double>(); };
  const int shadows = row.at("shadows").get<int>();
  const nlohmann::ordered_json& passes = row.at("gpu_ms");
  fmt::print(
      "{} | {}x{} | distance {} | shadows {} | median {:.2f} ms (p10 {:.2f}, p99 {:.2f}, max "
      "{:.2f}; {} over twice) | {:.1f} fps | CPU {:.2f} ms | GPU {:.2f} ms | {} quads of {} | "
      "{:.0f} MiB | {} "
      "programs made, {} allocations\n",
      row.at("name").get<std::string>(), row.at("size")[0].get<int>(), row.at("size")[1].get<int>(),
      row.at("distance").get<int>(), shadows != 0 ? fmt::format("{}", shadows) : "off",
      number("ms_median"), number("ms_p10"), number("ms_p99"), number("ms_max"),
      row.at("frames_over_2x").get<int>(), number("fps_median"), number("cpu_ms_median"),
      passes.at("total").get<double>(), row.at("quads_drawn").get<std::uint64_t>(),
      row.at("quads_resident").get<std::uint64_t>(), number("peak_rss_mib"),
      row.at("programs_made").get<int>(), row.at("allocations").get<std::uint64_t>());
  for (const auto& [pass, value] : passes.items())
    fmt::print("  {:<24} {:8.3f} ms\n", pass, value.get<double>());
}

}  // namespace

int bench_frame(const BenchFrameOptions& options) {
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(**device, options.scene);
  if (!view) return fail(kFailed, view.error());
  const double world_time_s = options.scene.settings.world_time_s;
  game::SceneView::Moment moment{(*view)->start_camera(),
                                 static_cast<double>(options.scene.time_of_day_s), world_time_s,
                                 false};
  moment.count_pixels = false;
  if (Result<void> loaded = (*view)->load_completely(moment); !loaded)
    return fail(kFailed, loaded.error());
  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  Result<Timings> timings = time_frames(**device, **view, moment, options);
  if (!timings) return fail(kFailed, timings.error());
  if (Result<void> timed = time_passes(**view, moment, size, *timings); !timed)
    return fail(kFailed, timed.error());
  const nlohmann::ordered_json row =
      row_of(options.scene, **device, (*view)->renderer(), *timings, options.clock_rate);
  print(row);
  if (Result<void> written = write_rows(options.json, nlohmann::ordered_json::array({row}));
      !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
