#include "game/session/saved_play.h"

#include <cmath>

#include "game/player/player.h"
#include "world/store/bytes.h"

namespace skerry::game {
namespace {

constexpr std::string_view kName = "play";
constexpr std::string_view kPlayers = "players";  // all who have a name
constexpr std::string_view kHabits = "habits";    // not read where only a place is wanted
constexpr double kMaxTime = 1e9;                  // as the setting world.time has it
constexpr std::int64_t kMaxLattice = std::int64_t{1} << 52;  // 2^20 blocks of 2^32 units
constexpr double kMaxYaw = 3600.0;

bool within(double v, double most) {
  return std::abs(v) <= most;  // false for NaN
}
bool within(const glm::dvec3& v, double most) {
  return within(v.x, most) && within(v.y, most) && within(v.z, most);
}
bool within(const world::WorldPos& p) {
  constexpr std::int64_t kMost = world::kMaxBlock * world::kUnitsPerBlock;
  const auto in = [](std::int64_t v) { return v >= -kMost && v <= kMost; };
  return in(p.x) && in(p.y) && in(p.z);
}

void put(world::ByteWriter& out, const world::WorldPos& p) {
  for (const std::int64_t axis : {p.x, p.y, p.z}) out.i64(axis);
}
void put(world::ByteWriter& out, const glm::dvec3& v) {
  for (const double axis : {v.x, v.y, v.z}) out.f64(axis);
}
void get(world::ByteReader& in, world::WorldPos& p) {
  for (std::int64_t* axis : {&p.x, &p.y, &p.z}) *axis = in.i64();
}
void get(world::ByteReader& in, glm::dvec3& v) {
  for (double* axis : {&v.x, &v.y, &v.z}) *axis = in.f64();
}

bool in_lattice(const LatticePos& p) {
  const auto in = [](std::int64_t v) { return v >= -kMaxLattice && v <= kMaxLattice; };
  return in(p.x) && in(p.y) && in(p.z);
}

bool sound(const SavedPlay& play) {
  const PlayerState& p = play.player;
  return within(p.feet) && in_lattice(p.lattice) && within(p.velocity, kMaxFlySpeed * 8) &&
         within(p.yaw_deg, kMaxYaw) && within(p.pitch_deg, 90.0) && p.fly_speed >= kMinFlySpeed &&
         p.fly_speed <= kMaxFlySpeed && p.mode <= static_cast<std::uint8_t>(MoveMode::kNoclip) &&
         within(play.eye.position) && within(play.eye.yaw_deg, kMaxYaw) &&
         within(play.eye.pitch_deg, 90.0) && play.time_of_day_s >= 0.0 &&
         play.time_of_day_s < 86400.0 && within(play.world_time_s, kMaxTime);
}

std::vector<std::byte> encode_habits(const SavedPlay& play) {
  world::ByteWriter out;
  for (const world::BlockId block : play.hotbar.blocks) out.u32(block);
  out.u8(static_cast<std::uint8_t>(play.hotbar.selected));
  out.u8(play.day_stands);
  const Footing safe = play.player.safe.value_or(Footing{});
  out.u8(play.player.safe.has_value());
  out.u64(safe.island);
  for (int axis = 0; axis < 3; ++axis) out.i64(safe.lattice[axis]);
  return out.take();
}

/// False, and nothing changed: damaged.
bool decode_habits(world::ByteReader& in, SavedPlay& play) {
  bool good = true;
  Hotbar hotbar;
  for (world::BlockId& block : hotbar.blocks) {
    const std::uint32_t id = in.u32();
    good &= id < world::block::kBuiltInCount;
    block = static_cast<world::BlockId>(id);
  }
  hotbar.selected = in.u8();
  good &= hotbar.selected < kHotbarSlots;
  const bool day_stands = in.u8() != 0;
  const bool stood = in.u8() != 0;
  Footing safe;
  safe.island = in.u64();
  for (int axis = 0; axis < 3; ++axis) safe.lattice[axis] = in.i64();
  if (in.cut_short() || !good || !in_lattice(safe.lattice)) return false;
  play.hotbar = hotbar;
  play.day_stands = day_stands;
  if (stood) play.player.safe = safe;
  return true;
}

std::vector<std::byte> encode_place(const SavedPlay& play) {
  world::ByteWriter out;
  put(out, play.player.feet);
  out.u8(play.player.island.has_value());
  out.u64(play.player.island.value_or(0));
  for (int axis = 0; axis < 3; ++axis) out.i64(play.player.lattice[axis]);
  put(out, play.player.velocity);
  out.f64(play.player.yaw_deg);
  out.f64(play.player.pitch_deg);
  out.u8(play.player.mode);
  out.f64(play.player.fly_speed);
  put(out, play.eye.position);
  out.f64(play.eye.yaw_deg);
  out.f64(play.eye.pitch_deg);
  out.f64(play.time_of_day_s);
  out.f64(play.world_time_s);
  return out.take();
}

/// None: damaged.
std::optional<SavedPlay> decode_place(world::ByteReader& in) {
  SavedPlay play;
  get(in, play.player.feet);
  const bool on_island = in.u8() != 0;
  const std::uint64_t island = in.u64();
  if (on_island) play.player.island = island;
  for (int axis = 0; axis < 3; ++axis) play.player.lattice[axis] = in.i64();
  get(in, play.player.velocity);
  play.player.yaw_deg = in.f64();
  play.player.pitch_deg = in.f64();
  play.player.mode = in.u8();
  play.player.fly_speed = in.f64();
  get(in, play.eye.position);
  play.eye.yaw_deg = in.f64();
  play.eye.pitch_deg = in.f64();
  play.time_of_day_s = in.f64();
  play.world_time_s = in.f64();
  if (in.cut_short() || !sound(play)) return std::nullopt;
  return play;
}

/// Leaves the defaults where a file has none, or damaged ones.
void read_habits(world::WorldFile& file, SavedPlay& play) {
  const auto bytes = file.value(kHabits);
  if (!bytes) return;
  world::ByteReader in(*bytes);
  SavedPlay read = play;
  if (decode_habits(in, read) && in.done()) {
    play = read;
  } else {
    file.note_damage("the saved world says nonsense about the player's hands: they hold the usual");
  }
}

/// Those before the first that is damaged; false: one was.
bool decode_players(std::span<const std::byte> bytes, std::map<std::string, SavedPlay>& plays) {
  world::ByteReader in(bytes);
  const std::uint32_t count = in.u32();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string name = in.text(kMaxPlayerBytes);
    std::optional<SavedPlay> play = decode_place(in);
    if (!play || !decode_habits(in, *play) || name.empty()) return false;
    plays.insert_or_assign(name, *play);
  }
  return in.done();
}

}  // namespace

void put_plays(world::WorldFile::Transaction& transaction,
               const std::map<std::string, SavedPlay>& plays) {
  world::ByteWriter named;
  named.u32(static_cast<std::uint32_t>(plays.size() - plays.count("")));
  for (const auto& [player, play] : plays) {
    if (player.empty()) {
      transaction.put_value(kName, encode_place(play));
      transaction.put_value(kHabits, encode_habits(play));
      continue;
    }
    named.text(player);
    named.raw(encode_place(play));
    named.raw(encode_habits(play));
  }
  if (plays.size() > plays.count("")) transaction.put_value(kPlayers, named.bytes());
}

std::optional<SavedPlay> saved_play(world::WorldFile& file) {
  const auto bytes = file.value(kName);
  if (!bytes) return std::nullopt;
  world::ByteReader in(*bytes);
  std::optional<SavedPlay> play = decode_place(in);
  if (play && in.done()) {
    read_habits(file, *play);
    return play;
  }
  file.note_damage("the saved world says nonsense about the player: back to its spawn");
  return std::nullopt;
}

std::map<std::string, SavedPlay> saved_plays(world::WorldFile& file) {
  std::map<std::string, SavedPlay> plays;
  if (const std::optional<SavedPlay> alone = saved_play(file)) plays.emplace("", *alone);
  const auto bytes = file.value(kPlayers);
  if (bytes && !decode_players(*bytes, plays))
    file.note_damage(
        "the saved world says nonsense about some players: they are back at its spawn");
  return plays;
}

}  // namespace skerry::game
