// The G-buffer against exact geometry: words, depth, and that culling loses nothing.
#include <glm/gtx/quaternion.hpp>

#include <algorithm>

#include "tests/render/passes_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{128, 96};

/// A section of one quad.
void add_quad(GeometryStore& store, gpu::Uploader& uploader, glm::ivec3 low, glm::ivec2 extent,
              std::uint32_t face, std::uint32_t block, std::uint32_t island,
              std::uint32_t voxel_size_log2) {
  const glm::uvec3 at(low);
  const shared::Quad quad{at.x | at.y << 6 | at.z << 12 |
                              static_cast<std::uint32_t>(extent.x - 1) << 18 |
                              static_cast<std::uint32_t>(extent.y - 1) << 24,
                          block | face << shared::kFaceShift};
  shared::Section section{};
  section.island = island;
  section.voxel_size_log2 = voxel_size_log2;
  section.bounds_max = 64u | 64u << 7 | 64u << 14;
  for (std::uint32_t r = face; r < shared::kRangeCount; ++r) section.range_end[r] = 1;
  const Result<SectionId> added = store.add(uploader, section, std::span(&quad, 1));
  ASSERT_TRUE(added) << added.error().message;
}

glm::dvec3 normal_of(std::uint32_t face) {
  glm::dvec3 n(0.0);
  n[static_cast<int>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
  return n;
}

using GBuffer = PassesOnGpu;

// 96 small islands side by side, each with one face towards the camera.
TEST_F(GBuffer, WordsComeBackAsTheyWereSent) {
  RandomPlaces random(1);
  constexpr int kColumns = 12, kRows = 8;
  std::vector<IslandPlacement> islands(shared::kMaxIslands);
  FrameInput input;
  input.camera = camera_at({0, 0, 0}, 0.0, 0.0, 60.0);
  struct Sent {
    std::uint32_t block, island, face;
  };
  std::vector<Sent> sent;
  std::vector<std::uint32_t> free(shared::kMaxIslands);
  for (std::uint32_t i = 0; i < free.size(); ++i) free[i] = i;
  for (int cell = 0; cell < kColumns * kRows; ++cell) {
    const auto pick = static_cast<std::size_t>(random.whole(0, std::ssize(free) - 1));
    const Sent one{static_cast<std::uint32_t>(random.whole(1, shared::kMaxMaterials - 1)),
                   cell == 0 ? shared::kMaxIslands - 1 : free[pick],
                   static_cast<std::uint32_t>(cell % 6)};
    std::erase(free, one.island);
    sent.push_back(one);
    add_quad(store(), uploader(), {0, 0, 0}, {1, 1}, one.face, one.block, one.island, 0);
    const double x = (cell % kColumns + 0.5) * kSize.width / kColumns - 0.5;
    const double y = (static_cast<double>(cell / kColumns) + 0.5) * kSize.height / kRows - 0.5;
    const glm::dvec3 centre = ray_of(input.camera, x, y, kSize.width, kSize.height) * 12.0;
    IslandPlacement& island = islands[one.island];
    island.rotation = glm::rotation(normal_of(one.face), glm::dvec3(0.0, 0.0, -1.0));
    const glm::dvec3 face_centre = glm::dvec3(0.5) + 0.5 * normal_of(one.face);
    island.origin = fixed_at(centre - island.rotation * face_centre);
  }
  input.islands = islands;
  const Drawn drawn = this->drawn(input, kSize);
  int surfaces = 0;
  for (const std::uint32_t word : drawn.words) surfaces += word != 0 ? 1 : 0;
  EXPECT_LT(surfaces, static_cast<int>(drawn.words.size())) << "sky is 0";
  for (int cell = 0; cell < kColumns * kRows; ++cell) {
    const auto x = static_cast<std::uint32_t>((cell % kColumns + 0.5) * kSize.width / kColumns);
    const auto y = static_cast<std::uint32_t>((cell / kColumns + 0.5) * kSize.height / kRows);
    const std::uint32_t word = drawn.words[y * kSize.width + x];
    const Sent& one = sent[static_cast<std::size_t>(cell)];
    EXPECT_EQ(word >> 31, 1u);
    EXPECT_EQ(shared::surface_block(word), one.block);
    EXPECT_EQ(shared::surface_face(word), one.face);
    EXPECT_EQ(shared::surface_island(word), one.island);
  }
}

// Depth is interpolated with an error relative to the greatest depth in the quad, that of its
// nearest corner: the distance's relative error is at most 2^-17 * (1 + distance / that corner's).
TEST_F(GBuffer, DistanceFromDepthIsExactFromTenCentimetresToAHundredKilometres) {
  RandomPlaces random(2);
  for (int level = 0; level <= 11; ++level)
    for (std::uint32_t face = 0; face < 6; ++face)
      add_quad(store(), uploader(), {0, 0, 0}, {64, 64}, face, 1, static_cast<std::uint32_t>(level),
               static_cast<std::uint32_t>(level));
  double worst = 0.0;
  int pixels = 0;
  for (int i = 0; i < 60; ++i) {
    const double distance = 0.1 * std::pow(10.0, 6.0 * i / 59.0);
    // As coarse as the game draws what is this far away, or coarser.
    const int level = std::clamp(static_cast<int>(std::ceil(std::log2(distance / 24.0))), 0, 11);
    std::vector<IslandPlacement> islands(12);
    for (IslandPlacement& island : islands) island.origin = fixed_at({0.0, 3e6, 0.0});
    FrameInput input;
    const FixedPos far{random.whole(-(kUnits << 39), kUnits << 39), 12345, -(kUnits << 39)};
    for (IslandPlacement& island : islands) island.origin = sum(island.origin, far);
    input.camera = camera_at({0, 0, 0}, random.uniform(0, 360), random.uniform(-80, 80), 60.0);
    input.camera.position = far;
    const auto face = static_cast<std::uint32_t>(i % 6);
    const double edge = static_cast<double>(64 << level);
    IslandPlacement& island = islands[static_cast<std::size_t>(level)];
    island.rotation = random.turn();
    // The face's middle straight ahead, and the face not seen from its edge.
    const Axes axes = axes_of(input.camera);
    glm::dvec3 normal = island.rotation * normal_of(face);
    for (; glm::dot(normal, axes.forward) > -0.6; normal = island.rotation * normal_of(face))
      island.rotation = random.turn();
    const glm::dvec3 middle = glm::dvec3(0.5 * edge) + 0.5 * edge * normal_of(face);
    // The mesher puts faces of a plus side one voxel further than the quad's lowest voxel.
    glm::dvec3 on_face = middle;
    on_face[static_cast<int>(face / 2)] = face % 2 == 0 ? static_cast<double>(1 << level) : 0.0;
    island.origin = sum(far, fixed_at(axes.forward * distance - island.rotation * on_face));
    input.islands = islands;
    const glm::dvec3 point =
        island.rotation * on_face + blocks_at({island.origin[0] - far[0], island.origin[1] - far[1],
                                               island.origin[2] - far[2]});
    double nearest = 1e30;
    for (int corner = 0; corner < 4; ++corner) {
      glm::dvec3 at = on_face;
      at[(static_cast<int>(face / 2) + 1) % 3] = corner % 2 * edge;
      at[(static_cast<int>(face / 2) + 2) % 3] = corner / 2 * edge;
      nearest = std::min(nearest, glm::dot(point + island.rotation * (at - on_face), axes.forward));
    }
    nearest = std::max(nearest, static_cast<double>(kNearPlane));  // it is clipped there
    const Drawn drawn = this->drawn(input, kSize);
    for (std::uint32_t p = 0; p < drawn.words.size(); ++p) {
      if (shared::surface_face(drawn.words[p]) != face || drawn.words[p] == 0) continue;
      const glm::dvec3 ray =
          ray_of(input.camera, p % kSize.width, p / kSize.width, kSize.width, kSize.height);
      const double exact = glm::dot(point, normal) / glm::dot(ray, normal);
      const double got = static_cast<double>(kNearPlane) / static_cast<double>(drawn.depth[p]);
      const double bound = std::ldexp(1.0 + exact / nearest, -17);
      worst = std::max(worst, std::abs(got / exact - 1.0) / bound);
      ++pixels;
    }
  }
  EXPECT_LT(worst, 1.0) << "times the bound";
  EXPECT_GT(pixels, 60 * 2000);
}

// Seen from above, ground of two kinds in a checkered and striped pattern has T-junctions at nearly
// every corner; the sky must not shine through any.
TEST_F(GBuffer, QuadsOfAllSizesLeaveNoCracksBetweenThem) {
  add_chunk(
      store(), uploader(),
      [](int x, int y, int z) -> world::BlockId {
        if (y >= 0) return world::block::kAirBlock;
        return (x * 7 + z * 13 + x * z / 5) % 5 < 2 ? world::block::kStone : world::block::kDirt;
      },
      {0, -1, 0}, 0);
  RandomPlaces random(3);
  const std::vector<IslandPlacement> islands{
      {{}, glm::angleAxis(0.37, glm::dvec3(0.0, 1.0, 0.0)), 100.0}};
  FrameInput input;
  input.islands = islands;
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 place{32.0 + random.uniform(-8, 8), random.uniform(3, 12),
                           32.0 + random.uniform(-8, 8)};
    input.camera = camera_at(islands[0].rotation * place, random.uniform(0, 360), -85.0, 60.0);
    const Drawn drawn = this->drawn(input, {320, 240});
    EXPECT_EQ(std::count(drawn.words.begin(), drawn.words.end(), 0u), 0) << "view " << i;
  }
}

/// A random handful of solid boxes in a chunk.
BlockAt random_boxes(RandomPlaces& random, glm::ivec3 corner) {
  struct Solid {
    glm::ivec3 low, high;
  };
  std::vector<Solid> solids;
  for (int i = 0; i < 3; ++i) {
    Solid one;
    for (int axis = 0; axis < 3; ++axis) {
      const auto low = static_cast<int>(random.whole(0, 60));
      one.low[axis] = corner[axis] + low;
      one.high[axis] = corner[axis] + static_cast<int>(random.whole(low + 1, 64));
    }
    solids.push_back(one);
  }
  return [solids](int x, int y, int z) -> world::BlockId {
    const glm::ivec3 at(x, y, z);
    for (const Solid& s : solids)
      if (glm::all(glm::greaterThanEqual(at, s.low)) && glm::all(glm::lessThan(at, s.high)))
        return world::block::kStone;
    return world::block::kAirBlock;
  };
}

/// Resident sections in random chunks of several islands.
class Culling : public PassesOnGpu {
 protected:
  void add_random_sections(RandomPlaces& random, int count) {
    for (int i = 0; i < 3; ++i)
      islands_.push_back({fixed_at(random.in_box(300.0)), random.turn(), 1000.0});
    for (int i = 0; i < count; ++i) {
      const auto level = static_cast<std::uint32_t>(random.whole(0, 2));
      const world::IVec3 chunk{static_cast<int>(random.whole(-3, 2)),
                               static_cast<int>(random.whole(-3, 2)),
                               static_cast<int>(random.whole(-3, 2))};
      const BlockAt boxes = random_boxes(random, glm::ivec3(chunk.x, chunk.y, chunk.z) * 64);
      add_chunk(store(), uploader(), boxes, chunk, static_cast<std::uint32_t>(i % 3), level);
    }
  }
  FrameInput random_view(RandomPlaces& random) const {
    FrameInput input;
    input.islands = islands_;
    input.camera = camera_at(random.in_box(500.0), random.uniform(0, 360), random.uniform(-89, 89),
                             random.uniform(5.0, 120.0));
    return input;
  }
  std::vector<IslandPlacement> islands_;
};

TEST_F(Culling, PassesWhatAnExactTestOfEveryBoxPassesAndLittleElse) {
  RandomPlaces random(4);
  add_random_sections(random, 400);  // more than one work group
  std::uint64_t needed = 0, passed = 0;
  for (int i = 0; i < 150; ++i) {
    const FrameInput input = random_view(random);
    const auto planes = frustum_of(input.camera, kSize.width, kSize.height);
    std::uint32_t visible = 0;
    for (const shared::Section& s : store().records())
      visible += box_meets(box_of(s, islands_[s.island], input.camera.position), planes) ? 1 : 0;
    const shared::CullStats stats = drawn(input, kSize).stats;
    EXPECT_EQ(stats.sections_in, store().sections_resident());
    EXPECT_GE(stats.sections_passed, visible) << "view " << i;
    needed += visible;
    passed += stats.sections_passed;
  }
  EXPECT_GT(needed, 2000u);
  // Boxes that straddle two planes outside the edge where these meet, and the slack for rounding.
  EXPECT_LT(static_cast<double>(passed), 1.10 * static_cast<double>(needed));
}

TEST_F(Culling, DrawsFacesTowardsTheEyeAndFewOthers) {
  RandomPlaces random(5);
  add_random_sections(random, 100);
  for (int i = 0; i < 50; ++i) {
    const FrameInput input = random_view(random);
    const auto planes = frustum_of(input.camera, kSize.width, kSize.height);
    std::uint64_t least = 0, most = 0;
    for (const shared::Section& s : store().records()) {
      const IslandPlacement& island = islands_[s.island];
      const Box box = box_of(s, island, input.camera.position);
      std::array<glm::dvec4, 5> wider = planes;
      for (glm::dvec4& plane : wider) plane.w += 1.0;
      const glm::dvec3 low = glm::inverse(island.rotation) * box[0],
                       high = glm::inverse(island.rotation) * box[7];
      for (int face = 0; face < 6; ++face) {
        const auto r = static_cast<std::size_t>(face);
        const std::uint32_t quads = s.range_end[r] - (face == 0 ? 0 : s.range_end[r - 1]);
        // The eye is at 0 of these coordinates: +x faces show when it lies beyond the lowest one.
        const double before = face % 2 == 0 ? -low[face / 2] : high[face / 2];
        least += box_meets(box, planes) && before > 0.0 ? quads : 0;
        most += box_meets(box, wider) && before > -0.1 ? quads : 0;
      }
    }
    const shared::CullStats stats = drawn(input, kSize).stats;
    EXPECT_GE(stats.quads, least);
    EXPECT_LE(static_cast<double>(stats.quads), 1.15 * static_cast<double>(most) + 20.0);
  }
}

}  // namespace
}  // namespace skerry::render
