#include "world/generate/columns.h"

#include <algorithm>
#include <array>
#include <optional>

#include "world/generate/design.h"
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

  void coarse_fields();
  void base_ground();
  void hang(const Spike& spike);
  void raise(const Butte& butte);
  void dig(const Lake& lake);
  void finish_heights();
  void contain_water();
  void raggedness();
  void reaches();
  void roofs();
  void cover();
  bool steep_at(std::size_t i) const;

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

void Builder::coarse_fields() {
  for (int i = 0; i < outline.edge; ++i) {
    for (int j = 0; j < outline.edge; ++j) {
      const int x = (i * kStep - columns.half) * kOne8;
      const int z = (j * kStep - columns.half) * kOne8;
      const Bend bend = bend_at(shape, x, z);
      const int inside = inside_at(shape, x, z, bend);
      shift_x.node(i, j) = bend.x;
      shift_z.node(i, j) = bend.z;
      outline.node(i, j) = inside;
      if (inside < -8 * kOne8) continue;  // no column interpolates from a node this far outside
      elevation.node(i, j) = elevation_at(shape, x, z, inside);
      thickness.node(i, j) = thickness_at(shape, x, z, inside);
      patches.node(i, j) = patch_at(shape, x, z);
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

void Builder::hang(const Spike& spike) {
  if (!columns.has(spike.x, spike.z)) return;
  const std::size_t foot = columns.index(spike.x, spike.z);
  if (columns.inside[foot] < 3) return;
  const int length = spike.length_at(columns.bottom[foot]);
  for_columns_near(spike.x, spike.z, spike.reach, [&](int x, int z, std::size_t i) {
    if (columns.inside[i] < 0) return;
    columns.bottom[i] = static_cast<std::int16_t>(columns.bottom[i] - spike.depth_at(x, z, length));
  });
}

void Builder::raise(const Butte& butte) {
  const ButteRise rise(butte);
  const int reach = butte.radius + shape.warp * 3 / 2 + 6;
  for_columns_near(butte.x, butte.z, reach, [&](int x, int z, std::size_t i) {
    if (columns.inside[i] >= 0) ground[i] += rise.at(x, z, {shift_x.at(x, z), shift_z.at(x, z)});
  });
}

void Builder::dig(const Lake& lake) {
  for_columns_near(lake.x, lake.z, lake.radius + kLakeReach + shape.warp + 6,
                   [&](int x, int z, std::size_t i) {
                     if (columns.inside[i] < 0) return;
                     LakeColumn column{ground[i], columns.water[i] != Columns::kDry, shore[i] != 0};
                     dig_at(lake, x, z, {shift_x.at(x, z), shift_z.at(x, z)}, column);
                     ground[i] = column.ground;
                     if (!column.wet) columns.water[i] = Columns::kDry;
                     if (column.dug) columns.water[i] = static_cast<std::int16_t>(lake.level);
                     shore[i] = column.shore ? 1 : 0;
                   });
}

void Builder::finish_heights() {
  for (std::size_t i = 0; i < ground.size(); ++i) {
    if (columns.inside[i] < 0) {
      columns.top[i] = Columns::kNoGround;
      columns.bottom[i] = Columns::kNoRock;
      columns.water[i] = Columns::kDry;
      continue;
    }
    const int x = static_cast<int>(i / columns.edge) - columns.half;
    const int z = static_cast<int>(i % columns.edge) - columns.half;
    const auto [top, bottom] = heights_at(shape, x, z, {ground[i], columns.bottom[i]});
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

void Builder::cover() {
  for (int x = -columns.half; x < columns.half; ++x) {
    for (int z = -columns.half; z < columns.half; ++z) {
      const std::size_t i = columns.index(x, z);
      if (columns.top[i] == Columns::kNoGround) continue;
      columns.skins[i] = skin_at(shape, {.x = x,
                                         .z = z,
                                         .bend = {shift_x.at(x, z), shift_z.at(x, z)},
                                         .patch = patches.at(x, z),
                                         .height = columns.top[i],
                                         .inside = columns.inside[i],
                                         .wet = columns.water[i] != Columns::kDry,
                                         .steep = steep_at(i),
                                         .shore = shore[i] != 0});
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
  for (const SpikeGrid& grid : spike_grids(shape))
    for_spikes(grid, columns.half, [&](const Spike& spike) { builder.hang(spike); });
  for (const Butte& butte : shape.buttes) builder.raise(butte);
  for (Lake& lake : shape.lakes) {
    const bool settled = settle(lake, kShoreSteps, [&](int x, int z) -> std::optional<int> {
      if (!columns.has(x, z) || columns.inside[columns.index(x, z)] < 3) return std::nullopt;
      return builder.ground[columns.index(x, z)];
    });
    if (settled) builder.dig(lake);
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
