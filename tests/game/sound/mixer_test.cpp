#include "game/sound/mixer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "tests/game/sound/listen.h"

namespace skerry::game {
namespace {

/// A bank whose clips are all one tone, noise or click, of a second.
class TestBank {
 public:
  template <class Wave>
  explicit TestBank(const Wave& wave) : samples_(kSampleRate) {
    for (std::size_t i = 0; i < samples_.size(); ++i)
      samples_[i] = static_cast<std::int16_t>(32767.0 * wave(static_cast<double>(i) / kSampleRate));
    bank_.clips.fill(samples_);
  }
  const SoundBank& operator*() const { return bank_; }

 private:
  std::vector<std::int16_t> samples_;
  SoundBank bank_;
};

TestBank tone(double hz, double level = 0.5) {
  return TestBank([=](double t) { return level * std::sin(2.0 * std::numbers::pi * hz * t); });
}
TestBank hiss() {
  std::uint32_t state = 1;
  return TestBank([&](double) {
    state = state * 1664525u + 1013904223u;
    return 0.5 * (static_cast<double>(state) / 2147483648.0 - 1.0);
  });
}

struct Stereo {
  std::vector<float> left, right;
};
Stereo rendered(Mixer& mixer, double seconds) {
  std::vector<float> both(2 * static_cast<std::size_t>(seconds * kSampleRate));
  mixer.render(both);
  Stereo out;
  for (std::size_t i = 0; i < both.size(); i += 2) {
    out.left.push_back(both[i]);
    out.right.push_back(both[i + 1]);
  }
  return out;
}

VoiceStart voice(VoiceId id, const VoiceAim& aim, bool loops = true) {
  VoiceStart start;
  start.id = id;
  start.loops = loops;
  start.aim = aim;
  return start;
}

TEST(Mixer, GainIsAmplitudeAndTheMiddleIsEquallyLoudOnBothSides) {
  const TestBank bank = tone(440.0);
  Mixer mixer(*bank);
  mixer.start(voice(1, {0.5f}));
  (void)rendered(mixer, 0.2);
  const Stereo out = rendered(mixer, 0.5);
  // A tone of 0.5 has an RMS of 0.5 / sqrt 2; the middle gives each side 1 / sqrt 2 of it.
  EXPECT_NEAR(rms_of(out.left), 0.125, 0.001);
  EXPECT_EQ(out.left, out.right);
}

TEST(Mixer, PanKeepsThePowerAndGoesToItsSide) {
  const TestBank bank = tone(440.0);
  for (const float pan : {-1.0f, -0.5f, 0.3f, 1.0f}) {
    Mixer mixer(*bank);
    mixer.start(voice(1, {0.5f, pan}));
    (void)rendered(mixer, 0.2);
    const Stereo out = rendered(mixer, 0.5);
    const double left = rms_of(out.left), right = rms_of(out.right);
    EXPECT_NEAR(std::hypot(left, right), 0.25 / std::numbers::sqrt2, 0.001);
    EXPECT_EQ(left<right, pan> 0.0f);
  }
  Mixer mixer(*bank);
  mixer.start(voice(1, {0.5f, -1.0f}));
  EXPECT_LT(rms_of(rendered(mixer, 0.2).right), 1e-6);
}

TEST(Mixer, TheLowPassFallsBySixDecibelsAnOctave) {
  const TestBank high = tone(4000.0);
  const auto level = [&](float cutoff_hz) {
    Mixer mixer(*high);
    mixer.start(voice(1, {0.5f, 0.0f, cutoff_hz}));
    (void)rendered(mixer, 0.2);
    return decibels(rms_of(rendered(mixer, 0.5).left));
  };
  const double open = level(20000.0f);
  EXPECT_NEAR(level(4000.0f) - open, -3.0, 0.8);
  EXPECT_NEAR(level(500.0f) - open, -18.1, 0.8);
  EXPECT_NEAR(level(250.0f) - open, -24.1, 0.8);
}

TEST(Mixer, GlidesWithoutClicks) {
  const TestBank bank = tone(100.0);
  Mixer mixer(*bank);
  mixer.start(voice(1, {0.5f}));
  double steepest = 0.0;
  float last = 0.0f;
  const auto listen = [&](double seconds) {
    for (const float x : rendered(mixer, seconds).left) {
      steepest = std::max(steepest, std::abs(double{x} - last));
      last = x;
    }
  };
  listen(0.5);
  mixer.aim(1, {0.05f, 0.9f});
  listen(0.3);
  mixer.aim(1, {1.0f, -0.9f});
  listen(1.3);  // over the loop's end, too
  mixer.stop(1);
  listen(0.3);
  // At full gain a tone of 100 Hz and 0.5 moves by 0.0065 a sample; gains add some.
  EXPECT_LT(steepest, 0.02);
  EXPECT_EQ(mixer.voices(), 0u);
  EXPECT_EQ(peak_of(rendered(mixer, 0.1).left), 0.0);
}

TEST(Mixer, AChangeIsThereWithinFiftyMilliseconds) {
  const TestBank bank = tone(440.0);
  Mixer mixer(*bank);
  mixer.start(voice(1, {0.0f}));
  (void)rendered(mixer, 0.1);
  mixer.aim(1, {1.0f});
  (void)rendered(mixer, 0.02);
  EXPECT_GT(rms_of(rendered(mixer, 0.02).left), 0.95 * 0.25);
}

TEST(Mixer, AClipEndsAndALoopDoesNot) {
  const TestBank bank = tone(440.0);
  Mixer mixer(*bank);
  mixer.start(voice(1, {0.5f}, true));
  mixer.start(voice(2, {0.5f}, false));
  (void)rendered(mixer, 1.01);
  EXPECT_EQ(mixer.voices(), 1u);
  VoiceStart fast = voice(3, {0.5f}, false);
  fast.speed = 2.0f;
  mixer.start(fast);
  (void)rendered(mixer, 0.49);
  EXPECT_EQ(mixer.voices(), 2u);
  (void)rendered(mixer, 0.02);
  EXPECT_EQ(mixer.voices(), 1u);
}

TEST(Mixer, SpeedIsPitch) {
  const TestBank bank = tone(1000.0);
  Mixer mixer(*bank);
  VoiceStart slow = voice(1, {0.5f});
  slow.speed = 0.5f;
  mixer.start(slow);
  EXPECT_NEAR(centroid_hz(rendered(mixer, 0.5).left), 500.0, 5.0);
}

TEST(Mixer, AtMost64VoicesOfWhichTheQuietestGivesWay) {
  const TestBank bank = tone(440.0);
  Mixer mixer(*bank);
  for (VoiceId id = 1; id <= 64; ++id)
    mixer.start(voice(id, {id == 40 ? 0.001f : 0.01f, id == 40 ? -1.0f : 1.0f}));
  EXPECT_EQ(mixer.voices(), 64u);
  (void)rendered(mixer, 0.1);
  EXPECT_GT(peak_of(rendered(mixer, 0.1).left), 1e-4);
  mixer.start(voice(100, {0.0001f}));  // quieter than all
  EXPECT_GT(peak_of(rendered(mixer, 0.1).left), 1e-4);
  mixer.start(voice(101, {0.5f, 1.0f}));  // in the place of 40, the only one on the left
  EXPECT_EQ(mixer.voices(), 64u);
  EXPECT_LT(peak_of(rendered(mixer, 0.1).left), 1e-5);
}

TEST(Mixer, NothingLeavesTheRangeAndQuietSoundsStayAsTheyAre) {
  const TestBank bank = tone(440.0, 1.0);
  Mixer mixer(*bank);
  for (VoiceId id = 1; id <= 64; ++id) mixer.start(voice(id, {4.0f}));
  (void)rendered(mixer, 0.1);
  const Stereo out = rendered(mixer, 0.2);
  EXPECT_LE(peak_of(out.left), 1.0);
  EXPECT_GT(peak_of(out.left), 0.9);
}

TEST(Mixer, VolumesScaleTheirGroupAndZeroIsSilence) {
  const TestBank bank = tone(440.0);
  const auto level = [&](SoundGroup group, float volume) {
    Mixer mixer(*bank);
    mixer.set_volume(group, volume);
    VoiceStart start = voice(1, {0.5f, 0.0f, 20000.0f, 0.5f});
    start.group = SoundGroup::kAmbience;
    mixer.start(start);
    mixer.set_reverb({1.0f, 0.5f});
    (void)rendered(mixer, 0.2);
    return rms_of(rendered(mixer, 0.5).left);
  };
  const double whole = level(SoundGroup::kMaster, 1.0f);
  EXPECT_NEAR(level(SoundGroup::kMaster, 0.5f), 0.5 * whole, 0.01 * whole);
  EXPECT_NEAR(level(SoundGroup::kAmbience, 0.25f), 0.25 * whole, 0.01 * whole);
  EXPECT_EQ(level(SoundGroup::kEffects, 0.0f), whole);
  EXPECT_EQ(level(SoundGroup::kAmbience, 0.0f), 0.0);
  EXPECT_EQ(level(SoundGroup::kMaster, 0.0f), 0.0);
}

/// Seconds in which the energy that is still to come falls from -5 to -35 dB, doubled (M. R.
/// Schroeder, New Method of Measuring Reverberation Time, JASA 1965).
double measured_decay(float decay_s) {
  const TestBank click([](double t) { return t < 0.002 ? 0.9 : 0.0; });
  Mixer mixer(*click);
  mixer.set_reverb({decay_s, 1.0f, 20000.0f});
  (void)rendered(mixer, 0.1);
  VoiceStart start = voice(1, {0.0f, 0.0f, 20000.0f, 1.0f}, false);
  mixer.start(start);
  (void)rendered(mixer, 0.5);  // the reverb has glided to its aim
  mixer.start(start);
  const Stereo out = rendered(mixer, 2.0 * decay_s + 0.5);
  std::vector<double> to_come(out.left.size() + 1, 0.0);
  for (std::size_t i = out.left.size(); i-- > 0;)
    to_come[i] = to_come[i + 1] + double{out.left[i]} * out.left[i];
  const auto at = [&](double db) {
    std::size_t i = 0;
    while (10.0 * std::log10(std::max(to_come[i], 1e-30) / to_come[0]) > db) ++i;
    return static_cast<double>(i) / kSampleRate;
  };
  return 2.0 * (at(-35.0) - at(-5.0));
}

TEST(Reverb, DecaysInItsTime) {
  for (const float decay_s : {0.3f, 0.8f, 2.0f, 4.0f})
    EXPECT_NEAR(measured_decay(decay_s), decay_s, 0.15 * decay_s) << decay_s;
}

TEST(Reverb, DampingTakesTheBrightnessOutOfTheTail) {
  const TestBank noise = hiss();
  const auto tail = [&](float damping_hz) {
    Mixer mixer(*noise);
    mixer.set_reverb({1.5f, 1.0f, damping_hz});
    VoiceStart start = voice(1, {0.0f, 0.0f, 20000.0f, 0.5f}, false);
    mixer.start(start);
    (void)rendered(mixer, 1.2);
    return centroid_hz(rendered(mixer, 0.3).left);
  };
  EXPECT_LT(tail(1500.0f), 0.5 * tail(15000.0f));
}

TEST(Reverb, FallsSilent) {
  const TestBank bank = tone(440.0);
  Mixer mixer(*bank);
  mixer.set_reverb({0.5f, 1.0f});
  mixer.start(voice(1, {0.5f, 0.0f, 20000.0f, 1.0f}, false));
  (void)rendered(mixer, 3.0);
  EXPECT_EQ(peak_of(rendered(mixer, 0.1).left), 0.0);
}

TEST(Mixer, TheSameCallsGiveTheSameSamples) {
  const auto once = [] {
    Mixer mixer(sound_bank());
    mixer.set_reverb({1.0f, 0.4f});
    for (std::size_t clip = 0; clip < kClips; ++clip) {
      VoiceStart start = voice(clip + 1, {0.1f, 0.2f, 3000.0f, 0.3f}, clip > 40);
      start.clip = clip;
      start.speed = 0.9f;
      mixer.start(start);
    }
    return rendered(mixer, 1.0).left;
  };
  EXPECT_EQ(once(), once());
}

// Several voices are mixed at a time.
TEST(Mixer, VoicesTogetherAreTheSumOfEach) {
  const auto start_of = [](VoiceId id) {
    const auto n = static_cast<float>(id);
    VoiceStart start =
        voice(id, {0.02f, 0.1f * n - 0.5f, id % 3 == 0 ? 20000.0f : 300.0f * n}, id != 6);
    start.clip = clip_index(Sound::kTorch) + id % 5;
    start.speed = id % 2 == 0 ? 1.0f : 1.1f;
    return start;
  };
  for (const VoiceId count : {1u, 3u, 4u, 7u, 10u}) {
    Mixer together(sound_bank());
    std::vector<float> sum;
    for (VoiceId id = 1; id <= count; ++id) {
      together.start(start_of(id));
      Mixer alone(sound_bank());
      alone.start(start_of(id));
      const std::vector<float> one = rendered(alone, 1.0).left;
      if (sum.empty())
        sum = one;
      else
        for (std::size_t i = 0; i < one.size(); ++i) sum[i] += one[i];
    }
    EXPECT_EQ(rendered(together, 1.0).left, sum) << count;
  }
}

// The aim is 0.5 ms a frame of 1/60 s; a build with sanitizers, or a busy machine, gets more room.
TEST(Mixer, MixesSixtyFourVoicesInASmallPartOfAFrame) {
  Mixer mixer(sound_bank());
  mixer.set_reverb({2.0f, 0.5f});
  for (VoiceId id = 1; id <= kMaxVoices; ++id) {
    VoiceStart start = voice(id, {0.05f, 0.1f, 2000.0f, 0.3f});
    start.clip = clip_index(Sound::kTorch);
    start.speed = id % 2 == 0 ? 1.0f : 1.03f;
    mixer.start(start);
  }
  std::vector<float> frame(2 * kSampleRate / 60);
  std::vector<double> ms;
  for (int i = 0; i < 300; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    mixer.render(frame);
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
                     .count());
  }
  std::sort(ms.begin(), ms.end());
  std::printf("64 voices, a frame of 1/60 s: median %.3f ms, p90 %.3f ms\n", ms[150], ms[270]);
  EXPECT_LT(ms[30], 5.0);
}

}  // namespace
}  // namespace skerry::game
