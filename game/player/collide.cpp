#include "game/player/collide.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace skerry::game {
namespace {

/// Longest step along any axis: less than a voxel, so that a diagonal path cannot skip a corner.
constexpr std::int64_t kMaxStep = kLatticeBlock / 2;

constexpr std::int64_t units(double blocks) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): a length, and floor is not constexpr
  return static_cast<std::int64_t>(blocks * static_cast<double>(kLatticeBlock) + 0.5);
}
constexpr std::int64_t kHalfWidth = units(kPlayerHalfWidth), kHeight = units(kPlayerHeight);

struct Box {
  LatticePos min, max;
};

Box box_at(const LatticePos& feet) {
  return {{feet.x - kHalfWidth, feet.y, feet.z - kHalfWidth},
          {feet.x + kHalfWidth, feet.y + kHeight, feet.z + kHalfWidth}};
}

int lower_voxel(std::int64_t edge) {
  return static_cast<int>(edge >> 32);
}
/// The last voxel an open interval ending at `edge` reaches into.
int upper_voxel(std::int64_t edge) {
  return static_cast<int>((edge - 1) >> 32);
}

/// Whether any voxel of the layer `at` along `axis` is solid where the box covers the other two
/// axes.
bool layer_blocks(const SolidQuery& solid, const Box& box, int axis, int at) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  glm::ivec3 voxel{0};
  voxel[axis] = at;
  for (voxel[u] = lower_voxel(box.min[u]); voxel[u] <= upper_voxel(box.max[u]); ++voxel[u]) {
    for (voxel[v] = lower_voxel(box.min[v]); voxel[v] <= upper_voxel(box.max[v]); ++voxel[v]) {
      if (solid({voxel.x, voxel.y, voxel.z})) return true;
    }
  }
  return false;
}

/// Moves along one axis. @return whether a solid stopped it.
bool step_axis(const SolidQuery& solid, LatticePos& feet, int axis, std::int64_t distance) {
  const Box box = box_at(feet);
  if (distance > 0) {
    const std::int64_t front = box.max[axis] + distance + kContactGap;
    for (int layer = upper_voxel(box.max[axis]) + 1; layer <= upper_voxel(front); ++layer) {
      if (!layer_blocks(solid, box, axis, layer)) continue;
      feet[axis] = layer * kLatticeBlock - kContactGap - (axis == 1 ? kHeight : kHalfWidth);
      return true;
    }
  } else if (distance < 0) {
    const std::int64_t front = box.min[axis] + distance - kContactGap;
    for (int layer = lower_voxel(box.min[axis]) - 1; layer >= lower_voxel(front); --layer) {
      if (!layer_blocks(solid, box, axis, layer)) continue;
      feet[axis] = (layer + 1) * kLatticeBlock + kContactGap + (axis == 1 ? 0 : kHalfWidth);
      return true;
    }
  }
  feet[axis] += distance;
  return false;
}

std::int64_t longest_axis(const LatticePos& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Share `part` of `parts` equal ones of a whole; together they are exactly the whole.
std::int64_t share(std::int64_t whole, std::int64_t part, std::int64_t parts) {
  const std::int64_t rest = whole % parts;
  const std::int64_t one_more = part < std::abs(rest) ? (rest < 0 ? -1 : 1) : 0;
  return whole / parts + one_more;
}

}  // namespace

LatticePos lattice_pos(const glm::dvec3& blocks) {
  const auto rounded = [](double axis) {
    return static_cast<std::int64_t>(std::llround(axis * static_cast<double>(kLatticeBlock)));
  };
  return {rounded(blocks.x), rounded(blocks.y), rounded(blocks.z)};
}

glm::dvec3 lattice_blocks(const LatticePos& pos) {
  constexpr double kBlocks = 1.0 / static_cast<double>(kLatticeBlock);
  return {static_cast<double>(pos.x) * kBlocks, static_cast<double>(pos.y) * kBlocks,
          static_cast<double>(pos.z) * kBlocks};
}

bool box_overlaps(const SolidQuery& solid, const LatticePos& feet) {
  const Box box = box_at(feet);
  for (int layer = lower_voxel(box.min.y); layer <= upper_voxel(box.max.y); ++layer) {
    if (layer_blocks(solid, box, 1, layer)) return true;
  }
  return false;
}

bool is_supported(const SolidQuery& solid, const LatticePos& feet) {
  return layer_blocks(solid, box_at(feet), 1, lower_voxel(feet.y - 2 * kContactGap));
}

SweepResult sweep_box(const SolidQuery& solid, const LatticePos& feet, const LatticePos& motion) {
  SweepResult result{feet, glm::ivec3(0)};
  const std::int64_t steps =
      std::max<std::int64_t>(1, (longest_axis(motion) + kMaxStep - 1) / kMaxStep);
  for (std::int64_t step = 0; step < steps; ++step) {
    for (const int axis : {1, 0, 2}) {
      if (result.blocked[axis] != 0) continue;
      if (step_axis(solid, result.feet, axis, share(motion[axis], step, steps))) {
        result.blocked[axis] = motion[axis] > 0 ? 1 : -1;
      }
    }
  }
  return result;
}

SweepResult climb_box(const SolidQuery& solid, const LatticePos& feet, const LatticePos& motion) {
  const SweepResult plain = sweep_box(solid, feet, motion);
  if (plain.blocked.x == 0 && plain.blocked.z == 0) return plain;
  const SweepResult up = sweep_box(solid, feet, {0, kLatticeBlock, 0});
  const SweepResult across = sweep_box(solid, up.feet, {motion.x, 0, motion.z});
  const SweepResult down = sweep_box(
      solid, across.feet, {0, feet.y - up.feet.y + std::min<std::int64_t>(0, motion.y), 0});
  const auto way = [&](const LatticePos& to) {
    return std::abs(to.x - feet.x) + std::abs(to.z - feet.z);
  };
  // A step that wins nothing sideways is none; nor is one that ends in the air.
  if (down.blocked.y >= 0 || way(down.feet) <= way(plain.feet)) return plain;
  return {down.feet, {across.blocked.x, -1, across.blocked.z}};
}

LatticePos keep_on_edge(const SolidQuery& solid, const LatticePos& feet, LatticePos motion) {
  LatticePos at = feet;
  for (const int axis : {0, 2}) {
    const auto holds = [&](std::int64_t distance) {
      LatticePos there = at;
      there[axis] += distance;
      return is_supported(solid, there);
    };
    if (!holds(motion[axis])) {
      // Between 0, where one stands, and all of it. A tick's motion is far shorter than a voxel, so
      // that there is one edge between.
      std::int64_t good = 0, bad = motion[axis];
      while (std::abs(bad - good) > 1) {
        const std::int64_t middle = good + (bad - good) / 2;
        (holds(middle) ? good : bad) = middle;
      }
      motion[axis] = good;
    }
    at[axis] += motion[axis];
  }
  return motion;
}

bool push_out(const SolidQuery& solid, LatticePos& feet, int max_rise) {
  const Box box = box_at(feet);
  LatticePos best = feet;
  std::int64_t best_distance = 2 * kLatticeBlock;
  for (int axis = 0; axis < 3; ++axis) {
    for (int beyond = 0; beyond < 2; ++beyond) {
      LatticePos up = feet, down = feet;
      up[axis] +=
          (lower_voxel(box.min[axis]) + 1 + beyond) * kLatticeBlock + kContactGap - box.min[axis];
      down[axis] +=
          (upper_voxel(box.max[axis]) - beyond) * kLatticeBlock - kContactGap - box.max[axis];
      for (const LatticePos& candidate : {up, down}) {
        const std::int64_t distance = longest_axis(candidate - feet);
        if (distance >= best_distance || box_overlaps(solid, candidate)) continue;
        best = candidate;
        best_distance = distance;
      }
    }
  }
  for (int rise = 2; best == feet && rise <= max_rise; ++rise) {
    const LatticePos candidate{feet.x, (lower_voxel(feet.y) + rise) * kLatticeBlock + kContactGap,
                               feet.z};
    if (!box_overlaps(solid, candidate)) best = candidate;
  }
  const bool found = best != feet;
  feet = best;
  return found;
}

}  // namespace skerry::game
