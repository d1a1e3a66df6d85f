#include "world/generate/far_island.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "engine/core/check.h"
#include "world/generate/columns.h"
#include "world/generate/design.h"
#include "world/mesh/face_axes.h"
#include "world/mesh/face_slice.h"
#include "world/voxel/voxel_source.h"

namespace skerry::world {
namespace {

using noise::kOne8;
using shared::Quad;

constexpr int kHalf = 32;       // voxels from the section's middle to its end
constexpr int kShoreLooks = 8;  // places that a lake's shore is looked at, each way around
constexpr BlockId kLikeWater = block::kIce;

/// What a design has at one place of the ground.
struct Sample {
  int bottom = 0, top = 0;
  BlockId cover = kAir;  ///< air: outside the outline
};

/// A design with what is worked out once an island.
class Design {
 public:
  Design(const IslandSpec& spec, int edge);
  Sample at(int x, int z) const;
  BlockId rock() const { return biome_.rock[0]; }
  int radius() const { return shape_.extent.radius; }

 private:
  struct Hung {
    Spike spike;
    int length;
  };
  int ground_at(int x, int z, Bend bend, int inside) const;
  int bottom_at(int x, int z, int inside) const;

  Shape shape_;
  const BiomeType& biome_;
  std::vector<ButteRise> rises_;
  std::vector<Hung> hung_;
  std::vector<Lake> lakes_;
};

Design::Design(const IslandSpec& spec, int edge)
    : shape_(shape_of(spec)), biome_(biome_type(shape_.biome)) {
  for (const Butte& butte : shape_.buttes) rises_.emplace_back(butte);
  const SpikeGrid large = spike_grids(shape_)[0];
  for_spikes(large, shape_.extent.radius, [&](const Spike& spike) {
    if (2 * spike.reach < edge) return;
    const int x8 = spike.x * kOne8, z8 = spike.z * kOne8;
    const int inside = inside_at(shape_, x8, z8, bend_at(shape_, x8, z8));
    if (inside < 3 * kOne8) return;
    const int bottom = -thickness_at(shape_, x8, z8, inside) / kOne8;
    hung_.push_back({spike, spike.length_at(bottom)});
  });
  for (Lake lake : shape_.lakes) {
    if (2 * lake.radius < edge) continue;
    const bool settled = settle(lake, kShoreLooks, [&](int x, int z) -> std::optional<int> {
      const int x8 = x * kOne8, z8 = z * kOne8;
      const Bend bend = bend_at(shape_, x8, z8);
      const int inside = inside_at(shape_, x8, z8, bend);
      if (inside < 3 * kOne8) return std::nullopt;
      return ground_at(x, z, bend, inside);
    });
    if (settled) lakes_.push_back(lake);
  }
}

/// Without lakes, Q8.
int Design::ground_at(int x, int z, Bend bend, int inside) const {
  int ground = shape_.rim * kOne8 + elevation_at(shape_, x * kOne8, z * kOne8, inside);
  for (const ButteRise& rise : rises_) ground += rise.at(x, z, bend);
  return ground;
}

int Design::bottom_at(int x, int z, int inside) const {
  int bottom = -thickness_at(shape_, x * kOne8, z * kOne8, inside) / kOne8;
  for (const Hung& hung : hung_) bottom -= hung.spike.depth_at(x, z, hung.length);
  return bottom;
}

Sample Design::at(int x, int z) const {
  const int x8 = x * kOne8, z8 = z * kOne8;
  const Bend bend = bend_at(shape_, x8, z8);
  const int inside = inside_at(shape_, x8, z8, bend);
  if (inside < 0) return {};
  LakeColumn column{ground_at(x, z, bend, inside), false, false};
  int water = Columns::kDry;
  for (const Lake& lake : lakes_) {
    dig_at(lake, x, z, bend, column);
    if (column.dug) water = lake.level;
    column.dug = false;
    if (!column.wet) water = Columns::kDry;
  }
  const Heights heights = heights_at(shape_, x, z, {column.ground, bottom_at(x, z, inside)});
  if (water > heights.top)
    return {heights.bottom, water, biome_.liquid == block::kWater ? kLikeWater : biome_.liquid};
  const SkinId skin = skin_at(shape_, {.x = x,
                                       .z = z,
                                       .bend = bend,
                                       .patch = patch_at(shape_, x8, z8),
                                       .height = heights.top,
                                       .inside = inside / kOne8,
                                       .wet = false,
                                       .steep = false,
                                       .shore = column.shore});
  const BlockId cover = kSkins[static_cast<std::size_t>(skin)].top;
  return {heights.bottom, heights.top, cover};
}

/// A column of voxels: its solid ones, bit y + kHalf, and what covers it.
struct VoxelColumn {
  std::uint64_t solid = 0;
  BlockId cover = kAir;
};

/// @param sample within the outline.
VoxelColumn column_of(const Sample& sample, int edge) {
  const auto first = static_cast<int>(floor_div(sample.bottom + edge / 2, edge)),
             end = std::max(first + 1, static_cast<int>(floor_div(sample.top + edge / 2, edge)));
  const std::uint64_t below_end = (std::uint64_t{1} << (end + kHalf)) - 1;
  return {below_end & ~((std::uint64_t{1} << (first + kHalf)) - 1), sample.cover};
}

/// The voxels of a section; columns index z + 64 x.
struct FarVoxels {
  std::array<VoxelColumn, std::size_t{4} * kHalf * kHalf> columns{};
  std::array<int, 3> low{2 * kHalf, 2 * kHalf, 2 * kHalf}, high{};  ///< box of the solid ones

  VoxelColumn& at(int x, int z) { return columns[static_cast<std::size_t>(z + 2 * kHalf * x)]; }
  const VoxelColumn& at(int x, int z) const {
    return columns[static_cast<std::size_t>(z + 2 * kHalf * x)];
  }
  bool solid(int x, int y, int z) const {
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= 2 * kHalf) return false;
    return (at(x, z).solid >> y & 1u) != 0;
  }
};

/// The first of parts x parts places of a column of voxels that lies within the outline.
Sample sample_of(const Design& design, int x, int z, int edge, int parts) {
  Sample sample;
  for (int i = 0; i < parts * parts && sample.cover == kAir; ++i)
    sample = design.at(x * edge + (2 * (i / parts) + 1) * edge / (2 * parts),
                       z * edge + (2 * (i % parts) + 1) * edge / (2 * parts));
  return sample;
}

void fill(const Design& design, int edge, int parts, FarVoxels& out) {
  const int reach = (design.radius() + edge - 1) / edge;
  for (int x = -reach; x < reach; ++x) {
    for (int z = -reach; z < reach; ++z) {
      const Sample sample = sample_of(design, x, z, edge, parts);
      if (sample.cover == kAir) continue;
      const VoxelColumn column = column_of(sample, edge);
      out.at(x + kHalf, z + kHalf) = column;
      const std::array<int, 3> first{x + kHalf, std::countr_zero(column.solid), z + kHalf},
          last{x + kHalf, 63 - std::countl_zero(column.solid), z + kHalf};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out.low[axis] = std::min(out.low[axis], first[axis]);
        out.high[axis] = std::max(out.high[axis], last[axis] + 1);
      }
    }
  }
}

/// The quads of one face direction.
void add_faces(const FarVoxels& voxels, std::uint32_t face, BlockId rock, FaceSlice& slice,
               std::vector<Quad>& out) {
  const auto [axis, u, v] = axes_of_face(face);
  const int beyond = face % 2 == 0 ? 1 : -1;
  std::array<int, 3> at{};
  for (at[axis] = voxels.low[axis]; at[axis] < voxels.high[axis]; ++at[axis]) {
    for (at[v] = voxels.low[v]; at[v] < voxels.high[v]; ++at[v]) {
      for (at[u] = voxels.low[u]; at[u] < voxels.high[u]; ++at[u]) {
        std::array<int, 3> other = at;
        other[axis] += beyond;
        if (!voxels.solid(at[0], at[1], at[2]) || voxels.solid(other[0], other[1], other[2]))
          continue;
        slice.set(at[u], at[v], face == 2 ? voxels.at(at[0], at[2]).cover : rock);
      }
    }
    slice.merge(face, at[axis], voxels.high[u], voxels.high[v], out);
  }
}

}  // namespace

int far_voxel_log2(const IslandSpec& spec, int level) {
  SKERRY_ASSERT(level >= kLevelCount && level < kLevelCount + 8);
  const int radius = spec.box_max.x - kBoxMargin;
  const int widest = std::min((radius << (level - kLevelCount)) / 3, radius * 3 / 4);
  const int coarsest = std::bit_width(static_cast<unsigned>(std::max(widest, 1))) - 1;
  return std::min(level - 1, coarsest);
}

void far_island(const IslandSpec& spec, int voxel_log2, ChunkMesh& out) {
  const int edge = 1 << voxel_log2;
  const Design design(spec, edge);
  SKERRY_ASSERT(spec.bounding_radius < static_cast<double>(kHalf * edge));
  FarVoxels voxels;
  // Of a thin bow or a ring, no voxel's middle may be within.
  for (int parts = 1; voxels.high[1] == 0 && parts <= edge; parts *= 2)
    fill(design, edge, parts, voxels);
  out.quads.clear();
  out.range_end = {};
  FaceSlice slice;
  for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
    if (range < shared::kFaceCount) add_faces(voxels, range, design.rock(), slice, out.quads);
    out.range_end[range] = static_cast<std::uint32_t>(out.quads.size());
  }
  out.bounds_min = out.bounds_max = {};
  if (out.quads.empty()) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.bounds_min[axis] = static_cast<std::uint8_t>(voxels.low[axis]);
    out.bounds_max[axis] = static_cast<std::uint8_t>(voxels.high[axis]);
  }
}

}  // namespace skerry::world
