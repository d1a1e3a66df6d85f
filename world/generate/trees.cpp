#include "world/generate/trees.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "world/generate/noise.h"
#include "world/voxel/coords.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr int kPadded = 66;

BlockId trunk_of(TreeKind kind) {
  switch (kind) {
    case TreeKind::kBirch:
      return block::kBirchLog;
    case TreeKind::kPine:
      return block::kPineLog;
    case TreeKind::kPalm:
      return block::kPalmLog;
    case TreeKind::kWillow:
      return block::kWillowLog;
    case TreeKind::kShroomRed:
    case TreeKind::kShroomGlow:
      return block::kMushroomStem;
    default:
      return block::kOakLog;
  }
}

BlockId crown_of(TreeKind kind) {
  switch (kind) {
    case TreeKind::kBirch:
      return block::kBirchLeaves;
    case TreeKind::kPine:
      return block::kPineLeaves;
    case TreeKind::kPalm:
      return block::kPalmLeaves;
    case TreeKind::kWillow:
      return block::kWillowLeaves;
    case TreeKind::kBlossom:
      return block::kBlossomLeaves;
    case TreeKind::kAutumn:
      return block::kAutumnLeaves;
    case TreeKind::kShroomRed:
      return block::kMushroomCapRed;
    case TreeKind::kShroomGlow:
      return block::kMushroomCapGlow;
    default:
      return block::kOakLeaves;
  }
}

bool yields(BlockId id) {
  return id == kAir || block_kind(id) == BlockKind::kPlant;
}

/// Where the voxels of level 0 go: leaves take air only, logs also replace leaves and plants.
class FineTarget {
 public:
  FineTarget(const Tree& tree, const Canvas& canvas)
      : canvas_(canvas), leaf_(crown_of(tree.kind)), log_(trunk_of(tree.kind)) {}

  int sample_level() const { return 0; }
  IVec3 low() const { return {canvas_.x0, canvas_.y0, canvas_.z0}; }
  IVec3 high() const {
    return {canvas_.x0 + kPadded - 1, canvas_.y0 + kPadded - 1, canvas_.z0 + kPadded - 1};
  }
  void leaf(int x, int y, int z) {
    BlockId* voxel = canvas_.find(x, y, z);
    if (yields(*voxel)) *voxel = leaf_;
  }
  void log(int x, int y, int z) {
    BlockId* voxel = canvas_.find(x, y, z);
    if (voxel != nullptr && (yields(*voxel) || *voxel == leaf_)) *voxel = log_;
  }

 private:
  const Canvas& canvas_;
  BlockId leaf_, log_;
};

/// What fills the voxels of a coarse level: each is looked at in 2 x 2 x 2 places, one bit each.
class CoarseTarget {
 public:
  CoarseTarget(const Tree& tree, const Canvas& canvas)
      : tree_(tree),
        canvas_(canvas),
        low_{(tree.x - kTreeReach) >> canvas.level, tree.y >> canvas.level,
             (tree.z - kTreeReach) >> canvas.level},
        count_{((tree.x + kTreeReach) >> canvas.level) - low_.x + 1,
               ((tree.y + kTreeHeight) >> canvas.level) - low_.y + 1,
               ((tree.z + kTreeReach) >> canvas.level) - low_.z + 1} {}

  int sample_level() const { return canvas_.level - 1; }
  IVec3 low() const { return {2 * low_.x, 2 * low_.y, 2 * low_.z}; }
  IVec3 high() const {
    return {2 * (low_.x + count_.x) - 1, 2 * (low_.y + count_.y) - 1, 2 * (low_.z + count_.z) - 1};
  }
  void leaf(int x, int y, int z) { mark(leaves_, x, y, z); }
  /// Of the first coarse level alone: beyond it a trunk is thinner than a quarter of a voxel.
  void log(int x, int y, int z) {
    if (canvas_.level == 1) mark(logs_, x, y, z);
  }

  /// As many voxels of leaves as the crown has, the fullest ones; what a voxel is too much or too
  /// little for the crown is left to chance. Where the trunk is bare it is drawn as thick as a
  /// voxel.
  void put() {
    std::array<int, 9> voxels_with{};  // by leaves of eight
    int leaves = 0;
    for (int i = 0; i < size(); ++i) {
      const int of_eight = std::popcount(leaves_[static_cast<std::size_t>(i)]);
      ++voxels_with[static_cast<std::size_t>(of_eight)];
      leaves += of_eight;
    }
    int left = (leaves + static_cast<int>(mix32(tree_.seed) >> 29)) / 8;
    int least = 8;
    while (least > 0 && voxels_with[static_cast<std::size_t>(least)] <= left)
      left -= voxels_with[static_cast<std::size_t>(least--)];
    // Of the voxels that are as full as the last one, every few: `left` of them.
    const int of = voxels_with[static_cast<std::size_t>(least)];
    int at = of / 2;
    for (int i = 0; i < size(); ++i) {
      const int of_eight = std::popcount(leaves_[static_cast<std::size_t>(i)]);
      bool taken = of_eight > least;
      if (of_eight == least && of_eight > 0) {
        at += left;
        taken = at >= of;
        if (taken) at -= of;
      }
      if (taken)
        put(i, crown_of(tree_.kind));
      else if (logs_[static_cast<std::size_t>(i)] != 0)
        put(i, trunk_of(tree_.kind));
    }
  }

 private:
  // Of level 1, the finest one.
  static constexpr int kWide = kTreeReach + 2, kHigh = kTreeHeight / 2 + 2;
  using Masks = std::array<std::uint8_t, std::size_t{kWide} * kWide * kHigh>;

  int size() const { return count_.x * count_.y * count_.z; }
  void mark(Masks& masks, int x, int y, int z) const {
    const int i = ((y >> 1) - low_.y) * count_.x * count_.z + ((x >> 1) - low_.x) * count_.z +
                  ((z >> 1) - low_.z);
    std::uint8_t& mask = masks[static_cast<std::size_t>(i)];
    mask = static_cast<std::uint8_t>(mask | 1u << ((x & 1) | (y & 1) << 1 | (z & 1) << 2));
  }
  void put(int i, BlockId id) const {
    BlockId* voxel = canvas_.find(low_.x + i / count_.z % count_.x,
                                  low_.y + i / (count_.x * count_.z), low_.z + i % count_.z);
    if (voxel != nullptr && yields(*voxel)) *voxel = id;
  }

  const Tree& tree_;
  const Canvas& canvas_;
  const IVec3 low_, count_;  // coarse voxels
  Masks leaves_{}, logs_{};
};

/// Draws one tree at any level: a shape is asked at the centres of samples, in half blocks.
template <class Target>
class Painter {
 public:
  Painter(const Tree& tree, Target& target) : tree_(tree), target_(target) {}

  /// Calls shape(dx, dy, dz) with half blocks from the trunk's lowest voxel's centre; true is a
  /// leaf.
  template <class Shape>
  void fill(int reach, int low, int high, Shape&& shape) const {
    const int level = target_.sample_level();
    const int size = 1 << level;
    const IVec3 first = target_.low(), last = target_.high();
    const int x_end = std::min((tree_.x + reach) >> level, last.x);
    const int y_end = std::min((tree_.y + high) >> level, last.y);
    const int z_end = std::min((tree_.z + reach) >> level, last.z);
    const auto centre = [level, size](int voxel, int block) {
      return 2 * ((voxel << level) - block) + size - 1;
    };
    for (int y = std::max((tree_.y + low) >> level, first.y); y <= y_end; ++y) {
      for (int x = std::max((tree_.x - reach) >> level, first.x); x <= x_end; ++x) {
        for (int z = std::max((tree_.z - reach) >> level, first.z); z <= z_end; ++z) {
          if (shape(centre(x, tree_.x), centre(y, tree_.y), centre(z, tree_.z)))
            target_.leaf(x, y, z);
        }
      }
    }
  }

  /// An ellipsoid around (cx, cy, cz) blocks from the foot, with a rough shell.
  void ball(int cx, int cy, int cz, int rx, int ry) const {
    const int ax = 2 * rx + 1;
    const int ay = 2 * ry + 1;
    const int reach = rx + std::max(std::abs(cx), std::abs(cz)) + 1;
    fill(reach, cy - ry - 1, cy + ry + 1, [&](int x, int y, int z) {
      const int dx = x - 2 * cx;
      const int dy = y - 2 * cy;
      const int dz = z - 2 * cz;
      const int squared = (dx * dx + dz * dz) * 256 / (ax * ax) + dy * dy * 256 / (ay * ay);
      return squared < 256 - roughness(x, y, z, 84);
    });
  }

  /// Up to `most`, by sample.
  int roughness(int x, int y, int z, int most) const {
    return static_cast<int>(hash3(tree_.seed, x, y, z) >> 24) * most / 256;
  }

  void log(int dx, int dy, int dz) const { target_.log(tree_.x + dx, tree_.y + dy, tree_.z + dz); }

  void trunk(int height) const {
    for (int y = 0; y < height; ++y) log(0, y, 0);
  }

 private:
  const Tree& tree_;
  Target& target_;
};

/// Several overlapping balls on a trunk, with visible limbs.
template <class Target>
void draw_broadleaf(const Tree& tree, const Painter<Target>& paint) {
  const int h = tree.height;
  const int r = tree.spread;
  Rng rng(tree.seed);
  const int limbs = r >= 4 ? rng.in(3, 5) : 2;
  const int start = rng.in(0, 1023);
  paint.ball(0, h + r / 3, 0, r * 3 / 4, std::max(2, r * 2 / 3));
  for (int i = 0; i < limbs; ++i) {
    const int direction = start + i * 1024 / limbs + rng.in(-60, 60);
    const int out = r * 5 / 8;
    const int x = out * noise::cosine(direction) / noise::kOne12;
    const int z = out * noise::sine(direction) / noise::kOne12;
    const int y = h - rng.in(0, 2);
    paint.ball(x, y, z, std::max(2, r * 9 / 16), std::max(2, r * 7 / 16));
    for (int k = 1; k <= out; ++k) paint.log(x * k / out, y - 1 - (out - k) / 2, z * k / out);
  }
  paint.trunk(h + r / 3);
}

template <class Target>
void draw_birch(const Tree& tree, const Painter<Target>& paint) {
  const int r = tree.spread;
  paint.ball(0, tree.height - 1, 0, r, r * 2);
  paint.ball(0, tree.height + r - 1, 0, std::max(1, r - 1), r + 1);
  paint.trunk(tree.height + 1);
}

/// Whorls of branches: the radius grows downwards in a saw-tooth.
template <class Target>
void draw_pine(const Tree& tree, const Painter<Target>& paint) {
  const int tip = tree.height + 2;
  const int foot = std::max(2, tree.height / 5);
  const int r = tree.spread;
  paint.fill(r + 1, foot, tip, [&](int x, int y, int z) {
    const int below_tip = 2 * tip - y;
    if (below_tip < 0 || y < 2 * foot) return false;
    const int whorl = (below_tip % 7) - 2;
    const int reach = below_tip * (2 * r + 1) / (2 * (tip - foot)) + whorl / 2 + 1;
    return x * x + z * z <= reach * reach - paint.roughness(x, y, z, reach * 2);
  });
  paint.trunk(tree.height + 1);
}

/// A leaning trunk with eight drooping fronds.
template <class Target>
void draw_palm(const Tree& tree, const Painter<Target>& paint) {
  Rng rng(tree.seed);
  const int h = tree.height;
  const int lean = rng.in(0, 1023);
  const int bend = rng.in(1, 3);
  const auto lean_at = [&](int y, int part) { return bend * part * y / h * y / h / noise::kOne12; };
  const int top_x = lean_at(h, noise::cosine(lean));
  const int top_z = lean_at(h, noise::sine(lean));
  for (int y = 0; y <= h; ++y) {
    const int x = lean_at(y, noise::cosine(lean));
    const int z = lean_at(y, noise::sine(lean));
    const int x_before = lean_at(y - 1, noise::cosine(lean));
    const int z_before = lean_at(y - 1, noise::sine(lean));
    paint.log(x, y, z);
    paint.log(x_before, y, z_before);  // where it leans over, logs meet face to face
    paint.log(x_before, y, z);
  }
  paint.ball(top_x, h + 1, top_z, 1, 0);
  const int r = tree.spread;
  paint.fill(kTreeReach, h - 3, h + 3, [&](int x, int y, int z) {
    const int dx = x - 2 * top_x;
    const int dz = z - 2 * top_z;
    const int d = noise::length(dx, dz);
    if (d > 2 * r + 1) return false;
    const int droop = 2 * h + 3 - d * d / (3 * r);  // half blocks
    if (std::abs(y - droop) > 2) return false;
    // On one of eight rays: along an axis or a diagonal.
    const int off_axis = std::min(std::abs(dx), std::abs(dz));
    const int off_diagonal = std::abs(std::abs(dx) - std::abs(dz));
    return off_axis <= 1 || off_diagonal <= 2 || d <= 3;
  });
}

/// A wide, flat crown from which strands hang.
template <class Target>
void draw_willow(const Tree& tree, const Painter<Target>& paint) {
  const int h = tree.height;
  const int r = tree.spread;
  paint.ball(0, h, 0, r, std::max(2, r / 2));
  paint.ball(0, h + 1, 0, r * 2 / 3, std::max(2, r * 2 / 3));
  paint.fill(r, 1, h, [&](int x, int y, int z) {
    const int d2 = x * x + z * z;
    const int outer = 2 * r + 1;
    const int inner = r + 2;
    if (d2 > outer * outer || d2 < inner * inner) return false;
    const std::uint32_t strand = hash2(tree.seed, x, z);
    return (strand & 3) != 0 && y > 2 * h - 2 * static_cast<int>(strand >> 8) % (2 * (h - 2)) - 2;
  });
  for (int i = 0; i < 4; ++i) {
    const int dx = i < 2 ? 2 * i - 1 : 0;
    const int dz = i < 2 ? 0 : 2 * i - 5;
    for (int k = 1; k <= r / 2; ++k) paint.log(dx * k, h - 1 - (r / 2 - k) / 2, dz * k);
  }
  paint.trunk(h + 1);
}

/// A giant mushroom: a dome, hollow below.
template <class Target>
void draw_shroom(const Tree& tree, const Painter<Target>& paint) {
  const int h = tree.height;
  const int r = tree.spread;
  const int rise = tree.kind == TreeKind::kShroomRed ? r : std::max(2, r * 2 / 3);
  paint.fill(r + 1, h - 2, h + rise + 1, [&](int x, int y, int z) {
    const int dy = y - 2 * (h - 1);
    if (dy < -1) return false;
    const auto inside = [&](int rx, int ry) {
      return (x * x + z * z) * 64 / std::max(1, rx * rx) + dy * dy * 64 / std::max(1, ry * ry) < 64;
    };
    return inside(2 * r + 1, 2 * rise + 1) && !inside(2 * r - 2, 2 * rise - 2);
  });
  paint.trunk(h + rise - 1);
}

template <class Target>
void draw_shape(const Tree& tree, Target& target) {
  const Painter<Target> paint(tree, target);
  switch (tree.kind) {
    case TreeKind::kBirch:
      return draw_birch(tree, paint);
    case TreeKind::kPine:
      return draw_pine(tree, paint);
    case TreeKind::kPalm:
      return draw_palm(tree, paint);
    case TreeKind::kWillow:
      return draw_willow(tree, paint);
    case TreeKind::kShroomRed:
    case TreeKind::kShroomGlow:
      return draw_shroom(tree, paint);
    default:
      return draw_broadleaf(tree, paint);
  }
}

}  // namespace

BlockId* Canvas::find(int x, int y, int z) const {
  const auto dx = static_cast<unsigned>(x - x0);
  const auto dy = static_cast<unsigned>(y - y0);
  const auto dz = static_cast<unsigned>(z - z0);
  if (dx >= kPadded || dy >= kPadded || dz >= kPadded) return nullptr;
  return &out[dz + kPadded * dx + kPadded * kPadded * dy];
}

Tree grown(TreeKind kind, std::uint32_t seed) {
  struct Size {
    int height_low, height_high, spread_low, spread_high;
  };
  static constexpr Size kSizes[] = {{4, 8, 3, 6},  {7, 11, 2, 2}, {9, 20, 2, 5},
                                    {6, 11, 4, 5}, {5, 8, 4, 6},  {4, 7, 3, 6},
                                    {5, 9, 3, 6},  {5, 12, 3, 6}, {4, 10, 3, 5}};
  static_assert(std::size(kSizes) == static_cast<std::size_t>(TreeKind::kCount));
  const Size& size = kSizes[static_cast<std::size_t>(kind)];
  Rng rng(seed);
  const int vigour = rng.in(0, 255);  // tall trees are broad
  const auto between = [&](int low, int high) {
    return static_cast<std::uint8_t>(low + ((high - low) * vigour + rng.in(0, 255)) / 256);
  };
  Tree tree{};
  tree.kind = kind;
  tree.height = between(size.height_low, size.height_high);
  tree.spread = between(size.spread_low, size.spread_high);
  tree.seed = static_cast<std::uint32_t>(rng.next());
  return tree;
}

void draw_tree(const Tree& tree, const Canvas& canvas) {
  const auto apart = [&canvas](int at, int first, int low, int high) {
    const int size = 1 << canvas.level;
    return at + high < first * size || at - low >= (first + kPadded) * size;
  };
  if (apart(tree.x, canvas.x0, kTreeReach, kTreeReach) ||
      apart(tree.z, canvas.z0, kTreeReach, kTreeReach) ||
      apart(tree.y, canvas.y0, 0, kTreeHeight)) {
    return;
  }
  if (canvas.level == 0) {
    FineTarget target(tree, canvas);
    return draw_shape(tree, target);
  }
  CoarseTarget target(tree, canvas);
  draw_shape(tree, target);
  target.put();
}

}  // namespace skerry::world
