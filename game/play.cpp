#include "game/play.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "engine/render/exposure.h"
#include "game/controls.h"
#include "game/overlay.h"
#include "game/player.h"
#include "game/presenter.h"
#include "game/scene_view.h"
#include "game/screenshot.h"
#include "game/world_surroundings.h"

namespace skerry::game {
namespace {

using platform::Key;
using Clock = std::chrono::steady_clock;

constexpr double kLongestFrame = 0.25;    // seconds of play in one frame, however long it took
constexpr double kIdleWait = 0.05;        // seconds between looks at a window that shows nothing
constexpr double kTitlePeriod = 0.5;      // seconds
constexpr std::size_t kFramesKept = 240;  // for the overlay's graph
constexpr double kDayTurn = 1800.0;       // seconds of day a second that T or Y is held
constexpr double kDayRate =
    24.0;  // seconds of day a second when it is left alone: a day is an hour
constexpr double kFlySpeedNotch = 1.25;  // factor a notch of the wheel

render::FixedPos fixed(const world::WorldPos& p) {
  return {p.x, p.y, p.z};
}
world::WorldPos place(const render::FixedPos& p) {
  return {p[0], p[1], p[2]};
}

/// Where the feet are when the eye is there.
Player player_at(const render::Camera& eye, double time_s) {
  return {world::moved(place(eye.position), {0.0, -kEyeHeight, 0.0}), eye.yaw_deg, eye.pitch_deg,
          time_s};
}

/// One run of the game.
class Session {
 public:
  Session(platform::Window& window, gpu::Device& device, const SceneOptions& options,
          std::unique_ptr<SceneView> view)
      : window_(window),
        device_(device),
        scene_(options),
        view_(std::move(view)),
        player_(player_at(view_->start_camera(), options.settings.world_time_s)),
        around_(view_->world()),
        day_(options.time_of_day_s) {
    // A place that was asked for is a view, most often in the air.
    if (options.camera) player_.set_mode(MoveMode::kFly);
  }

  Result<void> start(VkSurfaceKHR surface);
  Result<void> run();

 private:
  void act(const platform::InputFrame& input, double seconds);
  void adapt_eye(double seconds);
  void act_on_pointer(const platform::InputFrame& input);
  void act_on_picture_keys(const platform::InputFrame& input, double seconds);
  void move(const platform::InputFrame& input, double seconds);
  Result<bool> draw(double seconds);
  void take_screenshot();
  void note_frame(double seconds);
  OverlayTriangles overlay_triangles(double seconds);
  std::vector<std::string> overlay_lines() const;
  SceneView::Moment moment() const;

  platform::Window& window_;
  gpu::Device& device_;
  SceneOptions scene_;  // what F2 writes down; quality, time, camera and size follow the play
  std::unique_ptr<SceneView> view_;
  Player player_;
  WorldSurroundings around_;
  DayClock day_;
  std::optional<double> exposure_ev_;  // what the eye has adapted to by now; none before it saw
  Overlay overlay_;
  std::unique_ptr<Presenter> presenter_;
  bool overlay_shown_ = false;
  bool calibrating_ = false;
  bool culling_frozen_ = false;
  bool day_stands_ = false;
  bool screenshot_wanted_ = false;
  bool pointer_wanted_ = true;  // captured while the window has the focus
  std::vector<float> frame_ms_;
  double since_title_s_ = 0.0;
};

Result<void> Session::start(VkSurfaceKHR surface) {
  auto presenter = Presenter::create(device_, surface, overlay_.font());
  if (!presenter) return presenter.error();
  presenter_ = *std::move(presenter);
  return {};
}

Result<void> Session::run() {
  Clock::time_point before = Clock::now();
  bool drawn = true;
  while (!window_.should_close()) {
    const platform::InputFrame input = window_.poll(drawn ? 0.0 : kIdleWait);
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - before).count();
    before = now;
    note_frame(seconds);
    act(input, std::min(seconds, kLongestFrame));
    const Result<bool> done = draw(seconds);
    if (!done) return done.error();
    drawn = *done;
    if (drawn && std::exchange(screenshot_wanted_, false)) take_screenshot();
  }
  return {};
}

void Session::act(const platform::InputFrame& input, double seconds) {
  act_on_pointer(input);
  act_on_picture_keys(input, seconds);
  if (input.pressed(Key::kF)) {
    player_.set_mode(player_.mode() == MoveMode::kFly ? MoveMode::kWalk : MoveMode::kFly);
  }
  move(input, seconds);
  adapt_eye(seconds);
}

/// Follows what the newest finished frame was metered at; that frame's own exposure plays no part
/// in it, so nothing feeds back.
void Session::adapt_eye(double seconds) {
  const std::optional<render::FrameReport>& seen = view_->renderer().report();
  if (!seen || !seen->metered_ev) return;
  exposure_ev_ = exposure_ev_ ? render::adapted_ev(*exposure_ev_, *seen->metered_ev, seconds)
                              : double{*seen->metered_ev};
}

void Session::act_on_pointer(const platform::InputFrame& input) {
  if (input.pressed(Key::kMouseLeft)) pointer_wanted_ = true;
  // Without it, the pointer belongs to the person: then the key means the window.
  if (input.pressed(Key::kEscape) && !std::exchange(pointer_wanted_, false)) window_.close();
  window_.capture_pointer(pointer_wanted_ && window_.focused());
}

void Session::act_on_picture_keys(const platform::InputFrame& input, double seconds) {
  if (input.pressed(Key::kF2)) {
    screenshot_wanted_ = true;
    view_->renderer().forget_shadows();  // so that the command draws the same shadows again
  }
  if (input.pressed(Key::kF3)) overlay_shown_ = !overlay_shown_;
  if (input.pressed(Key::kF9)) calibrating_ = !calibrating_;
  if (input.pressed(Key::kL)) view_->settings().lights_held = !view_->settings().lights_held;
  if (input.pressed(Key::kF8)) culling_frozen_ = !culling_frozen_;
  if (input.pressed(Key::kF11)) window_.toggle_fullscreen();
  Settings& settings = view_->settings();
  if (calibrating_)
    settings.display =
        stepped_display(settings.display, input.pressed(Key::kRight) - input.pressed(Key::kLeft),
                        input.pressed(Key::kUp) - input.pressed(Key::kDown));
  const int farther = input.pressed(Key::kRightBracket) - input.pressed(Key::kLeftBracket);
  if (farther != 0) settings.view_distance = stepped_view_distance(settings.view_distance, farther);
  const int better = input.pressed(Key::kPlus) - input.pressed(Key::kMinus);
  if (better != 0) {
    scene_.quality = stepped_quality(scene_.quality, better);
    const QualityLevel& level = quality_level(scene_.quality);
    settings.view_distance = level.view_distance;
    settings.view_detail = level.view_detail;
    settings.shadow_size = level.shadow_size;
    settings.bloom.intensity = level.bloom_intensity;
  }
  const int later = input.down(Key::kT) - input.down(Key::kY);
  if (input.pressed(Key::kP)) day_stands_ = !day_stands_;
  if (later != 0) day_.turn(later * kDayTurn * seconds);
  if (later == 0 && !day_stands_) day_.turn(kDayRate * seconds);
}

void Session::move(const platform::InputFrame& input, double seconds) {
  if (window_.pointer_captured()) look(player_, input, scene_.fov_deg);
  if (input.scroll != 0.0)
    player_.set_fly_speed(player_.fly_speed() * std::pow(kFlySpeedNotch, input.scroll));
  const double reach = glm::length(player_.velocity()) * kLongestFrame;
  around_.refresh(player_.feet(), reach, player_.world_time_s());
  player_.advance(seconds, intent_of(input), around_);
  scene_.camera = player_.eye(around_);
}

SceneView::Moment Session::moment() const {
  SceneView::Moment moment;
  moment.camera = {fixed(scene_.camera->position), scene_.camera->yaw_deg, scene_.camera->pitch_deg,
                   scene_.fov_deg};
  moment.time_of_day_s = day_.time_of_day_s();
  moment.world_time_s = player_.world_time_s();
  moment.freeze_culling = culling_frozen_;
  moment.exposure_ev = exposure_ev_;
  return moment;
}

/// @return whether there was a window to draw to.
Result<bool> Session::draw(double seconds) {
  const SceneView::Moment now = moment();
  if (const auto done = view_->stream(now.camera, now.world_time_s); !done) return done.error();
  const platform::FramebufferSize window_px = window_.framebuffer_size();
  const std::optional<gpu::SwapchainFrame> frame =
      presenter_->acquire({window_px.width, window_px.height});
  if (!frame) return false;
  const VkExtent2D size = presenter_->extent();
  std::optional<OverlayTriangles> overlay;
  if (overlay_shown_ || calibrating_) overlay = overlay_triangles(seconds);
  Result<void> recorded;
  const auto bring_to_window = [&](VkCommandBuffer commands, gpu::Image& picture) {
    recorded = presenter_->record(commands, picture, *frame, overlay ? &*overlay : nullptr);
  };
  // A command meters what it draws and adapts to nothing, so F2 names the exposure; and its picture
  // is drawn by the way that a command with an exposure takes.
  Settings& settings = view_->settings();
  const std::optional<double> asked_ev = settings.exposure_ev;
  if (screenshot_wanted_ && !asked_ev) settings.exposure_ev = exposure_ev_;
  const Result<std::uint64_t> value =
      view_->draw(now, size, bring_to_window, {&frame->wait, 1}, {&frame->signal, 1});
  if (!value) return value.error();
  presenter_->present(*frame, *value);
  if (!recorded) return recorded.error();
  scene_.size = {size.width, size.height};
  scene_.time_of_day_s = day_.time_of_day_s();
  scene_.settings = settings;
  scene_.settings.world_time_s = now.world_time_s;
  settings.exposure_ev = asked_ev;
  return true;
}

void Session::take_screenshot() {
  const auto path = save_screenshot(device_, view_->renderer().picture(), scene_);
  if (!path) {
    fmt::print(stderr, "skerry: {}\n", path.error().message);
    return;
  }
  fmt::print("{}\n{}\n", path->string(), shot_command(scene_));
  std::fflush(stdout);
}

void Session::note_frame(double seconds) {
  if (frame_ms_.size() == kFramesKept) frame_ms_.erase(frame_ms_.begin());
  frame_ms_.push_back(static_cast<float>(seconds * 1000.0));
  since_title_s_ += seconds;
  if (since_title_s_ < kTitlePeriod) return;
  since_title_s_ = 0.0;
  const double fps = 1000.0 / std::max(spread_of_frames(frame_ms_).median, 1e-3f);
  window_.set_title(fmt::format("Skerry - seed {} - {:.0f} fps", scene_.seed_text, fps));
}

std::vector<std::string> Session::overlay_lines() const {
  const CameraPlace& eye = *scene_.camera;
  const world::Streamer::Stats stream = view_->streamer().stats();
  return {fmt::format("seed {}   {}x{}   {}", scene_.seed_text, presenter_->extent().width,
                      presenter_->extent().height, device_.info().name),
          fmt::format("x {} y {} z {}", format_blocks(eye.position.x),
                      format_blocks(eye.position.y), format_blocks(eye.position.z)),
          fmt::format("yaw {:.1f} pitch {:.1f}   {} {:.1f} blocks/s", eye.yaw_deg, eye.pitch_deg,
                      player_.mode() == MoveMode::kFly ? "flying"
                      : player_.in_water()             ? "swimming"
                                                       : "walking",
                      glm::length(player_.velocity())),
          fmt::format("time {}   islands at {:.1f} s", format_time_of_day(day_.time_of_day_s()),
                      player_.world_time_s()),
          fmt::format("quality {}   view {} blocks, detail {}{}",
                      quality_level(scene_.quality).name, view_->settings().view_distance,
                      view_->settings().view_detail, culling_frozen_ ? "   culling frozen" : ""),
          fmt::format("exposure {:.2f} stops",
                      view_->renderer().report().value_or(render::FrameReport{}).exposure_ev),
          fmt::format("streaming: {} islands, {} tasks left", stream.islands, stream.tasks_left)};
}

OverlayTriangles Session::overlay_triangles(double seconds) {
  OverlayFacts facts;
  facts.frame_ms = frame_ms_;
  const std::vector<std::string> lines = overlay_lines();
  facts.lines = lines;
  const render::FrameReport report = view_->renderer().report().value_or(render::FrameReport{});
  facts.gpu_ms = report.gpu_ms;
  facts.passes = report.passes;
  const render::GeometryStore& geometry = view_->renderer().geometry();
  const std::vector<OverlayFacts::Count> counts{{"sections resident", geometry.sections_resident()},
                                                {"sections drawn", report.camera.sections_passed},
                                                {"quads resident", geometry.quads_resident()},
                                                {"quads drawn", report.camera.quads},
                                                {"quads in shadows", report.shadows.quads},
                                                {"draws", report.camera.draws},
                                                {"draws in shadows", report.shadows.draws}};
  facts.counts = counts;
  const std::vector<gpu::MemoryUse> memory = device_.memory_use();
  facts.memory = memory;
  facts.numbers = overlay_shown_;
  if (calibrating_) facts.calibration = view_->settings().display;
  return overlay_.layout(facts, presenter_->extent().width, presenter_->extent().height, seconds);
}

}  // namespace

Result<void> play(platform::Window& window, gpu::Device& device, VkSurfaceKHR surface,
                  const SceneOptions& options) {
  auto view = SceneView::create(device, options);
  if (!view) return view.error();
  Session session(window, device, options, *std::move(view));
  if (const auto started = session.start(surface); !started) return started;
  return session.run();
}

}  // namespace skerry::game
