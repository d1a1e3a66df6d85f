#include "tools/skerry/bench/bench_pops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <memory>
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

constexpr int kPopFrames = 600;
constexpr double kPopSpeed = 48.0, kFramesASecond = 60.0;
constexpr double kMostShare = 0.005;   // of the pixels that a change of level may be seen in
constexpr std::size_t kWorstPops = 8;  // frames that are listed one by one

/// What a change of level did to the picture of one frame.
struct Pop {
  double at_blocks = 0.0, share = 0.0;
  int largest = 0;
  render::Camera camera;
  glm::dvec3 place{};  ///< of the camera, blocks from the world's origin
};

class PopFlight {
 public:
  static Result<PopFlight> create(gpu::Device& device, const BenchPopsOptions& options) {
    PopFlight out(device, options.scene);
    Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(device, options.scene);
    if (!view) return view.error();
    out.view_ = *std::move(view);
    out.start_ = {out.view_->start_camera(), static_cast<double>(options.scene.time_of_day_s),
                  options.scene.settings.world_time_s};
    out.step_blocks_ = options.speed.value_or(kPopSpeed) / kFramesASecond;
    // As after some time of play: shadows keep what reach they have had.
    for (const std::optional<double> blend_s : {std::optional<double>(), {1.0}})
      if (Result<void> loaded = out.load(out.start_, blend_s); !loaded) return loaded.error();
    if (Result<Bytes> first = out.draw(out.start_); !first) return first.error();
    out.start_.exposure_ev = out.view_->renderer().report().value().exposure_ev;
    return out;
  }

  /// @param frame from 1 on, in order.
  Result<Pop> step(int frame) {
    Pop pop;
    pop.at_blocks = step_blocks_ * frame;
    const game::SceneView::Moment moment = moment_at(pop.at_blocks);
    const Result<Bytes> before = draw(moment);
    if (!before) return before.error();
    if (Result<void> loaded = load(moment, 1.0 / kFramesASecond); !loaded) return loaded.error();
    const Result<Bytes> now = draw(moment);
    if (!now) return now.error();
    const measure::StepCounts counts = measure::count_steps(*before, *now, measure::kUnseenChange);
    pop.share = static_cast<double>(counts.stepped) / static_cast<double>(counts.pixels);
    pop.largest = counts.largest;
    pop.camera = moment.camera;
    const render::FixedPos& at = moment.camera.position;
    pop.place =
        world::difference_blocks(world::WorldPos{at[0], at[1], at[2]}, view_->world().origin());
    return pop;
  }

 private:
  PopFlight(gpu::Device& device, const game::SceneOptions& scene)
      : device_(&device), size_{scene.size.width, scene.size.height} {}

  game::SceneView::Moment moment_at(double ahead_blocks) const {
    game::SceneView::Moment moment = start_;
    const double yaw = glm::radians(moment.camera.yaw_deg);
    const render::FixedPos& from = start_.camera.position;
    const world::WorldPos at =
        world::moved(world::WorldPos{from[0], from[1], from[2]},
                     glm::dvec3(std::sin(yaw), 0.0, std::cos(yaw)) * ahead_blocks);
    moment.camera.position = {at.x, at.y, at.z};
    return moment;
  }

  Result<void> load(const game::SceneView::Moment& moment, std::optional<double> blend_s = {}) {
    return view_->load_completely(moment, blend_s);
  }

  Result<Bytes> draw(const game::SceneView::Moment& moment) {
    return drawn_picture(*device_, *view_, moment, size_);
  }

  gpu::Device* device_;
  VkExtent2D size_;
  double step_blocks_ = 0.0;
  std::unique_ptr<game::SceneView> view_;
  game::SceneView::Moment start_;
};

nlohmann::ordered_json row_of(const BenchPopsOptions& options, const gpu::Device& device,
                              const std::vector<Pop>& frames) {
  int changed = 0, over = 0;
  double worst = 0.0, sum = 0.0;
  nlohmann::ordered_json pops = nlohmann::ordered_json::array();
  for (const Pop& pop : frames) {
    changed += pop.largest > 0;
    over += pop.share > kMostShare;
    worst = std::max(worst, pop.share);
    sum += pop.share;
    if (pop.share <= kMostShare) continue;
    pops.push_back(
        {{"at_blocks", pop.at_blocks},
         {"share", pop.share},
         {"largest", pop.largest},
         {"camera",
          {pop.place.x, pop.place.y, pop.place.z, pop.camera.yaw_deg, pop.camera.pitch_deg}}});
  }
  const game::SceneOptions& scene = options.scene;
  return {{"name", fmt::format("seed {} {:02}:{:02}", scene.seed_text.substr(0, 20),
                               scene.time_of_day_s / 3600, scene.time_of_day_s / 60 % 60)},
          {"device", device.info().name},
          {"size", {scene.size.width, scene.size.height}},
          {"frames", frames.size()},
          {"speed", options.speed.value_or(kPopSpeed)},
          {"changed", changed},
          {"over", over},
          {"worst", worst},
          {"mean", sum / static_cast<double>(frames.size())},
          {"pops", std::move(pops)}};
}

void print_pops(const nlohmann::ordered_json& row, std::vector<Pop> frames) {
  fmt::print(
      "{} | {}x{} | {} frames at {:.0f} blocks/s | {} differ, {} in more than 0.5% of the pixels "
      "by more than 8/255 | at worst {:.3f}%, in the mean {:.4f}%\n",
      row.at("name").get<std::string>(), row.at("size")[0].get<int>(), row.at("size")[1].get<int>(),
      row.at("frames").get<int>(), row.at("speed").get<double>(), row.at("changed").get<int>(),
      row.at("over").get<int>(), 100.0 * row.at("worst").get<double>(),
      100.0 * row.at("mean").get<double>());
  std::ranges::sort(frames, std::greater<>(), &Pop::share);
  frames.resize(std::min(frames.size(), kWorstPops));
  for (const Pop& pop : frames)
    if (pop.share > 0.0)
      fmt::print("  at {:6.1f} blocks {:.3f}% of the pixels, by {}/255: --camera={},{},{},{},{}\n",
                 pop.at_blocks, 100.0 * pop.share, pop.largest, pop.place.x, pop.place.y,
                 pop.place.z, pop.camera.yaw_deg, pop.camera.pitch_deg);
}

}  // namespace

int bench_pops(const BenchPopsOptions& options) {
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());
  Result<PopFlight> flight = PopFlight::create(**device, options);
  if (!flight) return fail(kFailed, flight.error());
  const int count = options.frames.value_or(kPopFrames);
  std::vector<Pop> frames;
  ProgressBar bar;
  for (int frame = 1; frame <= count; ++frame) {
    Result<Pop> pop = flight->step(frame);
    if (!pop) return fail(kFailed, pop.error());
    frames.push_back(*std::move(pop));
    bar.show(static_cast<double>(frame) / static_cast<double>(count), "flight");
  }
  bar.clear();
  const nlohmann::ordered_json row = row_of(options, **device, frames);
  print_pops(row, std::move(frames));
  if (Result<void> written = write_rows(options.json, nlohmann::ordered_json::array({row}));
      !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
