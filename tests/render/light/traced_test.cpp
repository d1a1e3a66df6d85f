// Walls and lights: sealed rooms stay dark to the last bit, and elsewhere light arrives as the
// reference has it.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "engine/render/plan/frame_tables.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/light.h"
#include "tests/render/occupancy_on_gpu.h"
#include "tests/render/random_scenes.h"
#include "tools/reference/tracer.h"

namespace skerry::render {
namespace {

constexpr const char* kVisibility =
    "#include \"shared/light.h\"\n"
    "layout(scalar, binding = 2) readonly buffer Islands { IslandTransform islands[]; };\n"
    "IslandTransform island_at(uint island) { return islands[island]; }\n"
    "#include \"include/light/traced.glsl\"\n"
    R"(
  struct Question { vec3 position; uint word; Light light; };
  struct Answer { float visibility; };
  Answer answer_to(Question q) {
    Surface s;
    s.position = q.position;
    s.normal = world_from_lattice_vector(islands[surface_island(q.word)],
                                         face_normal(surface_face(q.word)));
    s.plant = false;
    return Answer(traced_visibility(way_start(s, q.word), q.light));
  })";

constexpr std::uint32_t kOff = 0, kEvery = ~0u;  // of kLightsShadows

struct Question {
  glm::vec3 position;
  std::uint32_t word;
  shared::Light light;
};

shared::Light light_at(const glm::dvec3& place, std::uint32_t kind = shared::kLightPoint) {
  shared::Light light{};
  light.position = glm::vec3(place);
  light.range = 100.0f;
  light.intensity = glm::vec3(1.0f);
  light.kind = kind;
  light.axis = {0.0f, 1.0f, 0.0f};
  light.cos_inner = 1.0f;
  light.cos_outer = -1.0f;
  light.island_count = 1;
  return light;
}

std::uint32_t word_of(std::uint32_t island, int face) {
  return island << shared::kIslandShift | static_cast<std::uint32_t>(face) << shared::kFaceShift;
}

/// An island of the world: camera-relative = rotation * lattice + place.
struct Placed {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 place{0.0};
  double voxel = 1.0;  ///< edge [blocks]
  glm::dvec3 world(const glm::dvec3& voxels) const { return rotation * (voxels * voxel) + place; }
  shared::IslandTransform transform() const {
    const glm::dmat3 axes = glm::mat3_cast(rotation);
    return {glm::vec3(axes[0]), glm::vec3(axes[1]), glm::vec3(axes[2]), glm::vec3(place)};
  }
};

/// A closed box of one voxel's thickness about some air.
struct Room {
  glm::ivec3 low, size;  ///< of the air
  bool whole = true;     ///< false: the walls' edges and corners are missing
  bool wall(const glm::ivec3& v) const {
    int outside = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int at = v[axis] - low[axis];
      if (at < -1 || at > size[axis]) return false;
      outside += at < 0 || at == size[axis];
    }
    return whole ? outside > 0 : outside == 1;
  }
};

class Traced : public OccupancyOnGpu {
 protected:
  std::vector<float> visibility(const std::vector<Question>& questions,
                                const std::vector<shared::IslandTransform>& islands,
                                const std::vector<std::uint32_t>& light_islands) {
    return ask<float>(kVisibility, questions,
                      {table(2, islands), table(shared::kLightIslandsBinding, light_islands)},
                      {{40, kEvery}});
  }
};

/// 16 rooms in each island's only chunk, every island turned its own way.
class Rooms {
 public:
  static constexpr int kRooms = 16, kReceivers = 24;
  Rooms(std::uint32_t island, RandomPlaces& random) : island_(island), random_(random) {
    placed_.rotation = random.turn();
    placed_.place = random.in_box(600.0);
    level_ = static_cast<int>(random.whole(0, 2));
    placed_.voxel = static_cast<double>(1 << level_);
    for (int i = 0; i < kRooms; ++i) {
      Room room;
      for (int axis = 0; axis < 3; ++axis) {
        room.size[axis] = static_cast<int>(random.whole(1, 5));
        room.low[axis] = 16 * (axis == 0   ? i % 4
                               : axis == 1 ? 0
                                           : i / 4) +
                         static_cast<int>(random.whole(4, 7));
      }
      room.low.y += 16 * static_cast<int>(random.whole(0, 3));
      room.whole = i % 2 == 0;
      rooms_.push_back(room);
    }
  }
  const Placed& placed() const { return placed_; }
  std::uint32_t level() const { return static_cast<std::uint32_t>(level_); }
  bool opaque(int x, int y, int z) const {
    for (const Room& room : rooms_)
      if (room.wall({x, y, z})) return true;
    return false;
  }
  /// Questions about faces inside each room, under a light outside of it.
  void ask_all(std::vector<Question>& questions) {
    for (const Room& room : rooms_) {
      const shared::Light light = light_outside(room);
      for (int i = 0; i < kReceivers; ++i) questions.push_back({receiver(room), face_, light});
    }
  }

 private:
  /// Often next to a wall, an edge or a corner; of any kind that has a place, and small enough not
  /// to reach through a wall.
  shared::Light light_outside(const Room& room) {
    glm::dvec3 place;
    do {
      for (int axis = 0; axis < 3; ++axis) {
        const double low = room.low[axis] - 1.0, high = room.low[axis] + room.size[axis] + 1.0;
        constexpr double kNear[] = {1e-3, 0.01, 0.3, 2.0};
        const double near = kNear[random_.whole(0, 3)];
        const std::int64_t side = random_.whole(0, 3);
        place[axis] = side == 0   ? low - near
                      : side == 1 ? high + near
                                  : random_.uniform(low - 3.0, high + 3.0);
      }
    } while (!outside(room, place));
    shared::Light light = light_at(placed_.world(place));
    light.first_island = island_;
    if (random_.whole(0, 2) == 0) {
      light.kind = shared::kLightSphere;
      light.size = static_cast<float>(0.4 * placed_.voxel);
    }
    return light;
  }
  bool outside(const Room& room, const glm::dvec3& place) const {
    const glm::ivec3 v(glm::floor(place));
    if (opaque(v.x, v.y, v.z)) return false;
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < room.low[axis] || v[axis] >= room.low[axis] + room.size[axis]) return true;
    return false;
  }
  /// On the inner face of a wall, a third of them on its edges; as inexact as depth makes it.
  glm::vec3 receiver(const Room& room) {
    const int axis = static_cast<int>(random_.whole(0, 2));
    const bool positive = random_.whole(0, 1) == 1;  // the face looks along +axis: the lower wall
    glm::dvec3 p;
    for (int a = 0; a < 3; ++a) {
      const double low = room.low[a], high = room.low[a] + room.size[a];
      const std::int64_t where = random_.whole(0, 5);
      p[a] = where == 0 ? low : where == 1 ? high : random_.uniform(low, high);
    }
    p[axis] = positive ? room.low[axis] : room.low[axis] + room.size[axis];
    face_ = word_of(island_, axis * 2 + (positive ? 0 : 1));
    return glm::vec3(placed_.world(p) + random_.in_box(1e-4));
  }
  std::uint32_t island_, face_ = 0;
  RandomPlaces& random_;
  Placed placed_;
  int level_ = 0;
  std::vector<Room> rooms_;
};

// 640 islands of 16 rooms: 10,240 configurations, 24 receivers each.
TEST_F(Traced, SealedRoomsAreDarkToTheLastBit) {
  constexpr std::uint32_t kIslands = 640;
  RandomPlaces random(21);
  std::vector<shared::IslandTransform> transforms;
  std::vector<std::uint32_t> light_islands;
  std::vector<Question> questions;
  for (std::uint32_t island = 0; island < kIslands; ++island) {
    Rooms rooms(island, random);
    const OpaqueAt opaque = [&](int x, int y, int z) { return rooms.opaque(x, y, z); };
    add_island(island, opaque, {{0, 0, 0}, {1, 1, 1}, rooms.level()});
    transforms.push_back(rooms.placed().transform());
    light_islands.push_back(island);
    rooms.ask_all(questions);
  }
  ASSERT_EQ(questions.size(), 10240u * Rooms::kReceivers);
  const std::vector<float> lit = visibility(questions, transforms, light_islands);
  EXPECT_EQ(std::count_if(lit.begin(), lit.end(), [](float v) { return v != 0.0f; }), 0);
}

// The same room with a window is lit, so that the darkness above is the walls'.
TEST_F(Traced, AWindowLetsLightIn) {
  const Room room{{10, 10, 10}, {3, 3, 3}};
  for (const bool window : {false, true}) {
    const std::uint32_t island = window ? 1 : 0;
    add_island(island,
               [&](int x, int y, int z) {
                 return room.wall({x, y, z}) && !(window && x == 13 && y == 11 && z == 11);
               },
               {{0, 0, 0}, {1, 1, 1}, 0});
    Placed placed;
    placed.rotation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    placed.place = {40.0, -20.0, 310.0};
    shared::Light light = light_at(placed.world({16.5, 11.5, 11.5}));
    // The wall across from the window; the wall beside it.
    const std::vector<Question> questions{
        {glm::vec3(placed.world({10.0, 11.5, 11.5})), word_of(island, 0), light},
        {glm::vec3(placed.world({13.0, 12.5, 10.5})), word_of(island, 1), light}};
    const std::vector<shared::IslandTransform> transforms(2, placed.transform());
    EXPECT_EQ(visibility(questions, transforms, {island}),
              (std::vector<float>{window ? 1.0f : 0.0f, 0.0f}));
  }
}

/// A tenth of the voxels stand.
bool rubble(int x, int y, int z) {
  if (x < 0 || y < 0 || z < 0 || x >= 64 || y >= 64 || z >= 64) return false;
  auto h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
           static_cast<std::uint32_t>(y) * 0x85ebca77u ^
           static_cast<std::uint32_t>(z) * 0xc2b2ae3du;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 13;
  return h % 10 == 0;
}

// Two turned islands that reach into each other's light: what the reference's tracer finds, but for
// ways that pass an edge within rounding.
TEST_F(Traced, LightCrossesFromIslandToIslandAsInTheReference) {
  RandomPlaces random(22);
  std::vector<Placed> placed(2);
  for (Placed& one : placed) one.rotation = random.turn();
  placed[0].place = {100.0, 50.0, -80.0};
  placed[1].place = placed[0].place + random.direction() * 70.0;
  std::vector<shared::IslandTransform> transforms;
  std::vector<reference::Island> islands;
  for (std::uint32_t i = 0; i < 2; ++i) {
    add_island(i, rubble, {{0, 0, 0}, {1, 1, 1}, 0});
    transforms.push_back(placed[i].transform());
    islands.push_back({world::Volume::from_voxels(
                           {0, 0, 0}, {64, 64, 64},
                           [](world::IVec3 v) {
                             return rubble(v.x, v.y, v.z) ? world::BlockId{world::block::kStone}
                                                          : world::kAir;
                           }),
                       glm::mat3_cast(placed[i].rotation), placed[i].place});
  }
  const reference::Tracer tracer(islands);
  std::vector<Question> questions;
  std::vector<bool> expected;
  while (questions.size() < 20000) {
    const auto island = static_cast<std::uint32_t>(random.whole(0, 1));
    const glm::ivec3 v(random.whole(0, 63), random.whole(0, 63), random.whole(0, 63));
    const int face = static_cast<int>(random.whole(0, 5)), axis = face / 2;
    glm::ivec3 front = v;
    front[axis] += face % 2 == 0 ? 1 : -1;
    if (!rubble(v.x, v.y, v.z) || rubble(front.x, front.y, front.z)) continue;
    glm::dvec3 p =
        glm::dvec3(v) + glm::dvec3(random.uniform(0.01, 0.99), random.uniform(0.01, 0.99),
                                   random.uniform(0.01, 0.99));
    p[axis] = v[axis] + (face % 2 == 0 ? 1 : 0);
    const glm::dvec3 point = placed[island].world(p), normal = tracer.normal(island, face);
    const glm::dvec3 to = random.direction() * random.uniform(1.0, 14.0);
    if (glm::dot(normal, to) < 0.05) continue;
    shared::Light light = light_at(point + to);
    light.island_count = 2;
    // A light inside a voxel is not blocked by it; the reference's is.
    bool inside = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const glm::ivec3 at(glm::floor(tracer.lattice_point(i, point + to)));
      inside = inside || rubble(at.x, at.y, at.z);
    }
    if (inside) continue;
    questions.push_back({glm::vec3(point), word_of(island, face), light});
    expected.push_back(!tracer.hidden(point + normal * 1e-7, glm::normalize(to), glm::length(to)));
  }
  const std::vector<float> lit = visibility(questions, transforms, {0, 1});
  std::size_t wrong = 0, open = 0;
  for (std::size_t i = 0; i < lit.size(); ++i) {
    wrong += lit[i] != (expected[i] ? 1.0f : 0.0f);
    open += expected[i];
  }
  EXPECT_GT(open, lit.size() / 10);
  EXPECT_LT(open, lit.size() * 9 / 10);
  EXPECT_LE(wrong, lit.size() / 2000);  // places are floats to 1.5e-5 block
}

TEST_F(Traced, TheVoxelALightStandsInDoesNotBlockItButOthersDo) {
  add_island(0, [](int x, int, int) { return x == 10 || x == 12; }, {{0, 0, 0}, {1, 1, 1}, 0});
  const std::vector<shared::IslandTransform> here{Placed{}.transform()};
  const std::vector<Question> questions{
      {{13.0f, 5.5f, 5.5f}, word_of(0, 0), light_at({12.5, 5.5, 5.5})},   // from outside, behind
      {{11.0f, 5.5f, 5.5f}, word_of(0, 0), light_at({12.5, 5.5, 5.5})},   // in the wall across
      {{11.0f, 5.5f, 5.5f}, word_of(0, 0), light_at({13.5, 5.5, 5.5})},   // behind that wall
      {{11.0f, 5.5f, 5.5f}, word_of(0, 0), light_at({10.5, 5.5, 5.5})}};  // in the wall itself
  EXPECT_EQ(visibility(questions, here, {0}), (std::vector<float>{1.0f, 1.0f, 0.0f, 1.0f}));
}

// --- Walls looked for before some lights

constexpr const char* kPixel =
    "#include \"shared/light.h\"\n"
    "layout(scalar, binding = 2) readonly buffer Islands { IslandTransform islands[]; };\n"
    "IslandTransform island_at(uint island) { return islands[island]; }\n"
    "layout(scalar, binding = 3) readonly buffer Lights { Light lights[]; };\n"
    "Light frame_light(uint index) { return lights[index]; }\n"
    "struct Cluster { uint first; uint count; };\n"
    "uint light_index(Cluster list, uint i) { return list.first + i; }\n"
    "const bool kOracle = false;\n"
    "vec3 left_by_panes(Light light, vec3 position) { return vec3(1.0); }\n"
    "#include \"include/light/lights.glsl\"\n"
    "#include \"include/light/traced.glsl\"\n"
    "#include \"include/light/shafts.glsl\"\n"
    "#include \"include/light/blocked_lights.glsl\"\n"
    R"(
  struct Question { vec3 position; uint word; uint first; uint count; };
  struct Answer { vec3 radiance; };
  Answer answer_to(Question q) {
    Surface s;
    s.position = q.position;
    s.normal = face_normal(surface_face(q.word));
    s.plant = false;
    return Answer(lights_reflected(Cluster(q.first, q.count), kNoShafts, matt_brdf(vec3(1.0)),
                                   way_start(s, q.word), vec3(0.0, 1.0, 0.0)));
  })";

class BlockedLights : public OccupancyOnGpu {
 protected:
  struct Pixel {
    glm::vec3 position;
    std::uint32_t word, first, count;
  };
  static constexpr std::uint32_t kLights = 12;
  /// Floor faces among rubble, and lights about each of them.
  void scatter(std::size_t count) {
    add_island(0, rubble, {{0, 0, 0}, {1, 1, 1}, 0});
    RandomPlaces random(23);
    while (pixels_.size() < count) {
      const glm::ivec3 v(random.whole(8, 55), random.whole(8, 55), random.whole(8, 55));
      if (!rubble(v.x, v.y, v.z) || rubble(v.x, v.y + 1, v.z)) continue;
      const glm::dvec3 p = glm::dvec3(v) + glm::dvec3(0.5, 1.0, 0.5);
      pixels_.push_back(
          {glm::vec3(p), word_of(0, 2), static_cast<std::uint32_t>(lights_.size()), kLights});
      for (std::uint32_t i = 0; i < kLights; ++i) {
        shared::Light light = light_at(p + random.in_box(7.0));
        light.intensity = glm::vec3(static_cast<float>(random.uniform(0.2, 3.0)));
        lights_.push_back(light);
      }
    }
  }
  std::vector<glm::vec3> radiance(const std::vector<Pixel>& pixels, std::uint32_t traced) {
    const std::vector<shared::IslandTransform> here{Placed{}.transform()};
    return ask<glm::vec3>(kPixel, pixels,
                          {table(2, here), table(3, lights_),
                           table(shared::kLightIslandsBinding, std::vector<std::uint32_t>{0}),
                           table(shared::kLightReachBinding, std::vector<shared::LightReach>(1))},
                          {{40, traced}});
  }
  /// Each light of each pixel by itself.
  std::vector<Pixel> single() const {
    std::vector<Pixel> out;
    for (const Pixel& pixel : pixels_)
      for (std::uint32_t i = 0; i < kLights; ++i)
        out.push_back({pixel.position, pixel.word, pixel.first + i, 1});
    return out;
  }
  std::vector<Pixel> pixels_;
  std::vector<shared::Light> lights_;
};

TEST_F(BlockedLights, TheStrongestAreTracedAndStandForTheOthers) {
  scatter(400);
  const std::vector<glm::vec3> alone = radiance(single(), kOff), seen = radiance(single(), kEvery);
  for (const std::uint32_t traced : {1u, 3u, 8u}) {
    const std::vector<glm::vec3> got = radiance(pixels_, traced);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      std::vector<std::size_t> order(kLights);
      for (std::size_t i = 0; i < kLights; ++i) order[i] = p * kLights + i;
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return alone[a].x > alone[b].x; });
      double asked = 0.0, arrived = 0.0, others = 0.0;
      for (std::size_t i = 0; i < kLights; ++i) {
        asked += i < traced ? alone[order[i]].x : 0.0;
        arrived += i < traced ? seen[order[i]].x : 0.0;
        others += i < traced ? 0.0 : alone[order[i]].x;
      }
      const double expected = arrived + (asked > 0.0 ? others * arrived / asked : others);
      ASSERT_NEAR(got[p].x, expected, 1e-4 * (1.0 + asked + others)) << traced << " of " << p;
    }
  }
}

TEST_F(BlockedLights, AllOfThemAreTracedOrNone) {
  scatter(400);
  const std::vector<glm::vec3> alone = radiance(single(), kOff), seen = radiance(single(), kEvery);
  const std::vector<glm::vec3> off = radiance(pixels_, kOff), every = radiance(pixels_, kEvery);
  int hidden = 0;
  for (std::size_t p = 0; p < pixels_.size(); ++p) {
    double open = 0.0, left = 0.0;
    for (std::size_t i = p * kLights; i < (p + 1) * kLights; ++i) {
      open += alone[i].x;
      left += seen[i].x;
      ASSERT_TRUE(seen[i] == alone[i] || seen[i] == glm::vec3(0.0f));
      hidden += seen[i] != alone[i];
    }
    ASSERT_NEAR(off[p].x, open, 1e-4 * (1.0 + open));
    ASSERT_NEAR(every[p].x, left, 1e-4 * (1.0 + open));
  }
  EXPECT_GT(hidden, 400);
}

TEST_F(BlockedLights, AClosedRoomIsDarkHoweverFewAreTraced) {
  const Room room{{20, 20, 20}, {3, 3, 3}};
  add_island(0,
             [&](int x, int y, int z) {
               return room.wall({x, y, z});
             },
             {{0, 0, 0}, {1, 1, 1}, 0});
  RandomPlaces random(24);
  for (std::uint32_t i = 0; i < 40; ++i)
    lights_.push_back(light_at(glm::dvec3(21.5, 25.5, 21.5) + random.in_box(1.0)));
  const std::vector<Pixel> floor{{{21.5f, 20.0f, 21.5f}, word_of(0, 2), 0, 40}};
  EXPECT_GT(radiance(floor, kOff)[0].x, 0.0f);
  for (const std::uint32_t traced : {1u, 2u, 8u, kEvery})
    EXPECT_EQ(radiance(floor, traced)[0], glm::vec3(0.0f)) << traced;
}

}  // namespace
}  // namespace skerry::render
