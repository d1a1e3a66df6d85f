#include "world/vdb_import/volume_field.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr int kBrickLog2 = 3;
constexpr int kTopLevel = 30 - kBrickLog2;  // one cube of it reaches as far as any index does
constexpr double kSnap = 1e-6;
// Along the side of a box whose samples are all looked at. Where a voxel is many blocks, bounds of
// whole bricks would settle next to nothing.
constexpr int kFewSamples = 4;

constexpr IVec3 shifted(IVec3 at, int bits) {
  return {at.x >> bits, at.y >> bits, at.z >> bits};
}

constexpr std::size_t index_in_brick(IVec3 at) {
  return static_cast<std::size_t>((at.z & 7) | ((at.y & 7) << 3) | ((at.x & 7) << 6));
}

std::int32_t clamped(double v) {
  constexpr double kFar = kMaxVolumeIndex;
  return static_cast<std::int32_t>(std::clamp(v, -kFar, kFar));
}

struct Split {
  std::int32_t whole;
  float part;
};

Split split(double v) {
  const double nearest = std::floor(v + 0.5);
  if (std::abs(v - nearest) < kSnap) return {clamped(nearest), 0.0f};
  const double low = std::floor(v);
  return {clamped(low), static_cast<float>(v - low)};
}

float mix(float a, float b, float t) {
  return a * (1.0f - t) + b * t;
}

}  // namespace

std::size_t VolumeField::Hash::operator()(const IVec3& key) const {
  return hash3(0, key.x, key.y, key.z);
}

VolumeField::VolumeField(const VolumeGrid& grid) : grid_(grid), nodes_(kTopLevel + 1) {
  bricks_.reserve(grid.bricks.size());
  for (const VolumeBrick& brick : grid.bricks) {
    bricks_.emplace(shifted(brick.origin, kBrickLog2), &brick);
    const auto [low, high] = std::minmax_element(brick.values.begin(), brick.values.end());
    nodes_[0].emplace(shifted(brick.origin, kBrickLog2), Range{*low, *high});
    widen_above(0, brick.origin, {*low, *high});
  }
  for (const VolumeTile& tile : grid.tiles) {
    const int log2 = std::countr_zero(static_cast<std::uint32_t>(tile.edge));
    const int level = log2 - kBrickLog2;
    auto found = std::find_if(tile_levels_.begin(), tile_levels_.end(),
                              [level](const TileLevel& t) { return t.level == level; });
    if (found == tile_levels_.end()) found = tile_levels_.insert(tile_levels_.end(), {level, {}});
    found->values.emplace(shifted(tile.origin, log2), tile.value);
    // Its own cube needs no node: where there is none, beside_bricks has the value.
    widen_above(level, tile.origin, {tile.value, tile.value});
  }
}

void VolumeField::widen_above(int level, IVec3 origin, Range range) {
  range.min = std::min(range.min, grid_.background);
  range.max = std::max(range.max, grid_.background);
  for (int up = level + 1; up <= kTopLevel; ++up) {
    const auto [node, fresh] = nodes_[up].emplace(shifted(origin, up + kBrickLog2), range);
    Range& whole = node->second;
    // Above a node that is wide enough already, all are.
    if (!fresh && whole.min <= range.min && whole.max >= range.max) return;
    whole.min = std::min(whole.min, range.min);
    whole.max = std::max(whole.max, range.max);
  }
}

const VolumeBrick* VolumeField::brick_at(IVec3 index) const {
  const auto found = bricks_.find(shifted(index, kBrickLog2));
  return found == bricks_.end() ? nullptr : found->second;
}

float VolumeField::beside_bricks(IVec3 index) const {
  for (const TileLevel& tiles : tile_levels_) {
    const auto found = tiles.values.find(shifted(index, tiles.level + kBrickLog2));
    if (found != tiles.values.end()) return found->second;
  }
  return grid_.background;
}

float VolumeField::at(IVec3 index) const {
  const VolumeBrick* brick = brick_at(index);
  return brick ? brick->values[index_in_brick(index)] : beside_bricks(index);
}

float VolumeField::nearest(glm::dvec3 place) const {
  return at({clamped(std::floor(place.x + 0.5)), clamped(std::floor(place.y + 0.5)),
             clamped(std::floor(place.z + 0.5))});
}

float VolumeField::interpolated(glm::dvec3 place) const {
  const Split x = split(place.x), y = split(place.y), z = split(place.z);
  const IVec3 low{x.whole, y.whole, z.whole};
  if (x.part == 0.0f && y.part == 0.0f && z.part == 0.0f) return at(low);
  const bool inside = (low.x & 7) < 7 && (low.y & 7) < 7 && (low.z & 7) < 7;
  const VolumeBrick* brick = inside ? brick_at(low) : nullptr;
  if (inside && !brick) return beside_bricks(low);
  const auto value = [&](int dx, int dy, int dz) {
    const IVec3 index{low.x + dx, low.y + dy, low.z + dz};
    return brick ? brick->values[index_in_brick(index)] : at(index);
  };
  const auto edge = [&](int dx, int dy) { return mix(value(dx, dy, 0), value(dx, dy, 1), z.part); };
  return mix(mix(edge(0, 0), edge(0, 1), y.part), mix(edge(1, 0), edge(1, 1), y.part), x.part);
}

VolumeField::Range VolumeField::node(int level, IVec3 key) const {
  if (const auto found = nodes_[level].find(key); found != nodes_[level].end())
    return found->second;
  const int bits = level + kBrickLog2;
  const float value = beside_bricks({key.x << bits, key.y << bits, key.z << bits});
  return {value, value};
}

VolumeField::Range VolumeField::range_of_samples(IVec3 low, IVec3 high) const {
  Range all{at(low), at(low)};
  for (std::int32_t x = low.x; x <= high.x; ++x) {
    for (std::int32_t y = low.y; y <= high.y; ++y) {
      for (std::int32_t z = low.z; z <= high.z; ++z) {
        const float one = at({x, y, z});
        all = {std::min(all.min, one), std::max(all.max, one)};
      }
    }
  }
  return all;
}

VolumeField::Range VolumeField::range(IVec3 low, IVec3 high) const {
  const auto side = [](std::int32_t from, std::int32_t to) { return std::int64_t{to} - from; };
  const std::int64_t extent =
      std::max({side(low.x, high.x), side(low.y, high.y), side(low.z, high.z), std::int64_t{1}});
  if (extent < kFewSamples) return range_of_samples(low, high);
  // The least cubes that are as long as the box: at most two a side then hold it.
  const int log2 = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(extent)));
  const int level = std::clamp(log2 - kBrickLog2, 0, kTopLevel);
  const IVec3 first = shifted(low, level + kBrickLog2);
  const IVec3 last = shifted(high, level + kBrickLog2);
  Range all = node(level, first);
  for (std::int32_t x = first.x; x <= last.x; ++x) {
    for (std::int32_t y = first.y; y <= last.y; ++y) {
      for (std::int32_t z = first.z; z <= last.z; ++z) {
        const Range one = node(level, {x, y, z});
        all = {std::min(all.min, one.min), std::max(all.max, one.max)};
      }
    }
  }
  return all;
}

}  // namespace skerry::world
