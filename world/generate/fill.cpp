#include "world/generate/fill.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "world/generate/plants.h"
#include "world/generate/sideways.h"

namespace skerry::world {
namespace {

constexpr int kPadded = kChunkEdge + 2;
constexpr int kLayer = kPadded * kPadded;
// Layers read above the chunk: they say how deep below the turf it starts.
constexpr int kLookAbove = 6;
constexpr int kLookBelow = 1;  // what the lowest layer's plants stand on

using Row = std::array<std::int16_t, kLayer>;

/// A column whose rock is shifted sideways layer by layer.
struct Ragged {
  std::int16_t at;    // index in the layer
  std::int16_t x, z;  // blocks
  Columns::Reach reach;
};

/// Fills one padded chunk of level 0, layer by layer from above: whole layers are plain loops over
/// 66 x 66 values that vectorise.
class Filler {
 public:
  Filler(const IslandPlan& plan, IVec3 chunk, std::span<BlockId> out);
  void fill();

 private:
  void gather();
  void shift_rock(int y);
  template <class F>
  void for_ball_voxels(const std::vector<Ball>& balls, int y, F&& f);
  void solid_layer(int y);
  void paint_layer(int y, BlockId* out);
  void ores();
  void plants();

  const IslandPlan& plan_;
  const Columns& columns_;
  Canvas canvas_;
  std::span<BlockId> out_;
  int low_ = Columns::kNoRock, high_ = Columns::kNoGround;
  Row top_, bottom_, water_, roof_, cover_, skin_top_, skin_below_, below_depth_, top_depth_,
      depth_, solid_, carved_, layer_;
  std::array<std::int16_t, kLayer> rock_;
  std::array<BlockId, kLayer> ground_below_;  // the layer under out
  std::vector<Ragged> ragged_;
  std::vector<Ball> solids_, holes_;
  std::vector<sideways::Shift> corners_;
};

Filler::Filler(const IslandPlan& plan, IVec3 chunk, std::span<BlockId> out)
    : plan_(plan),
      columns_(plan.columns),
      canvas_{chunk.x * kChunkEdge - 1, chunk.y * kChunkEdge - 1, chunk.z * kChunkEdge - 1, 0, out},
      out_(out) {
  const int x = canvas_.x0, y = canvas_.y0, z = canvas_.z0;
  const auto near = [&](const Ball& b) {
    return b.x + b.radius >= x && b.x - b.radius < x + kPadded && b.z + b.radius >= z &&
           b.z - b.radius < z + kPadded && b.y + b.radius >= y - kLookBelow &&
           b.y - b.radius < y + kPadded + kLookAbove;
  };
  std::copy_if(plan.solids.begin(), plan.solids.end(), std::back_inserter(solids_), near);
  std::copy_if(plan.holes.begin(), plan.holes.end(), std::back_inserter(holes_), near);
}

void Filler::gather() {
  int at = 0;
  for (int i = 0; i < kPadded; ++i) {
    const int x = canvas_.x0 + i;
    for (int k = 0; k < kPadded; ++k, ++at) {
      const int z = canvas_.z0 + k;
      if (!columns_.has(x, z)) {
        top_[at] = Columns::kNoGround;
        bottom_[at] = Columns::kNoRock;
        water_[at] = Columns::kDry;
        roof_[at] = cover_[at] = Columns::kNoGround;
        skin_top_[at] = skin_below_[at] = below_depth_[at] = top_depth_[at] = 0;
        continue;
      }
      const std::size_t c = columns_.index(x, z);
      const Skin& cover = kSkins[static_cast<std::size_t>(columns_.skins[c])];
      top_[at] = columns_.top[c];
      bottom_[at] = columns_.bottom[c];
      water_[at] = columns_.water[c];
      roof_[at] = static_cast<std::int16_t>(plan_.roof_of(kOpenHole, c));
      cover_[at] = static_cast<std::int16_t>(plan_.roof_of(kClosedHole, c));
      skin_top_[at] = static_cast<std::int16_t>(cover.top);
      skin_below_[at] = static_cast<std::int16_t>(cover.below);
      // Depth 1 is the top; bare rock has neither top nor turf.
      const bool bare = columns_.skins[c] == SkinId::kBare;
      top_depth_[at] = bare ? 0 : 1;
      below_depth_[at] = static_cast<std::int16_t>(bare ? 0 : 1 + cover.below_depth);
      low_ = std::min<int>(low_, bottom_[at]);
      high_ = std::max<int>(high_, std::max(top_[at], water_[at]));
      if (columns_.ragged[c] > 0) {
        ragged_.push_back({static_cast<std::int16_t>(at), static_cast<std::int16_t>(x),
                           static_cast<std::int16_t>(z), columns_.reach_at(x, z)});
        low_ = std::min<int>(low_, ragged_.back().reach.bottom);
        high_ = std::max<int>(high_, ragged_.back().reach.top);
      }
    }
  }
  for (const Ball& b : solids_) {
    low_ = std::min(low_, b.y - b.radius);
    high_ = std::max(high_, b.y + b.radius + 1);
  }
  depth_.fill(0);
  carved_.fill(0);
}

/// Rock of the ragged columns in the layer at block height y.
void Filler::shift_rock(int y) {
  if (ragged_.empty()) return;
  const int cx0 = sideways::floor_to(canvas_.x0, sideways::kCell);
  const int cz0 = sideways::floor_to(canvas_.z0, sideways::kCell);
  const int edge = kPadded / sideways::kCell + 3;
  corners_.resize(static_cast<std::size_t>(edge) * edge);
  for (int i = 0; i < edge; ++i) {
    for (int k = 0; k < edge; ++k) {
      corners_[static_cast<std::size_t>(i) * edge + k] =
          sideways::corner(plan_.shift_seed(), cx0 + i, y, cz0 + k);
    }
  }
  for (const Ragged& r : ragged_) {
    if (y >= r.reach.top || y < r.reach.bottom ||
        (y >= r.reach.core_bottom && y < r.reach.core_top)) {
      continue;
    }
    const int i = sideways::floor_to(r.x, sideways::kCell);
    const int k = sideways::floor_to(r.z, sideways::kCell);
    const sideways::Shift* c = &corners_[static_cast<std::size_t>(i - cx0) * edge + (k - cz0)];
    const sideways::Shift shift = sideways::between(
        c[0], c[edge], c[1], c[edge + 1], r.x - i * sideways::kCell, r.z - k * sideways::kCell);
    const std::size_t from =
        columns_.shifted_index(r.x, r.z, columns_.index(r.x, r.z), shift.x, shift.z);
    // The turf comes along with the rock, and only with its upper end: ledges below an overhang are
    // bare.
    const Skin& cover = kSkins[static_cast<std::size_t>(columns_.skins[from])];
    const bool turf = columns_.skins[from] != SkinId::kBare && y >= columns_.top[from] - kLedgeTurf;
    skin_top_[r.at] = static_cast<std::int16_t>(cover.top);
    skin_below_[r.at] = static_cast<std::int16_t>(cover.below);
    top_depth_[r.at] = turf ? 1 : 0;
    below_depth_[r.at] = static_cast<std::int16_t>(turf ? 1 + cover.below_depth : 0);
    solid_[r.at] = y >= columns_.bottom[from] && y < columns_.top[from] ? -1 : 0;
    // Bands follow the shift, so that strata undulate along a cliff.
    rock_[r.at] = static_cast<std::int16_t>(
        plan_.bands[static_cast<std::size_t>((y + (shift.x >> 10)) & (kBandPeriod - 1))]);
  }
}

/// Calls f(ball, first, last) with index ranges of the layer at block height y that lie in some
/// ball.
template <class F>
void Filler::for_ball_voxels(const std::vector<Ball>& balls, int y, F&& f) {
  for (const Ball& b : balls) {
    const int dy = y - b.y;
    const int flat = b.radius * b.radius - dy * dy;
    if (flat <= 0 || y < b.floor) continue;
    for (int i = 0; i < kPadded; ++i) {
      const int dx = canvas_.x0 + i - b.x;
      const int rest = flat - dx * dx;
      if (rest <= 0) continue;
      const int reach = static_cast<int>(
          noise::isqrt(static_cast<std::uint64_t>(rest - 1)));  // largest |dz| with dz^2 < rest
      const int first = std::max(0, b.z - reach - canvas_.z0);
      const int last = std::min(kPadded - 1, b.z + reach - canvas_.z0);
      if (first <= last) f(b, i * kPadded + first, i * kPadded + last);
    }
  }
}

void Filler::solid_layer(int y) {
  const auto height = static_cast<std::int16_t>(y);
  for (int i = 0; i < kLayer; ++i) {
    solid_[i] = select(height < top_[i], select(height >= bottom_[i], -1, 0), 0);
  }
  shift_rock(y);
  for_ball_voxels(solids_, y, [this](const Ball&, int first, int last) {
    for (int i = first; i <= last; ++i) solid_[i] = -1;
  });
  for_ball_voxels(holes_, y, [this, y](const Ball& hole, int first, int last) {
    for (int i = first; i <= last; ++i) {
      const int roof = hole.open ? roof_[i] : cover_[i];
      const bool dug = y < roof && (solid_[i] != 0 || y < top_[i]);
      if (!dug) continue;
      solid_[i] = 0;
      carved_[i] = kUnderground;
    }
  });
}

/// Advances the depth below open air and turns it into blocks. No branch on data: the loops must
/// vectorise.
/// @param out the layer's voxels, or null above the chunk.
void Filler::paint_layer(int y, BlockId* out) {
  const auto height = static_cast<std::int16_t>(y);
  for (int i = 0; i < kLayer; ++i) {
    const auto deeper = static_cast<std::int16_t>(std::min<std::int16_t>(depth_[i], kDeepest) + 1);
    depth_[i] = static_cast<std::int16_t>((deeper & solid_[i]) | (carved_[i] & ~solid_[i]));
  }
  if (out != nullptr) {
    const auto liquid = static_cast<std::int16_t>(plan_.biome().liquid);
    for (int i = 0; i < kLayer; ++i) {
      const std::int16_t depth = depth_[i];
      const std::int16_t below = select(depth <= below_depth_[i], skin_below_[i], rock_[i]);
      const std::int16_t block = select(depth <= top_depth_[i], skin_top_[i], below);
      const std::int16_t open = select(height < water_[i], select(height >= top_[i], liquid, 0), 0);
      layer_[i] = static_cast<std::int16_t>((block & solid_[i]) | (open & ~solid_[i]));
    }
    std::memcpy(out, layer_.data(), sizeof(layer_));
  }
  if (!holes_.empty()) carved_.fill(0);
}

void Filler::fill() {
  gather();
  for (int j = kPadded - 1 + kLookAbove; j >= -kLookBelow; --j) {
    const int y = canvas_.y0 + j;
    BlockId* out = j >= kPadded ? nullptr
                   : j < 0      ? ground_below_.data()
                                : &out_[static_cast<std::size_t>(j) * kLayer];
    if (y >= high_ || y < low_) {
      if (out != nullptr) std::fill_n(out, kLayer, kAir);
      continue;
    }
    rock_.fill(
        static_cast<std::int16_t>(plan_.bands[static_cast<std::size_t>(y & (kBandPeriod - 1))]));
    solid_layer(y);
    paint_layer(y, out);
  }
  ores();
  for (const Stamp& s : plan_.stamps) {
    BlockId* voxel = canvas_.find(s.x, s.y, s.z);
    if (voxel != nullptr && (*voxel == kAir) == s.into_air) *voxel = s.id;
  }
  for (const Tree& tree : plan_.trees) draw_tree(tree, canvas_);
  plants();
}

/// Small lumps of ore in the rock, richer with depth.
void Filler::ores() {
  constexpr int kCell = 16;
  constexpr int kReach = 2;
  const auto& rocks = plan_.biome().rock;
  const auto first = [](int at) { return sideways::floor_to(at - kReach, kCell); };
  for (int cy = first(canvas_.y0); cy <= first(canvas_.y0 + kPadded) + 1; ++cy) {
    for (int cx = first(canvas_.x0); cx <= first(canvas_.x0 + kPadded) + 1; ++cx) {
      for (int cz = first(canvas_.z0); cz <= first(canvas_.z0 + kPadded) + 1; ++cz) {
        Rng rng(hash3(plan_.shape.seed + 701, cx, cy, cz));
        if (!rng.chance(90)) continue;
        const int x0 = cx * kCell + rng.in(0, kCell - 1);
        const int y0 = cy * kCell + rng.in(0, kCell - 1);
        const int z0 = cz * kCell + rng.in(0, kCell - 1);
        const int rarity = rng.in(0, 99) + std::clamp(-y0 / 4, 0, 30);
        const BlockId ore = rarity < 40    ? block::kCoalOre
                            : rarity < 68  ? block::kIronOre
                            : rarity < 88  ? block::kCopperOre
                            : rarity < 108 ? block::kGoldOre
                                           : block::kCrystalOre;
        for (int k = rng.in(4, 12); k > 0; --k) {
          const int x = x0 + rng.in(-1, kReach - 1);
          const int y = y0 + rng.in(-1, 1);
          const int z = z0 + rng.in(-1, kReach - 1);
          BlockId* voxel = canvas_.find(x, y, z);
          if (voxel != nullptr && std::find(rocks.begin(), rocks.end(), *voxel) != rocks.end())
            *voxel = ore;
        }
      }
    }
  }
}

/// Grass, flowers and reeds on open ground.
void Filler::plants() {
  for (int i = 0; i < kLayer; ++i) {
    const int y = top_[i] - canvas_.y0;
    if (y < 0 || y >= kPadded) continue;
    BlockId& voxel = out_[static_cast<std::size_t>(y) * kLayer + i];
    const BlockId ground = y > 0 ? out_[static_cast<std::size_t>(y - 1) * kLayer + i]
                                 : ground_below_[static_cast<std::size_t>(i)];
    if (voxel == kAir)
      voxel = plant_on(plan_, ground, canvas_.x0 + i / kPadded, canvas_.z0 + i % kPadded);
  }
}

/// Whether a chunk is plainly outside of all that a plan holds.
bool apart(const IslandPlan& plan, IVec3 chunk, int level) {
  const int reach = plan.columns.half, size = kPadded << level;
  const auto low = [level](std::int32_t at) { return (at * kChunkEdge - 1) * (1 << level); };
  const auto beside = [&](int first) { return first >= reach || first + size <= -reach; };
  return low(chunk.y) >= plan.highest || low(chunk.y) + size <= plan.lowest ||
         beside(low(chunk.x)) || beside(low(chunk.z));
}

}  // namespace

void fill_fine(const IslandPlan& plan, IVec3 chunk, std::span<BlockId> out) {
  Filler(plan, chunk, out).fill();
}

bool fill_padded(const IslandPlan& plan, IVec3 chunk, int level, std::span<BlockId> out) {
  if (apart(plan, chunk, level)) {
    std::fill(out.begin(), out.end(), kAir);
    return false;
  }
  if (level == 0)
    fill_fine(plan, chunk, out);
  else
    fill_coarse(plan, chunk, level, out);
  return std::any_of(out.begin(), out.end(), [](BlockId id) { return id != kAir; });
}

}  // namespace skerry::world
