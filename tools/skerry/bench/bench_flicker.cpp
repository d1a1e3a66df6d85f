#include "tools/skerry/bench/bench_flicker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/trigonometric.hpp>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "game/view/scene_view.h"
#include "tools/measure/flicker.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kFlickerFrames = 120;
constexpr double kSlowTurnDeg = 0.06;        // about half a pixel of 1280
constexpr double kWalkBlocks = 4.3 / 60.0;   // blocks
constexpr double kDriftSeconds = 0.25;       // islands then move as fast as steered ones
constexpr double kSunSeconds = 24.0 / 60.0;  // of the day: 24 times as fast as it is, 60 frames/s

/// What moves from one frame to the next.
struct Step {
  std::string_view name;
  double turn_deg = 0.0, ahead_blocks = 0.0, world_s = 0.0, day_s = 0.0;
};
constexpr std::array kMotions{Step{.name = "turn", .turn_deg = kSlowTurnDeg},
                              Step{.name = "walk", .ahead_blocks = kWalkBlocks},
                              Step{.name = "drift", .world_s = kDriftSeconds},
                              Step{.name = "sun", .day_s = kSunSeconds}};

game::SceneView::Moment moment_at(game::SceneView::Moment moment, const Step& step, int frame) {
  const double yaw = glm::radians(moment.camera.yaw_deg);
  const glm::dvec3 ahead =
      glm::dvec3(std::sin(yaw), 0.0, std::cos(yaw)) * (step.ahead_blocks * frame * 65536.0);
  for (int axis = 0; axis < 3; ++axis)
    moment.camera.position[axis] += static_cast<std::int64_t>(std::llround(ahead[axis]));
  moment.camera.yaw_deg += step.turn_deg * frame;
  moment.world_time_s += step.world_s * frame;
  moment.time_of_day_s += step.day_s * frame;
  return moment;
}

/// A world seen twice: as the settings have it, and with 16 samples a pixel.
class Pair {
 public:
  static Result<Pair> create(gpu::Device& device, const game::SceneOptions& scene) {
    Pair out(device, scene);
    Result<std::unique_ptr<game::SceneView>> shown = game::SceneView::create(device, scene);
    if (!shown) return shown.error();
    out.shown_ = *std::move(shown);
    game::SceneOptions exact = scene;
    exact.settings.render.aa_samples = 16;
    Result<std::unique_ptr<game::SceneView>> ideal = game::SceneView::create(device, exact);
    if (!ideal) return ideal.error();
    out.ideal_ = *std::move(ideal);
    out.start_ = {out.shown_->start_camera(), static_cast<double>(scene.time_of_day_s),
                  scene.settings.world_time_s};
    // All frames are exposed as the first one is metered.
    if (Result<Bytes> first = out.draw(*out.ideal_, out.start_); !first) return first.error();
    out.start_.exposure_ev = out.ideal_->renderer().report().value().exposure_ev;
    return out;
  }

  using Each = std::function<void(const measure::FlickerCounts&, const measure::StepCounts&)>;
  /// @param each called behind each pair of frames with what it counted.
  Result<void> move(const Step& step, int frames, const Each& each) {
    Bytes shown_before, ideal_before;
    for (int frame = 0; frame < frames; ++frame) {
      const game::SceneView::Moment moment = moment_at(start_, step, frame);
      Result<Bytes> shown = draw(*shown_, moment), ideal = draw(*ideal_, moment);
      if (!shown) return shown.error();
      if (!ideal) return ideal.error();
      if (frame != 0)
        each(measure::count_flicker({shown_before, ideal_before}, {*shown, *ideal}),
             measure::count_steps(shown_before, *shown));
      shown_before = *std::move(shown);
      ideal_before = *std::move(ideal);
    }
    return {};
  }

 private:
  Pair(gpu::Device& device, const game::SceneOptions& scene)
      : device_(&device), size_{scene.size.width, scene.size.height} {}

  Result<Bytes> draw(game::SceneView& view, const game::SceneView::Moment& moment) const {
    if (Result<void> loaded = view.load_completely(moment); !loaded) return loaded.error();
    return drawn_picture(*device_, view, moment, size_);
  }

  gpu::Device* device_;
  VkExtent2D size_;
  std::unique_ptr<game::SceneView> shown_, ideal_;
  game::SceneView::Moment start_;
};

/// Shares of the pixels of all pairs of frames.
struct Flicker {
  measure::FlickerCounts sum;
  double worst = 0.0;  ///< share of the pixels of one pair that flicker
  measure::StepCounts steps;

  void add(const measure::FlickerCounts& counts, const measure::StepCounts& stepped) {
    steps.stepped += stepped.stepped;
    steps.largest = std::max(steps.largest, stepped.largest);
    sum.pixels += counts.pixels;
    sum.changed += counts.changed;
    sum.truly_changed += counts.truly_changed;
    sum.flickered += counts.flickered;
    worst = std::max(worst, share(counts.flickered, counts.pixels));
  }
  double of_all(std::uint64_t count) const { return share(count, sum.pixels); }
  static double share(std::uint64_t count, std::uint64_t pixels) {
    return static_cast<double>(count) / static_cast<double>(pixels);
  }
};

nlohmann::ordered_json row_of(const game::SceneOptions& scene, const gpu::Device& device,
                              const Step& step, int frames, const Flicker& flicker) {
  return {{"name", fmt::format("seed {} {:02}:{:02}", scene.seed_text.substr(0, 20),
                               scene.time_of_day_s / 3600, scene.time_of_day_s / 60 % 60)},
          {"motion", step.name},
          {"device", device.info().name},
          {"size", {scene.size.width, scene.size.height}},
          {"frames", frames},
          {"changed", flicker.of_all(flicker.sum.changed)},
          {"truly_changed", flicker.of_all(flicker.sum.truly_changed)},
          {"flicker", flicker.of_all(flicker.sum.flickered)},
          {"flicker_worst", flicker.worst},
          {"stepped", flicker.of_all(flicker.steps.stepped)},
          {"largest_step", flicker.steps.largest}};
}

void print_flicker(const nlohmann::ordered_json& row) {
  const auto percent = [&](const char* key) { return 100.0 * row.at(key).get<double>(); };
  fmt::print(
      "{} | {}x{} | {:<5} | {} frames | {:.3f}% of the pixels change, {:.3f}% truly | flicker "
      "{:.3f}%, at worst {:.3f}% | by more than 2/255 {:.4f}%, at most {}/255\n",
      row.at("name").get<std::string>(), row.at("size")[0].get<int>(), row.at("size")[1].get<int>(),
      row.at("motion").get<std::string>(), row.at("frames").get<int>(), percent("changed"),
      percent("truly_changed"), percent("flicker"), percent("flicker_worst"), percent("stepped"),
      row.at("largest_step").get<int>());
}

}  // namespace

int bench_flicker(const BenchFlickerOptions& options) {
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  Result<Pair> pair = Pair::create(**device, options.scene);
  if (!pair) return fail(kFailed, pair.error());
  const int frames = options.frames.value_or(kFlickerFrames);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::size_t pairs = 0;
  ProgressBar bar;
  for (const Step& step : kMotions) {
    Flicker flicker;
    const auto each = [&](const measure::FlickerCounts& counts, const measure::StepCounts& steps) {
      flicker.add(counts, steps);
      bar.show(static_cast<double>(++pairs) / static_cast<double>(kMotions.size() * (frames - 1)),
               step.name);
    };
    if (Result<void> moved = pair->move(step, frames, each); !moved)
      return fail(kFailed, moved.error());
    bar.clear();
    rows.push_back(row_of(options.scene, **device, step, frames, flicker));
    print_flicker(rows.back());
  }
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
