#include "world/mesh/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "world/mesh/kernel.h"
#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

using shared::Quad;

std::size_t padded_index(int x, int y, int z) {
  return static_cast<std::size_t>((z + 1) + kPaddedEdge * ((x + 1) + kPaddedEdge * (y + 1)));
}

struct Padded {
  std::vector<BlockId> ids = std::vector<BlockId>(kPaddedVoxels, kAir);
  BlockId& at(int x, int y, int z) { return ids[padded_index(x, y, z)]; }
  BlockId at(int x, int y, int z) const { return ids[padded_index(x, y, z)]; }
  void fill(const std::function<BlockId(int, int, int)>& id) {
    for (int y = -1; y <= 64; ++y)
      for (int x = -1; x <= 64; ++x)
        for (int z = -1; z <= 64; ++z) at(x, y, z) = id(x, y, z);
  }
};

/// SplitMix64; the tests' only source of chance.
struct Chance {
  std::uint64_t state;
  std::uint64_t next() {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }
  int below(int limit) { return static_cast<int>(next() % static_cast<std::uint64_t>(limit)); }
};

constexpr std::array<std::array<int, 3>, 6> kNormals = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
// docs/conventions.md: u and v as axis numbers, for x, y and z faces.
constexpr std::array<int, 3> kAxisU = {2, 0, 0}, kAxisV = {1, 2, 1};

/// One face of one voxel.
struct Face {
  int range, x, y, z, face;
  BlockId id;
  unsigned touches = 0;  // translucent_number() of what a translucent face looks at
  auto operator<=>(const Face&) const = default;
};

std::string describe(const Face& f) {
  return "range " + std::to_string(f.range) + " voxel " + std::to_string(f.x) + "," +
         std::to_string(f.y) + "," + std::to_string(f.z) + " face " + std::to_string(f.face) +
         " id " + std::to_string(f.id) + " touches " + std::to_string(f.touches);
}

/// The definition of what is visible, voxel by voxel.
std::vector<Face> naive_faces(const Padded& chunk) {
  std::vector<Face> faces;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int z = 0; z < 64; ++z) {
        const BlockId id = chunk.at(x, y, z);
        const BlockKind kind = block_kind(id);
        if (kind == BlockKind::kAir) continue;
        if (kind == BlockKind::kPlant) {
          faces.push_back({shared::kRangePlant, x, y, z, 6, id});
          faces.push_back({shared::kRangePlant, x, y, z, 7, id});
          continue;
        }
        const int range = kind == BlockKind::kOpaque   ? int{shared::kRangeOpaque}
                          : kind == BlockKind::kCutout ? int{shared::kRangeCutout}
                                                       : int{shared::kRangeTranslucent};
        for (int face = 0; face < 6; ++face) {
          const auto& n = kNormals[static_cast<std::size_t>(face)];
          const BlockId other = chunk.at(x + n[0], y + n[1], z + n[2]);
          if (block_kind(other) == BlockKind::kOpaque) continue;
          if (kind != BlockKind::kOpaque && other == id) continue;
          const bool translucent = kind == BlockKind::kTranslucent;
          faces.push_back(
              {range + face, x, y, z, face, id, translucent ? translucent_number(other) : 0});
        }
      }
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// The faces that merged quads stand for, each as often as it is covered.
std::vector<Face> covered_faces(const ChunkMesh& mesh) {
  std::vector<Face> faces;
  std::uint32_t at = 0;
  for (int range = 0; range < static_cast<int>(shared::kRangeCount); ++range) {
    for (; at < mesh.range_end[static_cast<std::size_t>(range)]; ++at) {
      const Quad q = mesh.quads.at(at);
      EXPECT_EQ(shared::surface_island(q.material), 0u);
      const std::array<int, 3> low = {static_cast<int>(q.geometry & 63),
                                      static_cast<int>(q.geometry >> 6 & 63),
                                      static_cast<int>(q.geometry >> 12 & 63)};
      const int u = static_cast<int>(q.geometry >> 18 & 63),
                v = static_cast<int>(q.geometry >> 24 & 63);
      const int face = static_cast<int>(shared::surface_face(q.material));
      const auto id = static_cast<BlockId>(shared::surface_block(q.material));
      const bool plant = range == static_cast<int>(shared::kRangePlant);
      EXPECT_EQ(face >= 6, plant);
      if (plant) {
        EXPECT_EQ(u + v, 0);
        EXPECT_EQ(shared::touched_by(q.geometry, q.material), 0u);
        faces.push_back({range, low[0], low[1], low[2], face, id});
        continue;
      }
      for (int i = 0; i <= u; ++i)
        for (int j = 0; j <= v; ++j) {
          std::array<int, 3> p = low;
          p[static_cast<std::size_t>(kAxisU[static_cast<std::size_t>(face / 2)])] += i;
          p[static_cast<std::size_t>(kAxisV[static_cast<std::size_t>(face / 2)])] += j;
          faces.push_back(
              {range, p[0], p[1], p[2], face, id, shared::touched_by(q.geometry, q.material)});
        }
    }
  }
  EXPECT_EQ(at, mesh.quads.size());
  std::sort(faces.begin(), faces.end());
  return faces;
}

void expect_bounds(const std::vector<Face>& faces, const ChunkMesh& mesh) {
  std::array<int, 3> low = {64, 64, 64}, high = {0, 0, 0};
  for (const Face& f : faces) {
    const std::array<int, 3> p = {f.x, f.y, f.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool own = f.face < 6 && static_cast<std::size_t>(f.face / 2) == axis;
      low[axis] = std::min(low[axis], p[axis] + (own && f.face % 2 == 0));
      high[axis] = std::max(high[axis], p[axis] + 1 - (own && f.face % 2 == 1));
    }
  }
  if (faces.empty()) low = {0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(int{mesh.bounds_min[axis]}, low[axis]) << "axis " << axis;
    EXPECT_EQ(int{mesh.bounds_max[axis]}, high[axis]) << "axis " << axis;
  }
}

bool same_mesh(const ChunkMesh& a, const ChunkMesh& b) {
  return a.range_end == b.range_end && a.bounds_min == b.bounds_min &&
         a.bounds_max == b.bounds_max &&
         std::equal(a.quads.begin(), a.quads.end(), b.quads.begin(), b.quads.end(),
                    [](const Quad& p, const Quad& q) {
                      return p.geometry == q.geometry && p.material == q.material;
                    });
}

/// Meshes with every kernel of this CPU, from ids and from a palette in descending order, and
/// compares all of it with the naive faces.
class Mesher {
 public:
  void check(const Padded& chunk) {
    const std::vector<Face> expected = naive_faces(chunk);
    mesh_chunk(chunk.ids, scratch_, mesh_);
    const std::vector<Face> covered = covered_faces(mesh_);
    if (covered != expected) {
      const auto [a, b] =
          std::mismatch(covered.begin(), covered.end(), expected.begin(), expected.end());
      ADD_FAILURE() << covered.size() << " faces for " << expected.size()
                    << "; first difference: " << (a == covered.end() ? "none" : describe(*a))
                    << " for " << (b == expected.end() ? "none" : describe(*b));
    }
    expect_bounds(expected, mesh_);
    check_kernels(chunk);
  }
  const ChunkMesh& mesh() const { return mesh_; }

 private:
  void check_kernels(const Padded& chunk) {
    std::vector<bool> present(65536);
    for (const BlockId id : chunk.ids) present[id] = true;
    std::vector<BlockId> palette;
    std::vector<std::uint8_t> index_of(65536);
    for (int id = 65535; id >= 0; --id) {
      if (!present[static_cast<std::size_t>(id)]) continue;
      index_of[static_cast<std::size_t>(id)] = static_cast<std::uint8_t>(palette.size());
      palette.push_back(static_cast<BlockId>(id));
    }
    std::vector<std::uint8_t> indices(kPaddedVoxels);
    for (std::size_t i = 0; i < kPaddedVoxels; ++i) indices[i] = index_of[chunk.ids[i]];
    for (const mesh_detail::Kernel* kernel : mesh_detail::kernels()) {
      mesh_chunk_with(*kernel, chunk.ids, scratch_, other_);
      EXPECT_TRUE(same_mesh(other_, mesh_)) << kernel->name;
      if (palette.size() > 256) continue;
      mesh_chunk_with(*kernel, indices, palette, scratch_, other_);
      EXPECT_TRUE(same_mesh(other_, mesh_)) << kernel->name << " with palette";
    }
  }

  MeshScratch scratch_;
  ChunkMesh mesh_, other_;
};

/// A few ids of each kind.
constexpr std::array<BlockId, 12> kMixed = {kAir,
                                            kAir,
                                            block::kStone,
                                            block::kDirt,
                                            block::kSand,
                                            block::kOakLeaves,
                                            block::kPineLeaves,
                                            block::kTallGrass,
                                            block::kFlowerRed,
                                            block::kWater,
                                            block::kGlass,
                                            block::kStone};

/// Boxes of random blocks over each other: long runs, shared edges, nested kinds.
Padded random_boxes(Chance& chance, std::span<const BlockId> ids, int boxes, int largest) {
  Padded chunk;
  for (int i = 0; i < boxes; ++i) {
    std::array<int, 3> low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = chance.below(66) - 1;
      high[a] = std::min(64, low[a] + chance.below(largest));
    }
    const BlockId id = ids[static_cast<std::size_t>(chance.below(static_cast<int>(ids.size())))];
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        for (int z = low[2]; z <= high[2]; ++z) chunk.at(x, y, z) = id;
  }
  return chunk;
}

/// Independent random blocks in a random box, air elsewhere: small enough for thousands of rounds.
Padded random_cluster(Chance& chance, std::span<const BlockId> ids) {
  Padded chunk;
  std::array<int, 3> low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = chance.below(66) - 1;
    high[a] = std::min(64, low[a] + chance.below(12));
  }
  for (int y = low[1]; y <= high[1]; ++y)
    for (int x = low[0]; x <= high[0]; ++x)
      for (int z = low[2]; z <= high[2]; ++z)
        chunk.at(x, y, z) =
            ids[static_cast<std::size_t>(chance.below(static_cast<int>(ids.size())))];
  return chunk;
}

TEST(Mesh, EmptyChunkHasNoQuads) {
  Mesher mesher;
  mesher.check(Padded{});
  EXPECT_TRUE(mesher.mesh().quads.empty());
}

TEST(Mesh, SolidChunkInSolidSurroundingsHasNoQuads) {
  Mesher mesher;
  Padded chunk;
  for (const BlockId id : {block::kStone, block::kWater, block::kOakLeaves}) {
    chunk.fill([&](int, int, int) { return BlockId{id}; });
    mesher.check(chunk);
    EXPECT_TRUE(mesher.mesh().quads.empty());
  }
}

TEST(Mesh, SolidChunkInAirIsSixQuads) {
  // Each side is one 64 x 64 square of one id.
  Mesher mesher;
  Padded chunk;
  for (const BlockId id : {block::kStone, block::kGlass, block::kPineLeaves}) {
    chunk.fill([&](int x, int y, int z) {
      const bool inside = std::min({x, y, z}) >= 0 && std::max({x, y, z}) < 64;
      return inside ? BlockId{id} : kAir;
    });
    mesher.check(chunk);
    EXPECT_EQ(mesher.mesh().quads.size(), 6u);
  }
}

TEST(Mesh, ChunkOfPlantsGivesTwoQuadsAVoxel) {
  Mesher mesher;
  Padded chunk;
  chunk.fill([](int, int, int) { return BlockId{block::kFern}; });
  mesher.check(chunk);
  EXPECT_EQ(mesher.mesh().quads.size(), 2u * kChunkVoxels);
}

TEST(Mesh, OneVoxelIsSixQuadsOnItsSides) {
  Mesher mesher;
  for (const auto& [x, y, z] :
       {std::array{0, 0, 0}, std::array{63, 63, 63}, std::array{5, 0, 63}}) {
    Padded chunk;
    chunk.at(x, y, z) = block::kStone;
    mesher.check(chunk);
    EXPECT_EQ(mesher.mesh().quads.size(), 6u);
  }
}

TEST(Mesh, SlabOfTwoIdsSplitsWhereTheyMeet) {
  // A 64 x 1 x 64 slab in air, stone for x < 10, dirt from there. Top and bottom: 2 quads each.
  // +-z sides: 2 each. +x and -x sides: one each. 2 * 2 + 2 * 2 + 2 = 10.
  Padded chunk;
  for (int x = 0; x < 64; ++x)
    for (int z = 0; z < 64; ++z) chunk.at(x, 7, z) = x < 10 ? block::kStone : block::kDirt;
  Mesher mesher;
  mesher.check(chunk);
  EXPECT_EQ(mesher.mesh().quads.size(), 10u);
}

TEST(Mesh, CheckerboardMergesNothing) {
  // 64^3 / 2 voxels with six free faces each.
  Padded chunk;
  chunk.fill(
      [](int x, int y, int z) { return (x + y + z) % 2 == 0 ? BlockId{block::kStone} : kAir; });
  Mesher mesher;
  mesher.check(chunk);
  EXPECT_EQ(mesher.mesh().quads.size(), kChunkVoxels / 2 * 6);
}

TEST(Mesh, ALoneFlatFaceHasAFlatBox) {
  // Solid everywhere but for one layer of the shell: one 64 x 64 face, at 64 or at 0.
  Mesher mesher;
  for (std::size_t face = 0; face < 6; ++face) {
    const std::size_t axis = face / 2;
    const int open = face % 2 == 0 ? 64 : -1;
    Padded chunk;
    chunk.fill([&](int x, int y, int z) {
      return std::array{x, y, z}[axis] == open ? kAir : BlockId{block::kStone};
    });
    mesher.check(chunk);
    EXPECT_EQ(mesher.mesh().quads.size(), 1u);
    EXPECT_EQ(mesher.mesh().bounds_min[axis], std::max(open, 0));
    EXPECT_EQ(mesher.mesh().bounds_max[axis], std::max(open, 0));
  }
}

TEST(Mesh, NeighbourAcrossTheBorderHidesAFace) {
  Padded chunk;
  chunk.at(63, 0, 63) = block::kStone;
  chunk.at(64, 0, 63) = block::kDirt;   // hides +x
  chunk.at(63, -1, 63) = block::kDirt;  // hides -y
  chunk.at(63, 0, 64) = block::kGlass;  // hides nothing of stone
  Mesher mesher;
  mesher.check(chunk);
  EXPECT_EQ(mesher.mesh().quads.size(), 4u);
}

TEST(Mesh, WaterHidesWaterButNotGlass) {
  // Three voxels in a row along x: water, water, glass. Water: 2 voxels long, its five outer sides
  // and the one against the glass are 6 quads; glass shows all of its 6 sides.
  Padded chunk;
  chunk.at(4, 4, 4) = chunk.at(5, 4, 4) = block::kWater;
  chunk.at(6, 4, 4) = block::kGlass;
  Mesher mesher;
  mesher.check(chunk);
  EXPECT_EQ(mesher.mesh().quads.size(), 12u);
}

TEST(Mesh, StaleScratchDoesNotLeakIntoTheNextChunk) {
  Chance chance{3};
  Mesher reused;
  for (int round = 0; round < 20; ++round) {
    const Padded chunk = random_boxes(chance, kMixed, 30, 30);
    reused.check(chunk);
    Mesher fresh;
    fresh.check(chunk);
    EXPECT_TRUE(same_mesh(reused.mesh(), fresh.mesh()));
  }
}

TEST(Mesh, RandomClustersAreCoveredExactly) {
  Chance chance{1};
  Mesher mesher;
  const std::array<BlockId, 2> sparse = {kAir, block::kStone};
  const std::array<BlockId, 3> two_ids = {block::kStone, block::kDirt, block::kStone};
  for (int round = 0; round < 700 && !HasFailure(); ++round) {
    mesher.check(random_cluster(chance, kMixed));
    mesher.check(random_cluster(chance, sparse));
    mesher.check(random_cluster(chance, two_ids));
  }
}

TEST(Mesh, RandomBoxesAreCoveredExactly) {
  Chance chance{2};
  Mesher mesher;
  for (int round = 0; round < 200 && !HasFailure(); ++round) {
    mesher.check(random_boxes(chance, kMixed, 1 + chance.below(80), 1 + chance.below(66)));
  }
}

TEST(Mesh, NoiseOfEveryDensityIsCoveredExactly) {
  Chance chance{4};
  Mesher mesher;
  for (int eighths = 1; eighths < 8; ++eighths) {
    Padded chunk;
    chunk.fill([&](int, int, int) {
      if (chance.below(8) >= eighths) return kAir;
      return kMixed[static_cast<std::size_t>(chance.below(static_cast<int>(kMixed.size())))];
    });
    mesher.check(chunk);
  }
}

TEST(Mesh, CaveLikeChunksAreCoveredExactly) {
  // Thresholded sums of coarse random lattices: connected hollows with ragged walls.
  Chance chance{5};
  Mesher mesher;
  for (int round = 0; round < 12 && !HasFailure(); ++round) {
    std::array<std::uint8_t, 18 * 18 * 18> lattice;
    for (std::uint8_t& value : lattice) value = static_cast<std::uint8_t>(chance.next());
    Padded chunk;
    chunk.fill([&](int x, int y, int z) {
      const auto at = [&](int i, int j, int k) {
        return int{lattice[static_cast<std::size_t>(i + 18 * (j + 18 * k))]};
      };
      const int i = (x + 1) / 4, j = (y + 1) / 4, k = (z + 1) / 4;
      const int sum = at(i, j, k) * (4 - (x + 1) % 4) + at(i + 1, j, k) * ((x + 1) % 4) +
                      at(i, j + 1, k) * ((y + 1) % 4) + at(i, j, k + 1) * ((z + 1) % 4);
      if (sum < 900) return kAir;
      return sum < 1300   ? BlockId{block::kStone}
             : sum < 1500 ? BlockId{block::kDirt}
                          : BlockId{block::kWater};
    });
    mesher.check(chunk);
  }
}

TEST(Mesh, EveryBuiltInBlockKeepsItsIdAndRange) {
  Chance chance{6};
  Mesher mesher;
  Padded chunk;
  chunk.fill(
      [&](int, int, int) { return static_cast<BlockId>(chance.below(block::kBuiltInCount)); });
  mesher.check(chunk);
}

TEST(Mesh, IdsBeyondAByteAreKept) {
  Chance chance{7};
  Mesher mesher;
  const std::array<BlockId, 6> large = {kAir, 255, 256, 1023, block::kWater, block::kOakLeaves};
  for (int round = 0; round < 8; ++round) mesher.check(random_boxes(chance, large, 40, 30));
  Padded many;  // more ids than a byte can index
  many.fill([&](int, int, int) { return static_cast<BlockId>(chance.below(1000)); });
  mesher.check(many);
}

// They have no look of their own, and must not name another face or island.
TEST(Mesh, IdsThatNoMaterialHasKeepTheirLowestBits) {
  Padded chunk;
  chunk.fill([](int x, int, int) { return BlockId{x % 2 == 0 ? BlockId{65535} : BlockId{1027}}; });
  MeshScratch scratch;
  ChunkMesh mesh;
  mesh_chunk(chunk.ids, scratch, mesh);
  chunk.fill([](int x, int, int) { return x < 10 ? BlockId{40000} : kAir; });
  ChunkMesh flat;
  mesh_chunk(chunk.ids, scratch, flat);
  ASSERT_FALSE(flat.quads.empty());
  for (const ChunkMesh* one : {&mesh, &flat})
    for (const shared::Quad& quad : one->quads) {
      EXPECT_LT(shared::surface_face(quad.material), 6u);
      EXPECT_EQ(shared::surface_island(quad.material), 0u);
    }
  EXPECT_EQ(shared::surface_block(flat.quads.front().material), 40000u % 1024u);
}

TEST(Mesh, PalettesOfEverySizeKeepTheirIds) {
  Chance chance{8};
  Mesher mesher;
  for (const int count : {2, 63, 64, 65, 128, 129, 255, 256}) {
    Padded chunk;
    chunk.fill([&](int, int, int) { return static_cast<BlockId>(chance.below(count) * 3); });
    mesher.check(chunk);
  }
}

// The ranges of leaves join those of opaque faces, in the order of the mesher's ranges.
TEST(Mesh, ClosedLeavesAreOpaqueFaces) {
  Chance chance{11};
  Padded padded;
  constexpr std::array<BlockId, 6> kIds{
      kAir, block::kStone, block::kOakLeaves, block::kOakLeaves, block::kTallGrass, block::kWater};
  padded.fill([&](int, int, int) { return kIds[static_cast<std::size_t>(chance.below(6))]; });
  MeshScratch scratch;
  ChunkMesh open, closed;
  mesh_chunk(padded.ids, scratch, open);
  closed = open;
  close_cutouts(closed);
  const auto quads_of = [](const ChunkMesh& mesh, std::uint32_t range) {
    return std::vector<Quad>(mesh.quads.begin() + (range == 0 ? 0 : mesh.range_end[range - 1]),
                             mesh.quads.begin() + mesh.range_end[range]);
  };
  const auto end_of = [](const Quad& quad) {
    const std::uint32_t axis = shared::surface_face(quad.material) / 2;
    std::array<std::uint32_t, 3> end{quad.geometry & 63u, quad.geometry >> 6 & 63u,
                                     quad.geometry >> 12 & 63u};
    end[static_cast<std::size_t>(kAxisU[axis])] += quad.geometry >> 18 & 63u;
    end[static_cast<std::size_t>(kAxisV[axis])] += quad.geometry >> 24 & 63u;
    return std::array{end[1], end[0], end[2]};
  };
  const auto bits = [](const std::vector<Quad>& quads) {
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> out;
    for (const Quad& quad : quads) out.emplace(quad.geometry, quad.material);
    return out;
  };
  for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
    const std::vector<Quad> now = quads_of(closed, range);
    std::vector<Quad> wanted = quads_of(open, range);
    if (range < shared::kFaceCount) {
      const std::vector<Quad> leaves = quads_of(open, shared::kRangeCutout + range);
      ASSERT_FALSE(leaves.empty());
      wanted.insert(wanted.end(), leaves.begin(), leaves.end());
      EXPECT_TRUE(std::is_sorted(now.begin(), now.end(), [&](const Quad& a, const Quad& b) {
        return end_of(a) < end_of(b);
      }));
    } else if (range < shared::kRangePlant) {
      wanted.clear();
    }
    EXPECT_EQ(bits(now), bits(wanted)) << "range " << range;
  }
}

}  // namespace
}  // namespace skerry::world
