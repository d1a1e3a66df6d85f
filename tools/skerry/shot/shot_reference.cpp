#include "tools/skerry/shot/shot_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "engine/core/clock.h"
#include "engine/core/log.h"
#include "engine/core/output.h"
#include "engine/platform/image_file.h"
#include "tools/reference/reference.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

using nlohmann::ordered_json;
using reference::ReferencePicture;

double black_fraction(const measure::Picture& picture) {
  const auto black = std::count(picture.pixels.begin(), picture.pixels.end(), glm::vec3(0.0f));
  return static_cast<double>(black) / static_cast<double>(picture.pixels.size());
}

double mean_radiance(const measure::Picture& picture) {
  double sum = 0.0;
  for (const glm::vec3& c : picture.pixels) sum += static_cast<double>(c.x) + c.y + c.z;
  return sum / (3.0 * static_cast<double>(picture.pixels.size()));
}

ordered_json reference_stats_json(const ShotOptions& options, const ReferencePicture& picture,
                                  std::span<const std::uint8_t> rgba, const ordered_json& cpu_ms) {
  const game::Settings& settings = options.scene.settings;
  ordered_json j;
  j["renderer"] = "reference";
  j["size"] = {picture.radiance.width, picture.radiance.height};
  j["image_sha256"] = sha256_hex(rgba);
  j["cpu_ms"] = cpu_ms;
  j["samples"] = settings.reference_samples;
  j["filter"] = settings.reference_filter == game::ReferenceFilter::kPixel ? "pixel" : "centre";
  j["error"] = {{"mean_radiance", mean_radiance(picture.radiance)},
                {"mean_standard_error", nullptr}};
  if (picture.mean_error) j["error"]["mean_standard_error"] = *picture.mean_error;
  j["exposure_ev"] = picture.ev;
  j["islands"] = picture.islands;
  j["chunks"] = picture.chunks;
  j["non_finite_pixels"] = picture.non_finite_pixels;
  j["black_fraction"] = black_fraction(picture.radiance);
  return j;
}

std::string summary(const ShotOptions& options, const ReferencePicture& picture) {
  const std::uint32_t samples = options.scene.settings.reference_samples;
  const double mean = mean_radiance(picture.radiance);
  if (!picture.mean_error || mean == 0.0)
    return fmt::format("{} samples a pixel in {:.1f} s", samples, picture.seconds);
  return fmt::format("{} samples a pixel in {:.1f} s, standard error {:.2g}% of the mean radiance",
                     samples, picture.seconds, 100.0 * *picture.mean_error / mean);
}

}  // namespace

int shot_reference(const ShotOptions& options) {
  const Stopwatch total;
  ProgressBar bar;
  const Result<ReferencePicture> picture =
      reference::render_reference(options.scene, reference::settings_from(options.scene),
                                  [&, shown = -1](double share) mutable {
                                    const int percent = static_cast<int>(100.0 * share);
                                    if (total.seconds() < 1.0 || percent == shown) return;
                                    shown = percent;
                                    bar.show(share, "reference");
                                  });
  if (!picture) return fail(kUsage, picture.error());
  ordered_json cpu_ms;
  cpu_ms["draw"] = total.milliseconds();
  const std::vector<std::uint8_t> rgba = reference::develop(
      picture->radiance, picture->ev, reference::darkroom_from(options.scene.settings));
  const platform::PixelView image{picture->radiance.width, picture->radiance.height, 4, rgba};
  const std::array<platform::PngText, 2> text{
      {{"Software", "Skerry"}, {"Command", game::shot_command(options.scene)}}};
  Outputs outputs;
  const Result<std::vector<std::byte>> png = platform::encode_png(image, text);
  if (!png) return fail(kFailed, png.error());
  if (Result<void> added = outputs.add(options.out, *png); !added)
    return fail(kFailed, added.error());
  cpu_ms["total"] = total.milliseconds();
  if (options.stats) {
    const ordered_json j = reference_stats_json(options, *picture, rgba, cpu_ms);
    if (Result<void> added = outputs.add(*options.stats, j.dump(2) + "\n"); !added)
      return fail(kFailed, added.error());
  }
  if (Result<void> written = outputs.publish(); !written) return fail(kFailed, written.error());
  log_info(summary(options, *picture));
  if (options.explain)
    fmt::print("runs:\n  reference: {} islands, {} chunks looked at\nleft out:\n  all passes\n",
               picture->islands, picture->chunks);
  if (picture->non_finite_pixels != 0)
    return fail(kFailed, {fmt::format("{} pixels were not finite; this is a bug in Skerry",
                                      picture->non_finite_pixels)});
  return kDone;
}

}  // namespace skerry::tools
