#include "tools/skerry/bench/bench_lights.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

constexpr int kLightsWarmUp = 3, kLightsFrames = 15;
constexpr std::array<std::uint32_t, 5> kCounts{64, 256, 1024, 4096, 16384};

bool shades(const std::string& pass) {
  return pass == "shade_lights" || pass == "cull_shafts";
}
bool is_light_pass(const std::string& name) {
  return name.find("light") != std::string::npos || shades(name);
}

/// Milliseconds of light passes, a value a frame.
struct Samples {
  std::map<std::string, std::vector<double>> passes;
  std::vector<double> sort, shade;
};

Samples samples_of(const std::vector<render::FrameReport>& reports) {
  Samples out;
  for (const render::FrameReport& report : reports) {
    double sort = 0.0, shade = 0.0;
    for (const gpu::PassTime& pass : report.passes) {
      if (!is_light_pass(pass.name)) continue;
      out.passes[pass.name].push_back(pass.ms);
      (shades(pass.name) ? shade : sort) += pass.ms;
    }
    out.sort.push_back(sort);
    out.shade.push_back(shade);
  }
  return out;
}

nlohmann::ordered_json lights_spread(const Spread& spread) {
  return {{"median", spread.median}, {"p10", spread.p10}, {"p90", spread.p90}};
}

Result<nlohmann::ordered_json> measure(gpu::Device& device, game::SceneOptions scene,
                                       std::uint32_t count) {
  scene.settings.lights_random = count;
  Result<std::unique_ptr<SceneDrawer>> drawer = SceneDrawer::create(device, scene);
  if (!drawer) return drawer.error();
  if (Result<std::vector<render::FrameReport>> warm = (*drawer)->time(kLightsWarmUp, true); !warm)
    return warm.error();
  const Result<std::vector<render::FrameReport>> reports = (*drawer)->time(kLightsFrames, true);
  if (!reports) return reports.error();
  const Samples samples = samples_of(*reports);
  const render::FrameReport& last = reports->back();
  const double per_cluster =
      last.clusters.clusters == 0
          ? 0.0
          : static_cast<double>(last.clusters.units) / static_cast<double>(last.clusters.clusters);
  nlohmann::ordered_json gpu_ms = nlohmann::ordered_json::object();
  for (const auto& [pass, values] : samples.passes) gpu_ms[pass] = spread_of(values).median;
  const Spread sort = spread_of(samples.sort), shade = spread_of(samples.shade);
  fmt::print("{:>7} {:>8} {:>9} {:>10.1f} {:>9.3f} {:>9.3f} {:>9.3f}\n", count, last.lights,
             last.clusters.clusters, per_cluster, sort.median, shade.median,
             sort.median + shade.median);
  return nlohmann::ordered_json{{"device", device.info().name},
                                {"size", {scene.size.width, scene.size.height}},
                                {"lights", count},
                                {"lights_in_view", last.lights},
                                {"clusters", last.clusters.clusters},
                                {"lights_a_cluster", per_cluster},
                                {"sort_ms", lights_spread(sort)},
                                {"shade_ms", lights_spread(shade)},
                                {"gpu_ms", gpu_ms}};
}

}  // namespace

int bench_lights(const BenchLightsOptions& options) {
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  fmt::print("{:>7} {:>8} {:>9} {:>10} {:>9} {:>9} {:>9}\n", "lights", "in view", "clusters",
             "a cluster", "sort ms", "shade ms", "sum ms");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::uint32_t count : kCounts) {
    const Result<nlohmann::ordered_json> row = measure(**device, options.scene, count);
    if (!row) return fail(kFailed, row.error());
    rows.push_back(*row);
  }
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
