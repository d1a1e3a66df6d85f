// What input does to a run of the game.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/render/exposure.h"
#include "game/play_loop.h"

namespace skerry::game {
namespace {

using platform::Key;

constexpr double kDayTurn = 1800.0;  // seconds of day a second that T or Y is held
constexpr double kDayRate =
    24.0;  // seconds of day a second when it is left alone: a day is an hour
constexpr double kFlySpeedNotch = 1.25;  // factor a notch of the wheel

}  // namespace

void PlayLoop::act(const platform::InputFrame& input, double seconds) {
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
void PlayLoop::adapt_eye(double seconds) {
  const std::optional<render::FrameReport>& seen = view_->renderer().report();
  if (!seen || !seen->metered_ev) return;
  exposure_ev_ = exposure_ev_ ? render::adapted_ev(*exposure_ev_, *seen->metered_ev, seconds)
                              : double{*seen->metered_ev};
}

void PlayLoop::act_on_pointer(const platform::InputFrame& input) {
  if (input.pressed(Key::kMouseLeft)) pointer_wanted_ = true;
  // Without it, the pointer belongs to the person: then the key means the window.
  if (input.pressed(Key::kEscape) && !std::exchange(pointer_wanted_, false)) window_.close();
  window_.capture_pointer(pointer_wanted_ && window_.focused());
}

void PlayLoop::act_on_picture_keys(const platform::InputFrame& input, double seconds) {
  if (input.pressed(Key::kF2)) {
    screenshot_wanted_ = true;
    view_->renderer().forget_shadows();  // so that the command draws the same shadows again
  }
  if (input.pressed(Key::kF3)) overlay_shown_ = !overlay_shown_;
  if (input.pressed(Key::kL)) view_->settings().lights_held = !view_->settings().lights_held;
  if (input.pressed(Key::kF9)) calibrating_ = !calibrating_;
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

void PlayLoop::move(const platform::InputFrame& input, double seconds) {
  if (window_.pointer_captured()) look(player_, input, scene_.fov_deg);
  if (input.scroll != 0.0)
    player_.set_fly_speed(player_.fly_speed() * std::pow(kFlySpeedNotch, input.scroll));
  const double reach = glm::length(player_.velocity()) * kLongestFrame;
  around_.refresh(player_.feet(), reach, player_.world_time_s());
  player_.advance(seconds, intent_of(input), around_);
  scene_.camera = player_.eye(around_);
}

}  // namespace skerry::game
