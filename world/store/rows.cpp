#include "world/store/rows.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "world/store/bytes.h"

namespace skerry::world {
namespace {

constexpr std::size_t kMaxNameBytes = 200, kMaxSeedBytes = 4096;
constexpr std::uint32_t kMaxIslandLimit = 100'000;
// Islands stay this near to the origin; the sum of two such coordinates is far from overflow.
constexpr std::int64_t kMaxUnits = 2 * kMaxBlock * kUnitsPerBlock;
constexpr double kMaxSpeed = 1000.0;  // blocks/s, rad/s

bool near_enough(const WorldPos& p) {
  const auto in = [](std::int64_t v) { return v >= -kMaxUnits && v <= kMaxUnits; };
  return in(p.x) && in(p.y) && in(p.z);
}

bool within(double v, double most) {
  return std::abs(v) <= most;  // false for NaN
}

bool within(const glm::dvec3& v, double most) {
  return within(v.x, most) && within(v.y, most) && within(v.z, most);
}

void put(ByteWriter& out, const WorldPos& p) {
  for (const std::int64_t axis : {p.x, p.y, p.z}) out.i64(axis);
}
void put(ByteWriter& out, const glm::dvec3& v) {
  for (const double axis : {v.x, v.y, v.z}) out.f64(axis);
}
WorldPos get_place(ByteReader& in) {
  WorldPos p;
  for (std::int64_t* axis : {&p.x, &p.y, &p.z}) *axis = in.i64();
  return p;
}
glm::dvec3 get_vector(ByteReader& in) {
  glm::dvec3 v;
  for (double* axis : {&v.x, &v.y, &v.z}) *axis = in.f64();
  return v;
}

std::uint64_t seal_of(std::string_view table, std::uint64_t key, std::span<const std::byte> bytes) {
  return checksum(bytes, checksum(std::as_bytes(std::span(table)), key));
}

}  // namespace

std::vector<std::byte> sealed(std::string_view table, std::uint64_t key,
                              std::span<const std::byte> bytes) {
  ByteWriter seal;
  seal.u64(seal_of(table, key, bytes));
  std::vector<std::byte> out = seal.take();
  out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

std::optional<std::span<const std::byte>> unsealed(std::string_view table, std::uint64_t key,
                                                   std::span<const std::byte> blob) {
  if (blob.size() < sizeof(std::uint64_t)) return std::nullopt;
  ByteReader seal(blob.first(sizeof(std::uint64_t)));
  const std::span<const std::byte> bytes = blob.subspan(sizeof(std::uint64_t));
  if (seal.u64() != seal_of(table, key, bytes)) return std::nullopt;
  return bytes;
}

bool is_vital(std::string_view name) {
  return name == "info" || name == "generator";
}

bool fits_file(const WorldInfo& info) {
  return info.name.size() <= kMaxNameBytes && info.seed_text.size() <= kMaxSeedBytes;
}

std::vector<std::byte> encode_info(const WorldInfo& info) {
  SKERRY_ASSERT(fits_file(info));
  ByteWriter out;
  out.text(info.name);
  out.text(info.seed_text);
  out.u64(info.desc.seed);
  for (const std::int64_t axis : info.desc.offset_blocks) out.i64(axis);
  out.u8(info.desc.island_limit.has_value());
  out.u32(info.desc.island_limit.value_or(0));
  out.u8(info.desc.generated);
  return out.take();
}

std::optional<WorldInfo> decode_info(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  WorldInfo info;
  info.name = in.text(kMaxNameBytes);
  info.seed_text = in.text(kMaxSeedBytes);
  info.desc.seed = in.u64();
  for (std::int64_t& axis : info.desc.offset_blocks) {
    axis = in.i64();
    if (axis < -kMaxBlock || axis > kMaxBlock) return std::nullopt;
  }
  const bool limited = in.u8() != 0;
  const std::uint32_t limit = in.u32();
  if (limit > kMaxIslandLimit) return std::nullopt;
  if (limited) info.desc.island_limit = limit;
  info.desc.generated = in.u8() != 0;
  if (!in.done()) return std::nullopt;
  return info;
}

std::vector<std::byte> encode_spec(const IslandSpec& spec) {
  ByteWriter out;
  put(out, spec.origin);
  out.u64(spec.seed);
  out.u32(spec.archetype);
  out.u32(spec.biome);
  out.f64(spec.yaw_rad);
  out.f64(spec.spin_rad_per_s);
  put(out, spec.drift_amplitude);
  out.f64(spec.drift_period_s);
  out.f64(spec.drift_phase_rad);
  return out.take();
}

std::optional<IslandSpec> decode_spec(std::uint64_t id, std::span<const std::byte> bytes) {
  constexpr double kMaxAngle = 1e6, kMinPeriod = 1e-3, kMaxPeriod = 1e9;
  ByteReader in(bytes);
  IslandSpec spec;
  spec.id = id;
  spec.origin = get_place(in);
  spec.seed = in.u64();
  spec.archetype = in.u32();
  spec.biome = in.u32();
  spec.yaw_rad = in.f64();
  spec.spin_rad_per_s = in.f64();
  spec.drift_amplitude = get_vector(in);
  spec.drift_period_s = in.f64();
  spec.drift_phase_rad = in.f64();
  const bool sound = in.done() && near_enough(spec.origin) && within(spec.yaw_rad, kMaxAngle) &&
                     within(spec.spin_rad_per_s, kMaxSpeed) &&
                     within(spec.drift_amplitude, kMaxIslandDriftBlocks) &&
                     spec.drift_period_s >= kMinPeriod && spec.drift_period_s <= kMaxPeriod &&
                     within(spec.drift_phase_rad, kMaxAngle);
  return sound ? std::optional(spec) : std::nullopt;
}

std::vector<std::byte> encode_spare(const IslandRow& row) {
  std::vector<std::byte> bytes = encode_spec(row.spec);
  bytes.push_back(static_cast<std::byte>(row.added));
  return bytes;
}

std::optional<IslandRow> decode_spare(std::uint64_t id, std::span<const std::byte> bytes) {
  if (bytes.empty()) return std::nullopt;
  const std::optional<IslandSpec> spec = decode_spec(id, bytes.first(bytes.size() - 1));
  if (!spec) return std::nullopt;
  return IslandRow{*spec, bytes.back() != std::byte{0}, {}};
}

std::vector<std::byte> encode_motion(const MotionState& motion) {
  ByteWriter out;
  out.i64(motion.tick);
  put(out, motion.pose.origin);
  for (const double part : {motion.pose.rotation.w, motion.pose.rotation.x, motion.pose.rotation.y,
                            motion.pose.rotation.z})
    out.f64(part);
  put(out, motion.velocity);
  out.f64(motion.spin);
  out.u8(motion.of_origin);
  return out.take();
}

std::optional<MotionState> decode_motion(std::span<const std::byte> bytes) {
  // As far as a world's time goes, 1e9 s.
  constexpr std::int64_t kMaxTick = std::int64_t{1'000'000'000} * kMotionTicksPerSecond;
  constexpr double kUnitError = 1e-9;
  constexpr std::size_t kWithoutOrigin = 96;  // as files have it that version 2 wrote
  ByteReader in(bytes);
  MotionState motion;
  motion.tick = in.i64();
  motion.pose.origin = get_place(in);
  glm::dquat& q = motion.pose.rotation;
  for (double* part : {&q.w, &q.x, &q.y, &q.z}) *part = in.f64();
  motion.velocity = get_vector(in);
  motion.spin = in.f64();
  if (bytes.size() != kWithoutOrigin) motion.of_origin = in.u8() != 0;
  const bool upright = q.x == 0.0 && q.z == 0.0 && within(q.w * q.w + q.y * q.y - 1.0, kUnitError);
  const bool sound = in.done() && motion.tick >= -kMaxTick && motion.tick <= kMaxTick &&
                     near_enough(motion.pose.origin) && upright &&
                     within(motion.velocity, kMaxSpeed) && within(motion.spin, kMaxSpeed);
  return sound ? std::optional(motion) : std::nullopt;
}

}  // namespace skerry::world
