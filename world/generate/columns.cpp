#include "world/generate/columns.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "world/generate/noise.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

using noise::kOne12;
using noise::kOne8;
using noise::smooth;

constexpr int kStep = 4;  // smooth fields are computed every kStep columns and interpolated

/// A field on the coarse lattice, Q8 unless said otherwise.
struct Coarse {
  int half, edge;
  std::vector<std::int32_t> values;

  explicit Coarse(int half_columns)
      : half(half_columns),
        edge(2 * half_columns / kStep + 2),
        values(static_cast<std::size_t>(edge) * edge) {}
  std::int32_t& node(int i, int j) {
    return values[static_cast<std::size_t>(i) * edge + static_cast<std::size_t>(j)];
  }
  /// Bilinear, at a column.
  std::int32_t at(int x, int z) const {
    const int i = x + half;
    const int j = z + half;
    const std::int32_t* p =
        &values[static_cast<std::size_t>(i / kStep) * edge + static_cast<std::size_t>(j / kStep)];
    const int u = i % kStep;
    const int v = j % kStep;
    const std::int32_t near = p[0] * (kStep - v) + p[1] * v;
    const std::int32_t far = p[edge] * (kStep - v) + p[edge + 1] * v;
    return (near * (kStep - u) + far * u) / (kStep * kStep);
  }
};

struct Builder {
  Shape& shape;
  Columns& columns;
  Coarse outline, elevation, thickness, shift_x, shift_z, patches;
  std::vector<std::int32_t> ground;  // Q8, one a column
  std::vector<std::uint8_t> shore;   // 1: beach

  Builder(Shape& s, Columns& c)
      : shape(s),
        columns(c),
        outline(c.half),
        elevation(c.half),
        thickness(c.half),
        shift_x(c.half),
        shift_z(c.half),
        patches(c.half),
        ground(c.top.size()),
        shore(c.top.size()) {}

  int radius8() const { return shape.extent.radius * kOne8; }
  void coarse_fields();
  int outline_at(int x, int z) const;
  int elevation_at(int x, int z, int inside) const;
  int thickness_at(int x, int z, int inside) const;
  void base_ground();
  void spikes(int spacing, int of_256, std::uint32_t seed);
  void raise(const Butte& butte);
  bool settle(Lake& lake) const;
  void dig(const Lake& lake);
  int room_at(int x, int z) const;
  void finish_heights();
  void contain_water();
  void raggedness();
  void reaches();
  void roofs();
  void cover();
  bool in_stream(int x, int z) const;
  bool steep_at(std::size_t i) const;
  SkinId skin_of(int x, int z, std::size_t i) const;

  template <class F>
  void for_columns_near(int cx, int cz, int reach, F&& f) {
    for (int x = std::max(cx - reach, -columns.half); x < std::min(cx + reach + 1, columns.half);
         ++x) {
      for (int z = std::max(cz - reach, -columns.half); z < std::min(cz + reach + 1, columns.half);
           ++z)
        f(x, z, columns.index(x, z));
    }
  }
};

/// Maximum with a rounded crease of width k.
int smooth_max(int a, int b, int k) {
  const int h = std::max(k - std::abs(a - b), 0);
  return std::max(a, b) + static_cast<int>(static_cast<std::int64_t>(h) * h / (4 * k));
}

/// Bends what passes three quarters of a limit so that it approaches the limit and never reaches
/// it.
int soft_limit(int value, int limit) {
  const int knee = limit * 3 / 4;
  const int room = limit - knee;
  const int over = value - knee;
  return over <= 0 ? value : knee + over * room / (over + room);
}

/// Distance into the outline at a place already bent by the shift, Q8.
int Builder::outline_at(int x, int z) const {
  const int round = std::max(kOne8, radius8() / 7);
  int inside = -radius8();
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

/// Hills, crags and peaks above the rim, Q8.
int Builder::elevation_at(int x, int z, int inside) const {
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

/// How deep the rock hangs under the base plane: a tapering keel with folds, Q8.
int Builder::thickness_at(int x, int z, int inside) const {
  if (inside <= 0) return kOne8;
  const int reach = std::max(kOne8, radius8() * 9 / 20);
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

void Builder::coarse_fields() {
  const int radius = shape.extent.radius;
  const int bend = shape.warp * kOne8;
  for (int i = 0; i < outline.edge; ++i) {
    for (int j = 0; j < outline.edge; ++j) {
      const int x = (i * kStep - columns.half) * kOne8;
      const int z = (j * kStep - columns.half) * kOne8;
      const int wavelength = std::clamp(radius * 3 / 4, 12, 160);
      const int sx = (bend * noise::fractal2(shape.seed + 1, x, z, wavelength, 3) >> 12) +
                     noise::gradient2(shape.seed + 5, x, z, 19) / 5;
      const int sz = (bend * noise::fractal2(shape.seed + 101, x, z, wavelength, 3) >> 12) +
                     noise::gradient2(shape.seed + 6, x, z, 19) / 5;
      const int bound = radius8() - noise::length(x, z) - kOne8;
      const int inside = std::min(bound, outline_at(x + sx, z + sz));
      shift_x.node(i, j) = sx;
      shift_z.node(i, j) = sz;
      outline.node(i, j) = inside;
      if (inside < -8 * kOne8) continue;  // no column interpolates from a node this far outside
      elevation.node(i, j) = elevation_at(x, z, inside);
      thickness.node(i, j) = thickness_at(x, z, inside);
      patches.node(i, j) = noise::fractal2(shape.seed + 51, x, z, 34, 2);
    }
  }
}

void Builder::base_ground() {
  for (int x = -columns.half; x < columns.half; ++x) {
    for (int z = -columns.half; z < columns.half; ++z) {
      const std::size_t i = columns.index(x, z);
      int inside = outline.at(x, z);
      if (inside > -3 * kOne8) {
        const int detail = noise::gradient2(shape.seed + 61, x * kOne8, z * kOne8, 11);
        if (inside < 6 * kOne8) inside += detail / 10;
        ground[i] = shape.rim * kOne8 + elevation.at(x, z) + detail / 28;
        columns.bottom[i] = static_cast<std::int16_t>(-(thickness.at(x, z) + detail / 6) / kOne8);
      }
      columns.inside[i] =
          static_cast<std::int16_t>(std::clamp(inside, -32 * kOne8, 127 * kOne8) >> 8);
    }
  }
}

/// Hanging cones of rock on a jittered grid. @param of_256 share of the grid's cells that have one.
void Builder::spikes(int spacing, int of_256, std::uint32_t seed) {
  const int cells = columns.half / spacing + 1;
  for (int cx = -cells; cx <= cells; ++cx) {
    for (int cz = -cells; cz <= cells; ++cz) {
      Rng rng(hash2(seed, cx, cz));
      if (!rng.chance(of_256)) continue;
      const int x0 = cx * spacing + rng.in(0, spacing - 1);
      const int z0 = cz * spacing + rng.in(0, spacing - 1);
      const int reach = rng.in(spacing / 3, spacing * 4 / 5);
      const int share = rng.in(14, 90);
      if (!columns.has(x0, z0) || columns.inside[columns.index(x0, z0)] < 3) continue;
      const int length = (6 - columns.bottom[columns.index(x0, z0)]) * share / 128 + reach / 2;
      for_columns_near(x0, z0, reach, [&](int x, int z, std::size_t i) {
        if (columns.inside[i] < 0) return;
        const int squared = (x - x0) * (x - x0) + (z - z0) * (z - z0);
        if (squared >= reach * reach) return;
        const int d =
            static_cast<int>(noise::isqrt(static_cast<std::uint64_t>(squared) * kOne8 * kOne8));
        const int t = kOne12 - d * 16 / reach;
        const int cone = (t + ((t * t) >> 12)) / 2;
        columns.bottom[i] = static_cast<std::int16_t>(columns.bottom[i] - ((length * cone) >> 12));
      });
    }
  }
}

void Builder::raise(const Butte& butte) {
  const int ramp_x = noise::cosine(butte.ramp);
  const int ramp_z = noise::sine(butte.ramp);
  const auto square = [](std::int64_t blocks) { return blocks * blocks * kOne8 * kOne8; };
  const int widest = std::max(butte.cliff, std::min(butte.ramp_width, butte.radius));
  const std::int64_t foot = square(butte.radius);
  const std::int64_t table = square(butte.radius - widest);  // nearer than this, all is up
  const int reach = butte.radius + shape.warp * 3 / 2 + 6;
  for_columns_near(butte.x, butte.z, reach, [&](int x, int z, std::size_t i) {
    if (columns.inside[i] < 0) return;
    const std::int64_t bent_x = (x - butte.x) * kOne8 + shift_x.at(x, z);
    const std::int64_t bent_z = (z - butte.z) * kOne8 + shift_z.at(x, z);
    const std::int64_t squared = bent_x * bent_x + bent_z * bent_z;
    if (squared >= foot) return;
    if (squared <= table) {
      ground[i] += butte.height * kOne8;
      return;
    }
    const int d = std::max(1, noise::length(bent_x, bent_z));
    const std::int64_t along = (static_cast<std::int64_t>(x - butte.x) * ramp_x +
                                static_cast<std::int64_t>(z - butte.z) * ramp_z) *
                               kOne8;
    const int facing = static_cast<int>(along / d);  // cosine of the angle to the ramp, Q12
    const int share = smooth(std::clamp((facing - 3300) * 8, 0, kOne12));
    const int width =
        butte.cliff * kOne8 + (std::min(butte.ramp_width, butte.radius) - butte.cliff) * share / 16;
    const int risen = smooth((butte.radius * kOne8 - d) * 16 / std::max(1, width / kOne8));
    ground[i] += butte.height * risen / 16;
  });
}

/// Finds a radius at which the whole shore lies inland, and a level. False when there is no such
/// place.
bool Builder::settle(Lake& lake) const {
  constexpr int kShoreRoom = 7;
  for (; lake.radius >= 4; lake.radius = lake.radius * 5 / 6) {
    int lowest = 1 << 30;
    bool inland = true;
    for (int a = 0; a < 1024 && inland; a += 32) {
      for (const int distance : {lake.radius + 2, lake.radius + kShoreRoom}) {
        const int x = lake.x + distance * noise::cosine(a) / kOne12;
        const int z = lake.z + distance * noise::sine(a) / kOne12;
        inland = inland && columns.has(x, z) && columns.inside[columns.index(x, z)] >= 3;
        if (inland) lowest = std::min(lowest, ground[columns.index(x, z)]);
      }
    }
    if (!inland) continue;
    if (lake.level == kLevelFromGround) lake.level = lowest / kOne8;
    return lake.level > 0;
  }
  return false;
}

void Builder::dig(const Lake& lake) {
  constexpr int kRim = 3;    // blocks of level ground around the water
  constexpr int kBlend = 9;  // blocks until the old ground is reached
  const int level = lake.level * kOne8;
  for_columns_near(
      lake.x, lake.z, lake.radius + kRim + kBlend + shape.warp + 6,
      [&](int x, int z, std::size_t i) {
        if (columns.inside[i] < 0) return;
        // Half of the bend, and at most two blocks: the bank must not outrun its rim.
        const int bx = std::clamp(shift_x.at(x, z) / 2, -2 * kOne8 - lake.radius * 40,
                                  2 * kOne8 + lake.radius * 40);
        const int bz = std::clamp(shift_z.at(x, z) / 2, -2 * kOne8 - lake.radius * 40,
                                  2 * kOne8 + lake.radius * 40);
        const int d = noise::length((x - lake.x) * kOne8 + bx, (z - lake.z) * kOne8 + bz) -
                      lake.radius * kOne8;
        if (d < 0) {
          const int bowl = smooth(std::min(kOne12, -d * 24 / lake.radius));
          ground[i] = std::min(ground[i], level - kOne8 - ((lake.depth * bowl) >> 4));
          columns.water[i] = static_cast<std::int16_t>(lake.level);
        } else if (d < (kRim + kBlend) * kOne8) {
          const int away = smooth(std::max(0, (d - kRim * kOne8) * 16 / kBlend));
          const int bank = level + kOne8 / 4 + d / 6;
          ground[i] =
              bank + static_cast<int>((static_cast<std::int64_t>(ground[i] - bank) * away) >> 12);
          if (ground[i] < level && away < kOne12) ground[i] = std::max(ground[i], level - d / 2);
          columns.water[i] = Columns::kDry;
        }
        if (d < 5 * kOne8) shore[i] = 1;
      });
}

/// How far up and down a column reaches before it, or a crown that leans out of it, would leave the
/// bounding sphere.
int Builder::room_at(int x, int z) const {
  const int sphere = shape.extent.sphere;
  const int flat = noise::length(x, z) + kBoxMargin + 2;
  return flat < sphere ? static_cast<int>(noise::isqrt(
                             static_cast<std::uint64_t>(sphere * sphere - flat * flat)))
                       : 0;
}

void Builder::finish_heights() {
  for (std::size_t i = 0; i < ground.size(); ++i) {
    if (columns.inside[i] < 0) {
      columns.top[i] = Columns::kNoGround;
      columns.bottom[i] = Columns::kNoRock;
      columns.water[i] = Columns::kDry;
      continue;
    }
    const int room = room_at(static_cast<int>(i / columns.edge) - columns.half,
                             static_cast<int>(i % columns.edge) - columns.half);
    const int highest = std::min(shape.extent.top, room - kTreeRoom);
    const int top = std::clamp(ground[i] >> 8, -shape.extent.depth / 2,
                               std::max(highest, -shape.extent.depth / 2));
    const int keel = soft_limit(-columns.bottom[i], std::min(shape.extent.depth, room - kKeelRoom));
    const int bottom = std::min(-keel, top - 4);
    columns.top[i] = static_cast<std::int16_t>(top);
    columns.bottom[i] = static_cast<std::int16_t>(bottom);
    if (columns.water[i] <= top) columns.water[i] = Columns::kDry;
  }
}

/// Raises every dry neighbour of a water column to the water's level, and drains what nothing can
/// hold: no bare wall of water.
void Builder::contain_water() {
  const std::array<std::ptrdiff_t, 4> neighbours = {1, -1, columns.edge, -columns.edge};
  const auto inner = [&](auto&& f) {
    for (int x = -columns.half + 1; x < columns.half - 1; ++x) {
      for (int z = -columns.half + 1; z < columns.half - 1; ++z) f(columns.index(x, z));
    }
  };
  inner([&](std::size_t i) {  // water at the outline or above a lower lake gives way
    const int level = columns.water[i];
    if (level == Columns::kDry) return;
    for (const std::ptrdiff_t step : neighbours) {
      const std::size_t n = i + static_cast<std::size_t>(step);
      const bool lower_lake = columns.water[n] != Columns::kDry && columns.water[n] < level;
      if (columns.top[n] == Columns::kNoGround || lower_lake) {
        columns.top[i] = static_cast<std::int16_t>(level);
        columns.water[i] = Columns::kDry;
        return;
      }
    }
  });
  inner([&](std::size_t i) {
    const int level = columns.water[i];
    if (level == Columns::kDry) return;
    for (const std::ptrdiff_t step : neighbours) {
      const std::size_t n = i + static_cast<std::size_t>(step);
      if (columns.water[n] == Columns::kDry && columns.top[n] < level)
        columns.top[n] = static_cast<std::int16_t>(level);
    }
  });
}

/// Marks cliffs and the outline, where the rock may shift sideways. Meadows and shores keep their
/// exact heights.
void Builder::raggedness() {
  constexpr int kGentle = 6;  // blocks of height within 2 cells: a slope, not a cliff
  columns.max_shift = std::min(9 * kOne8 / 2, kOne8 + shape.extent.radius * 12);
  const int cells = columns.edge / kStep;
  const auto cell = [cells](int i, int j) {
    return static_cast<std::size_t>(i) * cells + static_cast<std::size_t>(j);
  };
  constexpr std::int16_t kFar = 1000;  // beyond any height; columns without ground count as -kFar
  std::vector<std::int16_t> low(static_cast<std::size_t>(cells) * cells, kFar);
  std::vector<std::int16_t> high(low.size(), -kFar);
  for (int i = 0; i < columns.edge; ++i) {
    for (int j = 0; j < columns.edge; ++j) {
      const std::size_t c = cell(i / kStep, j / kStep);
      const std::int16_t top = columns.top[static_cast<std::size_t>(i) * columns.edge + j];
      low[c] = std::min(low[c], std::max<std::int16_t>(top, -kFar));
      high[c] = std::max(high[c], std::max<std::int16_t>(top, -kFar));
    }
  }
  Coarse amount(columns.half);
  for (int i = 1; i < cells; ++i) {
    for (int j = 1; j < cells; ++j) {  // a lattice node looks at the four cells that meet there
      const std::array<std::size_t, 4> around = {cell(i, j), cell(i - 1, j), cell(i, j - 1),
                                                 cell(i - 1, j - 1)};
      int least = kFar;
      int most = -kFar;
      for (const std::size_t c : around) {
        least = std::min<int>(least, low[c]);
        most = std::max<int>(most, high[c]);
      }
      amount.node(i, j) = std::clamp((most - least - kGentle) * 32, 0, 255);
    }
  }
  for (int x = -columns.half; x < columns.half; ++x) {
    for (int z = -columns.half; z < columns.half; ++z) {
      columns.ragged[columns.index(x, z)] = static_cast<std::uint8_t>(amount.at(x, z));
    }
  }
}

/// Bounds of the heights within the sideways shift of each cell: whole cells around it.
void Builder::reaches() {
  constexpr int kAround = 2;  // cells: 8 columns, more than the largest shift
  constexpr std::int16_t kTurf = 6;
  using Reach = Columns::Reach;
  const int cells = columns.edge / Columns::kReachCell;
  const auto widen = [](Reach& a, const Reach& b) {
    a = {std::min(a.bottom, b.bottom), std::max(a.top, b.top),
         std::max(a.core_bottom, b.core_bottom), std::min(a.core_top, b.core_top)};
  };
  constexpr Reach kNothing = {Columns::kNoRock, Columns::kNoGround, Columns::kNoGround,
                              Columns::kNoRock};
  std::vector<Reach> own(static_cast<std::size_t>(cells) * cells, kNothing);
  for (int i = 0; i < columns.edge; ++i) {
    for (int j = 0; j < columns.edge; ++j) {
      const std::size_t c = static_cast<std::size_t>(i) * columns.edge + j;
      widen(
          own[static_cast<std::size_t>(i / Columns::kReachCell) * cells + j / Columns::kReachCell],
          {columns.bottom[c], columns.top[c], columns.bottom[c], columns.top[c]});
    }
  }
  // Rows, then columns: a box filter is separable.
  std::vector<Reach> rows(own.size(), kNothing);
  columns.reaches.assign(own.size(), kNothing);
  const auto spread = [&](const std::vector<Reach>& from, std::vector<Reach>& to, int step_i,
                          int step_j) {
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        for (int k = -kAround; k <= kAround; ++k) {
          const int ni = std::clamp(i + k * step_i, 0, cells - 1);
          const int nj = std::clamp(j + k * step_j, 0, cells - 1);
          widen(to[static_cast<std::size_t>(i) * cells + j],
                from[static_cast<std::size_t>(ni) * cells + nj]);
        }
      }
    }
  };
  spread(own, rows, 0, 1);
  spread(rows, columns.reaches, 1, 0);
  for (Reach& reach : columns.reaches)
    reach.core_top =
        static_cast<std::int16_t>(std::max<int>(reach.core_top - kTurf, Columns::kNoGround));
}

/// Caves may open in cliffs only, and stay three blocks below any lake bed. Shores stay exact, so
/// that they hold.
void Builder::roofs() {
  constexpr int kTurf = 4;
  for (std::size_t i = 0; i < columns.top.size(); ++i) {
    columns.roof[i] = columns.ragged[i] > 0 ? Columns::kOpenRoof
                                            : static_cast<std::int16_t>(columns.top[i] - kTurf);
  }
  for (int x = -columns.half + 3; x < columns.half - 3; ++x) {
    for (int z = -columns.half + 3; z < columns.half - 3; ++z) {
      const std::size_t wet = columns.index(x, z);
      if (columns.water[wet] == Columns::kDry) continue;
      const auto limit = static_cast<std::int16_t>(columns.top[wet] - 3);
      for_columns_near(x, z, 2, [&](int, int, std::size_t i) {
        columns.roof[i] = std::min(columns.roof[i], limit);
        columns.ragged[i] = 0;
      });
    }
  }
}

/// Whether lava runs here: winding lines that leave the crater and end on the flanks.
bool Builder::in_stream(int x, int z) const {
  return std::any_of(shape.streams.begin(), shape.streams.end(), [&](int direction) {
    const int bx = x * kOne8 + shift_x.at(x, z) * 2;
    const int bz = z * kOne8 + shift_z.at(x, z) * 2;
    const int along =
        (bx / 16 * noise::cosine(direction) + bz / 16 * noise::sine(direction)) / (kOne12 / 16);
    const int across =
        (bz / 16 * noise::cosine(direction) - bx / 16 * noise::sine(direction)) / (kOne12 / 16);
    const int end = radius8() * 5 / 8;
    return along > 0 && along < end && std::abs(across) < 2 * kOne8 + (end - along) / 40;
  });
}

/// Whether the ground falls away by more than a player climbs.
bool Builder::steep_at(std::size_t i) const {
  constexpr int kClimb = 3;
  const auto edge = static_cast<std::size_t>(columns.edge);
  const std::int16_t* top = &columns.top[i];
  const auto falls = [top](const std::int16_t* other) {
    return *other != Columns::kNoGround && *top - *other >= kClimb;
  };
  return falls(top + 1) || falls(top - 1) || falls(top + edge) || falls(top - edge);
}

SkinId Builder::skin_of(int x, int z, std::size_t i) const {
  const BiomeType& biome = biome_type(shape.biome);
  const int patch = patches.at(x, z);
  const int height = columns.top[i];
  if (columns.water[i] != Columns::kDry) return biome.lake_bed;
  if (in_stream(x, z)) return SkinId::kLava;
  if (steep_at(i)) return SkinId::kBare;
  if (shore[i] && patch < 2600) return biome.beach;
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
      return columns.inside[i] < 5 + patch / 1200 && height < 6 ? SkinId::kSand : SkinId::kGrass;
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

void Builder::cover() {
  for (int x = -columns.half; x < columns.half; ++x) {
    for (int z = -columns.half; z < columns.half; ++z) {
      const std::size_t i = columns.index(x, z);
      if (columns.top[i] == Columns::kNoGround) continue;
      columns.skins[i] = skin_of(x, z, i);
      columns.highest = std::max<int>(columns.highest, std::max(columns.top[i], columns.water[i]));
      columns.lowest = std::min<int>(columns.lowest, columns.bottom[i]);
    }
  }
}

}  // namespace

Columns build_columns(Shape& shape) {
  Columns columns;
  columns.half = (shape.extent.radius + kBoxMargin + 8 + kStep - 1) / kStep * kStep;
  columns.edge = 2 * columns.half;
  const std::size_t count = static_cast<std::size_t>(columns.edge) * columns.edge;
  columns.top.assign(count, Columns::kNoGround);
  columns.bottom.assign(count, Columns::kNoRock);
  columns.water.assign(count, Columns::kDry);
  columns.roof.resize(count);
  columns.inside.resize(count);
  columns.ragged.resize(count);
  columns.skins.resize(count, SkinId::kStone);
  Builder builder(shape, columns);
  builder.coarse_fields();
  builder.base_ground();
  const int radius = shape.extent.radius;
  builder.spikes(std::clamp(radius * 2 / 5, 12, 60), 190, shape.seed + 71);
  builder.spikes(std::clamp(radius / 6, 8, 20), 110, shape.seed + 72);
  for (const Butte& butte : shape.buttes) builder.raise(butte);
  for (Lake& lake : shape.lakes) {
    if (builder.settle(lake)) builder.dig(lake);
  }
  builder.finish_heights();
  builder.contain_water();
  builder.raggedness();
  builder.reaches();
  builder.roofs();
  builder.cover();
  return columns;
}

}  // namespace skerry::world
