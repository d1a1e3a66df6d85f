// Light after edits is what is found of the edited island from nothing, bit for bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>
#include <utility>

#include "tests/world/light/voxel_rooms.h"
#include "world/light/lamp_reaches.h"
#include "world/light/sky_transfer.h"
#include "world/stream/stream.h"
#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

using test::chunks_of;
using test::Glass;
using test::Lamps;
using test::Voxels;

/// Colours that differ from block to block and face to face.
std::span<const FaceAlbedo> colours() {
  static const std::vector<FaceAlbedo> kAll = [] {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> share(0.2f, 0.9f);
    std::vector<FaceAlbedo> out(block_types().size());
    for (FaceAlbedo& block : out)
      for (glm::vec3& face : block) face = {share(random), share(random), share(random)};
    return out;
  }();
  return kAll;
}

const KeyDirections kKeys{glm::vec3(0.48f, 0.6f, -0.64f), glm::vec3(-0.8f, 0.36f, 0.48f)};

std::unique_ptr<SkyTransfer> looked_at(const LightChunks& chunks,
                                       std::span<const FaceAlbedo> albedo = colours(),
                                       int spare = 0, const KeyDirections& keys = kKeys) {
  auto transfer = std::make_unique<SkyTransfer>(chunks, albedo, BounceLight::kBounces, spare, keys);
  for (int octant = 0; octant < kOctants; ++octant) transfer->look(octant);
  transfer->spread_lamps();
  for (int step = 0; step < BounceLight::kSteps; ++step)
    for (int part = 0; part < BounceLight::kParts; ++part) transfer->follow_bounces(step, part);
  transfer->make_faces();
  return transfer;
}

/// Chunks that are as they were stay the same objects, as the game's do.
LightChunks with_what_stays(const LightChunks& before, LightChunks after) {
  for (auto& [at, chunk] : after) {
    const auto old = before.find(at);
    if (old == before.end()) continue;
    const auto same_quad = [](const shared::Quad& p, const shared::Quad& q) {
      return std::memcmp(&p, &q, sizeof p) == 0;
    };
    const auto same_lamp = [](const WeakLamp& p, const WeakLamp& q) {
      return p.place == q.place && p.intensity == q.intensity && p.range == q.range;
    };
    const auto same_strong = [](const StrongLamp& p, const StrongLamp& q) {
      return p.place == q.place && p.intensity == q.intensity && p.range == q.range;
    };
    const LightChunk &a = *old->second, &b = *chunk;
    if (a.opaque.fill == b.opaque.fill && a.opaque.table == b.opaque.table &&
        a.opaque.words == b.opaque.words && std::ranges::equal(a.quads, b.quads, same_quad) &&
        std::ranges::equal(a.lamps, b.lamps, same_lamp) && a.stained == b.stained &&
        std::ranges::equal(a.strong, b.strong, same_strong))
      chunk = old->second;
  }
  return after;
}

/// How many records differ; a chunk that only one side has counts as one.
std::size_t differences(const SkyTransfer::Skies& a, const SkyTransfer::Skies& b) {
  std::size_t count = 0;
  for (const auto& [at, sky] : b) {
    const auto other = a.find(at);
    if (other == a.end() || other->second->table != sky->table ||
        other->second->parts != sky->parts || other->second->texels.size() != sky->texels.size()) {
      ++count;
      continue;
    }
    for (std::size_t i = 0; i < sky->texels.size(); ++i)
      count += sky->texels[i] != other->second->texels[i] ? 1 : 0;
  }
  for (const auto& [at, sky] : a) count += b.contains(at) ? 0 : 1;
  return count;
}

TEST(SkyTransferEdit, FindsInRandomHeapsWhatALookFromNothingFinds) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    // Over the corner of eight chunks.
    const auto place = [&] {
      const auto part = [&](unsigned size) {
        return static_cast<int>(random() % size) - static_cast<int>(size / 2);
      };
      return IVec3{part(30), part(14), part(30)};
    };
    Voxels stone;
    Lamps lamps;
    for (int i = 0; i < 2500; ++i) stone.insert(place());
    for (const IVec3 corner :
         {IVec3{-1, -1, -1}, IVec3{-1, -1, 0}, IVec3{-1, 0, -1}, IVec3{-1, 0, 0}, IVec3{0, -1, -1},
          IVec3{0, -1, 0}, IVec3{0, 0, -1}, IVec3{0, 0, 0}})
      stone.insert(corner);
    for (int i = 0; i < 6; ++i) lamps.voxels.insert(place());
    LightChunks chunks = chunks_of(stone, lamps);
    const std::unique_ptr<SkyTransfer> kept = looked_at(chunks);
    for (int round = 0; round < 12; ++round) {
      for (int i = round % 4; i >= 0; --i) {
        const IVec3 at = place();
        if (stone.erase(at) == 0) stone.insert(at);
        stone.insert({0, 0, 0});
      }
      if (round % 3 == 0) lamps.voxels.erase(lamps.voxels.begin());
      if (round % 3 == 1) lamps.voxels.insert(place());
      chunks = with_what_stays(chunks, chunks_of(stone, lamps));
      ASSERT_TRUE(kept->edit(chunks)) << seed << ' ' << round;
      EXPECT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u) << seed << ' ' << round;
    }
  }
}

/// Some of the lamps are strong.
LightChunks with_strong_lamps(LightChunks chunks) {
  for (auto& [at, chunk] : chunks) {
    LightChunk other = *chunk;
    std::erase_if(other.lamps, [&](const WeakLamp& lamp) {
      const bool strong = static_cast<int>(lamp.place.x + lamp.place.z) % 3 != 0;
      if (strong) other.strong.push_back({lamp.place, 2.0f * lamp.range, lamp.intensity});
      return strong;
    });
    chunk = std::make_shared<const LightChunk>(std::move(other));
  }
  return chunks;
}

// Lamps and blocks come and go in an order of chance; all that is kept is followed along.
TEST(SkyTransferEdit, FollowsRandomLampsAndBlocksInACave) {
  for (unsigned seed = 0; seed < 2; ++seed) {
    std::mt19937 random(seed);
    const auto place = [&] {
      return IVec3{static_cast<int>(random() % 34) - 17, static_cast<int>(random() % 12) - 4,
                   static_cast<int>(random() % 34) - 17};
    };
    // Between a floor and a ceiling with pillars; a hole lets the sky in.
    Voxels stone, plants;
    for (int x = -18; x <= 18; ++x)
      for (int z = -18; z <= 18; ++z)
        for (const int y : {-5, 8})
          if (y == -5 || std::abs(x) + std::abs(z) > 3) stone.insert({x, y, z});
    for (int i = 0; i < 1200; ++i) stone.insert(place());
    plants.insert({0, 9, 12});  // the volume knows of plants
    Lamps lamps{{}, 7.0f};
    const auto now = [&] { return with_strong_lamps(chunks_of(stone, lamps, plants)); };
    LightChunks chunks = now();
    const std::unique_ptr<SkyTransfer> kept = looked_at(chunks);
    LampReaches reaches = reaches_of(chunks);
    for (int round = 0; round < 60; ++round) {
      const IVec3 at = place();
      switch (random() % 5) {
        case 0:
          lamps.voxels.insert(at);
          break;
        case 1:
          if (!lamps.voxels.empty())
            lamps.voxels.erase(std::next(
                lamps.voxels.begin(), static_cast<std::ptrdiff_t>(random() % lamps.voxels.size())));
          break;
        case 2:
          if (!stone.contains(at) && plants.erase(at) == 0) plants.insert(at);
          break;
        default:
          if (stone.erase(at) == 0) stone.insert(at), plants.erase(at);
      }
      const LightChunks before = chunks;
      chunks = with_what_stays(before, now());
      ASSERT_TRUE(kept->edit(chunks)) << seed << ' ' << round;
      reaches = reaches_after(chunks, before, reaches);
      ASSERT_TRUE(reaches == reaches_of(chunks)) << seed << ' ' << round;
      if (round % 10 != 9) continue;
      EXPECT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u) << seed << ' ' << round;
    }
  }
}

// A hall with windows and panes in it; panes, walls and lamps come, go and change their colours.
TEST(SkyTransferEdit, FollowsStainedGlassThatComesAndGoes) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    std::mt19937 random(seed);
    const auto part = [&](int low, int high) {
      return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
    };
    // Over the corner of chunks.
    Voxels stone;
    Glass glass;
    for (int x = -9; x < 9; ++x)
      for (int y = -2; y < 8; ++y)
        for (int z = -9; z < 9; ++z) {
          const bool wall = x == -9 || x == 8 || y == -2 || y == 7 || z == -9 || z == 8;
          if (wall) stone.insert({x, y, z});
        }
    for (int x = -13; x < 13; ++x)
      for (int z = -13; z < 13; ++z) stone.insert({x, -3, z});
    const auto put = [&](IVec3 at) {
      stone.erase(at);
      glass[at] = static_cast<BlockId>(block::kWhiteGlass + part(0, 16));
    };
    for (int z = -5; z < 5; ++z)
      for (int y = 1; y < 5; ++y) put({-9, y, z});
    Lamps lamps{{{3, 2, 3}, {-4, 5, 0}}, 7.0f};
    const auto now = [&] { return with_strong_lamps(chunks_of(stone, lamps, {}, glass)); };
    LightChunks chunks = now();
    std::unique_ptr<SkyTransfer> kept = looked_at(chunks);
    EXPECT_TRUE(
        std::ranges::any_of(kept->faces(), [](const auto& at) { return at.second->parts.tinted; }));
    int followed = 0;
    for (int round = 0; round < 30; ++round) {
      const IVec3 at{part(-10, 10), part(-2, 8), part(-10, 10)};
      switch (random() % 4) {
        case 0:
          if (!glass.empty() && random() % 2 == 0) {
            const auto one = std::next(glass.begin(), part(0, static_cast<int>(glass.size())));
            if (random() % 2 == 0)
              one->second = block::kBlueGlass;
            else
              glass.erase(one);
            break;
          }
          [[fallthrough]];
        case 1:
          if (!lamps.voxels.contains(at)) put(at);
          break;
        case 2:
          if (stone.erase(at) == 0 && !glass.contains(at) && !lamps.voxels.contains(at))
            stone.insert(at);
          break;
        default:
          if (round % 5 == 0) lamps.voxels.insert({at.x, at.y, at.z});
          stone.erase(at), glass.erase(at);
      }
      chunks = with_what_stays(chunks, now());
      if (kept->edit(chunks))
        ++followed;
      else
        kept = looked_at(chunks);
      ASSERT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u) << seed << ' ' << round;
    }
    EXPECT_GT(followed, 25);
    // The last pane goes, and the first one comes again.
    for (const Glass& next : {Glass{}, Glass{{{-9, 2, 0}, block::kRedGlass}}}) {
      glass = next;
      chunks = with_what_stays(chunks, now());
      if (!kept->edit(chunks)) kept = looked_at(chunks);
      ASSERT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u) << seed;
    }
  }
}

// A pool between walls: water, glass and stones come and go in it and beside it.
TEST(SkyTransferEdit, FollowsWaterThatComesAndGoes) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    std::mt19937 random(seed);
    const auto part = [&](int low, int high) {
      return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
    };
    Voxels stone;
    Glass water;
    for (int x = -9; x < 9; ++x)
      for (int z = -9; z < 9; ++z) {
        const bool shore = x < -6 || x > 5 || z < -6 || z > 5;
        for (int y = -6; y < (shore ? 0 : -3); ++y) stone.insert({x, y, z});
        for (int y = -3; y < 0 && !shore; ++y) water[{x, y, z}] = block::kWater;
      }
    for (int y = 0; y < 6; ++y)
      for (int z = -9; z < 9; ++z) stone.insert({-9, y, z});
    const auto now = [&] { return chunks_of(stone, {}, {}, water); };
    LightChunks chunks = now();
    std::unique_ptr<SkyTransfer> kept = looked_at(chunks);
    int followed = 0;
    for (int round = 0; round < 40; ++round) {
      const IVec3 at{part(-7, 7), part(-5, 2), part(-7, 7)};
      stone.erase(at), water.erase(at);
      switch (random() % 4) {
        case 0:
          stone.insert(at);
          break;
        case 1:
          water[at] = block::kWater;
          break;
        case 2:
          if (round % 3 == 0) water[at] = block::kGreenGlass;
          break;
        default:
          break;
      }
      chunks = with_what_stays(chunks, now());
      if (kept->edit(chunks))
        ++followed;
      else
        kept = looked_at(chunks);
      ASSERT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u) << seed << ' ' << round;
    }
    EXPECT_GT(followed, 30);
  }
}

void follow_key(SkyTransfer& transfer, std::size_t slot, const glm::vec3& to_body) {
  transfer.set_key(slot, to_body);
  for (int step = 0; step < BounceLight::kSteps; ++step)
    for (int part = 0; part < BounceLight::kParts; ++part) transfer.follow_key(slot, step, part);
  transfer.take_key(slot);
}

// Between leaves there are no faces: a face goes as leaves are put before it, which lines pass.
LightChunks with_leaves(const Voxels& stone, const Voxels& leaves) {
  const LightChunks as_stone = chunks_of(leaves);
  LightChunks out = chunks_of(stone);
  for (auto& [at, chunk] : out) {
    LightChunk other = *chunk;
    if (const auto found = as_stone.find(at); found != as_stone.end())
      other.leaves = found->second->opaque;
    for (const IVec3& v : leaves) {
      if (test::chunk_holding(v) != at) continue;
      for (int face = 0; face < 6; ++face)
        if (const IVec3 next = test::beside(v, face);
            !stone.contains(next) && !leaves.contains(next))
          other.quads.push_back(
              {static_cast<std::uint32_t>((v.x & 63) | (v.y & 63) << 6 | (v.z & 63) << 12),
               static_cast<std::uint32_t>(block::kOakLeaves | face << shared::kFaceShift)});
    }
    chunk = std::make_shared<const LightChunk>(std::move(other));
  }
  return out;
}
TEST(SkyTransferEdit, FollowsLeavesThatComeAndGo) {
  Voxels stone, leaves;
  for (int x = 8; x < 24; ++x)
    for (int z = 8; z < 24; ++z)
      for (int y = 8; y < (z < 10 ? 14 : 9); ++y) stone.insert({x, y, z});
  for (int y = 9; y < 12; ++y)
    for (int x = 15; x < 18; ++x) leaves.insert({x, y, 15});
  const std::unique_ptr<SkyTransfer> kept = looked_at(with_leaves(stone, leaves));
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    const IVec3 at{13 + static_cast<int>(random() % 7), 9 + static_cast<int>(random() % 3),
                   13 + static_cast<int>(random() % 5)};
    if (leaves.erase(at) == 0) leaves.insert(at);
    const LightChunks now = with_leaves(stone, leaves);
    ASSERT_TRUE(kept->edit(now)) << i;
    ASSERT_EQ(differences(kept->faces(), looked_at(now)->faces()), 0u) << i;
  }
}

/// A closed room in one chunk: all light in it comes by rays.
Voxels closed_room() {
  Voxels stone;
  for (int x = 8; x < 20; ++x)
    for (int y = 8; y < 15; ++y)
      for (int z = 8; z < 20; ++z)
        if (x == 8 || x == 19 || y == 8 || y == 14 || z == 8 || z == 19) stone.insert({x, y, z});
  return stone;
}

TEST(SkyTransferEdit, FollowsBlocksInAClosedRoom) {
  Voxels stone = closed_room();
  const auto now = [&] { return with_strong_lamps(chunks_of(stone, {{{12, 10, 12}}, 7.0f})); };
  const std::unique_ptr<SkyTransfer> kept = looked_at(now());
  std::mt19937 random(3);
  const auto part = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
  };
  for (int round = 0; round < 40; ++round) {
    const IVec3 at{part(9, 19), part(9, 14), part(9, 19)};
    if (at == IVec3{12, 10, 12}) continue;
    if (stone.erase(at) == 0) stone.insert(at);
    const LightChunks chunks = now();
    ASSERT_TRUE(kept->edit(chunks)) << round;
    ASSERT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u) << round;
  }
}

// A face may go though no voxel does: whoever looks there sees nothing then.
TEST(SkyTransferEdit, FollowsFacesThatComeAndGoAlone) {
  const LightChunks whole = with_strong_lamps(chunks_of(closed_room(), {{{12, 10, 12}}, 7.0f}));
  ASSERT_EQ(whole.size(), 1u);
  const std::unique_ptr<SkyTransfer> kept = looked_at(whole);
  const auto& [at, chunk] = *whole.begin();
  for (std::size_t i = 0; i < chunk->quads.size(); i += 97) {
    LightChunk less = *chunk;
    less.quads.erase(less.quads.begin() + static_cast<std::ptrdiff_t>(i));
    const LightChunks now{{at, std::make_shared<const LightChunk>(std::move(less))}};
    for (const LightChunks& next : {now, whole}) {
      ASSERT_TRUE(kept->edit(next)) << i;
      ASSERT_EQ(differences(kept->faces(), looked_at(next)->faces()), 0u) << i;
    }
  }
}

// Rooms with windows, of air or of glass, in whose way blocks come and go: rays through them are
// followed, and where they are asked changes too.
TEST(SkyTransferEdit, FollowsWhatIsSeenThroughWindows) {
  for (const bool stained : {false, true}) {
    std::mt19937 random(stained ? 5 : 2);
    const auto place = [&](int low, int high) {
      return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
    };
    Voxels stone;
    Glass glass;
    for (int x = 10; x <= 22; ++x)
      for (int y = 20; y <= 27; ++y)
        for (int z = 58; z <= 70; ++z)
          if (x == 10 || x == 22 || y == 20 || y == 27 || z == 58 || z == 70)
            stone.insert({x, y, z});
    for (int y = 22; y <= 24; ++y)
      for (int z = 62; z <= 65; ++z) {
        stone.erase({10, y, z});
        if (stained) glass[{10, y, z}] = block::kRedGlass;
      }
    stone.erase({16, 27, 66});
    LightChunks chunks = chunks_of(stone, {}, {}, glass);
    auto edited = looked_at(chunks, colours(), 16);
    std::size_t changes = 0, followed = 0;
    for (int i = 0; i < 60; ++i) {
      // In the room, in its walls, before the window; now and then a wall of it.
      const int count = i % 10 == 9 ? 20 : 1;
      for (int k = 0; k < count; ++k) {
        const IVec3 at{place(4, 22), place(20, 27), place(58, 70)};
        if (glass.erase(at) == 0 && !stone.insert(at).second) stone.erase(at);
        if (stained && i % 4 == 3 && !stone.contains(at)) glass[at] = block::kRedGlass;
        if (stained && i % 4 == 1)
          for (auto& [voxel, block] : glass)
            if (random() % 4 == 0)
              block = block == block::kRedGlass ? block::kSkyGlass : block::kRedGlass;
      }
      const LightChunks now = with_what_stays(chunks, chunks_of(stone, {}, {}, glass));
      const SkyTransfer::Skies before = edited->faces();
      if (edited->edit(now)) {
        ++followed;
      } else {
        edited = looked_at(now, colours(), 16);
      }
      chunks = now;
      ASSERT_EQ(differences(looked_at(chunks)->faces(), edited->faces()), 0u)
          << i << (stained ? ", stained" : "");
      changes += differences(before, edited->faces());
    }
    EXPECT_GT(changes, 1000u);
    EXPECT_GT(followed, stained ? 55u : 59u);
  }
}

// A court with a wall, leaves of grass, a lamp and panes: voxels come and go, and the sun moves on.
TEST(SkyTransferEdit, FollowsABodyThatMovesOn) {
  std::mt19937 random(6);
  const auto part = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
  };
  Voxels stone, plants{{2, 1, 2}};
  Glass glass{{{0, 3, 0}, block::kRedGlass}};
  for (int x = -12; x < 12; ++x)
    for (int z = -12; z < 12; ++z)
      for (int y = 0; y < (z < -10 || x > 10 ? 7 : 1); ++y) stone.insert({x, y, z});
  const Lamps lamps{{{-3, 2, 4}}, 6.0f};
  const auto now = [&] { return chunks_of(stone, lamps, plants, glass); };
  LightChunks chunks = now();
  KeyDirections keys;
  const std::unique_ptr<SkyTransfer> kept = looked_at(chunks, colours(), 0, keys);
  for (int round = 0; round < 24; ++round) {
    if (round % 3 == 0) {
      const auto slot = static_cast<std::size_t>(round / 3 % 2);
      const float turn = 0.2f * static_cast<float>(round);
      keys[slot] = glm::normalize(glm::vec3(std::cos(turn), 0.9f, std::sin(turn)));
      follow_key(*kept, slot, *keys[slot]);
      ASSERT_EQ(differences(kept->faces(), looked_at(chunks, colours(), 0, keys)->faces()), 0u)
          << round;
    }
    const IVec3 at{part(-12, 12), part(0, 8), part(-12, 12)};
    if (stone.erase(at) == 0 && !glass.contains(at)) stone.insert(at), plants.erase(at);
    chunks = with_what_stays(chunks, now());
    ASSERT_TRUE(kept->edit(chunks)) << round;
    ASSERT_EQ(differences(kept->faces(), looked_at(chunks, colours(), 0, keys)->faces()), 0u)
        << round;
  }
}

TEST(SkyTransferEdit, FindsTheSkyAloneAlike) {
  Voxels stone;
  for (int x = 0; x < 20; ++x)
    for (int z = 0; z < 20; ++z) stone.insert({x, 0, z});
  stone.insert({0, 8, 0});  // the volume has room for what follows
  LightChunks chunks = chunks_of(stone, {{{5, 2, 5}}});
  const std::unique_ptr<SkyTransfer> kept = looked_at(chunks, {});
  for (int y = 1; y < 6; ++y) {
    stone.insert({7, y, 6});
    chunks = with_what_stays(chunks, chunks_of(stone, {{{5, 2, 5}}}));
    ASSERT_TRUE(kept->edit(chunks));
    EXPECT_EQ(differences(kept->faces(), looked_at(chunks, {})->faces()), 0u) << y;
  }
}

TEST(SkyTransferEdit, ThatDoesTheSameAndUndoesItEndsWhereItBegan) {
  Voxels stone;
  for (int x = 0; x < 16; ++x)
    for (int z = 0; z < 16; ++z) stone.insert({x, z % 5 == 0 ? 1 : 0, z}), stone.insert({x, 0, z});
  const LightChunks before = chunks_of(stone);
  const std::unique_ptr<SkyTransfer> kept = looked_at(before);
  const SkyTransfer::Skies first = kept->faces();
  stone.insert({8, 2, 8});
  const LightChunks after = with_what_stays(before, chunks_of(stone));
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(kept->edit(i % 2 == 0 ? after : before));
    if (i == 0) {
      EXPECT_GT(differences(kept->faces(), first), 0u);
    }
  }
  EXPECT_EQ(differences(kept->faces(), first), 0u);
}

// A bridge with lamps on it, through a chunk that did not exist, and taken down again.
TEST(SkyTransferEdit, FollowsWhatIsBuiltBeyondTheIslandAndInNewChunks) {
  Voxels stone;
  for (int x = 50; x < 61; ++x)
    for (int z = 20; z < 40; ++z)
      for (int y = 0; y < 1 + (x + z) % 3; ++y) stone.insert({x, y, z});
  const LightChunks island = chunks_of(stone);
  const std::unique_ptr<SkyTransfer> kept = looked_at(island, colours(), 16);
  EXPECT_EQ(differences(kept->faces(), looked_at(island)->faces()), 0u);
  LampReaches reaches = reaches_of(island);
  LightChunks chunks = island;
  Lamps lamps{{}, 7.0f};
  const auto follow = [&](const LightChunks& now) {
    const LightChunks before = std::exchange(chunks, with_what_stays(chunks, now));
    ASSERT_TRUE(kept->edit(chunks));
    reaches = reaches_after(chunks, before, reaches);
    EXPECT_TRUE(reaches == reaches_of(chunks));
    EXPECT_EQ(differences(kept->faces(), looked_at(chunks)->faces()), 0u);
  };
  for (int x = 61; x < 76; ++x) {
    stone.insert({x, 1, 30});
    if (x % 5 == 0) lamps.voxels.insert({x, 3, 30});
    follow(with_strong_lamps(chunks_of(stone, lamps)));
  }
  EXPECT_EQ(chunks.size(), 2u);
  follow(island);
  EXPECT_EQ(kept->faces().size(), 1u);
}

TEST(SkyTransferEdit, SaysWhenItWouldNotBeLessWork) {
  Voxels stone{{0, 0, 0}, {1, 0, 0}};
  const LightChunks chunks = chunks_of(stone);
  // Voxels beyond the volume, in a chunk more and in the same.
  stone.insert({70, 0, 0});
  EXPECT_FALSE(looked_at(chunks)->edit(chunks_of(stone)));
  EXPECT_FALSE(looked_at(chunks)->edit(chunks_of({{0, 0, 0}, {20, 0, 0}})));
}

/// An island as the game has it: leaves, plants, water, glowing plants.
class RealIsland {
 public:
  explicit RealIsland(std::uint64_t seed)
      : world_({.seed = seed, .island_limit = 1}),
        id_(world_.islands_near(world_.origin(), 1000.0, 0.0).front().id),
        jobs_(2),
        streamer_(world_, jobs_, StreamOf::kMeshesAndOccupancy) {
    view_.camera = moved(world_.origin(), {0.0, 60.0, 0.0});
    take();
  }
  /// Puts a block somewhere on a surface, or takes one away, and everything round about.
  void edit(std::mt19937& random, BlockId block, int size) {
    std::vector<std::pair<IVec3, const LightChunk*>> chunks;
    for (const auto& [at, chunk] : chunks_)
      if (!chunk->quads.empty()) chunks.emplace_back(at, chunk.get());
    std::vector<IVec3> places;
    while (places.empty()) {
      const auto& [at, chunk] = chunks[random() % chunks.size()];
      const IVec3 corner = corner_of(at);
      for_each_face(chunk->quads[random() % chunk->quads.size()], [&](const DrawnFace& face) {
        places.push_back(corner + face.voxel + (block == kAir ? IVec3{} : to_front(face)));
      });
    }
    const IVec3 middle = places[random() % places.size()];
    for (int x = 0; x < size; ++x)
      for (int y = 0; y < size; ++y)
        for (int z = 0; z < size; ++z) world_.set_block(id_, middle + IVec3{x, y, z}, block);
    take();
  }
  const LightChunks& chunks() const { return chunks_; }

 private:
  void take() {
    do {
      streamer_.update(view_, {.view_distance_blocks = 320.0, .detail_distance_blocks = 320.0});
      streamer_.wait_until_complete();
      StreamUpdate update = streamer_.poll(~std::size_t{0});
      for (const SectionKey& key : update.removed) chunks_.erase(key.chunk);
      for (ReadySection& ready : update.ready) {
        LightChunk chunk{ready.occupancy, ready.leaves, ready.mesh.quads, {}, {}, ready.stained};
        for (const Emitter& emitter : ready.emitters) {
          if (emitter.block == block::kTorch)
            chunk.strong.push_back({emitter.place, 15.0f, glm::vec3(3.0f, 2.0f, 1.0f)});
          else
            chunk.lamps.push_back({emitter.place, glm::vec3(0.3f, 0.5f, 0.2f), 6.0f});
        }
        chunks_[ready.key.chunk] = std::make_shared<const LightChunk>(std::move(chunk));
      }
    } while (!streamer_.complete());
  }

  World world_;
  std::uint64_t id_;
  Jobs jobs_;
  Streamer streamer_;
  StreamView view_;
  LightChunks chunks_;
};

TEST(SkyTransferEdit, FindsOnARealIslandWhatALookFromNothingFinds) {
  RealIsland island(1);
  std::mt19937 random(1);
  std::unique_ptr<SkyTransfer> kept = looked_at(island.chunks());
  LampReaches reaches = reaches_of(island.chunks());
  constexpr std::array<BlockId, 9> kBlocks{
      kAir,          block::kStone,     block::kTorch, block::kOakLeaves, block::kRedGlass,
      block::kWater, block::kGlowstone, block::kGlass, block::kFlowerRed};
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < 12; ++i) {
      const LightChunks before = island.chunks();
      island.edit(random, kBlocks[i % kBlocks.size()], i % 3 == 2 ? 3 : 1);
      reaches = reaches_after(island.chunks(), before, reaches);
      EXPECT_TRUE(reaches == reaches_of(island.chunks())) << round << ' ' << i;
      if (!kept->edit(island.chunks())) kept = looked_at(island.chunks());
    }
    EXPECT_EQ(differences(kept->faces(), looked_at(island.chunks())->faces()), 0u) << round;
  }
}

}  // namespace
}  // namespace skerry::world
