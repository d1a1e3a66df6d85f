#include "tools/skerry/bench/bench_shade.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "game/scene_file/parse.h"
#include "tools/measure/flip.h"
#include "tools/measure/image.h"
#include "tools/reference/reference.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/shade/shade_errors.h"

namespace skerry::tools {
namespace {

constexpr game::PictureSize kShadeSize{160, 90};

/// The frame against the reference at its pixel centres, both at the reference's exposure.
Result<measure::ErrorMap> frame_errors(gpu::Device& device, game::SceneOptions scene) {
  scene.settings.reference_filter = game::ReferenceFilter::kCentre;
  const Result<reference::ReferencePicture> exact =
      reference::render_reference(scene, reference::settings_from(scene));
  if (!exact) return exact.error();
  const measure::Image shown{
      exact->radiance.width, exact->radiance.height,
      reference::develop(exact->radiance, exact->ev, reference::darkroom_from(scene.settings))};
  scene.settings.exposure_ev = exact->ev;
  Result<std::unique_ptr<SceneDrawer>> drawer = SceneDrawer::create(device, scene);
  if (!drawer) return drawer.error();
  Result<Drawn> drawn = (*drawer)->draw();
  if (!drawn) return drawn.error();
  return measure::flip_ldr(
      measure::picture_from(shown),
      measure::picture_from({drawn->size.width, drawn->size.height, std::move(drawn->rgba)}));
}

Result<nlohmann::ordered_json> row_of(gpu::Device& device, const ShadeScene& listed,
                                      const BenchShadeOptions& options) {
  const Result<game::SceneText> text = game::parse_scene(listed.json);
  if (!text) return text.error();
  Result<game::SceneOptions> scene = game::make_scene(*text, options.typed);
  if (!scene) return scene.error();
  if (!options.typed.size) scene->size = kShadeSize;
  const Result<ShadeErrors> errors = measure_shade(*scene);
  if (!errors) return errors.error();
  const Result<measure::ErrorMap> flip = frame_errors(device, *scene);
  if (!flip) return flip.error();
  const double flip_mean = measure::mean_of(*flip), flip_p99 = measure::quantile_of(*flip, 0.99);
  fmt::print(
      "{:<14} {:>7.0f} {:>6.1f}% {:>9.2g} {:>6.1f}% {:>7.1f}% {:>6.1f}% {:>6.1f}% {:>7.4f} "
      "{:>7.4f} {:>7.2f} {:>6.1f}\n",
      listed.name, errors->places, 100.0 * errors->without / std::max(1.0, errors->places),
      errors->mean, 100.0 * errors->rmse, 100.0 * errors->worst, 100.0 * errors->bias,
      100.0 * errors->standard_error, flip_mean, flip_p99, errors->work_seconds,
      static_cast<double>(errors->bytes) / (1024.0 * 1024.0));
  std::fflush(stdout);
  return nlohmann::ordered_json{{"scene", listed.name},
                                {"device", device.info().name},
                                {"size", {scene->size.width, scene->size.height}},
                                {"places", errors->places},
                                {"places_without", errors->without},
                                {"mean_irradiance", errors->mean},
                                {"relative_rmse", errors->rmse},
                                {"relative_worst", errors->worst},
                                {"relative_bias", errors->bias},
                                {"relative_standard_error", errors->standard_error},
                                {"flip_mean", flip_mean},
                                {"flip_p99", flip_p99},
                                {"work_seconds", errors->work_seconds},
                                {"bytes", errors->bytes}};
}

}  // namespace

int bench_shade(const BenchShadeOptions& options) {
  game::SceneOptions device_options;
  device_options.device = options.device;
  Result<std::unique_ptr<gpu::Device>> device = open_device(device_options);
  if (!device) return fail(kNoDevice, device.error());
  fmt::print("{:<14} {:>7} {:>7} {:>9} {:>7} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>6}\n", "scene",
             "places", "without", "mean", "rmse", "worst", "bias", "noise", "flip", "p99", "work s",
             "MiB");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ShadeScene& scene : shade_scenes()) {
    if (!options.scenes.empty() &&
        std::find(options.scenes.begin(), options.scenes.end(), scene.name) == options.scenes.end())
      continue;
    Result<nlohmann::ordered_json> row = row_of(**device, scene, options);
    if (!row) return fail(kFailed, row.error());
    rows.push_back(*std::move(row));
  }
  if (rows.empty()) return fail(kUsage, {"bench shade knows no scene of that name"});
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
