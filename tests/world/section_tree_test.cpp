// Islands drawn at several levels at once: which sections, and that their surfaces are closed.
#include "world/stream/section_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>

#include "world/islands/world.h"
#include "world/light/base/face_records.h"
#include "world/mesh/mesh.h"
#include "world/mesh/seams.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

/// The corner of lower coordinates of a node, and its edge [blocks].
struct Cube {
  explicit Cube(const TreeNode& node)
      : edge(kChunkEdge << node.level),
        low{node.chunk.x * edge, node.chunk.y * edge, node.chunk.z * edge} {}
  int edge;
  std::array<int, 3> low;

  bool overlaps(const Cube& other) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (low[i] >= other.low[i] + other.edge || other.low[i] >= low[i] + edge) return false;
    return true;
  }
  /// Whether the other lies at one of this cube's faces.
  bool touches(const Cube& other, std::size_t face) const {
    const std::size_t axis = face / 2;
    const int here = low[axis] + (face % 2 == 0 ? edge : 0);
    const int there = other.low[axis] + (face % 2 == 0 ? 0 : other.edge);
    if (here != there) return false;
    for (std::size_t i = 0; i < 3; ++i)
      if (i != axis && (low[i] >= other.low[i] + other.edge || other.low[i] >= low[i] + edge))
        return false;
    return true;
  }
};

/// Where the faces of a made-up section are: anywhere within it; some have none.
std::optional<LatticeBox> faces_of(const TreeNode& section) {
  const Cube cube(section);
  Rng random(hash3(static_cast<std::uint32_t>(section.level) + 7, section.chunk.x, section.chunk.y,
                   section.chunk.z));
  if (random.chance(20)) return std::nullopt;
  std::array<int, 3> low{}, high{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int a = random.in(0, cube.edge), b = random.in(0, cube.edge);
    low[i] = cube.low[i] + std::min(a, b);
    high[i] = cube.low[i] + std::max(a, b);
  }
  return LatticeBox{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

/// From the box about all faces that a place has, at its own level and at finer ones.
double distance_to(const std::vector<TreeNode>& sections, const TreeNode& place,
                   const glm::dvec3& p) {
  constexpr int kFar = 1 << 30;
  std::array<int, 3> low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  for (const TreeNode& section : sections) {
    const std::optional<LatticeBox> box = faces_of(section);
    if (!box || section.level > place.level || !Cube(place).overlaps(Cube(section))) continue;
    low = {std::min(low[0], box->low.x), std::min(low[1], box->low.y),
           std::min(low[2], box->low.z)};
    high = {std::max(high[0], box->high.x), std::max(high[1], box->high.y),
            std::max(high[2], box->high.z)};
  }
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double out = std::max({low[axis] - p[i], p[i] - high[axis], 0.0});
    squares += out * out;
  }
  return std::sqrt(squares);
}

/// A made-up island: random chunks of level 0, and at coarser levels most of what holds them.
std::vector<TreeNode> random_sections(std::mt19937& random, std::initializer_list<int> levels) {
  std::uniform_int_distribution<int> place(-6, 5), of_ten(0, 9);
  std::set<TreeNode> all;
  for (int i = 0; i < 120; ++i) {
    const IVec3 chunk{place(random), place(random) / 2, place(random)};
    for (const int level : levels) {
      const auto at = [level](int v) {
        return static_cast<std::int32_t>(std::floor(std::ldexp(v, -level)));
      };
      if (of_ten(random) > 0) all.insert({level, {at(chunk.x), at(chunk.y), at(chunk.z)}});
    }
  }
  return {all.begin(), all.end()};
}

/// A tree, and what it has told of its sections.
class ToldTree {
 public:
  explicit ToldTree(const std::vector<TreeNode>& sections) {
    for (const TreeNode& section : sections) add(section);
  }
  void add(const TreeNode& section) {
    tree.add(section, faces_of(section).value_or(LatticeBox{}));
    told[section] = {};
  }
  void remove(const TreeNode& section) {
    tree.remove(section);
    told.erase(section);
  }
  /// @return how many sections have changed.
  std::size_t cut(const glm::dvec3& camera, std::span<const double> nearest, bool keep = false) {
    const auto changes = tree.cut(camera, nearest, keep);
    for (const SectionTree::Change& change : changes)
      told.at(change.section) = {change.drawn, change.seams};
    return changes.size();
  }

  struct Told {
    bool drawn = true;
    std::uint8_t seams = 0;
    bool operator==(const Told&) const = default;
  };
  SectionTree tree;
  std::map<TreeNode, Told> told;
};

/// By section, what a new tree says.
struct SectionCut {
  std::vector<bool> drawn;
  std::vector<std::uint8_t> seams;
};
SectionCut cut_of(const std::vector<TreeNode>& sections, const glm::dvec3& camera,
                  std::span<const double> nearest) {
  ToldTree tree(sections);
  tree.cut(camera, nearest);
  SectionCut out;
  for (const TreeNode& section : sections) {
    out.drawn.push_back(tree.told.at(section).drawn);
    out.seams.push_back(tree.told.at(section).seams);
  }
  return out;
}

constexpr std::array<double, 5> kNearest{0.0, 70.0, 150.0, 290.0, 600.0};

glm::dvec3 random_camera(std::mt19937& random) {
  std::uniform_real_distribution<double> in(-600.0, 600.0);
  return {in(random), in(random) / 2, in(random)};
}

TEST(SectionTree, DrawsEachPlaceOnceAndAsCoarseAsItMay) {
  std::mt19937 random(1);
  std::size_t mixed = 0;
  for (int round = 0; round < 150; ++round) {
    const bool gap = round % 3 == 2;  // a level that is not there yet
    const std::vector<TreeNode> sections =
        gap ? random_sections(random, {0, 2, 3}) : random_sections(random, {0, 1, 2, 3});
    const glm::dvec3 camera = random_camera(random);
    const SectionCut cut = cut_of(sections, camera, kNearest);
    auto distance = [&, known = std::map<TreeNode, double>()](const TreeNode& of) mutable {
      const auto [at, is_new] = known.try_emplace(of);
      if (is_new) at->second = distance_to(sections, of, camera);
      return at->second;
    };
    std::set<int> levels;
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const Cube cube(sections[i]);
      bool finer = false, coarser = false;
      for (std::size_t k = 0; k < sections.size(); ++k) {
        const Cube other(sections[k]);
        if (k == i || !cut.drawn[k] || !cube.overlaps(other)) continue;
        ASSERT_FALSE(cut.drawn[i]) << "drawn twice";
        finer |= other.edge < cube.edge;
        coarser |= other.edge > cube.edge;
      }
      const double nearest = kNearest[static_cast<std::size_t>(sections[i].level)];
      if (cut.drawn[i]) {
        levels.insert(sections[i].level);
        ASSERT_TRUE(sections[i].level == 0 || distance_to(sections, sections[i], camera) >= nearest)
            << "too near";
      } else if (finer) {
        ASSERT_LT(distance(sections[i]), nearest) << "it could have been this coarse";
      } else if (!coarser && sections[i].level == 0) {
        // Something that holds it stands for it, and is empty; it must be far enough for that.
        bool may = false;
        for (const int level : gap ? std::vector{2, 3} : std::vector{1, 2, 3}) {
          const auto at = [level](int v) {
            return static_cast<std::int32_t>(std::floor(std::ldexp(v, -level)));
          };
          const IVec3 c = sections[i].chunk;
          may |= distance({level, {at(c.x), at(c.y), at(c.z)}}) >=
                 kNearest[static_cast<std::size_t>(level)];
        }
        ASSERT_TRUE(may) << "lost";
      }
    }
    mixed += levels.size() > 1;
  }
  EXPECT_GT(mixed, 75u);
}

TEST(SectionTree, NamesEachFaceAtWhichAnotherLevelIsDrawn) {
  std::mt19937 random(2);
  std::size_t seams = 0;
  for (int round = 0; round < 100; ++round) {
    const std::vector<TreeNode> sections = random_sections(random, {0, 1, 2, 3});
    const SectionCut cut = cut_of(sections, random_camera(random), kNearest);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      if (!cut.drawn[i]) {
        ASSERT_EQ(cut.seams[i], 0);
        continue;
      }
      for (std::size_t face = 0; face < 6; ++face) {
        bool same = false, other = false;
        for (std::size_t k = 0; k < sections.size(); ++k) {
          if (!cut.drawn[k] || !Cube(sections[i]).touches(Cube(sections[k]), face)) continue;
          (sections[k].level == sections[i].level ? same : other) = true;
        }
        const bool seam = (cut.seams[i] >> face & 1) != 0;
        ASSERT_TRUE(seam || !other);
        ASSERT_FALSE(seam && same);
        seams += seam;
      }
    }
  }
  EXPECT_GT(seams, 1000u);
}

TEST(SectionTree, StaysWhileTheCameraMovesLessThanItsSlack) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> in(-1.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    const std::vector<TreeNode> sections = random_sections(random, {0, 1, 2, 3});
    const glm::dvec3 camera = random_camera(random);
    ToldTree tree(sections);
    tree.cut(camera, kNearest);
    const auto first = tree.told;
    ASSERT_GT(tree.tree.slack(), 0.0);
    const glm::dvec3 way = glm::normalize(glm::dvec3(in(random), in(random), in(random) + 1e-6));
    EXPECT_EQ(tree.cut(camera + way * (0.999 * tree.tree.slack()), kNearest, true), 0u);
    // 5% about the limits: what is there and back is what it was.
    EXPECT_EQ(tree.cut(camera, kNearest, true), 0u);
    EXPECT_EQ(tree.told, first);
  }
}

// Sections come and go in parts, levels as wholes, and the camera moves.
TEST(SectionTree, IsAfterAnyChangesWhatANewTreeIs) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    std::vector<TreeNode> pool = random_sections(random, {0, 1, 2, 3});
    ToldTree tree({});
    std::set<TreeNode> there;
    for (int step = 0; step < 40; ++step) {
      std::shuffle(pool.begin(), pool.end(), random);
      for (std::size_t i = 0; i < random() % 60; ++i) {
        if (there.erase(pool[i]) != 0) {
          tree.remove(pool[i]);
          if (random() % 4 != 0) continue;  // a fourth is replaced
        }
        there.insert(pool[i]);
        tree.add(pool[i]);
      }
      const std::uint32_t coming = random() % 3 == 0 ? random() % 16 : 0;
      const glm::dvec3 camera = random_camera(random);
      ToldTree fresh({there.begin(), there.end()});
      tree.tree.set_coming(coming);
      fresh.tree.set_coming(coming);
      tree.cut(camera, kNearest);
      fresh.cut(camera, kNearest);
      ASSERT_EQ(tree.told, fresh.told) << "round " << round << " step " << step;
    }
  }
}

TEST(SectionTree, LevelsThatComeInPartsAreNotDrawn) {
  std::mt19937 random(6);
  const std::vector<TreeNode> sections = random_sections(random, {0, 1, 2});
  ToldTree tree(sections);
  const auto levels_drawn = [&](std::uint32_t coming) {
    tree.tree.set_coming(coming);
    tree.cut({0.0, 0.0, 0.0}, kNearest);
    std::set<int> levels;
    for (const auto& [section, told] : tree.told)
      if (told.drawn) levels.insert(section.level);
    return levels;
  };
  EXPECT_EQ(levels_drawn(0b000), (std::set{0, 1, 2}));
  EXPECT_EQ(levels_drawn(0b001), (std::set{1, 2}));
  EXPECT_EQ(levels_drawn(0b011), (std::set{2}));
  EXPECT_EQ(levels_drawn(0b111), (std::set{0})) << "nothing stands for the finest one";
}

/// A section as it is drawn: its opaque voxels, and the outer sides of them that have a face.
struct Drawn {
  std::vector<BlockId> padded = std::vector<BlockId>(kPaddedVoxels);
  std::array<std::bitset<64 * 64 * 64>, 6> faces;

  static std::size_t index(int x, int y, int z) {
    return static_cast<std::size_t>(z + 64 * (x + 64 * y));
  }
  bool opaque(int x, int y, int z) const {
    const auto at = static_cast<std::size_t>(z + 1 + kPaddedEdge * (x + 1 + kPaddedEdge * (y + 1)));
    return block_kind(padded[at]) == BlockKind::kOpaque;
  }
  void add(std::span<const shared::Quad> quads) {
    for (const shared::Quad& quad : quads) {
      if (shared::surface_face(quad.material) >= 6) continue;
      for_each_face(quad, [&](const DrawnFace& face) {
        faces[static_cast<std::size_t>(face.direction)].set(
            index(face.voxel.x, face.voxel.y, face.voxel.z));
      });
    }
  }
};

/// An island drawn by a cut; what it is made of comes from its blocks.
class CutIsland {
 public:
  CutIsland(World& world, std::uint64_t id, int levels, const glm::dvec3& camera,
            std::span<const double> nearest, bool seams) {
    std::vector<TreeNode> sections;
    std::map<TreeNode, std::unique_ptr<Drawn>> all;
    std::map<TreeNode, SeamFaces> closing;
    MeshScratch scratch;
    for (int level = 0; level < levels; ++level)
      for (const IVec3& chunk : world.chunks(id, level)) {
        auto drawn = std::make_unique<Drawn>();
        if (!world.generate_padded(id, chunk, level, drawn->padded)) continue;
        ChunkMesh mesh;
        mesh_chunk(drawn->padded, scratch, mesh);
        drawn->add({mesh.quads.data(), mesh.range_end[shared::kRangeCutout - 1]});
        const TreeNode node{level, chunk};
        sections.push_back(node);
        closing[node] = seam_faces(drawn->padded);
        all[node] = std::move(drawn);
      }
    const SectionCut cut = cut_of(sections, camera, nearest);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      if (!cut.drawn[i]) continue;
      Drawn& drawn = *(drawn_[sections[i]] = std::move(all[sections[i]]));
      levels_.insert(sections[i].level);
      for (std::size_t face = 0; seams && face < 6; ++face)
        if ((cut.seams[i] >> face & 1) != 0) drawn.add(closing[sections[i]][face]);
    }
    highest_ = levels;
  }

  const std::set<int>& levels() const { return levels_; }

  /// Blocks' sides with rock behind and none in front that no face covers, along random lines.
  std::size_t holes(std::mt19937& random, int lines) const {
    std::size_t count = 0;
    for (int i = 0; i < lines; ++i) {
      const auto& [node, drawn] =
          *std::next(drawn_.begin(), static_cast<std::ptrdiff_t>(random() % drawn_.size()));
      const Cube cube(node);
      const std::size_t axis = random() % 3;
      std::array<int, 3> at = cube.low;
      for (std::size_t a = 0; a < 3; ++a)
        if (a != axis) at[a] += static_cast<int>(random() % static_cast<unsigned>(cube.edge));
      // Some blocks past both ends, where the neighbours are.
      at[axis] -= 4;
      for (int step = 0; step < cube.edge + 8; ++step, ++at[axis]) {
        std::array<int, 3> next = at;
        ++next[axis];
        const bool here = solid(at), there = solid(next);
        if (here && !there) count += !has_face(at, 2 * axis);
        if (there && !here) count += !has_face(next, 2 * axis + 1);
      }
    }
    return count;
  }

 private:
  const Drawn* find(const std::array<int, 3>& block, std::array<int, 3>& voxel) const {
    for (int level = 0; level < highest_; ++level) {
      const auto chunk = [&](std::size_t a) { return block[a] >> (6 + level); };
      const auto found = drawn_.find({level, {chunk(0), chunk(1), chunk(2)}});
      if (found == drawn_.end()) continue;
      for (std::size_t a = 0; a < 3; ++a) voxel[a] = (block[a] >> level) & 63;
      return found->second.get();
    }
    return nullptr;
  }
  bool solid(const std::array<int, 3>& block) const {
    std::array<int, 3> voxel{};
    const Drawn* drawn = find(block, voxel);
    return drawn && drawn->opaque(voxel[0], voxel[1], voxel[2]);
  }
  bool has_face(const std::array<int, 3>& block, std::size_t face) const {
    std::array<int, 3> voxel{};
    const Drawn* drawn = find(block, voxel);
    return drawn && drawn->faces[face].test(Drawn::index(voxel[0], voxel[1], voxel[2]));
  }

  std::map<TreeNode, std::unique_ptr<Drawn>> drawn_;
  std::set<int> levels_;
  int highest_ = 0;
};

TEST(SectionTree, SurfacesAreClosedWhereLevelsMeet) {
  std::mt19937 random(4);
  std::size_t mixed = 0, without_seams = 0;
  constexpr std::array<double, kLevelCount> kNear{0.0, 16.0, 60.0, 150.0, 1e9};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    World world({.seed = seed});
    const IslandSpec spec = world.islands_near(world.origin(), 300.0, 0.0).front();
    std::uniform_real_distribution<double> along(-1.0, 1.0);
    const glm::dvec3 camera(along(random) * spec.bounding_radius, 40.0,
                            along(random) * spec.bounding_radius);
    const CutIsland island(world, spec.id, 4, camera, kNear, true);
    mixed += island.levels().size() > 1;
    EXPECT_EQ(island.holes(random, 3000), 0u) << "seed " << seed;
    if (seed <= 4)
      without_seams += CutIsland(world, spec.id, 4, camera, kNear, false).holes(random, 3000);
  }
  EXPECT_GT(mixed, 15u);
  EXPECT_GT(without_seams, 0u) << "there is something to close";
}

TEST(SeamFaces, AreTheBordersFacesThatTheMeshLeavesOut) {
  std::mt19937 random(5);
  MeshScratch scratch;
  constexpr std::array<BlockId, 6> kIds{kAir,         block::kStone, block::kStone,
                                        block::kDirt, block::kWater, block::kGlowFern};
  Drawn alone;
  for (BlockId& id : alone.padded) id = kIds[random() % kIds.size()];
  ChunkMesh mesh;
  mesh_chunk(alone.padded, scratch, mesh);
  std::array<std::bitset<64 * 64 * 64>, 6> expected;
  Drawn drawn;
  drawn.add({mesh.quads.data(), mesh.range_end[shared::kRangeCutout - 1]});
  const SeamFaces seams = seam_faces(alone.padded);
  for (std::size_t face = 0; face < 6; ++face) {
    Drawn closing;
    closing.add(seams[face]);
    EXPECT_TRUE((closing.faces[face] & drawn.faces[face]).none()) << "drawn twice";
    for (std::size_t other = 0; other < 6; ++other)
      EXPECT_TRUE(other == face || closing.faces[other].none());
    const std::size_t axis = face / 2;
    for (int i = 0; i < 64; ++i)
      for (int j = 0; j < 64; ++j) {
        std::array<int, 3> at{};
        at[axis] = face % 2 == 0 ? 63 : 0;
        at[(axis + 1) % 3] = i;
        at[(axis + 2) % 3] = j;
        const std::size_t index = Drawn::index(at[0], at[1], at[2]);
        EXPECT_EQ(drawn.faces[face].test(index) || closing.faces[face].test(index),
                  alone.opaque(at[0], at[1], at[2]));
        if (closing.faces[face].test(index)) expected[face].set(index);
      }
    EXPECT_EQ(closing.faces[face].count(), expected[face].count()) << "on the border alone";
  }
}

}  // namespace
}  // namespace skerry::world
