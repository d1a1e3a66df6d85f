// When frames are drawn, and how: caps, vertical sync, and the quality that a machine can hold.
#include <algorithm>
#include <chrono>
#include <thread>

#include "game/client/app.h"
#include "game/pace/frame_cap.h"

namespace skerry::game {
namespace {

constexpr double kStillWait = 1.0 / 60.0;  // seconds between frames in which only a screen is drawn
constexpr double kLoading = 10.0;  // seconds in which streaming and compiling put probes off

gpu::Sync sync_of(VerticalSync sync) {
  switch (sync) {
    case VerticalSync::kOff:
      return gpu::Sync::kOff;
    case VerticalSync::kOn:
      return gpu::Sync::kOn;
    case VerticalSync::kAdaptive:
      return gpu::Sync::kAdaptive;
  }
  return gpu::Sync::kOff;
}

}  // namespace

const FrameSettings& App::frame_settings() {
  return world_ ? world_->settings().frames : base_.settings.frames;
}

double App::frame_rate() {
  const FrameSettings& frames = frame_settings();
  return capped_rate(frames.cap, window_.refresh_hz(), window_.focused(), frames.unfocused);
}

/// Sleeps until the next frame is due: before its input is read, so that it shows the newest.
void App::wait_until_due() {
  presenter_->set_sync(sync_of(frame_settings().sync));
  due_s_ = next_due(due_s_, clock_.seconds(), frame_rate());
  const double left_s = due_s_ - clock_.seconds();
  if (left_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(left_s));
}

/// Seconds between frames in which only a screen is drawn; input ends the wait.
double App::still_wait_s() {
  return window_.focused() ? kStillWait : std::max(kStillWait, 1.0 / frame_settings().unfocused);
}

/// Time for a frame at the rate wanted, or at the cap where that is lower.
double App::budget_ms() {
  const FrameSettings& frames = frame_settings();
  const double display_hz = window_.refresh_hz();
  const double wanted = frames.wanted ? *frames.wanted : auto_quality_.usual_rate(display_hz);
  const double cap = capped_rate(frames.cap, display_hz, true, 0.0);
  return 1000.0 / (cap > 0.0 ? std::min(wanted, cap) : wanted);
}

/// What a frame took goes into how the next ones are drawn.
void App::choose_quality(bool drawn) {
  const double waited_s = presenter_->take_waited_s();
  if (!world_) return;
  SceneOptions& scene = world_->scene();
  if (!scene.quality_auto) return world_->set_quality_line({});
  SceneView& view = world_->view();
  FrameFacts frame;
  frame.now_s = clock_.seconds();
  // Work on the device may wait for the display as well; then the thread's own time tells more.
  const double busy_s = presenter_->waits_for_display() ? thread_seconds() - began_thread_s_
                                                        : frame.now_s - began_s_ - waited_s;
  const auto& report = view.renderer().report();
  frame.work_ms = std::max(busy_s * 1e3, report ? report->gpu_ms : 0.0);
  frame.settled = frame.now_s - world_began_s_ > kLoading ||
                  (view.complete() && view.renderer().programs_to_come() == 0);
  frame.held = !drawn || still_ || (report && report->lagged) || !screens_.stack.empty() ||
               !window_.focused();
  const Result<bool> changed =
      auto_quality_.note_frame(frame, budget_ms(), scene, world_->settings());
  if (!changed) say(changed.error().message);
  if (!changed || *changed) follow_settings();
  world_->set_quality_line(auto_quality_.line(budget_ms()));
}

/// Before the first frame of something else.
void App::begin_quality(SceneOptions& scene, Settings& settings) {
  if (!scene.quality_auto) return;
  const platform::FramebufferSize px = window_.framebuffer_size();
  const PictureSize size =
      px.width != 0 && px.height != 0 ? PictureSize{px.width, px.height} : scene.size;
  if (const auto begun = auto_quality_.begin(size, scene, settings); !begun)
    say(begun.error().message);
}

}  // namespace skerry::game
