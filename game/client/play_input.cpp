// What input does to a run of the game.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/core/log.h"
#include "engine/render/frame/exposure.h"
#include "game/client/play_loop.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

constexpr double kDayTurn = 1800.0;  // seconds of day a second that T or Y is held
constexpr double kDayRate =
    24.0;  // seconds of day a second when it is left alone: a day is an hour
constexpr double kFlySpeedNotch = 1.25;  // factor a notch of the wheel

}  // namespace

void PlayLoop::act(const platform::InputFrame& input, double seconds) {
  const ActionFrame actions(input, *bindings_, seconds);
  frame_s_ = seconds;
  rests_ = false;
  act_on_picture(input, actions, seconds);
  if (actions.pressed(Action::kFly)) {
    player_.set_mode(player_.mode() == MoveMode::kWalk ? MoveMode::kFly : MoveMode::kWalk);
  }
  if (actions.pressed(Action::kNoclip)) {
    player_.set_mode(player_.mode() == MoveMode::kNoclip ? MoveMode::kFly : MoveMode::kNoclip);
  }
  move(input, actions, seconds);
  use_hands(actions, seconds);
  act_on_places(actions);
  adapt_eye(seconds);
}

void PlayLoop::rest(double seconds) {
  scene_.camera = player_.eye(around_);
  frame_s_ = seconds;
  if (!std::exchange(rests_, true)) {
    // Who pauses may be about to leave the machine alone.
    tell_session();
    session_->save_next();
  }
  session_->rest();
  hear_session();
  adapt_eye(seconds);
}

void PlayLoop::adapt_eye(double seconds) {
  exposure_ev_ = view_->adapted_ev(exposure_ev_, seconds);
}

void PlayLoop::act_on_picture(const platform::InputFrame& input, const ActionFrame& actions,
                              double seconds) {
  if (actions.pressed(Action::kScreenshot)) want_screenshot();
  Settings& settings = view_->settings();
  if (actions.pressed(Action::kOverlay)) overlay_shown_ = !overlay_shown_;
  if (actions.pressed(Action::kTorch)) settings.lights_held = !settings.lights_held;
  if (actions.pressed(Action::kFreezeCulling)) culling_frozen_ = !culling_frozen_;
  const render::DisplaySettings display = settings.render.display;
  calibrate(input, actions, settings.render.display);
  const auto steps = [&](Action more, Action less) {
    return actions.presses(more) - actions.presses(less);
  };
  const int farther = steps(Action::kFartherView, Action::kNearerView);
  if (farther != 0) settings.view_distance = stepped_view_distance(settings.view_distance, farther);
  const int better = steps(Action::kBetterQuality, Action::kWorseQuality);
  if (better != 0) {
    scene_.quality_auto = false;
    scene_.quality = stepped_quality(scene_.quality, better);
    set_quality(scene_.quality, settings);
    said_.push_back(
        tr_format("Quality: {}", tr(std::string(quality_level(scene_.quality).name).c_str())));
  }
  settings_changed_ |= farther != 0 || better != 0 || settings.render.display != display;
  const double later = actions.value(Action::kLater) - actions.value(Action::kEarlier);
  if (actions.pressed(Action::kStopDay)) day_stands_ = !day_stands_;
  if (later != 0.0) day_.turn(later * kDayTurn * seconds);
  if (later == 0.0 && !day_stands_) day_.turn(kDayRate * seconds);
}

/// In the order of the events: in a long frame the screen may close after its keys.
void PlayLoop::calibrate(const platform::InputFrame& input, const ActionFrame& actions,
                         render::DisplaySettings& display) {
  using platform::Key;
  const Binding& toggle = (*bindings_)[Action::kCalibrate];
  for (const platform::InputEvent& event : input.events) {
    if (!event.down) continue;
    const bool toggles = event.key == toggle.key.key || event.key == toggle.pad.key;
    if (toggles && actions.pressed(Action::kCalibrate)) calibrating_ = !calibrating_;
    const auto is = [&](Key key) { return event.key == key ? 1 : 0; };
    if (calibrating_)
      display =
          stepped_display(display, is(Key::kRight) - is(Key::kLeft), is(Key::kUp) - is(Key::kDown));
  }
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
  Intent intent = intent_of(actions);
  toggles_.apply(settings().play, actions, player_.mode() == MoveMode::kWalk && !helm_.island(),
                 intent);
  go_on(seconds, steer(actions, intent, input.pad));
}

/// At the helm, what would move the player moves the island. @param pad messages name a gamepad's
/// buttons. @return what is left to the player.
Intent PlayLoop::steer(const ActionFrame& actions, const Intent& intent, bool pad) {
  const auto key = [&](Action action) {
    return chord_label(pad ? (*bindings_)[action].pad : (*bindings_)[action].key);
  };
  if (actions.pressed(Action::kHelm)) {
    if (helm_.island()) {
      helm_.leave(*session_);
    } else if (const std::optional<std::uint64_t> island = player_.frame_island()) {
      helm_.take(*island);
      said_.push_back(
          tr_format("At the helm: forward and back drive, left and right turn; {} rises, {} sinks, "
                    "{} lets go",
                    key(Action::kJump), key(Action::kCrouch), key(Action::kHelm)));
    } else {
      said_.emplace_back(tr("Stand on an island to take its helm"));
    }
  }
  if (!helm_.island()) return intent;
  helm_.steer(intent, player_.state().yaw_deg, *session_);
  if (player_.frame_island() != helm_.island()) helm_.leave(*session_);  // fell or was taken off
  return {};
}

bool PlayLoop::on_foot() const {
  return player_.mode() == MoveMode::kWalk && !player_.in_water() && !helm_.island();
}

/// The world goes on by so much, and the player in it.
void PlayLoop::go_on(double seconds, const Intent& intent) {
  // First the islands, then the player by the time that has passed for them: their ticks ask where
  // islands are at their ends.
  const double before_s = session_->time_s();
  const std::optional<world::Pose> helm_before = helm_pose();
  session_->advance(seconds);
  hear_session();
  if (const auto helm_now = helm_pose(); helm_before && helm_now) {
    if (auto line = helm_.watch(*helm_before, *helm_now, session_->time_s() - before_s))
      said_.push_back(*std::move(line));
  }
  const int returns = player_.returns();
  player_.advance(session_->time_s() - before_s, intent, around_);
  if (player_.returns() != returns)
    said_.emplace_back(tr("You fell off the world: back on firm ground"));
  scene_.camera = player_.eye(around_);
  tell_session();  // before edits are asked for: the session decides their reach by where the
                   // player is now
}

std::optional<world::Pose> PlayLoop::helm_pose() const {
  if (!helm_.island()) return std::nullopt;
  return view_->world().pose(*helm_.island(), session_->time_s());
}

/// Where the player is, and all else that a saved play keeps.
void PlayLoop::tell_session() {
  SavedPlay now;
  now.player = player_.state();
  now.eye = player_.eye(around_);
  now.time_of_day_s = day_.time_of_day_s();
  now.world_time_s = player_.tick_time_s();
  now.hotbar = hands_.hotbar();
  now.day_stands = day_stands_;
  session_->send(PlayerMoved{now});
}

void PlayLoop::hear_session() {
  for (const Answer& answer : session_->hear()) {
    if (const auto* notice = std::get_if<Notice>(&answer)) log_warning(notice->text);
    if (std::optional<std::string> line = line_of(answer)) said_.push_back(*std::move(line));
  }
}

void PlayLoop::use_hands(const ActionFrame& actions, double seconds) {
  HandIntent intent = hand_intent_of(actions);
  intent.repeats = settings().play.repeat;
  // The click that captured the pointer, or closed a screen, means nothing to the hands.
  hands_free_ = window_.pointer_captured() && (hands_free_ || (!intent.dig && !intent.place));
  if (!hands_free_) intent.dig = intent.place = false;
  hands_.advance(seconds, intent, player_, *scene_.camera, around_, *session_);
  if (hands_.replay_refused())
    said_.emplace_back(tr("Not from here, or not now: go closer, and stand beside it"));
  if (hands_.stands_in_way()) said_.emplace_back(tr("No room: you stand there yourself"));
}

}  // namespace skerry::game
