// Corners on the GPU against the closed form of tools/reference/brdf.h.
#include <algorithm>
#include <glm/common.hpp>
#include <random>

#include "tests/render/occupancy_on_gpu.h"
#include "tests/render/random_scenes.h"
#include "tools/reference/brdf.h"

namespace skerry::render {
namespace {

constexpr const char* kOpenness = R"(
  struct Question { vec3 lattice; uint face; uint island; };
  struct Answer { float ao; };
  Answer answer_to(Question q) { return Answer(corner_ao(q.island, q.face, q.lattice)); })";

/// A third of the voxels stand, without a pattern; some chunks are empty or full.
bool rubble(int x, int y, int z) {
  if ((x >> 6) == 1) return (y >> 6) == 0;
  auto h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
           static_cast<std::uint32_t>(y) * 0x85ebca77u ^
           static_cast<std::uint32_t>(z) * 0xc2b2ae3du;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 13;
  return h % 3 == 0;
}

class Corners : public OccupancyOnGpu {
 protected:
  struct Question {
    glm::vec3 lattice;
    std::uint32_t face, island;
  };
  /// A face of a voxel, and a place on it.
  struct Place {
    glm::ivec3 voxel;
    std::uint32_t face;
    double u, v;
    int axis() const { return static_cast<int>(face / 2); }
    int along_u() const { return axis() == 0 ? 2 : 0; }
    int along_v() const { return axis() == 1 ? 2 : 1; }
    glm::ivec3 front() const {
      glm::ivec3 at = voxel;
      at[axis()] += face % 2 == 0 ? 1 : -1;
      return at;
    }
    /// In voxels.
    glm::dvec3 point() const {
      glm::dvec3 p(voxel);
      p[axis()] += face % 2 == 0 ? 1.0 : 0.0;
      p[along_u()] += u;
      p[along_v()] += v;
      return p;
    }
  };
  static double expected(const Place& place, const OpaqueAt& opaque) {
    bool stands[9];
    for (int i = 0; i < 9; ++i) {
      glm::ivec3 at = place.front();
      at[place.along_u()] += i % 3 - 1;
      at[place.along_v()] += i / 3 - 1;
      stands[i] = opaque(at.x, at.y, at.z);
    }
    return reference::corner_ao({place.u, place.v}, stands);
  }
  /// Faces that are drawn: something stands, and nothing in front of it.
  static std::vector<Place> places(const OpaqueAt& opaque, glm::ivec3 low, glm::ivec3 size,
                                   std::size_t count) {
    RandomPlaces random(5);
    std::vector<Place> out;
    while (out.size() < count) {
      Place place;
      for (int axis = 0; axis < 3; ++axis)
        place.voxel[axis] = static_cast<int>(random.whole(low[axis], low[axis] + size[axis] - 1));
      place.face = static_cast<std::uint32_t>(random.whole(0, 5));
      place.u = random.uniform(0.0, 1.0);
      place.v = random.uniform(0.0, 1.0);
      const glm::ivec3 front = place.front();
      if (opaque(place.voxel.x, place.voxel.y, place.voxel.z) && !opaque(front.x, front.y, front.z))
        out.push_back(place);
    }
    return out;
  }
  void expect_equal(const std::vector<Place>& places, const OpaqueAt& opaque, double blocks_a_voxel,
                    double off, double bound) {
    std::vector<Question> questions;
    for (const Place& place : places) {
      glm::dvec3 p = place.point();
      // Off the plane and across the face's edges, as a depth is that was rounded.
      RandomPlaces random(questions.size());
      p += random.in_box(off);
      questions.push_back({glm::vec3(p * blocks_a_voxel), place.face, 0});
    }
    const auto answers = ask<float>(kOpenness, questions);
    double worst = 0.0;
    for (std::size_t i = 0; i < answers.size(); ++i)
      worst = std::max(worst, std::abs(answers[i] - expected(places[i], opaque)));
    EXPECT_LT(worst, bound);
  }
};

// Places within 200 blocks are floats to 1.6e-5 block; ao changes by at most 1 along a block
// in u and in v.
TEST_F(Corners, AreTheClosedFormAtEveryPointOfEveryFace) {
  add_island(0, rubble, {{-1, -1, -1}, {3, 2, 2}, 0});
  expect_equal(places(rubble, {-63, -63, -63}, {190, 126, 126}, 40000), rubble, 1.0, 0.0, 4e-5);
}

TEST_F(Corners, CrossTheBordersOfChunksAndBricks) {
  add_island(0, rubble, {{-1, -1, -1}, {2, 2, 2}, 0});
  std::vector<Place> near;
  for (const Place& place : places(rubble, {-10, -10, -10}, {20, 20, 20}, 40000)) {
    const glm::ivec3 front = place.front();
    if (glm::any(glm::lessThanEqual(glm::abs(front * 2 + 1), glm::ivec3(1)))) near.push_back(place);
  }
  ASSERT_GT(near.size(), 4000u);
  expect_equal(near, rubble, 1.0, 0.0, 4e-5);
}

TEST_F(Corners, AreThoseOfTheLevelThatIsShown) {
  add_island(0, rubble, {{-1, -1, -1}, {2, 2, 2}, 3});
  expect_equal(places(rubble, {-63, -63, -63}, {126, 126, 126}, 20000), rubble, 8.0, 0.0, 4e-5);
}

// Rounding may put a point next to a face's edge beside the face, where something may stand.
TEST_F(Corners, AreThoseOfTheFaceForPointsRoundedOffIt) {
  constexpr double kOff = 1e-3;
  add_island(0, rubble, {{-1, -1, -1}, {2, 2, 2}, 0});
  std::vector<Place> at_edges = places(rubble, {-60, -60, -60}, {120, 120, 120}, 40000);
  for (Place& place : at_edges) {
    place.u = place.u < 0.5 ? 0.0 : 1.0;  // what is beside the face is as often solid as not
    place.v = glm::clamp(place.v, 0.01, 0.99);
  }
  // Where nothing stands beside, the face may go on or not: the eight voxels are then others.
  std::erase_if(at_edges, [](const Place& place) {
    glm::ivec3 beside = place.front();
    beside[place.along_u()] += place.u == 0.0 ? -1 : 1;
    return !rubble(beside.x, beside.y, beside.z);
  });
  ASSERT_GT(at_edges.size(), 5000u);
  expect_equal(at_edges, rubble, 1.0, kOff, 2.5 * kOff);
}

}  // namespace
}  // namespace skerry::render
