// Light of a body on faces, against lines that are tried with each voxel by itself.
#include "world/light/body_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>
#include <vector>

#include "tests/world/light/voxel_rooms.h"
#include "world/light/base/face_records.h"
#include "world/light/glass_tints.h"
#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

using test::chunks_of;
using test::Glass;
using test::Voxels;

/// How much of a line from a place on lies in a voxel.
double length_in(glm::dvec3 from, glm::dvec3 d, IVec3 voxel) {
  double enters = 0.0, leaves = 1e9;
  for (int a = 0; a < 3; ++a) {
    const double low = vector_of(voxel)[a] - from[a], high = low + 1.0;
    if (d[a] == 0.0) {
      if (low > 0.0 || high < 0.0) return 0.0;
      continue;
    }
    enters = std::max(enters, std::min(low / d[a], high / d[a]));
    leaves = std::min(leaves, std::max(low / d[a], high / d[a]));
  }
  return std::max(leaves - enters, 0.0);
}

glm::dvec3 on_face(const Voxels& stone, const Glass& glass, IVec3 front, int face, glm::dvec3 d) {
  glm::dvec3 normal(0.0), sum(0.0);
  normal[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
  const double cosine = glm::dot(normal, d);
  if (cosine <= 0.0) return sum;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      glm::dvec3 from(vector_of(front));
      from[face / 2] += face % 2 == 0 ? 0.0 : 1.0;
      from[(face / 2 + 1) % 3] += (i + 0.5) / 3.0;
      from[(face / 2 + 2) % 3] += (j + 0.5) / 3.0;
      if (std::ranges::any_of(stone, [&](IVec3 v) { return length_in(from, d, v) > 1e-6; }))
        continue;
      glm::dvec3 left(1.0);
      for (const auto& [voxel, block] : glass)
        left *= left_by_glass(block, static_cast<float>(length_in(from, d, voxel)));
      sum += left;
    }
  return sum * (cosine / 9.0);
}

std::vector<glm::vec3> directions() {
  std::vector<glm::vec3> out{{0.0f, 1.0f, 0.0f},
                             glm::normalize(glm::vec3(0.0f, 1.0f, 0.37f)),
                             glm::normalize(glm::vec3(0.9f, 0.004f, -0.31f))};
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 8; ++i)
    out.push_back(glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
  return out;
}

struct Heap {
  Voxels stone;
  Glass glass;
  explicit Heap(unsigned seed) {
    std::mt19937 random(seed);
    const auto place = [&] {
      const auto part = [&](unsigned size) {
        return static_cast<int>(random() % size) - static_cast<int>(size / 2);
      };
      return IVec3{part(14), part(10), part(14)};
    };
    for (int i = 0; i < 160; ++i) stone.insert(place());
    for (int i = 0; i < 60; ++i) {
      const IVec3 at = place();
      if (!stone.contains(at)) glass[at] = static_cast<BlockId>(block::kWhiteGlass + random() % 16);
    }
  }
};

TEST(BodyRays, PassAndMeetWhatStraightLinesDo) {
  const Heap heap(1);
  const LightChunks chunks = chunks_of(heap.stone, {}, {}, heap.glass);
  const AirVolume air = air_volume_of(chunks);
  int lit = 0, partly = 0, differ = 0;
  for (const glm::vec3& d : directions()) {
    const BodyRays rays(air, d);
    for (const IVec3& voxel : heap.stone)
      for (int face = 0; face < 6; ++face) {
        const IVec3 front = test::beside(voxel, face);
        if (heap.stone.contains(front)) continue;
        const glm::dvec3 right = on_face(heap.stone, heap.glass, front, face, d);
        const glm::vec3 found = rays.on_face(front, face);
        bool same = true;
        for (int c = 0; c < 3; ++c)
          same &= std::abs(static_cast<double>(found[c]) - right[c]) < 1e-4;
        differ += same ? 0 : 1;
        lit += right.y > 0.0 ? 1 : 0;
        partly += right.y > 0.0 && right.y < 0.99 * std::abs(d[face / 2]) ? 1 : 0;
      }
  }
  EXPECT_GT(lit, 500);
  EXPECT_LE(differ, lit / 500);  // lines along edges
  EXPECT_GT(partly, 200);
}

// What an edit changes lies behind it.
TEST(BodyRays, KnowAllFacesThatAVoxelCanShade) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Heap heap(seed);
    Voxels without = heap.stone;
    const IVec3 gone = *std::next(without.begin(), 20 + seed * 17);
    without.erase(gone);
    const AirVolume with = air_volume_of(chunks_of(heap.stone)),
                    open = air_volume_of(chunks_of(without));
    int changed = 0;
    for (const glm::vec3& d : directions()) {
      const BodyRays before(with, d), after(open, d);
      std::set<IVec3> behind;
      before.for_each_behind(gone, [&](IVec3 voxel) { behind.insert(voxel); });
      for (const IVec3& voxel : without)
        for (int face = 0; face < 6; ++face) {
          const IVec3 front = test::beside(voxel, face);
          if (heap.stone.contains(front) || front == gone) continue;
          if (before.on_face(front, face) == after.on_face(front, face)) continue;
          EXPECT_TRUE(behind.contains(front)) << seed;
          ++changed;
        }
    }
    EXPECT_GT(changed, 5) << seed;
  }
}

// On a wide floor, half of the leaves' and a quarter of the plants' voxels stop a line.
TEST(BodyRays, LeavesStopHalfOfThemAndPlantsAQuarter) {
  Voxels stone, plants;
  for (int x = 0; x < 48; ++x)
    for (int z = 0; z < 48; ++z) stone.insert({x, 0, z}), plants.insert({x, 2, z});
  const AirVolume air = air_volume_of(chunks_of(stone, {}, plants));
  const BodyRays rays(air, glm::vec3(0.0f, 1.0f, 0.0f));
  double sum = 0.0;
  for (int x = 0; x < 48; ++x)
    for (int z = 0; z < 48; ++z) sum += static_cast<double>(rays.on_face({x, 1, z}, 2).x);
  EXPECT_NEAR(sum / (48 * 48), 0.75, 0.02);
}

}  // namespace
}  // namespace skerry::world
