#include "world/generate/design.h"

#include <cstdlib>

namespace skerry::world {
namespace {

using noise::kOne12;
using noise::kOne8;
using noise::smooth;

int radius8(const Shape& shape) {
  return shape.extent.radius * kOne8;
}

/// Maximum with a rounded crease of width k.
int smooth_max(int a, int b, int k) {
  const int h = std::max(k - std::abs(a - b), 0);
  return std::max(a, b) + static_cast<int>(static_cast<std::int64_t>(h) * h / (4 * k));
}

/// Distance into the outline at a place already bent by the shift, Q8.
int outline_at(const Shape& shape, int x, int z) {
  const int round = std::max(kOne8, radius8(shape) / 7);
  int inside = -radius8(shape);
  for (const Lobe& lobe : shape.lobes) {
    const int d = noise::length(x - lobe.x * kOne8, z - lobe.z * kOne8);
    inside = smooth_max(inside, lobe.radius * kOne8 - d, round);
  }
  for (const Lobe& bite : shape.bites) {
    inside = std::min(inside,
                      noise::length(x - bite.x * kOne8, z - bite.z * kOne8) - bite.radius * kOne8);
  }
  return inside;
}

/// Whether lava runs here: winding lines that leave the crater and end on the flanks.
bool in_stream(const Shape& shape, const SkinPlace& place) {
  return std::any_of(shape.streams.begin(), shape.streams.end(), [&](int direction) {
    const int bx = place.x * kOne8 + place.bend.x * 2;
    const int bz = place.z * kOne8 + place.bend.z * 2;
    const int along =
        (bx / 16 * noise::cosine(direction) + bz / 16 * noise::sine(direction)) / (kOne12 / 16);
    const int across =
        (bz / 16 * noise::cosine(direction) - bx / 16 * noise::sine(direction)) / (kOne12 / 16);
    const int end = radius8(shape) * 5 / 8;
    return along > 0 && along < end && std::abs(across) < 2 * kOne8 + (end - along) / 40;
  });
}

/// Bends what passes three quarters of a limit so that it approaches the limit and never reaches
/// it.
int soft_limit(int value, int limit) {
  const int knee = limit * 3 / 4;
  const int room = limit - knee;
  const int over = value - knee;
  return over <= 0 ? value : knee + over * room / (over + room);
}

/// How far up and down a column reaches before it, or a crown that leans out of it, would leave the
/// bounding sphere.
int room_at(const Shape& shape, int x, int z) {
  const int sphere = shape.extent.sphere;
  const int flat = noise::length(x, z) + kBoxMargin + 2;
  return flat < sphere ? static_cast<int>(noise::isqrt(
                             static_cast<std::uint64_t>(sphere * sphere - flat * flat)))
                       : 0;
}

std::int64_t square8(std::int64_t blocks) {
  return blocks * blocks * kOne8 * kOne8;
}

}  // namespace

Bend bend_at(const Shape& shape, int x, int z) {
  const int bend = shape.warp * kOne8;
  const int wavelength = std::clamp(shape.extent.radius * 3 / 4, 12, 160);
  return {(bend * noise::fractal2(shape.seed + 1, x, z, wavelength, 3) >> 12) +
              noise::gradient2(shape.seed + 5, x, z, 19) / 5,
          (bend * noise::fractal2(shape.seed + 101, x, z, wavelength, 3) >> 12) +
              noise::gradient2(shape.seed + 6, x, z, 19) / 5};
}

int inside_at(const Shape& shape, int x, int z, Bend bend) {
  const int bound = radius8(shape) - noise::length(x, z) - kOne8;
  return std::min(bound, outline_at(shape, x + bend.x, z + bend.z));
}

int elevation_at(const Shape& shape, int x, int z, int inside) {
  const int radius = shape.extent.radius;
  int height = noise::fractal2(shape.seed + 11, x, z, std::clamp(radius * 2 / 3, 20, 90), 3) *
               shape.roll / 16;
  const int inland =
      smooth(std::clamp(inside * 48 / radius, 0, kOne12));  // full at a third of the radius
  if (shape.crags > 0) {
    const int ridges = noise::ridge2(shape.seed + 23, x, z, std::clamp(radius / 2, 24, 80), 4);
    height += ((shape.crags * ridges) >> 12) * inland / 16;
  }
  for (const Peak& peak : shape.peaks) {
    const int d = noise::length(x - peak.x * kOne8, z - peak.z * kOne8);
    std::int64_t rise = kOne12 - static_cast<std::int64_t>(d) * kOne12 / (peak.radius * kOne8);
    if (rise <= 0) continue;
    if (peak.power == 2) rise = (rise * rise) >> 12;
    height += static_cast<int>((rise * peak.height * inland) >> 16);
  }
  const int shore_rise = smooth(std::clamp(inside * kOne12 / (10 * kOne8), 0, kOne12));
  return ((height >> 4) * shore_rise) >> 8;
}

int thickness_at(const Shape& shape, int x, int z, int inside) {
  if (inside <= 0) return kOne8;
  const int reach = std::max(kOne8, radius8(shape) * 9 / 20);
  const std::int64_t f =
      std::min<std::int64_t>(kOne12, static_cast<std::int64_t>(inside) * kOne12 / reach);
  const std::int64_t taper = (f * 1500 + ((f * f) >> 12) * 2596) >> 12;
  const int folds =
      noise::ridge2(shape.seed + 31, x, z, std::clamp(shape.extent.radius / 2, 14, 48), 3);
  const int wave =
      noise::gradient2(shape.seed + 37, x, z, std::clamp(shape.extent.radius, 16, 120));
  const std::int64_t depth = shape.extent.depth * 84 / 100 * kOne8;
  const std::int64_t body = depth * taper / kOne12;
  const int lip = 3 * kOne8 + (noise::gradient2(shape.seed + 41, x, z, 17) + kOne12) * 5 / 32;
  return lip + static_cast<int>(body * (2 * kOne12 + folds * 9 / 8 + wave / 2) / (3 * kOne12));
}

int patch_at(const Shape& shape, int x, int z) {
  return noise::fractal2(shape.seed + 51, x, z, 34, 2);
}

ButteRise::ButteRise(const Butte& butte)
    : butte_(&butte),
      ramp_x_(noise::cosine(butte.ramp)),
      ramp_z_(noise::sine(butte.ramp)),
      foot_(square8(butte.radius)),
      table_(square8(butte.radius -
                     std::max(butte.cliff, std::min(butte.ramp_width, butte.radius)))) {}

int ButteRise::at(int x, int z, Bend bend) const {
  const Butte& butte = *butte_;
  const std::int64_t bent_x = (x - butte.x) * kOne8 + bend.x;
  const std::int64_t bent_z = (z - butte.z) * kOne8 + bend.z;
  const std::int64_t squared = bent_x * bent_x + bent_z * bent_z;
  if (squared >= foot_) return 0;
  if (squared <= table_) return butte.height * kOne8;
  const int d = std::max(1, noise::length(bent_x, bent_z));
  const std::int64_t along = (static_cast<std::int64_t>(x - butte.x) * ramp_x_ +
                              static_cast<std::int64_t>(z - butte.z) * ramp_z_) *
                             kOne8;
  const int facing = static_cast<int>(along / d);  // cosine of the angle to the ramp, Q12
  const int share = smooth(std::clamp((facing - 3300) * 8, 0, kOne12));
  const int width =
      butte.cliff * kOne8 + (std::min(butte.ramp_width, butte.radius) - butte.cliff) * share / 16;
  const int risen = smooth((butte.radius * kOne8 - d) * 16 / std::max(1, width / kOne8));
  return butte.height * risen / 16;
}

int Spike::depth_at(int column_x, int column_z, int length) const {
  const int squared = (column_x - x) * (column_x - x) + (column_z - z) * (column_z - z);
  if (squared >= reach * reach) return 0;
  const int d = static_cast<int>(noise::isqrt(static_cast<std::uint64_t>(squared) * kOne8 * kOne8));
  const int t = kOne12 - d * 16 / reach;
  const int cone = (t + ((t * t) >> 12)) / 2;
  return (length * cone) >> 12;
}

std::array<SpikeGrid, 2> spike_grids(const Shape& shape) {
  const int radius = shape.extent.radius;
  return {{{std::clamp(radius * 2 / 5, 12, 60), 190, shape.seed + 71},
           {std::clamp(radius / 6, 8, 20), 110, shape.seed + 72}}};
}

Heights heights_at(const Shape& shape, int x, int z, const Ground& ground) {
  const int room = room_at(shape, x, z);
  const int lowest = -shape.extent.depth / 2;
  const int highest = std::max(std::min(shape.extent.top, room - kTreeRoom), lowest);
  const int top = std::clamp(ground.height >> 8, lowest, highest);
  const int keel = soft_limit(-ground.bottom, std::min(shape.extent.depth, room - kKeelRoom));
  return {top, std::min(-keel, top - 4)};
}

void dig_at(const Lake& lake, int x, int z, Bend bend, LakeColumn& column) {
  constexpr int kRim = 3;                    // blocks of level ground around the water
  constexpr int kBlend = kLakeReach - kRim;  // blocks until the old ground is reached
  const int level = lake.level * kOne8;
  // Half of the bend, and at most two blocks: the bank must not outrun its rim.
  const int most = 2 * kOne8 + lake.radius * 40;
  const int bx = std::clamp(bend.x / 2, -most, most), bz = std::clamp(bend.z / 2, -most, most);
  const int d =
      noise::length((x - lake.x) * kOne8 + bx, (z - lake.z) * kOne8 + bz) - lake.radius * kOne8;
  if (d < 0) {
    const int bowl = smooth(std::min(kOne12, -d * 24 / lake.radius));
    column.ground = std::min(column.ground, level - kOne8 - ((lake.depth * bowl) >> 4));
    column.wet = column.dug = true;
  } else if (d < (kRim + kBlend) * kOne8) {
    const int away = smooth(std::max(0, (d - kRim * kOne8) * 16 / kBlend));
    const int bank = level + kOne8 / 4 + d / 6;
    column.ground =
        bank + static_cast<int>((static_cast<std::int64_t>(column.ground - bank) * away) >> 12);
    if (column.ground < level && away < kOne12)
      column.ground = std::max(column.ground, level - d / 2);
    column.wet = false;
  }
  if (d < 5 * kOne8) column.shore = true;
}

SkinId skin_at(const Shape& shape, const SkinPlace& place) {
  const BiomeType& biome = biome_type(shape.biome);
  const int patch = place.patch, height = place.height;
  if (place.wet) return biome.lake_bed;
  if (in_stream(shape, place)) return SkinId::kLava;
  if (place.steep) return SkinId::kBare;
  if (place.shore && patch < 2600) return biome.beach;
  switch (shape.biome) {
    case Biome::kHighland: {
      const int snow_line = shape.extent.top * 5 / 16 + patch / 700;
      if (height > snow_line + 6) return SkinId::kSnow;
      if (height > snow_line) return SkinId::kSnowyGrass;
      return patch > 2900 ? SkinId::kMossy : SkinId::kGrass;
    }
    case Biome::kMesa:
      if (height > 8 && patch > -600) return SkinId::kDryGrass;
      return patch > 2100 ? SkinId::kDryGrass : SkinId::kRedSand;
    case Biome::kAutumn:
      return patch > 1500 ? SkinId::kDryGrass : SkinId::kGrass;
    case Biome::kTropical:
      return place.inside < 5 + patch / 1200 && height < 6 ? SkinId::kSand : SkinId::kGrass;
    case Biome::kMarsh:
      return patch > 1900 ? SkinId::kMud : SkinId::kGrass;
    case Biome::kVolcanic:
      if (height < shape.extent.top / 4 && patch > 300) return SkinId::kDryGrass;
      return patch < -2600 ? SkinId::kGravel : SkinId::kBasalt;
    case Biome::kMycelium:
      return patch > 2700 ? SkinId::kMossy : SkinId::kMycelium;
    default:
      return patch > 3300 ? SkinId::kDryGrass : SkinId::kGrass;
  }
}

}  // namespace skerry::world
