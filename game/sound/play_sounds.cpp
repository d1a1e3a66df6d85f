#include "game/sound/play_sounds.h"

#include <algorithm>
#include <cmath>

namespace skerry::game {
namespace {

constexpr double kWalkPace = 4.5, kSprintPace = 8.0;  // blocks/s, as in docs/play.md
constexpr double kLandSpeed = 3.0;                    // blocks/s from which landing is heard
constexpr double kSplashSpeed = 1.5;                  // and entering water

}  // namespace

std::vector<SoundEvent> PlaySounds::advance(const PlayMoment& now,
                                            const std::vector<EditHeard>& edits) {
  std::vector<SoundEvent> out;
  if (begun_) {
    enter_water(now, out);
    step(now, out);
  }
  begun_ = true;
  dig(now, out);
  // Deep, and all around: the ground carries it.
  if (now.bump > 0.0)
    out.push_back({Sound::kPlace, SoundMaterial::kStone, std::nullopt,
                   static_cast<float>(std::min(1.0, 0.4 + now.bump / 12.0)), 0.35f});
  for (std::size_t i = 0; i < std::min(edits.size(), kMostEdits); ++i) {
    const EditHeard& edit = edits[i];
    const bool taken = edit.is == world::kAir || edit.is == world::block::kWater;
    out.push_back({taken ? Sound::kDig : Sound::kPlace, sound_material(taken ? edit.was : edit.is),
                   edit.at, 0.9f, taken ? 0.85f : 1.0f});
  }
  fall_ = -now.velocity.y;
  on_ground_ = now.on_ground;
  in_water_ = now.in_water;
  return out;
}

void PlaySounds::step(const PlayMoment& now, std::vector<SoundEvent>& out) {
  if (!now.walks || !now.on_ground) {
    walked_ = 0.5 * kStride;  // the first step comes soon
    return;
  }
  const double pace = std::hypot(now.velocity.x, now.velocity.z);
  const bool lands = !on_ground_ && fall_ > kLandSpeed;
  walked_ = pace > 0.1 ? walked_ + pace * now.seconds : 0.0;
  const double stride = kStride * (now.crouching ? 0.75 : pace > 6.0 ? 1.35 : 1.0);
  if (walked_ < stride && !lands) return;
  walked_ = 0.0;
  SoundEvent event;
  event.material = now.in_water ? SoundMaterial::kWater : sound_material(now.ground);
  const double tread = now.crouching ? 0.12 : 0.25 + 0.3 * std::min(1.0, pace / kSprintPace);
  event.gain =
      static_cast<float>(lands ? std::max(tread, 0.3 + std::min(0.7, fall_ / 18.0)) : tread);
  event.speed =
      (++steps_ % 2 == 0 ? 0.97f : 1.03f) *
      static_cast<float>(1.0 + 0.06 * std::clamp((pace - kWalkPace) / kWalkPace, -1.0, 1.0));
  out.push_back(event);
}

void PlaySounds::enter_water(const PlayMoment& now, std::vector<SoundEvent>& out) {
  if (!now.in_water || in_water_) return;
  const double speed = std::max(fall_, std::hypot(now.velocity.x, now.velocity.z) * 0.5);
  if (speed < kSplashSpeed) return;
  out.push_back({Sound::kSplash, SoundMaterial::kWater, std::nullopt,
                 static_cast<float>(std::min(1.0, 0.25 + speed / 14.0)),
                 static_cast<float>(1.1 - 0.2 * std::min(1.0, speed / 20.0))});
}

void PlaySounds::dig(const PlayMoment& now, std::vector<SoundEvent>& out) {
  if (now.dig_progress <= 0.0 || now.dug == world::kAir) {
    until_blow_ = 0.0;
    return;
  }
  until_blow_ -= now.seconds;
  if (until_blow_ > 0.0) return;
  until_blow_ = kBlowPeriod;
  out.push_back({Sound::kDig, sound_material(now.dug), now.pointed_at, 0.45f, 1.1f});
}

}  // namespace skerry::game
