#include "game/sound/mixer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skerry::game {
namespace {

constexpr auto kMixRate = static_cast<float>(kSampleRate);
constexpr float kOpenHz = 18000.0f;  // a low-pass from here on lets everything pass
constexpr float kFromInt16 = 1.0f / 32768.0f;
constexpr float kFadedOut = 1e-5f;  // -100 dB: a voice that fades out has ended

/// Straight up to 0.8, then ever flatter, up to 1.
float compressed(float x) {
  constexpr float kKnee = 0.8f, kRoom = 1.0f - kKnee;
  const float size = std::abs(x);
  if (size <= kKnee) return x;
  const float over = (size - kKnee) / kRoom;
  return std::copysign(kKnee + kRoom * over / (1.0f + over), x);
}

/// How much of the way to its goal a number glides in so many samples.
float glide_of(std::size_t samples) {
  return static_cast<float>(
      std::min(1.0, static_cast<double>(samples) / (kGlideSeconds * 0.25 * kSampleRate)));
}

}  // namespace

Mixer::Mixer(const SoundBank& bank) : bank_(bank) {
  volumes_.fill(1.0f);
}

Mixer::Goal Mixer::goal_of(const Voice& voice) const {
  const VoiceAim& aim = voice.start.aim;
  const float volume = voice.ending ? 0.0f : volumes_[static_cast<std::size_t>(voice.start.group)];
  const float angle = (std::clamp(aim.pan, -1.0f, 1.0f) + 1.0f) * 0.25f * std::numbers::pi_v<float>;
  const float gain = std::clamp(aim.gain, 0.0f, 4.0f) * volume;
  const float pole =
      aim.cutoff_hz >= kOpenHz
          ? 1.0f
          : 1.0f - std::exp(-2.0f * std::numbers::pi_v<float> * aim.cutoff_hz / kMixRate);
  return {gain * std::cos(angle), gain * std::sin(angle),
          std::clamp(aim.reverb, 0.0f, 4.0f) * volume, pole};
}

Mixer::Voice* Mixer::find(VoiceId id) {
  if (id == 0) return nullptr;
  for (Voice& voice : voices_)
    if (voice.playing && !voice.ending && voice.start.id == id) return &voice;
  return nullptr;
}

Mixer::Voice* Mixer::free_voice(float gain) {
  Voice* quietest = nullptr;
  for (Voice& voice : voices_) {
    if (!voice.playing) return &voice;
    if (!quietest || voice.start.aim.gain < quietest->start.aim.gain) quietest = &voice;
  }
  return quietest->start.aim.gain < gain ? quietest : nullptr;
}

void Mixer::start(const VoiceStart& voice) {
  if (voice.clip >= kClips) return;
  Voice* place = find(voice.id);
  if (!place) place = free_voice(voice.aim.gain);
  if (!place) return;
  *place = Voice{};
  place->start = voice;
  place->start.speed = std::clamp(voice.speed, 0.25f, 4.0f);
  place->playing = true;
  const Goal goal = goal_of(*place);
  place->pole = goal.pole;
  if (voice.loops) return;  // comes in gently; what is struck does not
  place->left = goal.left;
  place->right = goal.right;
  place->reverb = goal.reverb;
}

void Mixer::aim(VoiceId id, const VoiceAim& aim) {
  if (Voice* voice = find(id)) voice->start.aim = aim;
}

void Mixer::stop(VoiceId id) {
  if (Voice* voice = find(id)) voice->ending = true;
}

void Mixer::stop_all() {
  for (Voice& voice : voices_) voice.ending = voice.playing;
}

void Mixer::set_volume(SoundGroup group, float volume) {
  volumes_[static_cast<std::size_t>(group)] = std::clamp(volume, 0.0f, 1.0f);
}

std::size_t Mixer::voices() const {
  return static_cast<std::size_t>(
      std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.playing; }));
}

/// The clip's next samples, by the voice's speed; silence once it has ended.
void Mixer::fill(Voice& voice, std::size_t samples, Clip& out) {
  const std::span<const std::int16_t> clip = bank_.clips[voice.start.clip];
  const std::size_t size = clip.size();
  if (voice.start.speed == 1.0f) {
    std::size_t at = static_cast<std::size_t>(voice.at), done = 0;
    while (done < samples) {
      const std::size_t run = std::min(samples - done, size - at);
      for (std::size_t i = 0; i < run; ++i)
        out[done + i] = static_cast<float>(clip[at + i]) * kFromInt16;
      done += run;
      at += run;
      if (at < size) break;
      at = 0;
      if (voice.start.loops) continue;
      voice.playing = false;
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(done),
                out.begin() + static_cast<std::ptrdiff_t>(samples), 0.0f);
      break;
    }
    voice.at = static_cast<double>(at);
    return;
  }
  for (std::size_t i = 0; i < samples; ++i) {
    const auto at = static_cast<std::size_t>(voice.at);
    const auto part = static_cast<float>(voice.at - static_cast<double>(at));
    const std::size_t next = at + 1 < size ? at + 1 : voice.start.loops ? 0 : at;
    out[i] = kFromInt16 *
             (static_cast<float>(clip[at]) * (1.0f - part) + static_cast<float>(clip[next]) * part);
    voice.at += double{voice.start.speed};
    if (voice.at < static_cast<double>(size)) continue;
    voice.at -= static_cast<double>(size);
    if (voice.start.loops) continue;
    voice.playing = false;
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(i) + 1,
              out.begin() + static_cast<std::ptrdiff_t>(samples), 0.0f);
    return;
  }
}

/// @param voices kTogether at most, whose clips these are.
void Mixer::low_pass(std::span<Voice* const> voices, std::span<Clip> clips, std::size_t samples) {
  Clip unused{};
  std::array<float*, kTogether> x;
  x.fill(unused.data());
  std::array<float, kTogether> low{}, pole{};
  for (std::size_t k = 0; k < voices.size(); ++k) {
    if (voices[k]->pole >= 0.999f) continue;
    x[k] = clips[k].data();
    low[k] = voices[k]->low;
    pole[k] = voices[k]->pole;
  }
  for (std::size_t i = 0; i < samples; ++i)
    for (std::size_t k = 0; k < kTogether; ++k) x[k][i] = low[k] += pole[k] * (x[k][i] - low[k]);
  for (std::size_t k = 0; k < voices.size(); ++k) voices[k]->low = clips[k][samples - 1];
}

void Mixer::add(Voice& voice, const Goal& goal, std::size_t samples, const Clip& clip) {
  // Straight to what the glide reaches at the block's end: no step, and no exponential a sample.
  const float glide = glide_of(samples);
  const auto n = static_cast<float>(samples);
  const Goal step{(goal.left - voice.left) * glide / n, (goal.right - voice.right) * glide / n,
                  (goal.reverb - voice.reverb) * glide / n, 0.0f};
  const float left = voice.left, right = voice.right, reverb = voice.reverb;
  for (std::size_t i = 0; i < samples; ++i) {
    const auto at = static_cast<float>(static_cast<int>(i) + 1);
    left_[i] += (left + step.left * at) * clip[i];
    right_[i] += (right + step.right * at) * clip[i];
    send_[i] += (reverb + step.reverb * at) * clip[i];
  }
  voice.left += step.left * n;
  voice.right += step.right * n;
  voice.reverb += step.reverb * n;
  if (voice.ending && voice.left + voice.right + voice.reverb < kFadedOut) voice.playing = false;
}

/// @param voices kTogether at most.
void Mixer::mix_voices(std::span<Voice* const> voices, std::size_t samples) {
  std::array<Goal, kTogether> goals;
  for (std::size_t k = 0; k < voices.size(); ++k) {
    Voice& voice = *voices[k];
    fill(voice, samples, clips_[k]);
    goals[k] = goal_of(voice);
    voice.pole += (goals[k].pole - voice.pole) * glide_of(samples);
  }
  low_pass(voices, clips_, samples);
  for (std::size_t k = 0; k < voices.size(); ++k) add(*voices[k], goals[k], samples, clips_[k]);
}

void Mixer::mix_block(std::span<float> stereo) {
  const std::size_t samples = stereo.size() / 2;
  std::fill_n(left_.begin(), samples, 0.0f);
  std::fill_n(right_.begin(), samples, 0.0f);
  std::fill_n(send_.begin(), samples, 0.0f);
  std::array<Voice*, kTogether> together{};
  std::size_t count = 0;
  for (Voice& voice : voices_) {
    if (!voice.playing) continue;
    together[count++] = &voice;
    if (count == kTogether) mix_voices(together, samples);
    count %= kTogether;
  }
  mix_voices(std::span(together).first(count), samples);
  reverb_.render({send_.data(), samples}, {left_.data(), samples}, {right_.data(), samples});
  // The master's volume is of all that is heard, the reverb's tail included.
  const float goal = volumes_[static_cast<std::size_t>(SoundGroup::kMaster)];
  const float step = (goal - master_) * glide_of(samples) / static_cast<float>(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const float volume = master_ + step * static_cast<float>(i + 1);
    stereo[2 * i] = compressed(volume * left_[i]);
    stereo[2 * i + 1] = compressed(volume * right_[i]);
  }
  master_ += step * static_cast<float>(samples);
  if (std::abs(goal - master_) < kFadedOut) master_ = goal;
}

void Mixer::render(std::span<float> stereo) {
  for (std::size_t at = 0; at < stereo.size(); at += 2 * kBlock)
    mix_block(stereo.subspan(at, std::min(2 * kBlock, stereo.size() - at)));
}

}  // namespace skerry::game
