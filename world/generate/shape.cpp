#include "world/generate/shape.h"

#include <algorithm>

#include "engine/core/check.h"
#include "world/generate/noise.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

using noise::cosine;
using noise::kOne12;
using noise::sine;

// Arguments travel as braced lists, because those are evaluated from left to right: random numbers
// in a plain argument list would be drawn in an order that differs between compilers.
struct Polar {
  int direction, distance, radius;
};
struct Rise {
  Lobe where;
  int height, cliff, ramp_width;
};
struct Pool {
  Lobe where;
  int depth;
  int level = kLevelFromGround;
};

/// Places design parts on one island; all lengths scale with its radius.
struct Designer {
  Shape& shape;
  Rng& rng;

  int scaled(int percent) const { return shape.extent.radius * percent / 100; }
  /// A random length between two shares of the radius.
  int between(int low_percent, int high_percent) {
    const int low = scaled(low_percent);
    return rng.in(low, std::max(low, scaled(high_percent)));
  }
  int angle() { return rng.in(0, 1023); }
  Lobe at(const Polar& p) const {
    return {p.distance * cosine(p.direction) / kOne12, p.distance * sine(p.direction) / kOne12,
            std::max(3, p.radius)};
  }

  /// A body with bays and headlands.
  void coast(int body_percent, int lobes) {
    shape.lobes.push_back({0, 0, scaled(body_percent)});
    const int start = angle();
    for (int i = 0; i < lobes; ++i) {
      const int direction = start + 1024 * i / lobes + rng.in(-60, 60);
      shape.lobes.push_back(at({direction, between(34, 56), between(22, 40)}));
    }
  }
  void butte(const Rise& r) {
    shape.buttes.push_back({r.where.x, r.where.z, r.where.radius, std::max(3, r.height), r.cliff,
                            angle(), r.ramp_width});
  }
  void lake(const Pool& pool) {
    shape.lakes.push_back({pool.where.x, pool.where.z, pool.where.radius, pool.level, pool.depth});
  }
  void arch(Lobe from, Lobe to, int rise, int thickness) {
    shape.arches.push_back({from.x, from.z, to.x, to.z, rise, thickness});
  }
};

void plateau(Designer& d) {
  d.coast(58, d.rng.in(4, 6));
  const int direction = d.angle();
  const Lobe table = d.at({direction, d.between(18, 30), d.between(36, 46)});
  d.butte({table, d.between(9, 15), 3, 22});
  d.butte({{table.x + d.between(2, 8), table.z - d.between(2, 8), table.radius * 55 / 100},
           d.between(7, 13),
           3,
           18});
  if (d.rng.chance(128))
    d.butte({d.at({direction + 400, d.scaled(45), d.between(10, 16)}), d.between(8, 20), 2, 8});
  d.lake({d.at({direction + 512 + d.rng.in(-80, 80), d.between(22, 34), d.between(14, 22)}),
          d.rng.in(3, 6)});
  d.lake({{table.x + table.radius / 2, table.z + table.radius / 3, d.between(6, 9)}, 3});
}

void crescent(Designer& d) {
  const int front = d.angle();
  d.shape.lobes.push_back({0, 0, d.scaled(88)});
  d.shape.bites.push_back(d.at({front, d.scaled(112), d.between(50, 62)}));
  d.lake({d.at({front, d.scaled(10), d.between(32, 40)}), d.rng.in(5, 8), 3});
  for (int i = -3; i <= 3; ++i) {  // hills around the back of the lagoon
    if (i == 0 || d.rng.chance(220)) {
      d.butte({d.at({front + 512 + i * 90, d.between(62, 70), d.between(13, 21)}), d.between(9, 22),
               d.rng.in(2, 7), 16});
    }
  }
  d.shape.rim = 3;
  d.shape.roll = 2;
}

void spires(Designer& d) {
  d.coast(48, d.rng.in(3, 5));
  const int count = d.rng.in(5, 9);
  for (int i = 0; i < count; ++i) {
    const Lobe foot = d.at({d.angle(), d.between(8, 58), d.between(8, 15)});
    d.butte({foot, d.between(22, 68), 3, 3});
    d.butte({{foot.x, foot.z, foot.radius + d.scaled(7)}, d.between(6, 14), 3, 12});
  }
  d.lake({d.at({d.angle(), d.between(10, 30), d.between(10, 15)}), 4});
  d.shape.roll = 5;
}

void terraces(Designer& d) {
  d.coast(66, d.rng.in(3, 5));
  const int direction = d.angle();
  const int steps = d.rng.in(4, 6);
  const int rise = d.between(6, 10);
  for (int i = 0; i < steps; ++i) {
    const int radius = d.scaled(68 - 56 * i / steps);
    d.butte({d.at({direction, d.scaled(5 + 22 * i / steps), radius}), rise, 2, 14});
    if (i < 3) d.lake({d.at({direction + 512, d.scaled(50 - 16 * i), d.between(7, 10)}), 3});
  }
  d.shape.roll = 2;
}

void twin(Designer& d) {
  const int axis = d.angle();
  const Lobe one = d.at({axis, d.scaled(50), d.between(42, 48)});
  const Lobe two = d.at({axis + 512, d.scaled(54), d.between(34, 42)});
  d.shape.lobes = {one, two};
  for (int i = -3; i <= 3; ++i)
    d.shape.lobes.push_back(d.at({axis, d.scaled(14) * i / 2, d.between(13, 18)}));
  d.butte({{one.x, one.z, one.radius * 70 / 100}, d.between(12, 20), 3, 20});
  d.butte({{one.x, one.z, one.radius * 40 / 100}, d.between(10, 20), 3, 14});
  d.butte({{two.x, two.z, two.radius * 66 / 100}, d.between(10, 26), 3, 22});
  d.lake({{one.x * 13 / 10, one.z * 13 / 10, d.between(8, 12)}, 4});
  d.arch({one.x * 55 / 100, one.z * 55 / 100, 0}, {two.x * 55 / 100, two.z * 55 / 100, 0},
         d.between(20, 28), std::clamp(d.scaled(4), 2, 6));
}

void buttes(Designer& d) {
  d.coast(62, d.rng.in(4, 6));
  const int count = d.rng.in(4, 7);
  for (int i = 0; i < count; ++i) {
    const Lobe foot =
        d.at({1024 * i / count + d.rng.in(-60, 60), d.between(20, 55), d.between(13, 26)});
    const int height = d.between(14, 34);
    d.butte({foot, height, 2, d.rng.chance(160) ? 24 : 4});
    if (d.rng.chance(150)) d.butte({{foot.x, foot.z, foot.radius * 60 / 100}, height / 2, 2, 6});
  }
  d.lake({{0, 0, d.between(9, 14)}, 3});
  d.shape.roll = 3;
}

void volcano(Designer& d) {
  d.coast(66, d.rng.in(4, 7));
  const int height = d.between(56, 70);
  const int crater = d.between(13, 17);
  d.shape.peaks.push_back({0, 0, d.scaled(72), height, 2});
  d.lake({{0, 0, crater}, d.rng.in(8, 14), height * 48 / 100});
  for (int i = 0; i < 3; ++i)
    d.butte({d.at({d.angle(), d.between(48, 60), d.between(9, 14)}), d.between(6, 14), 3, 14});
  d.lake({d.at({d.angle(), d.scaled(56), d.between(6, 9)}), 3});
  d.shape.crags = d.scaled(6);
  const int first = d.angle();
  for (int i = 0; i < 3; ++i) d.shape.streams.push_back(first + i * 341 + d.rng.in(-90, 90));
}

void ridge(Designer& d) {
  const int axis = d.angle();
  int bend = axis;
  int x = -d.scaled(62) * cosine(axis) / kOne12;
  int z = -d.scaled(62) * sine(axis) / kOne12;
  for (int i = 0; i < 7; ++i) {
    d.shape.lobes.push_back({x, z, d.between(26, 36)});
    if (i > 0 && i < 6) d.shape.peaks.push_back({x, z, d.between(26, 38), d.between(18, 46), 1});
    bend += d.rng.in(-70, 70);
    x += d.scaled(21) * cosine(bend) / kOne12;
    z += d.scaled(21) * sine(bend) / kOne12;
  }
  d.lake({d.at({axis + 256, d.between(14, 20), d.between(9, 13)}), 4});
  d.shape.crags = d.between(12, 18);
}

void shard(Designer& d) {
  d.shape.lobes.push_back({0, 0, d.scaled(70)});
  for (int i = d.rng.in(1, 3); i > 0; --i)
    d.shape.lobes.push_back(d.at({d.angle(), d.between(30, 50), d.between(30, 45)}));
  if (d.rng.chance(150))
    d.butte({d.at({d.angle(), d.between(10, 30), d.between(26, 42)}), d.between(14, 50), 3, 10});
  if (d.rng.chance(60)) d.lake({{0, 0, d.between(22, 30)}, 3});
  d.shape.roll = 3;
}

void arches(Designer& d) {
  d.coast(56, 5);
  const int start = d.angle();
  const int count = d.rng.in(2, 3);
  for (int i = 0; i < count; ++i) {
    const int direction = start + i * 1024 / count;
    const Lobe from = d.at({direction, d.scaled(50), 0});
    const Lobe to = d.at({direction + d.rng.in(250, 420), d.scaled(46), 0});
    d.arch(from, to, d.between(28, 46), std::clamp(d.scaled(5), 2, 8));
    d.butte({{from.x, from.z, d.scaled(16)}, d.between(5, 10), 4, 14});
  }
  d.lake({{0, 0, d.between(14, 20)}, d.rng.in(3, 6)});
}

}  // namespace

Extent extent_of(Archetype archetype, int radius) {
  struct Share {
    int top, depth;
  };
  static constexpr Share kShares[] = {{46, 80}, {36, 62}, {90, 90}, {66, 74},  {60, 80},
                                      {60, 64}, {78, 84}, {72, 70}, {60, 120}, {50, 76}};
  static_assert(std::size(kShares) == static_cast<std::size_t>(Archetype::kCount));
  const Share share = kShares[static_cast<std::size_t>(archetype)];
  Extent extent{radius, std::min(150, 12 + radius * share.top / 100),
                std::min(210, 12 + radius * share.depth / 100), 0};
  const int tall = std::max(extent.top + kTreeRoom, extent.depth + kKeelRoom);
  // Wide enough for cliffs a third as tall as the whole at the outline; the columns keep within it.
  extent.sphere = std::max(tall, noise::length(radius + kBoxMargin, tall / 3)) + 3;
  return extent;
}

Shape shape_of(const IslandSpec& spec) {
  SKERRY_ASSERT(spec.archetype < static_cast<std::uint32_t>(Archetype::kCount));
  SKERRY_ASSERT(spec.biome < static_cast<std::uint32_t>(Biome::kCount));
  Shape shape;
  shape.archetype = static_cast<Archetype>(spec.archetype);
  shape.biome = static_cast<Biome>(spec.biome);
  shape.extent = extent_of(shape.archetype, spec.box_max.x - kBoxMargin);
  shape.seed = static_cast<std::uint32_t>(mix64(spec.seed) >> 32);
  Rng rng(spec.seed);
  Designer designer{shape, rng};
  shape.warp = designer.scaled(13);
  static constexpr void (*kDesigns[])(Designer&) = {plateau, crescent, spires, terraces, twin,
                                                    buttes,  volcano,  ridge,  shard,    arches};
  kDesigns[spec.archetype](designer);
  if (shape.biome == Biome::kMarsh) {
    shape.roll = 1;
    for (int i = rng.in(6, 11); i > 0; --i) {
      designer.lake(
          {designer.at({designer.angle(), designer.between(8, 62), designer.between(5, 12)}),
           rng.in(1, 3)});
    }
  }
  if (shape.biome == Biome::kHighland) shape.crags = std::max(shape.crags, designer.scaled(8));
  return shape;
}

}  // namespace skerry::world
