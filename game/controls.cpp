#include "game/controls.h"

#include <algorithm>
#include <cmath>

namespace skerry::game {
namespace {

using platform::Key;

constexpr double kDegreesPerPixel = 0.12;  // at the default field of view
constexpr double kDefaultFov = 70.0;
constexpr double kViewStep = 1.25;
constexpr double kSecondsPerDay = 86400.0;
constexpr double kDayStep = 10.0;  // seconds

double axis(const platform::InputFrame& input, Key plus, Key minus) {
  return (input.down(plus) ? 1.0 : 0.0) - (input.down(minus) ? 1.0 : 0.0);
}

}  // namespace

Intent intent_of(const platform::InputFrame& input) {
  Intent intent;
  intent.move = {axis(input, Key::kD, Key::kA), axis(input, Key::kW, Key::kS)};
  intent.rise = axis(input, Key::kSpace, Key::kShift);
  intent.jump = input.down(Key::kSpace) || input.pressed(Key::kSpace);
  intent.fast = input.down(Key::kControl);
  return intent;
}

void look(Player& player, const platform::InputFrame& input, double fov_deg) {
  const double scale = kDegreesPerPixel * std::min(1.0, fov_deg / kDefaultFov);
  // Growing yaw turns left (docs/conventions.md), the pointer's y grows downwards.
  player.turn(-input.mouse_delta.x * scale, -input.mouse_delta.y * scale);
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
