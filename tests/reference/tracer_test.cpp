#include "tools/reference/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/render/scene/block_textures.h"
#include "tests/reference/made_scenes.h"
#include "tools/reference/textures.h"

namespace skerry::reference {
namespace {

using world::BlockId;
using world::BlockKind;
using world::IVec3;

/// Voxels of a lattice as a plain map, and the faces that a ray meets found by looking at each.
class BruteForce {
 public:
  explicit BruteForce(std::map<IVec3, BlockId> voxels) : voxels_(std::move(voxels)) {}

  BlockId at(IVec3 v) const {
    const auto found = voxels_.find(v);
    return found == voxels_.end() ? world::kAir : found->second;
  }

  /// Every drawn face that the ray meets, front faces of blocks and both sides of plants.
  std::vector<Meeting> meetings(glm::dvec3 origin, glm::dvec3 direction, bool fronts) const {
    std::vector<Meeting> out;
    for (const auto& [voxel, id] : voxels_) {
      if (world::block_kind(id) == BlockKind::kPlant) {
        for (const int face : {6, 7}) add_diagonal(origin, direction, voxel, id, face, out);
        continue;
      }
      for (int face = 0; face < 6; ++face)
        add_face(origin, direction, voxel, id, face, fronts, out);
    }
    std::sort(out.begin(), out.end(), [](const Meeting& a, const Meeting& b) { return a.t < b.t; });
    return out;
  }

 private:
  static glm::dvec3 corner(IVec3 v) { return {v.x, v.y, v.z}; }
  void add_face(glm::dvec3 o, glm::dvec3 d, IVec3 voxel, BlockId id, int face, bool fronts,
                std::vector<Meeting>& out) const {
    const int axis = face / 2, sign = face % 2 == 0 ? 1 : -1;
    IVec3 front = voxel;
    (axis == 0 ? front.x : axis == 1 ? front.y : front.z) += sign;
    const BlockId other = at(front);
    if (world::block_kind(other) == BlockKind::kOpaque) return;
    if (world::block_kind(id) != BlockKind::kOpaque && other == id) return;
    if (fronts != (d[axis] * sign < 0.0)) return;
    const double plane = corner(voxel)[axis] + (sign > 0 ? 1.0 : 0.0);
    const double t = (plane - o[axis]) / d[axis];
    if (!(t > 0.0)) return;
    const glm::dvec3 p = o + d * t;
    for (int a = 0; a < 3; ++a)
      if (a != axis && (p[a] < corner(voxel)[a] || p[a] > corner(voxel)[a] + 1.0)) return;
    if (world::block_kind(id) == BlockKind::kCutout && !BlockTexels::shared().covers(id, face, p))
      return;
    out.push_back({t, 0, id, face, voxel, p});
  }
  static void add_diagonal(glm::dvec3 o, glm::dvec3 d, IVec3 voxel, BlockId id, int face,
                           std::vector<Meeting>& out) {
    const glm::dvec3 normal = face == 6 ? glm::dvec3(1, 0, -1) : glm::dvec3(1, 0, 1);
    const double through = face == 6 ? 0.0 : 1.0;
    const double t = (through - glm::dot(normal, o - corner(voxel))) / glm::dot(normal, d);
    const glm::dvec3 p = o + d * t, local = p - corner(voxel);
    if (!(t > 0.0) || local.x < 0.0 || local.x > 1.0 || local.y < 0.0 || local.y > 1.0) return;
    if (BlockTexels::shared().covers(id, face, local)) out.push_back({t, 0, id, face, voxel, p});
  }

  std::map<IVec3, BlockId> voxels_;
};

/// Random blocks of every kind in a box over several chunks, with gaps of all sizes.
std::map<IVec3, BlockId> random_voxels(std::mt19937& random, int extent, int count) {
  constexpr BlockId kIds[] = {world::block::kStone,     world::block::kDirt,
                              world::block::kOakLeaves, world::block::kPineLeaves,
                              world::block::kFern,      world::block::kFlowerRed,
                              world::block::kWater,     world::block::kGlass};
  std::uniform_int_distribution<int> place(-extent, extent - 1), run(1, 4), kind(0, 7);
  std::map<IVec3, BlockId> voxels;
  for (int i = 0; i < count; ++i) {
    const IVec3 low{place(random), place(random), place(random)};
    const BlockId id = kIds[kind(random)];
    const int edge = run(random);
    for (int n = 0; n < edge * edge * edge; ++n)
      voxels[{low.x + n % edge, low.y + n / edge % edge, low.z + n / (edge * edge)}] = id;
  }
  return voxels;
}

Island island_of(const std::map<IVec3, BlockId>& voxels, glm::dmat3 rotation, glm::dvec3 origin) {
  IVec3 low{1 << 20, 1 << 20, 1 << 20}, high{-(1 << 20), -(1 << 20), -(1 << 20)};
  for (const auto& [v, id] : voxels) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x + 1), std::max(high.y, v.y + 1), std::max(high.z, v.z + 1)};
  }
  return {world::Volume::from_voxels(low, high,
                                     [voxels](IVec3 v) {
                                       const auto found = voxels.find(v);
                                       return found == voxels.end() ? world::kAir : found->second;
                                     }),
          rotation, origin};
}

bool solid(const Meeting& m) {
  return world::block_kind(m.block) != BlockKind::kTranslucent;
}

/// The voxel before a meeting's face.
IVec3 in_front(const Meeting& m) {
  IVec3 voxel = m.voxel;
  (m.face / 2 == 0 ? voxel.x : m.face / 2 == 1 ? voxel.y : voxel.z) += m.face % 2 == 0 ? 1 : -1;
  return voxel;
}

/// Whether a meeting lies on the side of its voxel that its face names.
bool on_front(const Meeting& m) {
  const int axis = m.face / 2;
  const glm::dvec3 corner(m.voxel.x, m.voxel.y, m.voxel.z);
  return std::abs(m.lattice[axis] - corner[axis] - (m.face % 2 == 0 ? 1.0 : 0.0)) < 1e-6;
}

/// A ray that begins in the air and misses edges by far more than rounding.
struct Shot {
  glm::dvec3 origin, direction;
};
Shot random_shot(std::mt19937& random, const BruteForce& voxels, double extent) {
  std::uniform_real_distribution<double> place(-1.2 * extent, 1.2 * extent);
  while (true) {
    const glm::dvec3 origin(place(random), place(random), place(random));
    const IVec3 voxel{static_cast<int>(std::floor(origin.x)),
                      static_cast<int>(std::floor(origin.y)),
                      static_cast<int>(std::floor(origin.z))};
    if (voxels.at(voxel) == world::kAir) return {origin, random_direction(random)};
  }
}

TEST(ReferenceTracer, MeetsWhatLookingAtEveryFaceFinds) {
  std::mt19937 random(11);
  int hits = 0, layers = 0;
  for (const int extent : {5, 20, 90}) {
    const auto voxels = random_voxels(random, extent, extent == 5 ? 40 : 120);
    const BruteForce brute(voxels);
    const glm::dmat3 rotation =
        glm::mat3_cast(glm::angleAxis(0.3 * extent, random_direction(random)));
    const glm::dvec3 origin(7.25, -3.5, 11.0);
    const Tracer tracer({island_of(voxels, rotation, origin)});
    Trace trace;
    for (int i = 0; i < 400; ++i) {
      const Shot shot = random_shot(random, brute, extent);
      const std::vector<Meeting> met = brute.meetings(shot.origin, shot.direction, true);
      const auto first = std::find_if(met.begin(), met.end(), solid);
      tracer.trace(rotation * shot.origin + origin, rotation * shot.direction, trace);
      ASSERT_EQ(trace.hit.has_value(), first != met.end());
      if (trace.hit) {
        ++hits;
        EXPECT_NEAR(trace.hit->t, first->t, 1e-9);
        EXPECT_EQ(trace.hit->block, first->block);
        EXPECT_EQ(trace.hit->face, first->face);
        EXPECT_EQ(trace.hit->voxel, first->voxel);
      }
      // Media are entered by their fronts and left by their backs; one surface where two meet.
      const double end = (trace.hit ? first->t : kFar) - 1e-9;
      const auto before = [&](const Meeting& m) { return !solid(m) && m.t < end; };
      const std::vector<Meeting> backs = brute.meetings(shot.origin, shot.direction, false);
      const auto entered = std::count_if(met.begin(), met.end(), before);
      const auto left = std::count_if(backs.begin(), backs.end(), [&](const Meeting& m) {
        return before(m) && world::block_kind(brute.at(in_front(m))) != BlockKind::kTranslucent;
      });
      const auto fronts = std::count_if(trace.layers.begin(), trace.layers.end(), on_front);
      layers += static_cast<int>(fronts);
      EXPECT_EQ(fronts, entered);
      EXPECT_EQ(static_cast<long>(trace.layers.size()) - fronts, left);
      EXPECT_TRUE(std::is_sorted(trace.layers.begin(), trace.layers.end(),
                                 [](const Meeting& a, const Meeting& b) { return a.t < b.t; }));
    }
  }
  EXPECT_GT(hits, 150);
  EXPECT_GT(layers, 50);
}

TEST(ReferenceTracer, HidesLightBehindWhatFacesIt) {
  std::mt19937 random(12);
  int hidden = 0;
  for (const int extent : {5, 30}) {
    const auto voxels = random_voxels(random, extent, extent == 5 ? 40 : 120);
    const BruteForce brute(voxels);
    const glm::dmat3 rotation = glm::mat3_cast(glm::angleAxis(1.0, random_direction(random)));
    const Tracer tracer({island_of(voxels, rotation, glm::dvec3(0.5))});
    for (int i = 0; i < 400; ++i) {
      const Shot shot = random_shot(random, brute, extent);
      // Faces that the light sees, which are met from behind on the way to it.
      const auto met = brute.meetings(shot.origin, shot.direction, false);
      const bool expected = std::any_of(met.begin(), met.end(), solid);
      EXPECT_EQ(tracer.hidden(rotation * shot.origin + 0.5, rotation * shot.direction), expected);
      hidden += expected ? 1 : 0;
    }
  }
  EXPECT_GT(hidden, 100);
  EXPECT_LT(hidden, 700);
}

TEST(ReferenceTracer, TheNearestOfSeveralIslandsIsMet) {
  std::mt19937 random(13);
  std::vector<Island> islands;
  std::vector<Tracer> alone;
  for (int i = 0; i < 5; ++i) {
    const auto rotation = glm::mat3_cast(glm::angleAxis(0.9 * i, random_direction(random)));
    islands.push_back(
        island_of(random_voxels(random, 6, 40), rotation, random_direction(random) * 6.0));
    alone.emplace_back(std::vector<Island>{islands.back()});
  }
  const Tracer tracer(islands);
  Trace all, one;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 origin = random_direction(random) * 25.0;
    const glm::dvec3 direction = glm::normalize(random_direction(random) * 5.0 - origin);
    tracer.trace(origin, direction, all);
    double nearest = kFar;
    std::size_t which = 0;
    bool hidden = false;
    for (std::size_t k = 0; k < alone.size(); ++k) {
      alone[k].trace(origin, direction, one);
      if (one.hit && one.hit->t < nearest) {
        nearest = one.hit->t;
        which = k;
      }
      hidden = hidden || alone[k].hidden(origin, direction);
    }
    ASSERT_EQ(all.hit.has_value(), nearest < kFar);
    if (all.hit) {
      EXPECT_EQ(all.hit->t, nearest);
      EXPECT_EQ(all.hit->island, which);
    }
    EXPECT_EQ(tracer.hidden(origin, direction), hidden);
  }
}

TEST(ReferenceTracer, ALeafIsThereWhereItsTextureIs) {
  const world::Texture layer = world::block_types()[world::block::kOakLeaves].side;
  const render::BlockTextures file = render::block_textures();
  ASSERT_EQ(file.edge, 32u);
  const Tracer tracer({single_block(world::block::kOakLeaves, {0.5, 0.5, 0.5})});
  Trace trace;
  int covered = 0;
  for (std::uint32_t row = 0; row < 32; ++row) {
    for (std::uint32_t column = 0; column < 32; ++column) {
      // Through the texel's centre, row 0 on top; on the -z face columns run along x.
      const glm::dvec3 at((column + 0.5) / 32.0, 1.0 - (row + 0.5) / 32.0, 0.0);
      const std::size_t texel = (static_cast<std::size_t>(layer) * 32 + row) * 32 + column;
      const bool there = std::to_integer<int>(file.texels[4 * texel + 3]) >= 128;
      tracer.trace(at - glm::dvec3(0, 0, 2), {0.0, 0.0, 1.0}, trace);
      EXPECT_EQ(trace.hit.has_value(), there);
      // Light from -z meets the same face.
      EXPECT_EQ(tracer.hidden(at + glm::dvec3(0, 0, 2), {0.0, 0.0, -1.0}), there);
      covered += there ? 1 : 0;
    }
  }
  EXPECT_GT(covered, 300);
  EXPECT_LT(covered, 1000);
}

TEST(ReferenceTracer, APlantDoesNotShadeItselfButItsNeighbour) {
  const Island two{world::Volume::from_voxels(
      {0, 0, 0}, {2, 1, 1}, [](IVec3) { return BlockId{world::block::kTallGrass}; })};
  const Tracer tracer({two});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  Trace trace;
  int itself = 0, neighbour = 0;
  for (int i = 0; i < 500; ++i) {
    // Somewhere on the nearer plant, and light from where the other one stands.
    tracer.trace({-1.0, place(random), place(random)}, {1.0, 0.0, 0.0}, trace);
    if (!trace.hit || trace.hit->voxel.x != 0) continue;
    const glm::dvec3 point = trace.hit->lattice;
    const glm::dvec3 light = glm::normalize(glm::dvec3(1.0, 0.1, 0.0));
    const BruteForce other({{{1, 0, 0}, world::block::kTallGrass}});
    const bool shaded = !other.meetings(point, light, true).empty();
    EXPECT_EQ(tracer.hidden(point, light, kFar, &*trace.hit), shaded);
    neighbour += shaded ? 1 : 0;
    itself += tracer.hidden(point + light * 1e-6, light) && !shaded ? 1 : 0;
  }
  EXPECT_GT(neighbour, 5);
  EXPECT_GT(itself, 5);
}

TEST(ReferenceTracer, ColoursOfATextureAreItsTexelsInLinearLight) {
  const render::BlockTextures file = render::block_textures();
  const auto layer = static_cast<std::size_t>(world::block_types()[world::block::kGrass].side);
  for (const std::uint32_t row : {0u, 5u, 31u}) {
    for (const std::uint32_t column : {0u, 9u, 31u}) {
      const glm::dvec3 at((column + 0.3) / 32.0 + 4.0, -(row + 0.7) / 32.0 - 2.0, 5.0);
      const glm::dvec4 texel = BlockTexels::shared().texel(world::block::kGrass, 4, at);
      for (std::size_t c = 0; c < 3; ++c) {
        const double srgb =
            std::to_integer<int>(file.texels[((layer * 32 + row) * 32 + column) * 4 + c]) / 255.0;
        const double linear =
            srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(texel[static_cast<int>(c)], linear, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace skerry::reference
