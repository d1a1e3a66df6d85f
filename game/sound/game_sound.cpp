#include "game/sound/game_sound.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "game/sound/openal_out.h"

namespace skerry::game {
namespace {

constexpr std::size_t kMostEvents = 64;  // that wait; more are not told apart
constexpr auto kPause = std::chrono::milliseconds(3);
constexpr int kBlocksToStatus = 50;

/// What two frames that are heard as one are.
void join(SoundFrame& earlier, SoundFrame later) {
  const auto put_before = [](auto& before, auto& after) {
    before.insert(before.end(), std::make_move_iterator(after.begin()),
                  std::make_move_iterator(after.end()));
    after = std::move(before);
  };
  const bool same = earlier.world == later.world;
  later.seconds += earlier.seconds;
  put_before(earlier.events, later.events);
  if (same) put_before(earlier.changes, later.changes);
  if (later.events.size() > kMostEvents)
    later.events.erase(later.events.begin(), later.events.end() - kMostEvents);
  earlier = std::move(later);
}

}  // namespace

GameSound::GameSound() {
  // OpenAL Soft writes about every driver that finds no device.
  ::setenv("ALSOFT_LOGLEVEL", "0", 0);
  listener_ = std::thread([this] { listen(); });
  mixer_ = std::thread([this] { mix(); });
}

GameSound::~GameSound() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  listener_.join();
  mixer_.join();
}

void GameSound::frame(SoundFrame frame) {
  {
    const std::lock_guard lock(mutex_);
    if (pending_)
      join(*pending_, std::move(frame));
    else
      pending_ = std::move(frame);
  }
  wake_.notify_all();
}

std::vector<std::string> GameSound::take_captions() {
  const std::lock_guard lock(mutex_);
  return std::exchange(captions_, {});
}

std::string GameSound::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void GameSound::listen() {
  SoundScene scene;
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || pending_; });
    if (stop_) return;
    std::optional<SoundFrame> frame = std::exchange(pending_, std::nullopt);
    lock.unlock();
    std::vector<MixCommand> heard = scene.advance(*frame);
    std::vector<std::string> lines = scene.take_captions();
    frame.reset();  // a world may end with it, which takes its time
    lock.lock();
    if (has_device_) commands_.insert(commands_.end(), heard.begin(), heard.end());
    captions_.insert(captions_.end(), lines.begin(), lines.end());
  }
}

bool GameSound::take_commands(std::vector<MixCommand>& out) {
  const std::lock_guard lock(mutex_);
  out = std::exchange(commands_, {});
  return !stop_;
}

void GameSound::mix() {
  auto opened = OpenAlOut::open();
  if (!opened) {
    const std::lock_guard lock(mutex_);
    has_device_ = false;
    commands_.clear();
    status_ = opened.error().message;
    return;
  }
  OpenAlOut& out = **opened;
  Mixer mixer(sound_bank());
  std::vector<MixCommand> commands;
  std::vector<float> mixed(2 * OpenAlOut::kBlock);
  std::vector<std::int16_t> block(mixed.size());
  int until_status = 0;
  while (take_commands(commands)) {
    for (const MixCommand& command : commands) apply(command, mixer);
    for (int room = out.room(); room > 0; --room) {
      mixer.render(mixed);
      for (std::size_t i = 0; i < mixed.size(); ++i)
        block[i] = static_cast<std::int16_t>(std::lround(mixed[i] * 32767.0f));
      out.play(block);
      if (until_status-- > 0) continue;
      until_status = kBlocksToStatus;
      const std::lock_guard lock(mutex_);
      status_ = fmt::format("sound: {} voices", mixer.voices());
    }
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace skerry::game
