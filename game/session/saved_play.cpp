#include "game/session/saved_play.h"

#include <cmath>

#include "game/player/player.h"
#include "world/store/bytes.h"

namespace skerry::game {
namespace {

constexpr std::string_view kName = "play";
constexpr std::string_view kHabits = "habits";  // what whoever only wants a place may leave unread
constexpr double kMaxTime = 1e9;                // as the setting world.time has it
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

void put_habits(world::WorldFile::Transaction& transaction, const SavedPlay& play) {
  world::ByteWriter out;
  for (const world::BlockId block : play.hotbar.blocks) out.u32(block);
  out.u8(static_cast<std::uint8_t>(play.hotbar.selected));
  out.u8(play.day_stands);
  const Footing safe = play.player.safe.value_or(Footing{});
  out.u8(play.player.safe.has_value());
  out.u64(safe.island);
  for (int axis = 0; axis < 3; ++axis) out.i64(safe.lattice[axis]);
  transaction.put_value(kHabits, out.bytes());
}

/// Leaves the usual ones where a file has none, or nonsense.
void get_habits(world::WorldFile& file, SavedPlay& play) {
  const auto bytes = file.value(kHabits);
  if (!bytes) return;
  world::ByteReader in(*bytes);
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
  if (!in.done() || !good || !in_lattice(safe.lattice)) {
    file.note_damage("the saved world says nonsense about the player's hands: they hold the usual");
    return;
  }
  play.hotbar = hotbar;
  play.day_stands = day_stands;
  if (stood) play.player.safe = safe;
}

}  // namespace

void put_play(world::WorldFile::Transaction& transaction, const SavedPlay& play) {
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
  transaction.put_value(kName, out.bytes());
  put_habits(transaction, play);
}

std::optional<SavedPlay> saved_play(world::WorldFile& file) {
  const auto bytes = file.value(kName);
  if (!bytes) return std::nullopt;
  world::ByteReader in(*bytes);
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
  if (in.done() && sound(play)) {
    get_habits(file, play);
    return play;
  }
  file.note_damage("the saved world says nonsense about the player: back to its spawn");
  return std::nullopt;
}

}  // namespace skerry::game
