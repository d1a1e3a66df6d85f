#include "tools/skerry/bench/bench_frame.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <map>

#include "game/view/scene_view.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

constexpr int kWarmUpFrames = 8;
constexpr int kMinFrames = 30, kMaxFrames = 600;
constexpr double kMaxSeconds = 8.0;
constexpr double kTurnDegPerFrame = 0.5;

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
  if (Result<void> loaded = (*view)->load_completely(moment.camera, world_time_s); !loaded)
    return fail(kFailed, loaded.error());

  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  std::vector<double> frames;
  std::map<std::string, std::vector<double>> passes;
  render::Renderer& renderer = (*view)->renderer();
  double last = now_ms();
  const double start = last;
  for (int i = 0; i < kWarmUpFrames + kMaxFrames; ++i) {
    moment.camera.yaw_deg += kTurnDegPerFrame;
    if (Result<std::uint64_t> drawn = (*view)->draw(moment, size); !drawn)
      return fail(kFailed, drawn.error());
    const double now = now_ms();
    if (i >= kWarmUpFrames) {
      frames.push_back(now - last);
      for (const gpu::PassTime& pass : renderer.report()->passes)
        passes[pass.name].push_back(pass.ms);
    }
    last = now;
    if (i >= kWarmUpFrames + kMinFrames && now - start > kMaxSeconds * 1000.0) break;
  }
  renderer.finish();

  const Spread ms = spread_of(frames);
  const game::Settings& settings = options.scene.settings;
  nlohmann::ordered_json gpu_ms = nlohmann::ordered_json::object();
  double gpu_total = 0.0;
  for (const auto& [name, samples] : passes) {
    // A pass that ran in some frames only (a shadow map drawn once) counts by its mean over all
    // frames.
    double sum = 0.0;
    for (const double sample : samples) sum += sample;
    gpu_ms[name] = samples.size() == frames.size() ? spread_of(samples).median
                                                   : sum / static_cast<double>(frames.size());
    gpu_total += gpu_ms[name].get<double>();
  }
  gpu_ms["total"] = gpu_total;
  const std::string name =
      fmt::format("seed {} {:02}:{:02}", options.scene.seed_text.substr(0, 20),
                  options.scene.time_of_day_s / 3600, options.scene.time_of_day_s / 60 % 60);
  nlohmann::ordered_json row{{"name", name},
                             {"device", (*device)->info().name},
                             {"size", {size.width, size.height}},
                             {"distance", settings.view_distance},
                             {"shadows", settings.shadow_enabled ? settings.shadow_size : 0},
                             {"frames", frames.size()},
                             {"ms_median", ms.median},
                             {"ms_p10", ms.p10},
                             {"ms_p99", ms.p99},
                             {"fps_median", 1000.0 / ms.median},
                             {"quads_resident", renderer.geometry().quads_resident()},
                             {"quads_drawn", renderer.report()->camera.quads},
                             {"gpu_memory_bytes", (*device)->memory_total()},
                             {"peak_rss_mib", peak_rss_mib()},
                             {"gpu_ms", gpu_ms}};
  fmt::print(
      "{} | {}x{} | distance {} | shadows {} | median {:.2f} ms (p10 {:.2f}, p99 {:.2f}) | {:.1f} "
      "fps | GPU {:.2f} ms | {} quads of {} | {:.0f} MiB\n",
      name, size.width, size.height, settings.view_distance,
      settings.shadow_enabled ? fmt::format("{}", settings.shadow_size) : "off", ms.median, ms.p10,
      ms.p99, 1000.0 / ms.median, gpu_total, renderer.report()->camera.quads,
      renderer.geometry().quads_resident(), peak_rss_mib());
  for (const auto& [pass, value] : gpu_ms.items())
    fmt::print("  {:<24} {:8.3f} ms\n", pass, value.get<double>());
  if (Result<void> written = write_rows(options.json, nlohmann::ordered_json::array({row}));
      !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
