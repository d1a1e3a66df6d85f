// What input does to a run of the game.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/render/exposure.h"
#include "game/play_loop.h"

namespace skerry::game {
namespace {

constexpr double kDayTurn = 1800.0;  // seconds of day a second that T or Y is held
constexpr double kDayRate =
    24.0;  // seconds of day a second when it is left alone: a day is an hour
constexpr double kFlySpeedNotch = 1.25;  // factor a notch of the wheel

}  // namespace

void PlayLoop::act(const platform::InputFrame& input, double seconds) {
  const ActionFrame actions(input, *bindings_);
  act_on_picture(input, actions, seconds);
  if (actions.pressed(Action::kFly)) {
    player_.set_mode(player_.mode() == MoveMode::kWalk ? MoveMode::kFly : MoveMode::kWalk);
  }
  if (actions.pressed(Action::kNoclip)) {
    player_.set_mode(player_.mode() == MoveMode::kNoclip ? MoveMode::kFly : MoveMode::kNoclip);
  }
  move(input, actions, seconds);
  use_hands(actions, seconds);
  adapt_eye(seconds);
}

void PlayLoop::rest(double seconds) {
  scene_.camera = player_.eye(around_);
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

void PlayLoop::act_on_picture(const platform::InputFrame& input, const ActionFrame& actions,
                              double seconds) {
  if (actions.pressed(Action::kScreenshot)) want_screenshot();
  Settings& settings = view_->settings();
  if (actions.pressed(Action::kOverlay)) overlay_shown_ = !overlay_shown_;
  if (actions.pressed(Action::kTorch)) settings.lights_held = !settings.lights_held;
  if (actions.pressed(Action::kCalibrate)) calibrating_ = !calibrating_;
  if (actions.pressed(Action::kFreezeCulling)) culling_frozen_ = !culling_frozen_;
  using platform::Key;
  if (calibrating_)
    settings.display =
        stepped_display(settings.display, input.pressed(Key::kRight) - input.pressed(Key::kLeft),
                        input.pressed(Key::kUp) - input.pressed(Key::kDown));
  const auto steps = [&](Action more, Action less) {
    return actions.presses(more) - actions.presses(less);
  };
  const int farther = steps(Action::kFartherView, Action::kNearerView);
  if (farther != 0) settings.view_distance = stepped_view_distance(settings.view_distance, farther);
  const int better = steps(Action::kBetterQuality, Action::kWorseQuality);
  if (better != 0) {
    scene_.quality = stepped_quality(scene_.quality, better);
    set_quality(scene_.quality, settings);
  }
  const double later = actions.value(Action::kLater) - actions.value(Action::kEarlier);
  if (actions.pressed(Action::kStopDay)) day_stands_ = !day_stands_;
  if (later != 0.0) day_.turn(later * kDayTurn * seconds);
  if (later == 0.0 && !day_stands_) day_.turn(kDayRate * seconds);
}

void PlayLoop::move(const platform::InputFrame& input, const ActionFrame& actions, double seconds) {
  const bool captured = window_.pointer_captured();
  look(player_, {&actions, bindings_, captured ? input.mouse_delta : glm::dvec2(0.0), seconds},
       scene_.fov_deg);
  const int faster =
      actions.presses(Action::kFasterFlight) - actions.presses(Action::kSlowerFlight);
  if (faster != 0)
    player_.set_fly_speed(player_.fly_speed() * std::pow(kFlySpeedNotch, double(faster)));
  const double reach = glm::length(player_.velocity()) * kLongestFrame;
  around_.refresh(player_.feet(), reach, player_.world_time_s());
  const int returns = player_.returns();
  player_.advance(seconds, intent_of(actions), around_);
  if (player_.returns() != returns) said_.push_back("You fell off the world: back on firm ground");
  scene_.camera = player_.eye(around_);
}

void PlayLoop::use_hands(const ActionFrame& actions, double seconds) {
  HandIntent intent = hand_intent_of(actions);
  // The click that captured the pointer, or closed a screen, means nothing to the hands.
  hands_free_ = window_.pointer_captured() && (hands_free_ || (!intent.dig && !intent.place));
  if (!hands_free_) intent.dig = intent.place = false;
  hands_.advance(seconds, intent, player_, *scene_.camera, around_, editor_);
}

}  // namespace skerry::game
