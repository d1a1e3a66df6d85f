#include <algorithm>
#include <array>
#include <optional>

#include "world/generate/noise.h"
#include "world/generate/plan.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

/// Where a cave may begin: level ground at the foot of a cliff.
struct Mouth {
  int x, y, z;
  int direction;  ///< into the cliff, 1/1024 turn
};

int top_at(const Columns& columns, int x, int z) {
  return columns.has(x, z) ? columns.top[columns.index(x, z)] : Columns::kNoGround;
}

std::optional<Mouth> find_mouth(const Columns& columns, int radius, Rng& rng) {
  constexpr int kTries = 400;
  constexpr int kHeadroom = 8;
  for (int i = 0; i < kTries; ++i) {
    const int x = rng.in(-radius, radius);
    const int z = rng.in(-radius, radius);
    const int y = top_at(columns, x, z);
    if (y == Columns::kNoGround || columns.water[columns.index(x, z)] != Columns::kDry) continue;
    const int direction = rng.in(0, 1023);
    const auto ahead = [&](int distance) {
      return top_at(columns, x + distance * noise::cosine(direction) / noise::kOne12,
                    z + distance * noise::sine(direction) / noise::kOne12);
    };
    const int behind = ahead(-4);
    const bool level = behind >= y - 2 && behind <= y + 1;
    if (level && ahead(7) >= y + kHeadroom && ahead(12) >= y + kHeadroom &&
        ahead(18) >= y + kHeadroom)
      return Mouth{x, y, z, direction};
  }
  return std::nullopt;
}

/// Digs one cave: a winding passage, then a chamber.
class Digger {
 public:
  Digger(IslandPlan& plan, Rng& rng) : plan_(plan), rng_(rng) {}

  void dig(const Mouth& mouth) {
    int x = mouth.x * noise::kOne8 - 2 * noise::cosine(mouth.direction) / 16;
    int z = mouth.z * noise::kOne8 - 2 * noise::sine(mouth.direction) / 16;
    int floor = mouth.y * noise::kOne8;
    int direction = mouth.direction;
    const int length = rng_.in(18, std::clamp(plan_.shape.extent.radius / 2, 24, 90));
    const int slope = rng_.in(0, 90);
    for (int step = 0; step < length; ++step) {
      const bool through = step > 8 && !rock_around(x >> 8, (floor >> 8) + 2, z >> 8);
      hollow(x >> 8, floor >> 8, z >> 8, rng_.in(3, 4), step < 8 || through);
      if (through) return;  // came out on the far side: a tunnel
      direction += rng_.in(-34, 34);
      x += noise::cosine(direction) / 16;
      z += noise::sine(direction) / 16;
      if (step > 6) floor -= slope;
      if (step % 9 == 8) grow(x >> 8, floor >> 8, z >> 8, 2, block::kGlowFern);
    }
    chamber(x >> 8, floor >> 8, z >> 8);
  }

 private:
  bool rock_around(int x, int y, int z) const {
    return plan_.rock_at(x + 5, y, z) || plan_.rock_at(x - 5, y, z) || plan_.rock_at(x, y, z + 5);
  }

  void hollow(int x, int floor, int z, int radius, bool open) {
    plan_.holes.push_back({x, floor + radius - 2, z, radius, floor, open});
  }

  /// A hall with a level floor where mushrooms and crystals glow.
  void chamber(int x, int floor, int z) {
    const int size = std::clamp(plan_.shape.extent.radius / 9, 5, 13);
    for (int i = rng_.in(3, 6); i > 0; --i) {
      const int r = rng_.in(size * 2 / 3, size);
      const int cx = x + rng_.in(-size, size);
      const int cz = z + rng_.in(-size, size);
      plan_.holes.push_back({cx, floor + r / 3, cz, r, floor, false});
      for (int k = 0; k < r; ++k)
        grow(cx, floor, cz, r, rng_.chance(150) ? block::kGlowShroom : block::kGlowFern);
      for (int k = rng_.in(1, 3); k > 0; --k) {
        const int px = cx + rng_.in(-r, r);
        const int pz = cz + rng_.in(-r, r);
        pillar(px, floor, pz);
      }
    }
  }

  /// One glowing plant near (x, z) on moss or mycelium.
  void grow(int x, int floor, int z, int spread, BlockId plant) {
    const int px = x + rng_.in(-spread, spread);
    const int pz = z + rng_.in(-spread, spread);
    for (int dx = -1; dx <= 1; ++dx) stamp(px + dx, floor - 1, pz, block::kMycelium, floor);
    stamp(px, floor, pz, plant, floor);
  }

  void pillar(int x, int floor, int z) {
    for (int y = rng_.in(2, 5); y >= 0; --y) stamp(x, floor + y, z, plan_.biome().crystal, floor);
    stamp(x + 1, floor, z, plan_.biome().crystal, floor);
    stamp(x, floor - 1, z, plan_.biome().crystal, floor);
  }

  /// Below `floor` rock is replaced, above it air is filled.
  void stamp(int x, int y, int z, BlockId id, int floor) {
    const Stamp made{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                     static_cast<std::int16_t>(z), id, y >= floor};
    pending_.push_back({made, floor});
  }

 public:
  /// Keeps the stamps that ended up inside a cave and above solid floor: all holes must be known
  /// first.
  void settle() {
    // Blocks before plants, so that no crystal takes root on a mushroom.
    std::stable_partition(pending_.begin(), pending_.end(), [](const Pending& p) {
      return block_kind(p.made.id) != BlockKind::kPlant;
    });
    for (const auto& [made, floor] : pending_) {
      if (!plan_.columns.has(made.x, made.z)) continue;
      const int roof = plan_.roof_of(plan_.holes.back(), plan_.columns.index(made.x, made.z));
      const int open = std::max<int>(made.y, floor);
      const bool dug = open + 1 < roof && plan_.rock_at(made.x, open, made.z) &&
                       !plan_.solid_at(made.x, open, made.z);
      if (dug && plan_.solid_at(made.x, floor - 1, made.z)) plan_.stamps.push_back(made);
    }
  }

 private:
  struct Pending {
    Stamp made;
    int floor;
  };
  IslandPlan& plan_;
  Rng& rng_;
  std::vector<Pending> pending_;
};

}  // namespace

void plan_caves(IslandPlan& plan) {
  const int radius = plan.shape.extent.radius;
  if (radius < 28) return;
  Rng rng(mix64(plan.shape.seed + 601));
  Digger digger(plan, rng);
  for (int i = std::min(7, 1 + radius / 36); i > 0; --i) {
    if (const auto mouth = find_mouth(plan.columns, radius, rng)) digger.dig(*mouth);
  }
  digger.settle();
}

}  // namespace skerry::world
