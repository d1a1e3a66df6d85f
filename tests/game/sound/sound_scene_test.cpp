#include "game/sound/sound_scene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "game/player/player.h"
#include "game/sound/game_sound.h"
#include "game/sound/play_sounds.h"
#include "tests/folder.h"
#include "tests/game/sound/listen.h"
#include "tests/game/sound/wav_file.h"
#include "world/islands/stored_voxels.h"

namespace skerry::game {
namespace {

namespace block = world::block;
using world::IVec3;

constexpr double kFrame = 1.0 / 60.0;

/// A world of islands of one chunk, whose lattices begin at the given places.
class TestWorld {
 public:
  TestWorld() : world_(std::make_shared<world::World>(world::WorldDesc{1, {}, {}, false})) {}
  void add(std::uint64_t id, world::WorldPos origin, const world::Chunk& chunk) {
    auto voxels = std::make_shared<world::StoredVoxels>(
        std::map<IVec3, world::Chunk>{{IVec3{0, 0, 0}, chunk}});
    world::IslandSpec spec;
    spec.id = id;
    spec.origin = origin;
    ASSERT_TRUE(world_->add_island(world::fitted(spec, *voxels), voxels));
    ASSERT_TRUE(world_->ensure_chunk(id, {0, 0, 0}));
  }
  const std::shared_ptr<world::World>& operator*() const { return world_; }

 private:
  std::shared_ptr<world::World> world_;
};

void fill(world::Chunk& chunk, IVec3 low, IVec3 high, world::BlockId block) {
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z) chunk.set(x, y, z, block);
}

world::WorldPos at(double x, double y, double z) {
  return world::moved({}, {x, y, z});
}

/// Scene and mixer, frame after frame. What was heard in all becomes a file where recordings are
/// asked for, named after the test.
struct Ears {
  SoundScene scene;
  Mixer mixer{sound_bank()};
  SoundFrame frame;
  std::vector<MixCommand> last;
  std::vector<float> heard;  // left and right, since the beginning

  explicit Ears(std::shared_ptr<world::World> world, world::WorldPos eye) {
    frame.world = std::move(world);
    frame.listener = {eye, 1, 0.0};
    frame.seconds = kFrame;
  }
  ~Ears() {
    const auto folder = recordings_folder();
    if (!folder) return;
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::path file = *folder / (test + ".wav");
    for (int i = 2; std::filesystem::exists(file); ++i)
      file = *folder / (test + "_" + std::to_string(i) + ".wav");
    EXPECT_TRUE(write_wav(file, heard)) << file;
  }
  Ears(const Ears&) = delete;
  Ears& operator=(const Ears&) = delete;
  /// @return left and right of that time.
  std::vector<float> hear(double seconds) {
    std::vector<float> all, one(2 * static_cast<std::size_t>(kSampleRate * kFrame));
    for (double t = 0.0; t < seconds - 1e-9; t += kFrame) {
      last = scene.advance(frame);
      for (const MixCommand& command : last) apply(command, mixer);
      frame.events.clear();
      frame.changes.clear();
      frame.listener.time_s += kFrame;
      mixer.render(one);
      all.insert(all.end(), one.begin(), one.end());
    }
    heard.insert(heard.end(), all.begin(), all.end());
    return all;
  }
  void edit(IVec3 voxel, world::BlockId block) {
    frame.world->set_block(1, voxel, block);
    frame.changes.push_back({1, voxel, block});
  }
  std::vector<VoiceStart> starts() const {
    std::vector<VoiceStart> found;
    for (const MixCommand& command : last)
      if (const auto* start = std::get_if<VoiceStart>(&command)) found.push_back(*start);
    return found;
  }
};

/// Rock, in it a small room with a torch and a tunnel beside it where the listener stands.
world::Chunk rock_with_torch() {
  world::Chunk chunk;
  fill(chunk, {0, 0, 0}, {63, 63, 63}, block::kStone);
  fill(chunk, {20, 20, 20}, {23, 23, 23}, world::kAir);
  fill(chunk, {20, 20, 24}, {23, 23, 36}, world::kAir);
  chunk.set(21, 20, 21, block::kTorch);
  return chunk;
}

TEST(SoundScene, AnOpenedWallIsHeardWithinFiftyMilliseconds) {
  TestWorld world;
  world.add(1, {}, rock_with_torch());
  Ears ears(*world, at(21.5, 21.6, 28.5));
  ears.frame.volumes[static_cast<std::size_t>(SoundGroup::kEffects)] = 0.0f;
  (void)ears.hear(1.0);
  const double sealed = rms_of(ears.hear(0.5));
  ears.edit({21, 21, 23}, world::kAir);
  (void)ears.hear(kFrame);
  (void)ears.hear(kFrame);
  const double opened = rms_of(ears.hear(kFrame));  // 33 to 50 ms after
  EXPECT_GT(decibels(opened), decibels(sealed) + 20.0);
  EXPECT_GT(opened, 1e-4);
  ears.edit({21, 21, 23}, block::kStone);
  (void)ears.hear(6.0);  // the echo dies away
  EXPECT_LT(decibels(rms_of(ears.hear(0.5))), decibels(opened) - 20.0);
}

TEST(SoundScene, ATorchIsHeardFromItsSideAndSaidSo) {
  world::Chunk chunk;
  fill(chunk, {0, 0, 0}, {60, 10, 60}, block::kGrass);
  chunk.set(24, 10, 30, block::kTorch);
  TestWorld world;
  world.add(1, {}, chunk);
  for (const bool turned : {false, true}) {
    Ears ears(*world, at(30.5, 11.6, 30.5));
    ears.frame.volumes[static_cast<std::size_t>(SoundGroup::kAmbience)] = 1.0f;
    ears.frame.yaw_deg = turned ? 180.0 : 0.0;  // 0 looks along +z: the torch at -x is on the right
    ears.scene.advance(ears.frame);
    const std::vector<std::string> lines = ears.scene.take_captions();
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0],
              turned ? "[torch crackling to the left]" : "[torch crackling to the right]");
    EXPECT_TRUE(ears.scene.take_captions().empty());
    Ears fresh(*world, at(30.5, 11.6, 30.5));
    fresh.frame.yaw_deg = ears.frame.yaw_deg;
    (void)fresh.hear(kFrame);
    for (const VoiceStart& start : fresh.starts())
      if (start.clip == clip_index(Sound::kTorch)) {
        EXPECT_EQ(start.aim.pan < 0.0f, turned);
      }
  }
}

TEST(SoundScene, VolumeZeroIsSilenceAndPauseIsToo) {
  world::Chunk chunk;
  fill(chunk, {0, 0, 0}, {60, 10, 60}, block::kGrass);
  chunk.set(28, 10, 30, block::kTorch);
  TestWorld world;
  world.add(1, {}, chunk);
  Ears ears(*world, at(30.5, 11.6, 30.5));
  EXPECT_GT(rms_of(ears.hear(0.5)), 1e-3);
  ears.frame.volumes = {0.0f, 1.0f, 1.0f, 1.0f};
  (void)ears.hear(0.3);
  ears.frame.events = {{Sound::kStep, SoundMaterial::kStone, std::nullopt}};
  EXPECT_LT(peak_of(ears.hear(0.3)), 1e-6);
  ears.frame.volumes[0] = 1.0f;
  ears.frame.paused = true;
  (void)ears.hear(3.0);
  EXPECT_EQ(peak_of(ears.hear(0.3)), 0.0);
  ears.frame.events = {{Sound::kClick, SoundMaterial::kStone, std::nullopt}};
  EXPECT_GT(peak_of(ears.hear(0.1)), 0.01);  // screens click
  ears.frame.paused = false;
  EXPECT_GT(rms_of(ears.hear(0.5)), 1e-3);
}

/// Samples of a file that write_wav wrote, read by its format.
std::vector<float> samples_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<float> samples;
  for (std::size_t i = kWavHeaderBytes; i + 1 < bytes.size(); i += 2) {
    const auto low = static_cast<unsigned char>(bytes[i]);
    const auto high = static_cast<signed char>(bytes[i + 1]);
    samples.push_back(static_cast<float>(high * 256 + low) / 32767.0f);
  }
  return samples;
}

TEST(SoundScene, AFileHoldsWhatIsHeardItsLevelItsSpectrumAndItsSilence) {
  TestWorld world;
  world.add(1, {}, rock_with_torch());
  Ears ears(*world, at(21.5, 21.6, 28.5));
  ears.edit({21, 21, 23}, world::kAir);
  (void)ears.hear(1.0);
  ears.frame.paused = true;
  (void)ears.hear(3.5);
  const Folder folder;
  ASSERT_TRUE(write_wav(folder / "heard.wav", ears.heard));
  EXPECT_EQ(std::filesystem::file_size(folder / "heard.wav"),
            kWavHeaderBytes + 2 * ears.heard.size());
  const std::vector<float> read = samples_of(folder / "heard.wav");
  ASSERT_EQ(read.size(), ears.heard.size());
  const std::size_t second = 2 * static_cast<std::size_t>(kSampleRate);
  const auto first = [&](const std::vector<float>& all) { return std::span(all).first(second); };
  EXPECT_NEAR(decibels(rms_of(first(read))), decibels(rms_of(first(ears.heard))), 0.01);
  EXPECT_NEAR(centroid_hz(first(read)), centroid_hz(first(ears.heard)), 20.0);
  EXPECT_GT(rms_of(first(read)), 1e-4);
  EXPECT_EQ(peak_of(std::span(read).last(second / 4)), 0.0);
}

TEST(SoundScene, WindGrowsWithSpeedAndHeightAndIsNotUnderground) {
  world::Chunk chunk = rock_with_torch();
  TestWorld world;
  world.add(1, {}, chunk);
  const auto wind = [&](world::WorldPos eye, double speed) {
    Ears ears(*world, eye);
    ears.frame.air_speed = speed;
    (void)ears.hear(kFrame);
    for (const VoiceStart& start : ears.starts())
      if (start.clip == clip_index(Sound::kWind)) return start.aim.gain;
    return 0.0f;
  };
  const float low = wind(at(30.5, 64.7, 30.5), 0.0), high = wind(at(30.5, 85.0, 30.5), 0.0);
  EXPECT_GT(low, 0.01f);
  EXPECT_GT(high, 1.3f * low);
  EXPECT_GT(wind(at(30.5, 64.7, 30.5), 40.0), 3.0f * low);
  EXPECT_EQ(wind(at(21.5, 21.6, 28.5), 0.0), 0.0f);
}

TEST(SoundScene, IslandsThatTouchGrindWhenOneMoves) {
  world::Chunk chunk;
  fill(chunk, {0, 0, 0}, {20, 10, 20}, block::kStone);
  TestWorld world;
  world.add(1, {}, chunk);
  world.add(2, at(20.0, 0.0, 0.0), chunk);
  Ears ears(*world, at(14.5, 11.6, 10.5));
  double along_z = 0.0;  // blocks/s, along the face
  std::int64_t tick = 0;
  const auto grinds = [&] {
    bool found = false;
    for (int i = 0; i < 40; ++i) {
      for (const double until_s = ears.frame.listener.time_s + kFrame;
           static_cast<double>(tick) * world::kMotionTickSeconds <= until_s; ++tick)
        (*world)->move_island(
            2, tick,
            {at(20.0, 0.0, along_z * static_cast<double>(tick) * world::kMotionTickSeconds)});
      (void)ears.hear(kFrame);
      for (const VoiceStart& start : ears.starts())
        found |= start.clip == clip_index(Sound::kGrind);
    }
    return found;
  };
  EXPECT_FALSE(grinds());  // it lies still
  along_z = 2.0;
  EXPECT_TRUE(grinds());
}

TEST(SoundScene, UnderWaterEverythingIsDull) {
  world::Chunk chunk;
  fill(chunk, {0, 0, 0}, {60, 10, 60}, block::kGrass);
  fill(chunk, {1, 10, 1}, {59, 40, 59}, block::kWater);
  TestWorld world;
  world.add(1, {}, chunk);
  Ears below(*world, at(30.5, 20.5, 30.5)), above(*world, at(30.5, 60.5, 30.5));
  for (Ears* ears : {&below, &above}) {
    ears->frame.events = {{Sound::kDig, SoundMaterial::kStone,
                           world::moved(ears->frame.listener.eye, {3.0, 0.0, 0.0})}};
    (void)ears->hear(kFrame);
    bool found = false;
    for (const VoiceStart& start : ears->starts()) {
      if (start.loops) continue;
      found = true;
      EXPECT_EQ(start.aim.cutoff_hz <= 700.0f, ears == &below);
    }
    EXPECT_TRUE(found);
  }
}

// The fake sink: what a scripted walk asks for.
std::vector<SoundEvent> walk(PlaySounds& sounds, PlayMoment moment, double seconds) {
  std::vector<SoundEvent> all;
  moment.seconds = kFrame;
  for (double t = 0.0; t < seconds; t += kFrame)
    for (const SoundEvent& event : sounds.advance(moment, {})) all.push_back(event);
  return all;
}

PlayMoment walking(double pace, world::BlockId ground) {
  PlayMoment moment;
  moment.velocity = {pace, 0.0, 0.0};
  moment.on_ground = true;
  moment.ground = ground;
  return moment;
}

TEST(PlaySounds, StepsFollowPaceAndGround) {
  const auto steps = [](double pace, world::BlockId ground) {
    PlaySounds sounds;
    return walk(sounds, walking(pace, ground), 10.0);
  };
  // 45 blocks in steps of 2; 80 in steps of 2.7.
  EXPECT_NEAR(static_cast<double>(steps(4.5, block::kGrass).size()), 22.0, 1.0);
  EXPECT_NEAR(static_cast<double>(steps(8.0, block::kGrass).size()), 29.0, 1.0);
  EXPECT_TRUE(steps(0.0, block::kGrass).empty());
  const std::map<world::BlockId, SoundMaterial> materials{
      {block::kStone, SoundMaterial::kStone},      {block::kGrass, SoundMaterial::kSoil},
      {block::kSand, SoundMaterial::kSand},        {block::kPlanks, SoundMaterial::kWood},
      {block::kOakLeaves, SoundMaterial::kLeaves}, {block::kSnow, SoundMaterial::kSnow}};
  for (const auto& [ground, material] : materials)
    for (const SoundEvent& event : steps(4.5, ground)) {
      EXPECT_EQ(event.sound, Sound::kStep);
      EXPECT_EQ(event.material, material);
    }
  PlaySounds sounds;
  PlayMoment crouched = walking(1.5, block::kGrass);
  crouched.crouching = true;
  const auto quiet = walk(sounds, crouched, 10.0);
  ASSERT_FALSE(quiet.empty());
  EXPECT_LT(quiet[0].gain, 0.5f * steps(4.5, block::kGrass)[0].gain);
}

TEST(PlaySounds, AFallLandsAndWaterSplashes) {
  PlaySounds sounds;
  PlayMoment falling;
  falling.velocity = {0.0, -12.0, 0.0};
  EXPECT_TRUE(walk(sounds, falling, 0.5).empty());
  const auto landed = walk(sounds, walking(0.0, block::kSnow), 0.5);
  ASSERT_EQ(landed.size(), 1u);
  EXPECT_EQ(landed[0].sound, Sound::kStep);
  EXPECT_GT(landed[0].gain, 0.6f);
  (void)walk(sounds, falling, 0.5);
  PlayMoment wet;
  wet.in_water = true;
  const auto splashed = walk(sounds, wet, 1.0);
  ASSERT_EQ(splashed.size(), 1u);
  EXPECT_EQ(splashed[0].sound, Sound::kSplash);
  // A play that begins in water, or on the ground, is silent.
  PlaySounds fresh;
  EXPECT_TRUE(walk(fresh, wet, 1.0).empty());
}

TEST(PlaySounds, AnIslandThatBumpsThudsOnceAndTheLouderTheFaster) {
  PlaySounds sounds;
  PlayMoment bump;
  bump.bump = 2.0;
  const auto slow = sounds.advance(bump, {});
  bump.bump = 6.0;
  const auto fast = sounds.advance(bump, {});
  ASSERT_EQ(slow.size(), 1u);
  ASSERT_EQ(fast.size(), 1u);
  EXPECT_EQ(slow[0].material, SoundMaterial::kStone);
  EXPECT_LT(slow[0].speed, 0.5f);  // deeper than any block that is placed
  EXPECT_GT(fast[0].gain, slow[0].gain + 0.2f);
  EXPECT_TRUE(sounds.advance({}, {}).empty());
}

TEST(PlaySounds, DiggingStrikesAndEditsAreHeardAtTheirPlace) {
  PlaySounds sounds;
  PlayMoment digging;
  digging.dig_progress = 0.5;
  digging.dug = block::kPlanks;
  const auto blows = walk(sounds, digging, 1.0);
  EXPECT_NEAR(static_cast<double>(blows.size()), 1.0 / PlaySounds::kBlowPeriod, 1.0);
  for (const SoundEvent& blow : blows) {
    EXPECT_EQ(blow.sound, Sound::kDig);
    EXPECT_EQ(blow.material, SoundMaterial::kWood);
  }
  const EditHeard taken{block::kSand, world::kAir, at(1.0, 2.0, 3.0)};
  const EditHeard put{world::kAir, block::kStone, at(4.0, 5.0, 6.0)};
  const auto heard = sounds.advance({}, {taken, put});
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].sound, Sound::kDig);
  EXPECT_EQ(heard[0].material, SoundMaterial::kSand);
  EXPECT_EQ(heard[0].at, taken.at);
  EXPECT_EQ(heard[1].sound, Sound::kPlace);
  EXPECT_EQ(heard[1].material, SoundMaterial::kStone);
  EXPECT_EQ(sounds.advance({}, std::vector<EditHeard>(100, taken)).size(), PlaySounds::kMostEdits);
}

/// What the overlay says once the device is open, or is not.
std::string status_with(const char* drivers) {
  ::setenv("ALSOFT_DRIVERS", drivers, 1);
  GameSound sound;
  TestWorld world;
  world.add(1, {}, rock_with_torch());
  SoundFrame frame;
  frame.world = *world;
  frame.listener = {at(21.5, 21.6, 28.5), 1, 0.0};
  frame.seconds = kFrame;
  for (int i = 0; i < 2000 && sound.status() == "sound: opening the device"; ++i) {
    sound.frame(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::unsetenv("ALSOFT_DRIVERS");
  return sound.status();
}

// Each in a process of its own: OpenAL reads the names of drivers once.
TEST(GameSoundDeathTest, NoDeviceAndANullDeviceAreNoErrors) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto says = [](const char* drivers, const char* part) {
    std::_Exit(status_with(drivers).find(part) != std::string::npos ? 0 : 1);
  };
  EXPECT_EXIT(says("null", " voices"), testing::ExitedWithCode(0), "^$");
  // With or without a card; libasound complains of none.
  EXPECT_EXIT(says("alsa", "sound: "), testing::ExitedWithCode(0), "^$");
  EXPECT_EXIT(says("no_such_driver", "no sound: there is no device"), testing::ExitedWithCode(0),
              "^$");
}

TEST(GameSound, SaysWhatIsHeardWithoutADevice) {
  ::setenv("ALSOFT_DRIVERS", "no_such_driver", 1);
  world::Chunk chunk;
  fill(chunk, {0, 0, 0}, {60, 10, 60}, block::kGrass);
  chunk.set(24, 10, 30, block::kTorch);
  TestWorld world;
  world.add(1, {}, chunk);
  GameSound sound;
  SoundFrame frame;
  frame.world = *world;
  frame.listener = {at(30.5, 11.6, 30.5), 1, 0.0};
  frame.seconds = kFrame;
  std::vector<std::string> lines;
  for (int i = 0; i < 1000 && lines.empty(); ++i) {
    sound.frame(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    lines = sound.take_captions();
  }
  ::unsetenv("ALSOFT_DRIVERS");
  EXPECT_EQ(lines, std::vector<std::string>{"[torch crackling to the right]"});
}

}  // namespace
}  // namespace skerry::game
