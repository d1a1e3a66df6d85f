#include "world/light/opening_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "tests/world/light/voxel_rooms.h"

namespace skerry::world {
namespace {

using test::beside;
using test::chunks_of;
using test::record_of;
using test::Voxels;

TEST(OpeningRays, OfEachSetAreInAllLobesOfTheFace) {
  for (int face = 0; face < 6; ++face)
    for (int set = 0; set < 8; ++set) {
      const IVec3 front{set & 1, -(set >> 1 & 1), set >> 2};
      for (const std::uint32_t lobe : OpeningRays::lobes(front, face, ~std::uint64_t{0}))
        EXPECT_EQ(lobe, 65280u);
      for (const std::uint32_t lobe : OpeningRays::lobes(front, face, 0)) EXPECT_EQ(lobe, 0u);
    }
}

// A room of stone with one window, a voxel deep, in the wall at low x.
constexpr int kEdge = 12, kHeight = 5;
constexpr int kLowZ = 4, kHighZ = 8, kLowY = 1, kHighY = 4;  // of the window, the last one excluded
Voxels room() {
  Voxels stone;
  for (int x = -1; x <= kEdge; ++x)
    for (int y = -1; y <= kHeight; ++y)
      for (int z = -1; z <= kEdge; ++z) {
        const bool inside = x >= 0 && x < kEdge && y >= 0 && y < kHeight && z >= 0 && z < kEdge;
        const bool window = x == -1 && y >= kLowY && y < kHighY && z >= kLowZ && z < kHighZ;
        if (!inside && !window) stone.insert({x, y, z});
      }
  return stone;
}
bool is_inside(IVec3 v) {
  return v.x >= 0 && v.x < kEdge && v.y >= 0 && v.y < kHeight && v.z >= 0 && v.z < kEdge;
}

/// Irradiance under an even sky, of that of an open plane, through the window: an integral over its
/// outer side of what is seen through its inner one.
double through_window(glm::dvec3 place, glm::dvec3 normal) {
  constexpr int kParts = 24;  // of a block
  double sum = 0.0;
  for (int i = 0; i < (kHighY - kLowY) * kParts; ++i)
    for (int k = 0; k < (kHighZ - kLowZ) * kParts; ++k) {
      const glm::dvec3 outer(-1.0, kLowY + (i + 0.5) / kParts, kLowZ + (k + 0.5) / kParts);
      const glm::dvec3 way = outer - place, inner = place + way * (place.x / (place.x + 1.0));
      if (inner.y < kLowY || inner.y > kHighY || inner.z < kLowZ || inner.z > kHighZ) continue;
      const double distance2 = glm::dot(way, way);
      const double cosines = std::max(0.0, glm::dot(way, normal)) * -way.x / distance2;
      sum += cosines / (std::numbers::pi * distance2);
    }
  return sum / (kParts * kParts);
}

/// Share of an even sky's irradiance that a corner of a record has.
double of_record(const std::vector<std::uint32_t>& record, std::size_t corner, int face) {
  std::array<double, shared::kSkyLobes> weights{};
  for (const std::size_t fan : fans_of_face(face))
    for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k)
      weights[lobe_of(axis_of(fan), octant_of(fan), k)] +=
          lobe_weights(face / 2)[k] / (4.0 * 65280.0);
  double sum = 0.0;
  for (std::size_t lobe = 0; lobe < weights.size(); ++lobe)
    sum += weights[lobe] * (record[2 * corner + lobe / 4] >> 8 * (lobe % 4) & 255u) / 255.0;
  return sum;
}

// A corner stands for the faces about it, each by its middle.
TEST(OpeningRays, SeeOfTheSkyThroughAWindowWhatAnIntegralSays) {
  const Voxels stone = room();
  SkyTransfer transfer(chunks_of(stone));
  for (int octant = 0; octant < kOctants; ++octant) transfer.look(octant);
  const SkyTransfer::Skies& skies = transfer.make_faces();
  double squares = 0.0, mean = 0.0, difference = 0.0, lines_squares = 0.0;
  int count = 0;
  for (const IVec3& wall : stone)
    for (int face = 0; face < 6; ++face) {
      const IVec3 front = beside(wall, face);
      if (!is_inside(front)) continue;
      const FaceAxes axes(face);
      const std::vector<std::uint32_t> record = record_of(skies, wall, face);
      ASSERT_EQ(record.size(), 16u);
      for (std::size_t corner = 0; corner < 4; ++corner) {
        double exact = 0.0, lines = 0.0;
        int faces = 0;
        for (int b = 0; b < 2; ++b)
          for (int c = 0; c < 2; ++c) {
            const IVec3 at = front + axis_vector(axes.b, corner & 1 ? b : -b) +
                             axis_vector(axes.c, corner & 2 ? c : -c);
            if (!is_inside(at)) continue;
            glm::dvec3 normal(0.0);
            normal[axes.own] = axes.sign;
            exact += through_window(glm::dvec3(vector_of(at)) + 0.5 - 0.5 * normal, normal);
            ++faces;
            for (const std::size_t fan : fans_of_face(face))
              for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k)
                if (transfer.seen(at, fan) >> k & 1)
                  lines += lobe_weights(face / 2)[k] / (4.0 * 65280.0);
          }
        exact /= faces;
        lines /= faces;
        const double off = of_record(record, corner, face) - exact;
        squares += off * off;
        difference += off;
        mean += exact;
        lines_squares += (lines - exact) * (lines - exact);
        ++count;
      }
    }
  const double rmse = std::sqrt(squares / count) / (mean / count),
               of_lines = std::sqrt(lines_squares / count) / (mean / count);
  RecordProperty("rmse", std::to_string(rmse));
  EXPECT_LT(rmse, 0.4) << of_lines << " by lines alone";
  EXPECT_GT(of_lines, 1.5 * rmse);
  EXPECT_LT(std::abs(difference / mean), 0.05);
}

std::unique_ptr<SkyTransfer> looked_at(const LightChunks& chunks) {
  auto transfer = std::make_unique<SkyTransfer>(chunks);
  for (int octant = 0; octant < kOctants; ++octant) transfer->look(octant);
  transfer->make_faces();
  return transfer;
}

/// Records that differ, of chunks that both have.
std::size_t differences(const SkyTransfer::Skies& a, const SkyTransfer::Skies& b) {
  std::size_t count = 0;
  for (const auto& [at, sky] : a) {
    const auto other = b.find(at);
    if (other == b.end()) continue;
    const ChunkSky &its = *sky, &others = *other->second;
    for_each_record(its, [&](IVec3 voxel, int direction, std::size_t record) {
      const auto same = find_record(others, voxel, direction);
      if (!same) return;
      for (std::size_t i = 0; i < its.record_texels(); ++i)
        if (its.texels[record + i] != others.texels[*same + i]) {
          ++count;
          return;
        }
    });
  }
  return count;
}

// A room in rock with a window to one side. Screens come and go so far away that rays cross more
// planes than are counted and kept, at once and close by; a shaft is dug up from it, and closed.
TEST(OpeningRays, AreFollowedAgainFromFarAwayAndWhereRockIsDug) {
  constexpr int kRoom = 6, kRock = 18, kFar = 300, kScreen = 40;
  Voxels stone;
  for (int x = -kRock; x <= kRoom; ++x)
    for (int y = -kRock; y < kRoom + kRock; ++y)
      for (int z = -kRock; z < kRoom + kRock; ++z) {
        const bool inside = x >= -10 && x < kRoom && y >= 0 && y < kRoom && z >= 0 && z < kRoom;
        const bool window = x == kRoom && y >= 1 && y < 5 && z >= 1 && z < 5;
        if (!inside && !window) stone.insert({x, y, z});
      }
  stone.insert({kFar + 2, -22, -22});  // the kept volume holds all that comes
  stone.insert({kFar + 2, 22, 22});
  const auto screen = [&](int x, int y, int z, int edge) {
    Voxels out;
    for (int j = 0; j < edge; ++j)
      for (int k = 0; k < edge; ++k) out.insert({x, y + j, z + k});
    return out;
  };
  Voxels shaft;
  for (int y = kRoom; y < kRoom + kRock; ++y)
    for (int i = 0; i < 4; ++i) shaft.insert({-7 + i % 2, y, 2 + i / 2});
  struct Change {
    Voxels voxels;
    bool come;
  };
  const std::vector<Change> changes{{screen(kFar, -20, -20, kScreen), true},
                                    {screen(kRoom + 4, 2, 2, 2), true},
                                    {shaft, false},
                                    {screen(kFar, -20, -20, kScreen), false},
                                    {screen(kRoom + 4, 2, 2, 2), false},
                                    {Voxels{{-7, kRoom + kRock - 1, 2}}, true},
                                    {Voxels{{-7, kRoom + kRock - 1, 2}}, false}};
  LightChunks chunks = chunks_of(stone);
  auto edited = looked_at(chunks);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    for (const IVec3& voxel : changes[i].voxels)
      if (changes[i].come)
        stone.insert(voxel);
      else
        stone.erase(voxel);
    const SkyTransfer::Skies before = edited->faces();
    chunks = chunks_of(stone);
    ASSERT_TRUE(edited->edit(chunks)) << i;
    EXPECT_EQ(differences(looked_at(chunks)->faces(), edited->faces()), 0u) << i;
    EXPECT_GT(differences(before, edited->faces()), 0u) << i;
  }
}

}  // namespace
}  // namespace skerry::world
