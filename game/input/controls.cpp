#include "game/input/controls.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace skerry::game {
namespace {

constexpr double kDegreesPerPixel = 0.12;  // at the default field of view
constexpr double kPadDegreesPerSecond = 180.0;
constexpr double kDefaultFov = 70.0;
constexpr double kViewStep = 1.25;
constexpr double kSecondsPerDay = 86400.0;
constexpr double kDayStep = 1.0;  // seconds

double axis(const ActionFrame& actions, Action plus, Action minus) {
  return actions.value(plus) - actions.value(minus);
}

}  // namespace

Intent intent_of(const ActionFrame& actions) {
  Intent intent;
  intent.move = {axis(actions, Action::kRight, Action::kLeft),
                 axis(actions, Action::kForward, Action::kBack)};
  intent.rise = axis(actions, Action::kJump, Action::kCrouch);
  intent.jump = actions.down(Action::kJump) || actions.pressed(Action::kJump);
  intent.fast = actions.down(Action::kFast);
  intent.crouch = actions.down(Action::kCrouch);
  return intent;
}

void Toggles::apply(const PlaySettings& settings, const ActionFrame& actions, bool walking,
                    Intent& intent) {
  if (actions.presses(Action::kFast) % 2 != 0) sprints_ = !sprints_;
  if (actions.presses(Action::kCrouch) % 2 != 0) crouches_ = !crouches_;
  sprints_ &= walking && settings.toggle_sprint && intent.move != glm::dvec2(0.0);
  crouches_ &= walking && settings.toggle_crouch;
  if (!walking) return;
  if (settings.toggle_sprint) intent.fast = sprints_;
  if (settings.toggle_crouch) intent.crouch = crouches_;
}

HandIntent hand_intent_of(const ActionFrame& actions) {
  HandIntent intent;
  // What was pressed and released within a frame still counts for that frame.
  intent.dig = actions.down(Action::kDig) || actions.pressed(Action::kDig);
  intent.place = actions.down(Action::kPlace) || actions.pressed(Action::kPlace);
  intent.take_block = actions.pressed(Action::kPick);
  intent.undo = actions.pressed(Action::kUndo);
  intent.redo = actions.pressed(Action::kRedo);
  for (int slot = 0; slot < kHotbarSlots; ++slot)
    if (actions.pressed(static_cast<Action>(static_cast<int>(Action::kSlot1) + slot)))
      intent.slot = slot;
  intent.scroll = actions.presses(Action::kNextSlot) - actions.presses(Action::kPreviousSlot);
  return intent;
}

glm::dvec2 turned_deg(const LookInput& input, double fov_deg) {
  const Bindings& bindings = *input.bindings;
  const double zoom = std::min(1.0, fov_deg / kDefaultFov);
  const double upside = bindings.inverted ? -1.0 : 1.0;
  const ActionFrame& actions = *input.actions;
  const glm::dvec2 pad{axis(actions, Action::kLookRight, Action::kLookLeft),
                       axis(actions, Action::kLookDown, Action::kLookUp)};
  // Squared: slow where one aims, fast at the stick's end.
  const glm::dvec2 moved =
      input.pointer * (kDegreesPerPixel * bindings.mouse_speed) +
      pad * glm::abs(pad) * (kPadDegreesPerSecond * bindings.pad_speed * input.seconds);
  // Growing yaw turns left (docs/conventions.md), the pointer's y grows downwards.
  return {-moved.x * zoom, -moved.y * zoom * upside};
}

void look(Player& player, const LookInput& input, double fov_deg) {
  const glm::dvec2 turned = turned_deg(input, fov_deg);
  player.turn(turned.x, turned.y);
}

std::uint32_t stepped_view_distance(std::uint32_t blocks, int steps) {
  const double wanted = blocks * std::pow(kViewStep, steps);
  return static_cast<std::uint32_t>(
      std::clamp(std::round(wanted), double{kMinViewDistance}, double{kMaxViewDistance}));
}

render::DisplaySettings stepped_display(render::DisplaySettings display, int peak_steps,
                                        int black_steps) {
  // In whole steps, so that there and back is where one was.
  const auto stepped = [](double value, int steps, double step, double least, double most) {
    return static_cast<float>(std::clamp((std::round(value / step) + steps) * step, least, most));
  };
  if (peak_steps != 0) display.peak = stepped(display.peak, peak_steps, 0.05, kMinDisplayPeak, 1.0);
  if (black_steps != 0)
    display.black = stepped(display.black, black_steps, 0.005, 0.0, kMaxDisplayBlack);
  return display;
}

Quality stepped_quality(Quality quality, int steps) {
  const int level = static_cast<int>(quality) + steps;
  return static_cast<Quality>(
      std::clamp(level, static_cast<int>(Quality::kLow), static_cast<int>(Quality::kUltra)));
}

void DayClock::turn(double seconds) {
  exact_s_ = std::fmod(exact_s_ + seconds, kSecondsPerDay);
  if (exact_s_ < 0.0) exact_s_ += kSecondsPerDay;
  if (std::abs(exact_s_ - shown_s_) < kDayStep) return;
  shown_s_ = static_cast<int>(std::floor(exact_s_ / kDayStep) * kDayStep) %
             static_cast<int>(kSecondsPerDay);
}

}  // namespace skerry::game
