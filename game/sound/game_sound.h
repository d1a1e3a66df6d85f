// Sound while it is played: a thread that listens and one that mixes. Neither touches what the
// frame thread owns; frames go in and captions come out through queues.
#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "game/sound/sound_scene.h"

namespace skerry::game {

class GameSound {
 public:
  /// Opens the default device on a thread of its own. Without one all is as with one, but silent.
  GameSound();
  ~GameSound();
  GameSound(const GameSound&) = delete;
  GameSound& operator=(const GameSound&) = delete;

  /// What is heard from now on. Never waits; frames that come faster than they are heard are heard
  /// as one.
  void frame(SoundFrame frame);
  /// Lines for who cannot hear, since the last call.
  std::vector<std::string> take_captions();
  /// For the overlay: whether there is a device, how many voices play, or why there is no sound.
  std::string status() const;

 private:
  void listen();
  void mix();
  bool take_commands(std::vector<MixCommand>& out);

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  std::optional<SoundFrame> pending_;
  std::vector<MixCommand> commands_;
  std::vector<std::string> captions_;
  std::string status_ = "sound: opening the device";
  std::atomic<bool> has_device_ = true;  // until it is known
  std::thread listener_, mixer_;         // last: they use the above
};

}  // namespace skerry::game
