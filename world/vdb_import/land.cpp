#include "world/vdb_import/land.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "world/generate/noise.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr int kSoil = 3;         // blocks of dirt under grass
constexpr int kNormalReach = 3;  // blocks around a voxel that decide its slope
constexpr int kApron = kSoil + kNormalReach;
constexpr int kEdge = kChunkEdge + 2 * kApron;
constexpr int kCell = 8, kCells = kChunkEdge / kCell;

// Upward component of the surface's normal, in 1/256: gentle ground bears grass, slopes bear poorer
// grass in patches, cliffs are bare.
constexpr int kGentle = 150, kSlope = 96;

constexpr std::int32_t kTallIsland = 140;  // blocks of height from which peaks are white

/// The solid voxels of a chunk and of an apron around it.
class Surroundings {
 public:
  Surroundings(const SolidMasks& masks, IVec3 chunk) : solid_(std::size_t{kEdge} * kEdge * kEdge) {
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        for (int z = -1; z <= 1; ++z) copy(masks, chunk, {x, y, z});
  }

  /// Chunk-local, -kApron .. 63 + kApron.
  bool at(int x, int y, int z) const { return solid_[index(x, y, z)] != 0; }

  /// Whether a cell of 8^3 and all that is within the apron's width of it is solid.
  bool deep(int cell_x, int cell_y, int cell_z) const {
    constexpr int kWidth = kCell + 2 * kApron;
    static constexpr std::array<std::uint8_t, kWidth> kFull = [] {
      std::array<std::uint8_t, kWidth> ones{};
      ones.fill(1);
      return ones;
    }();
    const int x0 = cell_x * kCell - kApron, y0 = cell_y * kCell - kApron;
    for (int y = y0; y < y0 + kWidth; ++y)
      for (int x = x0; x < x0 + kWidth; ++x)
        if (std::memcmp(&solid_[index(x, y, cell_z * kCell - kApron)], kFull.data(), kWidth) != 0)
          return false;
    return true;
  }

  bool exposed(int x, int y, int z) const {
    return !(at(x - 1, y, z) && at(x + 1, y, z) && at(x, y - 1, z) && at(x, y + 1, z) &&
             at(x, y, z - 1) && at(x, y, z + 1));
  }

  /// Upward component of the unit normal, in 1/256: away from where the solid voxels are.
  int steepness(int x, int y, int z) const {
    std::int64_t sum_x = 0, sum_y = 0, sum_z = 0;
    for (int dy = -kNormalReach; dy <= kNormalReach; ++dy) {
      for (int dx = -kNormalReach; dx <= kNormalReach; ++dx) {
        const std::uint8_t* row = &solid_[index(x + dx, y + dy, z - kNormalReach)];
        int count = 0;
        for (int k = 0; k < 2 * kNormalReach + 1; ++k) {
          count += row[k];
          sum_z += row[k] != 0 ? k - kNormalReach : 0;
        }
        sum_x += dx * count;
        sum_y += dy * count;
      }
    }
    const auto square = static_cast<std::uint64_t>(sum_x * sum_x + sum_y * sum_y + sum_z * sum_z);
    const std::int64_t length = std::max<std::int64_t>(1, noise::isqrt(square));
    return static_cast<int>(-sum_y * 256 / length);
  }

 private:
  static std::size_t index(int x, int y, int z) {
    return static_cast<std::size_t>((z + kApron) + kEdge * ((x + kApron) + kEdge * (y + kApron)));
  }

  struct Span {
    int first, last;  // chunk-local of the middle chunk, [first, last)
  };
  static Span span_of(int side) {
    if (side < 0) return {-kApron, 0};
    return side == 0 ? Span{0, kChunkEdge} : Span{kChunkEdge, kChunkEdge + kApron};
  }

  void copy(const SolidMasks& masks, IVec3 chunk, IVec3 side) {
    const auto found = masks.find({chunk.x + side.x, chunk.y + side.y, chunk.z + side.z});
    if (found == masks.end()) return;
    const Span xs = span_of(side.x), ys = span_of(side.y), zs = span_of(side.z);
    for (int y = ys.first; y < ys.last; ++y) {
      for (int x = xs.first; x < xs.last; ++x) {
        const std::uint64_t row = found->second.row(x & (kChunkEdge - 1), y & (kChunkEdge - 1));
        if (row == 0) continue;
        for (int z = zs.first; z < zs.last; ++z)
          solid_[index(x, y, z)] = static_cast<std::uint8_t>(row >> (z & (kChunkEdge - 1)) & 1);
      }
    }
  }

  std::vector<std::uint8_t> solid_;
};

/// What covers a column from one open voxel down.
struct Cover {
  BlockId top = block::kStone, below = block::kStone;
  bool meadow = false;  ///< bears plants
};

class Painter {
 public:
  Painter(const SolidMasks& masks, IVec3 chunk, const Land& land)
      : land_(land), around_(masks, chunk), voxels_(kChunkVoxels, kAir) {
    origin_ = {chunk.x * kChunkEdge, chunk.y * kChunkEdge, chunk.z * kChunkEdge};
    for (int x = 0; x < kCells; ++x)
      for (int y = 0; y < kCells; ++y)
        for (int z = 0; z < kCells; ++z) deep_[deep_index(x, y, z)] = around_.deep(x, y, z);
  }

  Chunk run() {
    for (int x = 0; x < kChunkEdge; ++x)
      for (int z = 0; z < kChunkEdge; ++z) paint_column(x, z);
    return Chunk::from_voxels(voxels_);
  }

 private:
  void paint_column(int x, int z) {
    noise_ = noise_at(place(x, 0, z));
    Cover cover;
    int depth = kSoil + 1;  // of solid voxels above; no cover reaches deeper than kSoil
    for (int y = kChunkEdge + kSoil; y >= 0; --y) {
      if (y < kChunkEdge && deep_[deep_index(x / kCell, y / kCell, z / kCell)]) {
        put(x, y, z, block::kStone);
        depth = kSoil + 1;
        continue;
      }
      if (!around_.at(x, y, z)) {
        depth = 0;
        if (y < kChunkEdge && around_.at(x, y - 1, z)) put(x, y, z, plant_on(x, y - 1, z));
        continue;
      }
      if (depth == 0) cover = cover_of(x, y, z);
      if (y < kChunkEdge) put(x, y, z, block_of(cover, depth, x, y, z));
      depth = std::min(depth + 1, kSoil + 1);
    }
  }

  BlockId block_of(const Cover& cover, int depth, int x, int y, int z) const {
    if (land_.colored && around_.exposed(x, y, z)) return land_.colored(place(x, y, z));
    if (land_.colored) return block::kStone;
    if (depth == 0) return cover.top;
    return depth <= kSoil && cover.below != block::kStone ? cover.below : rock(place(x, y, z));
  }

  /// Of an open voxel's floor.
  Cover cover_of(int x, int y, int z) const {
    const IVec3 at = place(x, y, z);
    const int up = around_.steepness(x, y, z) + noise_.wobble;
    if (land_.snow_from && at.y + noise_.wobble / 3 >= *land_.snow_from) {
      if (up > kSlope) return {block::kSnow, block::kSnow};
      return {rock(at), block::kStone};
    }
    if (up > kGentle) return {block::kGrass, block::kDirt, true};
    if (up > kSlope) {
      // Tufts thin out towards the cliff.
      const auto chance = static_cast<std::uint32_t>((up - kSlope) * 256 / (kGentle - kSlope));
      if (hash3(land_.seed + 2, at.x, at.y, at.z) % 256 < chance)
        return {block::kGrass, block::kDirt};
      return {block::kStoneMossy, block::kStone};
    }
    return {rock(at), block::kStone};
  }

  BlockId plant_on(int x, int y, int z) const {
    if (land_.colored) return kAir;
    const IVec3 at = place(x, y, z);
    const std::uint32_t dice = hash3(land_.seed + 3, at.x, at.y, at.z);
    // Most of the ground is bare, so that the dear question for the slope comes last.
    if (static_cast<int>(dice % 512) >= noise_.lush || !cover_of(x, y, z).meadow) return kAir;
    switch (dice / 512 % 16) {
      case 0:
        return block::kFlowerYellow;
      case 1:
        return block::kFlowerRed;
      case 2:
        return block::kFern;
      default:
        return block::kTallGrass;
    }
  }

  /// Strata that bend gently.
  BlockId rock(IVec3 at) const {
    const auto layer = static_cast<std::int32_t>(floor_mod(at.y + noise_.bend, 29));
    if (layer < 3) return block::kSlate;
    if (layer == 13 || layer == 14) return block::kLimestone;
    return hash3(land_.seed + 5, at.x, at.y, at.z) % 400 == 0 ? block::kCoalOre : block::kStone;
  }

  IVec3 place(int x, int y, int z) const { return {origin_.x + x, origin_.y + y, origin_.z + z}; }
  void put(int x, int y, int z, BlockId id) { voxels_[voxel_index(x, y, z)] = id; }

  /// What changes from column to column only.
  struct ColumnNoise {
    int wobble = 0;  // of slopes and of the snow line, +-25
    int lush = 0;    // of 512 places, how many bear a plant
    int bend = 0;    // of strata, +-8 blocks
  };
  ColumnNoise noise_at(IVec3 at) const {
    const auto gradient = [&](std::uint32_t salt, int wavelength) {
      return noise::gradient2(land_.seed + salt, at.x * 256, at.z * 256, wavelength);
    };
    return {gradient(1, 12) / 160, 40 + gradient(4, 20) / 24, gradient(0, 96) / 512};
  }

  static std::size_t deep_index(int x, int y, int z) {
    return static_cast<std::size_t>(x + kCells * (y + kCells * z));
  }

  const Land& land_;
  // Rock that is never seen is plain, which keeps chunks small, and exports of them.
  std::array<bool, kCells * kCells * kCells> deep_{};
  ColumnNoise noise_;
  Surroundings around_;
  IVec3 origin_;
  std::vector<BlockId> voxels_;
};

}  // namespace

std::optional<std::int32_t> snow_line(std::int32_t low, std::int32_t high) {
  const std::int32_t height = high - low;
  if (height < kTallIsland) return std::nullopt;
  return high - height / 8;
}

bool is_buried(const SolidMasks& masks, IVec3 chunk) {
  constexpr std::array<IVec3, 7> kSelfAndFaces = {
      {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  return std::all_of(kSelfAndFaces.begin(), kSelfAndFaces.end(), [&](IVec3 side) {
    const auto found = masks.find({chunk.x + side.x, chunk.y + side.y, chunk.z + side.z});
    return found != masks.end() && found->second.fill == ChunkMask::Fill::kFull;
  });
}

Chunk land_chunk(const SolidMasks& masks, IVec3 chunk, const Land& land) {
  if (is_buried(masks, chunk)) return Chunk(block::kStone);
  return Painter(masks, chunk, land).run();
}

}  // namespace skerry::world
