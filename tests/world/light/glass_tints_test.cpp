// Light that passes stained glass, against Beer's law along lines and paths through the same voxels
// that know of no lattice vectors, no octants and no harmonics.
#include "world/light/glass_tints.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <random>

#include "tests/world/light/voxel_rooms.h"
#include "world/light/base/shared_exponent.h"
#include "world/light/sky_transfer.h"
#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

using test::beside;
using test::chunks_of;
using test::Glass;
using test::Voxels;

constexpr double kPi = std::numbers::pi;
constexpr float kAlbedo = 0.6f;

glm::dvec3 extinction_of(BlockId block) {
  const BlockType& type = block_types()[block];
  return glm::dvec3(type.absorption[0], type.absorption[1], type.absorption[2]) +
         static_cast<double>(type.scattering);
}

glm::dvec3 exponentials(glm::dvec3 v) {
  return {std::exp(v.x), std::exp(v.y), std::exp(v.z)};
}

/// A look at an island, all of it.
class Look {
 public:
  explicit Look(const LightChunks& chunks)
      : albedo_(block_types().size()), transfer_(chunks, with_albedo(albedo_)) {
    for (int octant = 0; octant < kOctants; ++octant) transfer_.look(octant);
    transfer_.spread_lamps();
    for (int step = 0; step < BounceLight::kSteps; ++step)
      for (int part = 0; part < BounceLight::kParts; ++part) transfer_.follow_bounces(step, part);
    transfer_.make_faces();
  }
  const SkyTransfer::Skies& faces() const { return transfer_.faces(); }

  /// Irradiance in the middle of a face under a sky of radiance 1 from everywhere.
  glm::dvec3 under_even_sky(IVec3 voxel, int face) const {
    return sky(voxel, face) + bounced(voxel, face);
  }
  /// Of the sky itself.
  glm::dvec3 sky(IVec3 voxel, int face) const {
    const std::vector<std::uint32_t> record = test::record_of(faces(), voxel, face);
    EXPECT_GE(record.size(), 16u);
    glm::dvec3 sum(0.0), colour(0.0);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const glm::vec3 tint =
          record.size() > 16 ? unpack_shared_exponent(record[16 + corner]) : glm::vec3(1.0f);
      double seen = 0.0;
      for (std::size_t lobe = 0; lobe < shared::kSkyLobes; ++lobe)
        seen += (record[2 * corner + lobe / 4] >> (8 * (lobe % 4)) & 255u) / 255.0 *
                whole_lobe(face, lobe);
      sum += seen / 4.0;
      colour += glm::dvec3(tint) / 4.0;
    }
    return kPi * sum * colour;
  }
  /// What other faces reflect of it.
  glm::dvec3 bounced(IVec3 voxel, int face) const {
    const std::vector<std::uint32_t> record = test::record_of(faces(), voxel, face);
    double share = 0.0;
    for (int corner = 0; corner < 4; ++corner)
      share += (record[13] >> (8 * corner) & 255u) / 255.0 / 4.0;
    return glm::dvec3(unpack_shared_exponent(record[12])) * (std::sqrt(4.0 * kPi) * share);
  }

 private:
  static std::span<const FaceAlbedo> with_albedo(std::vector<FaceAlbedo>& all) {
    for (FaceAlbedo& block : all) block.fill(glm::vec3(kAlbedo));
    return all;
  }
  /// Share of an open face's light.
  static double whole_lobe(int face, std::size_t lobe) {
    double sum = 0.0;
    for (int octant = 0; octant < kOctants; ++octant)
      for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k)
        if ((octant >> face / 2 & 1) == face % 2 && lobe_of(face / 2, octant, k) == lobe)
          sum += lobe_weights(face / 2)[k] / 65280.0 / 4.0;
    return sum;
  }

  std::vector<FaceAlbedo> albedo_;
  SkyTransfer transfer_;
};

/// Where a straight line is in a closed voxel, in units of its direction; to < from: nowhere.
struct Stretch {
  double from = 0.0, to = 0.0;
};
Stretch stretch_in(IVec3 voxel, glm::dvec3 origin, glm::dvec3 direction) {
  Stretch out{0.0, 1e300};
  const glm::dvec3 low(voxel.x, voxel.y, voxel.z);
  for (int a = 0; a < 3; ++a) {
    const double one = (low[a] - origin[a]) / direction[a],
                 other = (low[a] + 1.0 - origin[a]) / direction[a];
    out.from = std::max(out.from, std::min(one, other));
    out.to = std::min(out.to, std::max(one, other));
  }
  return out;
}
glm::dvec3 middle_of(IVec3 voxel) {
  return glm::dvec3(voxel.x, voxel.y, voxel.z) + 0.5;
}

/// What is left of light along a line, by its length in each voxel of glass.
glm::dvec3 left_along(const Glass& glass, glm::dvec3 from, glm::dvec3 direction, double end) {
  glm::dvec3 depth(0.0);
  for (const auto& [voxel, block] : glass) {
    const Stretch in = stretch_in(voxel, from, direction);
    depth += extinction_of(block) * std::max(0.0, std::min(in.to, end) - in.from);
  }
  return exponentials(-depth);
}
/// From the middle of a voxel, with twice the length in that one.
glm::dvec3 left_along(const Glass& glass, IVec3 from, glm::dvec3 direction, double end) {
  const Glass::const_iterator own = glass.find(from);
  const glm::dvec3 left = left_along(glass, middle_of(from), direction, end);
  return own == glass.end() ? left : left * left_along({*own}, middle_of(from), direction, end);
}

constexpr std::array<BlockId, 3> kColours{block::kRedGlass, block::kBlueGlass, block::kLimeGlass};

TEST(GlassTints, FollowBeersLawAlongEachLineUpToWhereItEnds) {
  std::mt19937 random(7);
  Voxels stone;
  Glass glass;
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = 0; z < 16; ++z) {
        const auto lot = random() % 100;
        if (lot < 4) stone.insert({x, y, z});
        if (lot >= 90) glass[{x, y, z}] = kColours[random() % 3];
      }
  const AirVolume air = air_volume_of(chunks_of(stone, {}, {}, glass));
  const LatticeLines lines(air);
  VoxelBits wanted(air.opaque.low(), air.opaque.size(), false);
  for (int i = 0; i < 40; ++i) {
    const IVec3 voxel{static_cast<int>(random() % 16), static_cast<int>(random() % 16),
                      static_cast<int>(random() % 16)};
    if (!stone.contains(voxel)) wanted.set(voxel);
  }
  const VoxelIndex index(std::move(wanted));
  GlassTints tints(air, lines, index);
  for (std::size_t fan = 0; fan < kFans; ++fan) tints.look(fan);
  int passed = 0, clear = 0;
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = 0; z < 16; ++z) {
        const IVec3 voxel{x, y, z};
        if (!index.has(voxel)) continue;
        for (std::size_t way = 0; way < LatticeLines::kWays; ++way) {
          const IVec3 v = lines.way(way).vector;
          const glm::dvec3 direction = glm::normalize(glm::dvec3(v.x, v.y, v.z));
          const std::size_t fan = way / 16;
          const glm::dvec3 start = test::start_of_line(voxel, v, axis_of(fan));
          double end = 1e300;
          for (const IVec3& block : stone) {
            const Stretch in = stretch_in(block, start, direction);
            if (in.to > in.from) end = std::min(end, in.from);
          }
          const glm::dvec3 right = left_along(glass, start, direction, end);
          const GlassTints::Tints* all = tints.find(index.of(voxel), fan);
          glm::dvec3 found(1.0);
          if (all != nullptr)
            for (const GlassTints::Tint& tint : *all)
              if (tint.pattern == way % 16) found = tint.left;
          for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], right[c], 1e-4) << way << ' ' << c;
          (right.x < 1.0 ? passed : clear) += 1;
        }
      }
  EXPECT_GT(passed, 1000);
  EXPECT_GT(clear, 300);
}

TEST(GlassTints, OfLampsAreBeersLawAlongTheWayToEach) {
  const Voxels stone{{0, 0, 0}, {12, 8, 12}};
  Glass glass;
  std::mt19937 random(3);
  for (int i = 0; i < 150; ++i)
    glass[{1 + static_cast<int>(random() % 10), static_cast<int>(random() % 8),
           static_cast<int>(random() % 12)}] = kColours[random() % 3];
  const IVec3 lamp_voxel{6, 4, 6};
  glass.erase(lamp_voxel);
  const WeakLamp lamp{glm::vec3(middle_of(lamp_voxel)), glm::vec3(1.0f), 30.0f};
  const AirVolume clear = air_volume_of(chunks_of(stone)),
                  stained = air_volume_of(chunks_of(stone, {}, {}, glass));
  int tinted = 0;
  for (int i = 0; i < 300; ++i) {
    const IVec3 voxel{static_cast<int>(random() % 12), 1 + static_cast<int>(random() % 7),
                      static_cast<int>(random() % 12)};
    if (voxel == lamp_voxel) continue;
    // A little aside, since a line along a plane between voxels is in both or in neither.
    WeakLamp aside = lamp;
    aside.place += glm::vec3(0.0131f, -0.0173f, 0.0117f);
    const glm::dvec3 way = glm::dvec3(aside.place) - middle_of(voxel);
    const glm::dvec3 left = left_along(glass, voxel, glm::normalize(way), glm::length(way));
    const LampLight open = light_of_lamp(clear, aside, voxel),
                    found = light_of_lamp(stained, aside, voxel);
    for (std::size_t face = 0; face < 6; ++face)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(static_cast<double>(found[face][c]),
                    static_cast<double>(open[face][c]) * left[c],
                    1e-4 * static_cast<double>(open[face][c]));
    tinted += left.y < 0.5 ? 1 : 0;
  }
  EXPECT_GT(tinted, 100);
}

/// Voxels as a path tracer has them.
class GlassPaths {
 public:
  GlassPaths(const Voxels& stone, const Glass& glass) : stone_(stone), glass_(glass) {}

  /// Irradiance of a face under a sky of radiance 1.
  struct Light {
    glm::dvec3 sky{0.0}, bounced{0.0};
  };
  /// By paths from all over it.
  Light light(IVec3 voxel, int face, int count) {
    Light sum;
    for (int i = 0; i < count; ++i) {
      Point at{glm::dvec3(voxel.x, voxel.y, voxel.z), face};
      for (int a = 0; a < 3; ++a)
        at.place[a] += a == face / 2 ? (face % 2 == 0 ? 1.0 : 0.0) : even_(random_);
      glm::dvec3 weight(kPi / count);
      for (int bounce = 0; bounce <= BounceLight::kBounces; ++bounce) {
        if (!meets(at, weight)) {
          (bounce == 0 ? sum.sky : sum.bounced) += weight;
          break;
        }
        weight *= static_cast<double>(kAlbedo);
      }
    }
    return sum;
  }

 private:
  struct Point {
    glm::dvec3 place;
    int face;
  };
  /// Goes on by a cosine's lot. @return whether that meets a face, and which.
  bool meets(Point& at, glm::dvec3& weight) {
    const int axis = at.face / 2;
    const double r = even_(random_), turn = 2.0 * kPi * even_(random_);
    glm::dvec3 d;
    d[axis] = std::sqrt(1.0 - r) * (at.face % 2 == 0 ? 1.0 : -1.0);
    d[(axis + 1) % 3] = std::sqrt(r) * std::cos(turn);
    d[(axis + 2) % 3] = std::sqrt(r) * std::sin(turn);
    glm::ivec3 voxel(glm::floor(at.place));
    voxel[axis] = static_cast<int>(std::round(at.place[axis])) - (at.face % 2 == 0 ? 0 : 1);
    const glm::dvec3 from = at.place;
    double t = 0.0;
    while (glm::all(glm::lessThan(glm::abs(voxel), glm::ivec3(40)))) {
      int next_axis = 0;
      double next = 1e300;
      for (int a = 0; a < 3; ++a) {
        const double to = (voxel[a] + (d[a] > 0.0 ? 1 : 0) - from[a]) / d[a];
        if (to < next) next = to, next_axis = a;
      }
      if (const auto in = glass_.find({voxel.x, voxel.y, voxel.z}); in != glass_.end())
        weight *= exponentials(extinction_of(in->second) * (t - next));
      t = next;
      voxel[next_axis] += d[next_axis] > 0.0 ? 1 : -1;
      if (!stone_.contains({voxel.x, voxel.y, voxel.z})) continue;
      at = {from + t * d, 2 * next_axis + (d[next_axis] > 0.0 ? 1 : 0)};
      at.place[next_axis] = voxel[next_axis] + (d[next_axis] > 0.0 ? 0 : 1);
      return true;
    }
    return false;
  }

  const Voxels& stone_;
  const Glass& glass_;
  std::mt19937_64 random_{3};
  std::uniform_real_distribution<double> even_{0.0, 1.0};
};

/// Calls fn(voxel, block) for each of a box.
template <class Fn>
void for_each_in(IVec3 low, IVec3 high, const Fn& fn) {
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z) fn(IVec3{x, y, z});
}

/// A room with a red window and a blue one, and a floor of glass tiles in a corner.
struct Room {
  Voxels stone;
  Glass glass;
  Room() {
    for_each_in({-7, 0, -7}, {7, 9, 7}, [&](IVec3 v) { stone.insert(v); });
    for_each_in({-6, 1, -6}, {6, 8, 6}, [&](IVec3 v) { stone.erase(v); });
    const auto pane = [&](IVec3 low, IVec3 high, BlockId block) {
      for_each_in(low, high, [&](IVec3 v) { stone.erase(v), glass[v] = block; });
    };
    pane({6, 2, -4}, {7, 7, 4}, block::kRedGlass);
    pane({-7, 2, -4}, {-6, 7, 4}, block::kSkyGlass);
    pane({-2, 1, -6}, {2, 2, -4}, block::kOrangeGlass);
  }
};

TEST(GlassLight, InARoomIsNearToPathsThroughItsWindows) {
  const Room room;
  const Look look(chunks_of(room.stone, {}, {}, room.glass));
  GlassPaths paths(room.stone, room.glass);
  struct Sums {
    glm::dvec3 right{0.0}, found{0.0}, squares{0.0};
  };
  Sums sky, bounced;
  int faces = 0;
  double hue_off = 0.0;
  std::mt19937 random(2);
  for (const IVec3& v : room.stone)
    for (int face = 0; face < 6; ++face) {
      const IVec3 front = beside(v, face);
      const bool inside = front.x >= -6 && front.x < 6 && front.y >= 1 && front.y < 8 &&
                          front.z >= -6 && front.z < 6;
      if (!inside || room.stone.contains(front) || random() % 5 != 0) continue;
      const GlassPaths::Light right = paths.light(v, face, 4000);
      const auto take = [](Sums& sums, glm::dvec3 its, glm::dvec3 found) {
        sums.right += its, sums.found += found;
        sums.squares += (found - its) * (found - its);
      };
      take(sky, right.sky, look.sky(v, face));
      take(bounced, right.bounced, look.bounced(v, face));
      const glm::dvec3 all = right.sky + right.bounced, found = look.under_even_sky(v, face);
      hue_off += std::abs(all.x / (all.x + all.z) - found.x / (found.x + found.z));
      ++faces;
    }
  ASSERT_GT(faces, 60);
  for (int c = 0; c < 3; ++c) {
    const auto rms = [&](const Sums& sums) {
      return std::sqrt(sums.squares[c] / faces) / (sums.right[c] / faces);
    };
    EXPECT_NEAR(sky.found[c] / sky.right[c], 1.0, 0.06) << c;
    EXPECT_NEAR(bounced.found[c] / bounced.right[c], 1.0, 0.12) << c;
    EXPECT_LT(rms(sky), 0.4) << c;
    EXPECT_LT(rms(bounced), 0.4) << c;
  }
  EXPECT_LT(hue_off / faces, 0.05);
}

TEST(GlassLight, ReachesNothingInASealedRoomWithGlassInIt) {
  Room room;
  for_each_in({-8, 0, -8}, {8, 10, 8}, [&](IVec3 v) {
    const bool wall = v.x < -6 || v.x >= 6 || v.y < 1 || v.y >= 8 || v.z < -6 || v.z >= 6;
    if (wall && !room.glass.contains(v)) room.stone.insert(v);
  });
  const Look look(chunks_of(room.stone, {}, {}, room.glass));
  int faces = 0;
  for (const IVec3& v : room.stone)
    for (int face = 0; face < 6; ++face) {
      const IVec3 front = beside(v, face);
      if (std::max(std::abs(2 * front.x + 1), std::abs(2 * front.z + 1)) > 12 || front.y < 1 ||
          front.y > 7 || room.stone.contains(front))
        continue;
      EXPECT_EQ(look.under_even_sky(v, face), glm::dvec3(0.0));
      ++faces;
    }
  EXPECT_GT(faces, 300);
}

TEST(GlassLight, IsWhiteBehindClearGlass) {
  std::vector<BlockId> padded(kPaddedVoxels, kAir);
  const auto place = [](int x, int y, int z) {
    return static_cast<std::size_t>(1 + z + kPaddedEdge * (x + 1 + kPaddedEdge * (y + 1)));
  };
  padded[place(3, 5, 7)] = block::kGlass;
  padded[place(4, 5, 7)] = block::kWater;
  EXPECT_TRUE(stained_voxels_of(padded).empty());
  padded[place(63, 1, 2)] = block::kWhiteGlass;
  padded[place(0, 9, 63)] = block::kBlackGlass;
  padded[place(-1, 3, 3)] = block::kRedGlass;  // another chunk's
  const std::vector<StainedVoxel> found = stained_voxels_of(padded);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0], (StainedVoxel{2 | 63 << 6 | 1 << 12, block::kWhiteGlass}));
  EXPECT_EQ(found[1], (StainedVoxel{63 | 9 << 12, block::kBlackGlass}));
}

}  // namespace
}  // namespace skerry::world
