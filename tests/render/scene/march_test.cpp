// The march through occupancy against an exact one in integers.
#include <array>
#include <random>
#include <set>
#include <vector>

#include "tests/render/occupancy_on_gpu.h"
#include "tests/render/random_scenes.h"

namespace skerry::render {
namespace {

constexpr const char* kMarch =
    "#include \"include/scene/march.glsl\"\n"
    R"(
  struct Question { vec3 from; vec3 to; uint island; };
  struct Answer { uint blocked; };
  Answer answer_to(Question q) {
    ivec3 first = ivec3(floor(q.from)), last = ivec3(floor(q.to));
    return Answer(marched_into(voxel_grid(q.island), q.from, first, q.to, last) ? 1u : 0u);
  })";

struct Ray {
  glm::vec3 from, to;
  std::uint32_t island = 0;
};

// Coordinates are whole numbers of these, so that the march below is exact. Distinct crossings of
// ways of up to 2000 units lie 1 / 2000^2 of the way apart: floats still tell them from each other.
constexpr int kUnits16 = 16;

/// An exact march. Where a way passes through an edge or corner, each order of the axes is a way
/// next to it: all are followed.
class ExactMarch {
 public:
  ExactMarch(const OpaqueAt& opaque, const Ray& ray) : opaque_(opaque) {
    for (int axis = 0; axis < 3; ++axis) {
      from_[axis] = std::llround(ray.from[axis] * kUnits16);
      way_[axis] = std::llround(ray.to[axis] * kUnits16) - from_[axis];
      last_[axis] = static_cast<int>(std::floor(ray.to[axis]));
    }
    const glm::ivec3 first(glm::floor(ray.from));
    follow(first);
  }
  bool may_be_blocked() const { return blocked_; }
  bool may_be_open() const { return open_; }

 private:
  using Int = std::int64_t;
  /// Distance to the next plane along an axis, in units; the way's own length there is |way|.
  Int to_plane(int axis, int voxel) const {
    const Int plane = Int{voxel + (way_[axis] > 0 ? 1 : 0)} * kUnits16;
    return way_[axis] > 0 ? plane - from_[axis] : from_[axis] - plane;
  }
  void follow(glm::ivec3 voxel) {
    // What follows depends on the voxel alone.
    while (seen_.insert({voxel.x, voxel.y, voxel.z}).second) {
      if (voxel == last_) {
        open_ = true;
        return;
      }
      if (opaque_(voxel.x, voxel.y, voxel.z)) {  // and not the last
        blocked_ = true;
        return;
      }
      // The nearest plane: the least to_plane / |way|.
      std::vector<int> nearest;
      for (int axis = 0; axis < 3; ++axis) {
        if (way_[axis] == 0) continue;
        const Int mine = to_plane(axis, voxel[axis]), length = std::abs(way_[axis]);
        if (mine >= length) continue;  // beyond the end
        if (!nearest.empty()) {
          const Int best = to_plane(nearest[0], voxel[nearest[0]]),
                    best_length = std::abs(way_[nearest[0]]);
          if (mine * best_length > best * length) continue;
          if (mine * best_length < best * length) nearest.clear();
        }
        nearest.push_back(axis);
      }
      if (nearest.empty()) {
        open_ = true;
        return;
      }
      for (std::size_t i = 1; i < nearest.size(); ++i) follow(stepped(voxel, nearest[i]));
      voxel = stepped(voxel, nearest[0]);
    }
  }
  glm::ivec3 stepped(glm::ivec3 voxel, int axis) const {
    voxel[axis] += way_[axis] > 0 ? 1 : -1;
    return voxel;
  }
  const OpaqueAt& opaque_;
  Int from_[3]{}, way_[3]{};
  glm::ivec3 last_{};
  std::set<std::array<int, 3>> seen_;
  bool blocked_ = false, open_ = false;
};

bool scattered(int x, int y, int z, std::uint32_t one_in) {
  auto h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
           static_cast<std::uint32_t>(y) * 0x85ebca77u ^
           static_cast<std::uint32_t>(z) * 0xc2b2ae3du;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 13;
  return h % one_in == 0;
}

class March : public OccupancyOnGpu {
 protected:
  /// Voxels from -64 to 128, dense below, sparse above, with holes of bricks and chunks.
  static bool world(int x, int y, int z) {
    if (x < -64 || y < -64 || z < -64 || x >= 128 || y >= 128 || z >= 128) return false;
    if ((x >> 6) == 1 && (y >> 6) == 1) return false;
    if (scattered(x >> 3, y >> 3, z >> 3, 2)) return false;
    return scattered(x, y, z, y < 0 ? 4 : 40);
  }
  void compare(const std::vector<Ray>& rays, const OpaqueAt& opaque) {
    const auto answers = ask<std::uint32_t>(kMarch, rays);
    int wrong = 0, blocked = 0, edges = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const ExactMarch exact(opaque, rays[i]);
      wrong += !(answers[i] != 0 ? exact.may_be_blocked() : exact.may_be_open());
      blocked += answers[i] != 0;
      edges += exact.may_be_blocked() && exact.may_be_open();
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(blocked, static_cast<int>(rays.size() / 20));
    EXPECT_LT(blocked, static_cast<int>(rays.size() - rays.size() / 20));
    EXPECT_LT(edges, static_cast<int>(rays.size() / 4)) << "the test says too little";
  }
  static float on_grid(RandomPlaces& random, double low, double high, int step) {
    return static_cast<float>(random.whole(static_cast<std::int64_t>(low * kUnits16 / step),
                                           static_cast<std::int64_t>(high * kUnits16 / step))) *
           static_cast<float>(step) / kUnits16;
  }
};

TEST_F(March, FindsWhatAnExactMarchFinds) {
  add_island(0, world, {{-1, -1, -1}, {3, 3, 3}, 0});
  RandomPlaces random(11);
  std::vector<Ray> rays(60000);
  for (Ray& ray : rays)
    for (int axis = 0; axis < 3; ++axis) {
      ray.from[axis] = on_grid(random, -70.0, 130.0, 1);
      ray.to[axis] = ray.from[axis] + on_grid(random, -60.0, 60.0, 1);
    }
  compare(rays, world);
}

// Rays along axes and diagonals, through corners and edges, within faces, of no length.
TEST_F(March, FindsWhatAnExactMarchFindsOnSpecialWays) {
  add_island(0, world, {{-1, -1, -1}, {3, 3, 3}, 0});
  RandomPlaces random(12);
  std::vector<Ray> rays(60000);
  for (Ray& ray : rays) {
    const auto length = on_grid(random, -40.0, 40.0, 8);
    for (int axis = 0; axis < 3; ++axis) {
      ray.from[axis] = on_grid(random, -66.0, 130.0, 8);  // whole and half voxels
      ray.to[axis] = ray.from[axis] + length * static_cast<float>(random.whole(-1, 1));
    }
  }
  compare(rays, world);
}

constexpr const char* kWhere =
    "#include \"include/scene/march.glsl\"\n"
    R"(
  struct Question { vec3 from; vec3 to; uint island; };
  struct Answer { uint met; float share; uint face; };
  Answer answer_to(Question q) {
    Marched m = march(voxel_grid(q.island), q.from, ivec3(floor(q.from)), q.to, ivec3(0x7fffffff));
    return Answer(m.met ? 1u : 0u, m.share, m.face);
  })";

struct Met {
  std::uint32_t met;
  float share;
  std::uint32_t face;
};

/// By steps of one voxel, in doubles. Ways along axes cross no plane of the others.
Met first_opaque(const OpaqueAt& opaque, const Ray& ray) {
  const glm::dvec3 from(ray.from), way = glm::dvec3(ray.to) - from;
  glm::ivec3 voxel(glm::floor(ray.from));
  double share = 0.0;
  std::uint32_t face = shared::kFaceCount;
  while (share < 1.0) {
    if (opaque(voxel.x, voxel.y, voxel.z)) return {1, static_cast<float>(share), face};
    double next = 2.0;
    int axis = 0;
    for (int a = 0; a < 3; ++a) {
      if (way[a] == 0.0) continue;
      const double at = (voxel[a] + (way[a] > 0.0 ? 1.0 : 0.0) - from[a]) / way[a];
      if (at < next) axis = a;
      next = std::min(next, at);
    }
    share = next;
    voxel[axis] += way[axis] > 0.0 ? 1 : -1;
    face = static_cast<std::uint32_t>(2 * axis + (way[axis] > 0.0 ? 1 : 0));
  }
  return {0, 1.0f, shared::kFaceCount};
}

TEST_F(March, SaysWhereItMeetsAVoxelAndByWhichFace) {
  add_island(0, world, {{-1, -1, -1}, {3, 3, 3}, 0});
  RandomPlaces random(14);
  std::vector<Ray> rays(20000);
  for (Ray& ray : rays)
    for (int axis = 0; axis < 3; ++axis) {
      ray.from[axis] = static_cast<float>(random.uniform(-90.0, 150.0));
      ray.to[axis] = ray.from[axis] + static_cast<float>(random.uniform(-90.0, 90.0));
    }
  const auto answers = ask<Met>(kWhere, rays);
  int met = 0, other = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Met exact = first_opaque(world, rays[i]);
    met += exact.met != 0;
    // Floats may pass on the other side of an edge.
    const bool same = answers[i].met == exact.met && answers[i].face == exact.face &&
                      std::abs(answers[i].share - exact.share) < 1e-4f;
    other += !same;
  }
  EXPECT_GT(met, 5000);
  EXPECT_LE(other, 10);
}

// Two voxels that share an edge leave nothing through, however long the way is.
TEST_F(March, NothingPassesBetweenVoxelsThatShareAnEdge) {
  // A wall whose voxels meet along edges alone.
  const OpaqueAt steps = [](int x, int, int z) { return x + z == 0; };
  add_island(0, steps, {{-1, -1, -1}, {2, 2, 2}, 0});
  RandomPlaces random(13);
  std::vector<Ray> rays(40000);
  for (Ray& ray : rays) {
    // Through an edge: (k, ?, 1 - k) is where voxels (k, -k) and (k - 1, 1 - k) meet.
    const double k = static_cast<double>(random.whole(-50, 50));
    const glm::dvec3 edge(k, random.uniform(-50.0, 50.0), 1.0 - k);
    glm::dvec3 way = random.direction();
    if (way.x + way.z < 0.0) way = -way;
    if (way.x + way.z < 0.05) way.x += 0.3;
    ray = {glm::vec3(edge - way * random.uniform(2.0, 60.0)),
           glm::vec3(edge + way * random.uniform(2.0, 60.0))};
  }
  const auto answers = ask<std::uint32_t>(kMarch, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(answers[i], 1u) << i;
}

TEST_F(March, ALightInAWallIsNotBlockedByItsOwnVoxel) {
  const OpaqueAt wall = [](int x, int, int) { return x == 10; };
  add_island(0, wall, {{0, 0, 0}, {1, 1, 1}, 0});
  const std::vector<Ray> rays{
      {{5.5f, 5.5f, 5.5f}, {10.5f, 5.5f, 5.5f}},   // into the wall
      {{5.5f, 5.5f, 5.5f}, {11.0f, 5.5f, 5.5f}},   // to its other face
      {{5.5f, 5.5f, 5.5f}, {10.0f, 5.5f, 5.5f}},   // to its face
      {{10.5f, 5.5f, 5.5f}, {10.5f, 5.5f, 5.5f}},  // no way at all
      {{5.5f, 5.5f, 5.5f}, {10.5f, 5.5f, 6.5f}},   // slanted
      {{9.5f, 63.5f, 5.5f}, {9.5f, 1e6f, 5.5f}},   // out of the island, beside the wall
      {{-1e6f, 5.5f, 5.5f}, {9.5f, 5.5f, 5.5f}},   // from far away
      {{-1e6f, 5.5f, 5.5f}, {1e6f, 5.5f, 5.5f}},   // through all of it
  };
  EXPECT_EQ(ask<std::uint32_t>(kMarch, rays), (std::vector<std::uint32_t>{0, 1, 0, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace skerry::render
