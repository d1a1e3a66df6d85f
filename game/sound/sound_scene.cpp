#include "game/sound/sound_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "game/words/words.h"

namespace skerry::game {
namespace {

namespace block = world::block;

constexpr double kSourceReach = 24.0;     // blocks, of what goes on
constexpr std::size_t kMostSources = 24;  // nearest first
constexpr int kBin = 8;                   // blocks; water and lava are one source a bin
constexpr float kHeard = 0.002f;          // amplitude from which a voice plays
constexpr float kCaptionHeard = 0.03f;    // and from which a caption says so
constexpr double kCaptionPause = 10.0;    // seconds between two captions of a sound
constexpr double kHighAbove = 30.0;       // blocks above ground in which the wind grows
constexpr VoiceId kWindVoice = 1, kContactVoices = 16, kSourceVoices = 1u << 16;

constexpr std::array<const char*, kSounds> kCaptions{"",
                                                     "",
                                                     "",
                                                     word("splash"),
                                                     "",
                                                     word("strong wind"),
                                                     word("torch crackling"),
                                                     word("lava bubbling"),
                                                     word("water lapping"),
                                                     word("islands grinding")};

SoundGroup group_of(Sound sound) {
  if (sound == Sound::kClick) return SoundGroup::kInterface;
  return sound_kind(sound).loops && sound != Sound::kGrind ? SoundGroup::kAmbience
                                                           : SoundGroup::kEffects;
}

VoiceId voice_of(Sound sound, world::IVec3 lattice) {
  std::uint64_t hash = static_cast<std::uint64_t>(sound);
  for (const int v : {lattice.x, lattice.y, lattice.z})
    hash = (hash ^ static_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15u;
  return (hash ^ (hash >> 29)) | kSourceVoices;
}

/// Yaw 0 looks along +z, 90 along +x; to the right of +z is -x (docs/conventions.md).
glm::dvec3 forward_of(double yaw_deg) {
  const double yaw = yaw_deg * std::numbers::pi / 180.0;
  return {std::sin(yaw), 0.0, std::cos(yaw)};
}
glm::dvec3 right_of(double yaw_deg) {
  const double yaw = yaw_deg * std::numbers::pi / 180.0;
  return {-std::cos(yaw), 0.0, std::sin(yaw)};
}

const char* side_of(const glm::dvec3& arrival, double yaw_deg) {
  if (arrival == glm::dvec3(0.0)) return "";
  if (std::abs(arrival.y) > 0.8) return tr(arrival.y > 0.0 ? word("above") : word("below"));
  const double right = glm::dot(arrival, right_of(yaw_deg));
  const double ahead = glm::dot(arrival, forward_of(yaw_deg));
  if (std::abs(right) > std::abs(ahead))
    return tr(right > 0.0 ? word("to the right") : word("to the left"));
  return tr(ahead > 0.0 ? word("ahead") : word("behind"));
}

}  // namespace

void apply(const MixCommand& command, Mixer& mixer) {
  if (const auto* start = std::get_if<VoiceStart>(&command)) mixer.start(*start);
  if (const auto* aim = std::get_if<AimVoice>(&command)) mixer.aim(aim->id, aim->aim);
  if (const auto* stop = std::get_if<StopVoice>(&command)) mixer.stop(stop->id);
  if (const auto* reverb = std::get_if<ReverbAim>(&command)) mixer.set_reverb(*reverb);
  if (const auto* set = std::get_if<SetVolumes>(&command))
    for (std::size_t i = 0; i < kSoundGroups; ++i)
      mixer.set_volume(static_cast<SoundGroup>(i), set->volumes[i]);
}

std::vector<MixCommand> SoundScene::advance(const SoundFrame& frame) {
  std::vector<MixCommand> out;
  clock_s_ += frame.seconds;
  if (!volumes_ || volumes_->volumes != frame.volumes) {
    volumes_ = SetVolumes{frame.volumes};
    out.push_back(*volumes_);
  }
  if (frame.world.get() != world_) keeper_.forget();
  world_ = frame.world.get();
  if (!frame.world || frame.paused) {
    silence(out);
    for (const SoundEvent& event : frame.events)
      if (event.sound == Sound::kClick) hear_event(frame, event, out);
    if (!frame.world) return out;
  }
  for (const VoxelChange& change : frame.changes) keeper_.change(change);
  if (frame.paused) return out;
  keeper_.follow(*frame.world, frame.listener, frame.seconds);
  ear_ = keeper_.room_place(frame.listener.eye);
  paths_.listen_at(ear_);
  hear_echo(out);
  hear_wind(frame, out);
  hear_sources(frame, out);
  hear_contacts(frame, out);
  for (const SoundEvent& event : frame.events) hear_event(frame, event, out);
  return out;
}

void SoundScene::silence(std::vector<MixCommand>& out) {
  for (const auto& [id, sound] : playing_) out.push_back(StopVoice{id});
  playing_.clear();
}

/// Of blocks that are heard where they meet air: torches one by one, water and lava by the nearest
/// of a bin.
void SoundScene::find_source(world::IVec3 cell, std::map<VoiceId, Source>& found) const {
  const SoundRoom& room = keeper_.room();
  const world::BlockId id = room.block(cell);
  if (id != block::kTorch && id != block::kLava && id != block::kWater) return;
  world::IVec3 key = keeper_.lattice(cell);
  Source source{0, Sound::kTorch, SoundRoom::middle_of(cell), 0.25f};
  if (id != block::kTorch) {
    const world::IVec3 above{cell.x, cell.y + 1, cell.z};
    if (room.medium(above) != SoundMedium::kAir) return;
    source.at = SoundRoom::middle_of(above);
    source.sound = id == block::kLava ? Sound::kLava : Sound::kWater;
    source.gain = 0.6f;
    const auto beside = [&](int x, int z) { return room.block({cell.x + x, cell.y, cell.z + z}); };
    // Still water is silent but for its shores and where it falls.
    if (id == block::kWater && beside(1, 0) == id && beside(-1, 0) == id && beside(0, 1) == id &&
        beside(0, -1) == id)
      return;
    for (std::int32_t* v : {&key.x, &key.y, &key.z})
      *v = static_cast<std::int32_t>(world::floor_div(*v, kBin));
  }
  const double distance = glm::length(source.at - ear_);
  if (distance > kSourceReach) return;
  source.id = voice_of(source.sound, key);
  const auto [place, fresh] = found.emplace(source.id, source);
  if (!fresh && distance < glm::length(place->second.at - ear_)) place->second = source;
}

void SoundScene::find_sources() {
  std::map<VoiceId, Source> found;
  const world::IVec3 ear = SoundRoom::cell_of(ear_);
  const auto reach = static_cast<int>(kSourceReach);
  for (int y = ear.y - reach; y <= ear.y + reach; ++y)
    for (int x = ear.x - reach; x <= ear.x + reach; ++x)
      for (int z = ear.z - reach; z <= ear.z + reach; ++z) find_source({x, y, z}, found);
  sources_.clear();
  for (const auto& [id, source] : found) sources_.push_back(source);
  std::stable_sort(sources_.begin(), sources_.end(), [this](const Source& a, const Source& b) {
    return glm::length(a.at - ear_) < glm::length(b.at - ear_);
  });
  if (sources_.size() > kMostSources) sources_.resize(kMostSources);
}

VoiceAim SoundScene::aim_of(const SoundPath& path, float gain, double yaw_deg) const {
  const glm::dvec3 arrival = keeper_.world_direction(path.arrival);
  VoiceAim aim;
  aim.gain = gain * static_cast<float>(path.gain());
  // What is at the ear has no side; from two blocks on it has.
  const double side = std::min(1.0, 0.5 * path.length) * 0.9;
  aim.pan = static_cast<float>(side * glm::dot(arrival, right_of(yaw_deg)));
  double cutoff_hz = path.cutoff_hz;
  if (glm::dot(arrival, forward_of(yaw_deg)) < -0.3) cutoff_hz = std::min(cutoff_hz, 9000.0);
  aim.cutoff_hz = static_cast<float>(cutoff_hz);
  // The echo of a source falls less with distance than its own sound, but no wall lets more pass.
  const double echo = std::pow(10.0, -path.loss_db / 20.0) / std::sqrt(std::max(1.0, path.length));
  aim.reverb = gain * static_cast<float>(echo);
  return aim;
}

void SoundScene::caption(Sound sound, const VoiceAim& aim, const SoundPath& path, double yaw_deg) {
  const auto index = static_cast<std::size_t>(sound);
  if (*kCaptions[index] == '\0' || aim.gain < kCaptionHeard) return;
  if (captioned_s_[index] > 0.0 && clock_s_ - captioned_s_[index] < kCaptionPause) return;
  captioned_s_[index] = std::max(clock_s_, 1e-3);
  const char* side = side_of(keeper_.world_direction(path.arrival), yaw_deg);
  captions_.push_back(*side == '\0' ? fmt::format("[{}]", tr(kCaptions[index]))
                                    : fmt::format("[{} {}]", tr(kCaptions[index]), side));
}

void SoundScene::keep_voice(const Source& source, const VoiceAim& aim,
                            std::vector<MixCommand>& out) {
  const bool plays = playing_.contains(source.id);
  const bool heard = std::max(aim.gain, aim.reverb * static_cast<float>(echo_.level)) >= kHeard;
  if (!heard) {
    if (!plays) return;
    out.push_back(StopVoice{source.id});
    playing_.erase(source.id);
  } else if (plays) {
    out.push_back(AimVoice{source.id, aim});
  } else {
    // Two of a kind are a little off each other's pitch, or they would beat.
    const float speed = 0.94f + 0.12f * static_cast<float>(source.id % 97) / 96.0f;
    out.push_back(
        VoiceStart{source.id, clip_index(source.sound), true, speed, group_of(source.sound), aim});
    playing_[source.id] = source.sound;
  }
}

void SoundScene::hear_sources(const SoundFrame& frame, std::vector<MixCommand>& out) {
  const world::IVec3 cell = SoundRoom::cell_of(ear_);
  if (sources_revision_ != keeper_.room().revision() || cell != echo_cell_) find_sources();
  sources_revision_ = keeper_.room().revision();
  echo_cell_ = cell;
  std::map<VoiceId, Sound> gone = playing_;
  for (const Source& source : sources_) {
    gone.erase(source.id);
    const SoundPath path = paths_.path_from(source.at);
    const VoiceAim aim = aim_of(path, source.gain, frame.yaw_deg);
    if (!playing_.contains(source.id)) caption(source.sound, aim, path, frame.yaw_deg);
    keep_voice(source, aim, out);
  }
  for (const auto& [id, sound] : gone) {
    if (id < kSourceVoices) continue;
    out.push_back(StopVoice{id});
    playing_.erase(id);
  }
}

void SoundScene::hear_contacts(const SoundFrame& frame, std::vector<MixCommand>& out) {
  constexpr std::size_t kMost = 4;
  const std::vector<IslandContact>& contacts = keeper_.contacts();
  for (std::size_t i = 0; i < kMost; ++i) {
    Source source{kContactVoices + i, Sound::kGrind};
    VoiceAim aim{0.0f};
    if (i < contacts.size()) {
      const IslandContact& contact = contacts[i];
      // From a creep on; loudest at walking pace. Rock is heard far.
      const double moving = std::min(1.0, std::sqrt(contact.speed / 4.0));
      const double loud = std::max(contact.speed > 0.02 ? moving : 0.0, frame.strains ? 0.35 : 0.0);
      // It sounds through the ground that the listener stands on, too: nothing is in its way.
      SoundPath path;
      path.length = glm::length(contact.at - ear_);
      if (path.length > 0.0) path.arrival = (contact.at - ear_) / path.length;
      aim = aim_of(path, static_cast<float>(5.0 * loud), frame.yaw_deg);
      aim.gain = std::min(aim.gain, 1.0f);
      if (!playing_.contains(source.id)) caption(source.sound, aim, path, frame.yaw_deg);
    }
    keep_voice(source, aim, out);
  }
}

void SoundScene::hear_wind(const SoundFrame& frame, std::vector<MixCommand>& out) {
  const SoundRoom& room = keeper_.room();
  const bool wet = room.medium(SoundRoom::cell_of(ear_)) == SoundMedium::kWater;
  const RayHit ground = first_hit(room, ear_, {0.0, -1.0, 0.0}, kHighAbove);
  const double height = wet ? 0.0 : ground.distance / kHighAbove;
  const double rush = std::min(1.0, std::pow(frame.air_speed / 40.0, 1.5));
  const double open = std::sqrt(echo_.open);
  VoiceAim aim;
  aim.gain = static_cast<float>((wet ? 0.1 : 1.0) * open * (0.10 + 0.20 * height + 0.7 * rush));
  aim.cutoff_hz = wet ? 300.0f : static_cast<float>(700.0 + 1500.0 * height + 6000.0 * rush);
  if (aim.gain > 0.45f) caption(Sound::kWind, aim, {}, frame.yaw_deg);
  keep_voice({kWindVoice, Sound::kWind}, aim, out);
}

void SoundScene::hear_event(const SoundFrame& frame, const SoundEvent& event,
                            std::vector<MixCommand>& out) {
  SoundPath path;
  if (event.at) path = paths_.path_from(keeper_.room_place(*event.at));
  VoiceAim aim = aim_of(path, event.gain, frame.yaw_deg);
  if (group_of(event.sound) == SoundGroup::kInterface) aim.reverb = 0.0f;
  const SoundMedium around = keeper_.room().medium(SoundRoom::cell_of(ear_));
  if (frame.world && around == SoundMedium::kWater)
    aim.cutoff_hz = std::min(aim.cutoff_hz, static_cast<float>(kWaterCutoffHz));
  caption(event.sound, aim, path, frame.yaw_deg);
  if (aim.gain < kHeard) return;
  const std::size_t clip = clip_index(event.sound, event.material, throws_++);
  out.push_back(VoiceStart{0, clip, false, event.speed, group_of(event.sound), aim});
}

void SoundScene::hear_echo(std::vector<MixCommand>& out) {
  const world::IVec3 cell = SoundRoom::cell_of(ear_);
  if (echo_revision_ == keeper_.room().revision() && cell == echo_cell_) return;
  echo_revision_ = keeper_.room().revision();
  echo_ = room_echo(keeper_.room(), ear_);
  const bool wet = keeper_.room().medium(cell) == SoundMedium::kWater;
  out.push_back(ReverbAim{static_cast<float>(echo_.decay_s), static_cast<float>(echo_.level),
                          wet ? 800.0f : 5000.0f});
}

}  // namespace skerry::game
