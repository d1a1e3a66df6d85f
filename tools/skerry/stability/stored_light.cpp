// Light that stays on faces: worlds that are full, full of holes, black and white, lamps from a
// millionth to a million, and edits without end.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/packing.hpp>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/harmonics.h"
#include "engine/render/sky/sky_irradiance.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"
#include "world/light/base/shared_exponent.h"
#include "world/light/sky_transfer.h"
#include "world/voxel/blocks.h"

namespace skerry::tools::stability {
namespace {

using world::IVec3;
using world::LightChunk;
using world::LightChunks;
using world::SkyTransfer;
using world::block::kAirBlock;
using world::block::kStone;

using Albedo = std::vector<world::FaceAlbedo>;

Albedo albedo_of(float value) {
  world::FaceAlbedo faces;
  faces.fill(glm::vec3(value));
  return Albedo(world::block_types().size(), faces);
}

/// One chunk at the lattice's origin.
LightChunk chunk_of(const BlockAt& block_at, std::vector<world::WeakLamp> lamps = {}) {
  return {world::occupancy_of(padded_chunk(block_at, {})),
          {},
          mesh_chunk_of(block_at, {}).quads,
          std::move(lamps),
          {}};
}

LightChunks alone(LightChunk chunk) {
  return {{IVec3{}, std::make_shared<const LightChunk>(std::move(chunk))}};
}

std::unique_ptr<SkyTransfer> looked_at(LightChunks chunks, const Albedo& albedo) {
  auto transfer = std::make_unique<SkyTransfer>(std::move(chunks), albedo);
  for (int octant = 0; octant < world::kOctants; ++octant) transfer->look(octant);
  transfer->spread_lamps();
  for (int step = 0; step < world::BounceLight::kSteps; ++step)
    for (int part = 0; part < world::BounceLight::kParts; ++part)
      transfer->follow_bounces(step, part);
  transfer->make_faces();
  return transfer;
}

using Record = std::span<const glm::uvec4>;

/// Calls fn(voxel, direction, record) for each face of the only chunk.
template <class Fn>
void for_each_record(const SkyTransfer& transfer, const Fn& fn) {
  const auto found = transfer.faces().find(IVec3{});
  if (found == transfer.faces().end()) return;
  for (int y = 0; y < world::kChunkEdge; ++y)
    for (int x = 0; x < world::kChunkEdge; ++x)
      for (int z = 0; z < world::kChunkEdge; ++z)
        for (int direction = 0; direction < 6; ++direction)
          if (const auto at = world::find_record(*found->second, {x, y, z}, direction))
            fn(IVec3{x, y, z}, direction,
               Record(found->second->texels).subspan(*at, shared::kIndirectRecordTexels));
}

bool is_dark(Record record) {
  return std::ranges::all_of(record.first(2), [](auto t) { return t == glm::uvec4(0); }) &&
         glm::ivec4(record[2]) == glm::ivec4(0) && record[3].x == 0;
}

/// Shares of a face's lobes in the light of an even sky; they sum to 1.
std::array<double, shared::kSkyLobes> lobe_shares(int face) {
  std::array<double, shared::kSkyLobes> out{};
  for (int octant = 0; octant < world::kOctants; ++octant)
    for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k)
      if ((octant >> face / 2 & 1) == face % 2)
        out[world::lobe_of(face / 2, octant, k)] +=
            world::lobe_weights(face / 2)[k] / (4.0 * 65280.0);
  return out;
}

/// Mean over a face's corners of the light of an even sky that is seen, over the open sky's.
double sky_seen(Record record, int face) {
  const std::array<double, shared::kSkyLobes> shares = lobe_shares(face);
  double sum = 0.0;
  for (std::size_t corner = 0; corner < 4; ++corner)
    for (std::size_t lobe = 0; lobe < shares.size(); ++lobe) {
      const std::uint32_t word = record[corner / 2][static_cast<int>(2 * (corner % 2) + lobe / 4)];
      sum += shares[lobe] * (word >> 8 * (lobe % 4) & 255u) / (4.0 * 255.0);
    }
  return sum;
}

/// Mean over a face of what others reflect under a sky of radiance 1, over pi.
double reflected(Record record) {
  double share = 0.0;
  for (int corner = 0; corner < 4; ++corner) share += (record[3].y >> 8 * corner & 255u) / 255.0;
  const double even = std::sqrt(4.0 * 3.14159265358979);
  return static_cast<double>(world::unpack_shared_exponent(record[3].x).y) * even * share / 4.0 /
         3.14159265358979;
}

/// How many records differ; a chunk that only one side has counts as one.
double differences(const SkyTransfer::Skies& a, const SkyTransfer::Skies& b) {
  double count = 0.0;
  for (const auto& [at, sky] : b) {
    const auto other = a.find(at);
    count += other == a.end() || *other->second != *sky ? 1.0 : 0.0;
  }
  for (const auto& [at, sky] : a) count += b.contains(at) ? 0.0 : 1.0;
  return count;
}

/// A floor, a wall and a roof over a part of it.
world::BlockId shelter(int x, int y, int z) {
  const bool inside = x >= 8 && x < 40 && z >= 8 && z < 40 && y >= 4 && y < 24;
  if (!inside) return kAirBlock;
  return y == 4 || x == 8 || (y == 16 && x < 24) || (z == 20 && y < 9 && x > 20) ? kStone
                                                                                 : kAirBlock;
}

/// The shelter's pieces alone, all their faces in the chunk. Albedo 0 reflects nothing; albedo 1
/// gives back what it receives, and no face has more than an open sky sends.
Result<Rows> black_and_white() {
  double black = 0.0, white_faces = 0.0, most = 0.0;
  const auto dark = looked_at(alone(chunk_of(shelter)), albedo_of(0.0f));
  for_each_record(*dark, [&](IVec3, int, Record r) { black += r[3].x != 0 ? 1.0 : 0.0; });
  const auto white = looked_at(alone(chunk_of(shelter)), albedo_of(1.0f));
  for_each_record(*white, [&](IVec3, int face, Record r) {
    white_faces += reflected(r) > 0.1 ? 1.0 : 0.0;
    most = std::max(most, sky_seen(r, face) + reflected(r));
  });
  return Rows{
      {"faces that receive reflected light, albedo 0", 0.0, if_shown(white_faces > 0.0, black)},
      // Half of the lines stand for all: what one face has of a lobe is off by a few
      // hundredths, as BounceLight's tests allow.
      {"light over that of the open sky, less 1, albedo 1", 0.06,
       if_shown(white_faces > 0.0, most - 1.0)}};
}

/// Stone throughout but for one voxel, and every other voxel stone: air there touches air along
/// edges alone.
Result<Rows> full_and_chequered() {
  const Albedo grey = albedo_of(0.8f);
  const auto within = [](int v) { return v >= 4 && v < 60; };
  const auto solid = [&](int x, int y, int z) {
    const bool hole = x == 30 && y == 30 && z == 30;
    return within(x) && within(y) && within(z) && !hole ? kStone : kAirBlock;
  };
  const auto chequered = [&](int x, int y, int z) {
    return within(x) && within(y) && within(z) && (x + y + z) % 2 == 0 ? kStone : kAirBlock;
  };
  std::array<double, 2> lit{}, outside{};
  const std::array<BlockAt, 2> worlds{solid, chequered};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto found = looked_at(alone(chunk_of(worlds[i])), grey);
    for_each_record(*found, [&](IVec3 v, int, Record r) {
      const auto deep = [](int at) { return at > 5 && at < 58; };
      const bool is_inside = deep(v.x) && deep(v.y) && deep(v.z);
      (is_inside ? lit : outside)[i] += is_dark(r) ? 0.0 : 1.0;
    });
  }
  return Rows{
      {"faces lit in a closed voxel of a solid world", 0.0, if_shown(outside[0] > 0.0, lit[0])},
      {"faces lit inside a chequered world", 0.0, if_shown(outside[1] > 0.0, lit[1])}};
}

/// One lamp over a floor, its light a millionth to a million of a torch's.
Result<Rows> weak_lamps() {
  const Albedo grey = albedo_of(0.5f);
  const auto ground = [](int x, int y, int z) {
    return y == 4 && x >= 8 && x < 40 && z >= 8 && z < 40 ? kStone : kAirBlock;
  };
  double darker = 0.0, worst = 0.0, brighter = 0.0;
  std::map<std::array<int, 4>, double> before;
  for (int decade = -6; decade <= 6; ++decade) {
    const float power = std::pow(10.0f, static_cast<float>(decade));
    const auto found = looked_at(
        alone(chunk_of(ground, {{glm::vec3(24.5f, 8.5f, 24.5f), glm::vec3(power), 9.0f}})), grey);
    for_each_record(*found, [&](IVec3 v, int direction, Record r) {
      double sum = 0.0;
      for (int corner = 0; corner < 4; ++corner)
        sum += static_cast<double>(world::unpack_shared_exponent(r[2][corner]).y) / 4.0;
      double& last = before[{v.x, v.y, v.z, direction}];
      darker += sum < last ? 1.0 : 0.0;
      brighter += sum > 1.5 * last ? 1.0 : 0.0;
      last = sum;
      // Below the lamp: its corners are alike, what a point gives them less a twelfth of its
      // Laplacian along the face, ended by the mean of what ends the lamp's light in the four
      // voxels about each.
      if (direction != 2 || v.x != 24 || v.z != 24 || v.y != 4) return;
      double window = 0.0;
      for (const double x : {0.0, 1.0})
        for (const double z : {0.0, 1.0}) {
          const double d2 = 3.5 * 3.5 + x * x + z * z, w = 1.0 - d2 * d2 / (81.0 * 81.0);
          window += w * w / 4.0;
        }
      const auto point = [](double x, double z) {
        return 3.5 / std::pow(3.5 * 3.5 + x * x + z * z, 1.5);
      };
      constexpr double kStep = 1e-3;
      const double there = point(0.5, 0.5),
                   laplacian = (point(0.5 + kStep, 0.5) + point(0.5 - kStep, 0.5) +
                                point(0.5, 0.5 + kStep) + point(0.5, 0.5 - kStep) - 4.0 * there) /
                               (kStep * kStep);
      double right = power * window * (there - laplacian / 12.0);
      right = std::min(right, 511.0 * 128.0);  // the most that is kept
      // Three numbers with an exponent in common: 9 bits each, of 2^-24 at least.
      worst = std::max(worst, std::abs(sum - right) / std::max(right / 256.0, std::exp2(-24.0)));
    });
  }
  return Rows{{"faces that a brighter weak lamp darkens, 1e-6 to 1e6", 0.0,
               if_shown(brighter > 0.0, darker)},
              {"error of lamp light 3.5 voxels below over the step it is kept in, 1e-6 to 1e6", 1.0,
               if_shown(worst > 0.0, worst)}};
}

/// A minute of edits at 60 a second, of a heap of voxels that comes and goes.
Result<Rows> a_minute_of_edits() {
  const Albedo grey = albedo_of(0.6f);
  std::vector<std::uint8_t> stone(64 * 64 * 64, 0);
  const auto at = [](int x, int y, int z) {
    return static_cast<std::size_t>((y * 64 + x) * 64 + z);
  };
  const auto block = [&](int x, int y, int z) -> world::BlockId {
    const bool inside = std::min({x, y, z}) >= 0 && std::max({x, y, z}) < 64;
    return inside && stone[at(x, y, z)] != 0 ? kStone : kAirBlock;
  };
  std::mt19937 random(60);
  const auto any = [&random] { return static_cast<int>(20 + random() % 14); };
  for (const int corner : {18, 36}) stone[at(corner, corner, corner)] = 1;
  for (int i = 0; i < 900; ++i) stone[at(any(), any(), any())] = 1;
  std::unique_ptr<SkyTransfer> kept = looked_at(alone(chunk_of(block)), grey);
  const SkyTransfer::Skies first = kept->faces();
  double changed = 0.0;
  for (int edit = 0; edit < 60 * 60; ++edit) {
    stone[at(any(), any(), any())] ^= 1;
    const LightChunks chunks = alone(chunk_of(block));
    // An edit may say that it would be as much work to begin anew.
    if (!kept->edit(chunks)) kept = looked_at(chunks, grey);
    changed += differences(kept->faces(), first) > 0.0 ? 1.0 : 0.0;
  }
  const double off = differences(kept->faces(), looked_at(alone(chunk_of(block)), grey)->faces());
  return Rows{{"chunks unlike a look from nothing, a minute of 60 edits a second", 0.0,
               if_shown(changed > 3000.0, off)}};
}

/// A roof's voxel that lets the sky in and a lamp, a thousand times.
Result<Rows> comes_and_goes() {
  const Albedo grey = albedo_of(0.7f);
  const auto holed = [](int x, int y, int z) -> world::BlockId {
    if (x == 12 && y == 16 && z == 12) return kAirBlock;
    return shelter(x, y, z);
  };
  const std::vector<world::WeakLamp> lamp{{glm::vec3(15.5f, 9.5f, 30.5f), glm::vec3(2.0f), 8.0f}};
  const LightChunks closed = alone(chunk_of(shelter)), lit = alone(chunk_of(holed, lamp));
  const std::unique_ptr<SkyTransfer> kept = looked_at(closed, grey);
  const SkyTransfer::Skies first = kept->faces();
  double changed = 0.0, refused = 0.0;
  for (int i = 0; i < 1000; ++i) {
    refused += kept->edit(lit) ? 0.0 : 1.0;
    changed += differences(kept->faces(), first) > 0.0 ? 1.0 : 0.0;
    refused += kept->edit(closed) ? 0.0 : 1.0;
  }
  return Rows{{"chunks that differ after light came and left 1,000 times", 0.0,
               if_shown(changed == 1000.0 && refused == 0.0, differences(kept->faces(), first))}};
}

/// Of what the sky sends to islands: halves and floats that are no number.
double not_finite(std::span<const glm::uvec4> texels, std::size_t islands) {
  double count = 0.0;
  const std::size_t first = (islands + 3) / 4;  // which sky each has, before the skies
  for (std::size_t i = first; i < texels.size(); ++i)
    for (int word = 0; word < 4; ++word) {
      if ((i - first) % shared::kIndirectIslandTexels >= shared::kIndirectHarmonics + 3) {
        count += std::isfinite(std::bit_cast<float>(texels[i][word])) ? 0.0 : 1.0;
        continue;
      }
      const glm::vec2 pair = glm::unpackHalf2x16(texels[i][word]);
      count += (std::isfinite(pair.x) ? 0.0 : 1.0) + (std::isfinite(pair.y) ? 0.0 : 1.0);
    }
  return count;
}

std::vector<glm::uvec4> sent_at_noon(double times, std::span<const render::IslandPlacement> on) {
  render::Celestial bodies = render::celestial_at(43200.0, 0.5);
  render::SkyModel sky = render::sky_model(bodies);
  const auto factor = static_cast<float>(times);
  bodies.sun_irradiance *= factor;
  bodies.moon_irradiance *= factor;
  sky.constants.sun.light *= factor;
  sky.constants.moon.light *= factor;
  return render::sky_irradiance(sky, bodies, on, std::vector<bool>(on.size(), true), {});
}

/// Islands side by side, 100 blocks from each other, the first one turned.
std::vector<render::IslandPlacement> field_of(int edge, double angle) {
  std::vector<render::IslandPlacement> out;
  for (int x = 0; x < edge; ++x)
    for (int z = 0; z < edge; ++z)
      out.push_back({fixed_at({100.0 * x, 7.0 * ((x + z) % 5), 100.0 * z}),
                     {1.0, 0.0, 0.0, 0.0},
                     60.0,
                     false,
                     0,
                     {glm::vec3(0.0f, -10.0f, 0.0f), glm::vec3(40.0f, 25.0f, 30.0f)}});
  out.front().rotation = glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
  return out;
}

/// Of the first island.
double most_of(std::span<const glm::uvec4> texels) {
  double most = 0.0;
  for (const glm::uvec4& texel : texels.subspan(texels[0].x, shared::kIndirectHarmonics))
    for (int word = 0; word < 4; ++word) {
      const glm::vec2 pair = glm::abs(glm::unpackHalf2x16(texel[word]));
      most = std::max({most, static_cast<double>(pair.x), static_cast<double>(pair.y)});
    }
  return most;
}

Result<Rows> skies() {
  const std::vector<render::IslandPlacement> one(1);
  const double noon = most_of(sent_at_noon(1.0, one));
  const std::vector<glm::uvec4> many = sent_at_noon(1.0, field_of(32, 0.3));
  double wild = 0.0;
  for (int frame = 0; frame < 60; ++frame)  // 1,000 rad/s, 60 frames a second
    wild += not_finite(sent_at_noon(1.0, field_of(2, frame * 1000.0 / 60.0)), 4);
  return Rows{{"numbers that are not finite under a sky of 1e6", 0.0,
               if_shown(noon > 0.0, not_finite(sent_at_noon(1e6, one), 1))},
              {"most light that a sky of 0 sends, its stars apart", 0.0,
               if_shown(noon > 0.0, most_of(sent_at_noon(0.0, one)))},
              {"numbers that are not finite, 1,024 islands in each other's sky", 0.0,
               if_shown(noon > 0.0, not_finite(many, 1024))},
              {"numbers that are not finite, an island at 1,000 rad/s among others", 0.0,
               if_shown(noon > 0.0, wild)}};
}

constexpr Case kStoredLightCases[] = {{"stored_light.albedo", black_and_white},
                                      {"stored_light.worlds", full_and_chequered},
                                      {"stored_light.lamps", weak_lamps},
                                      {"stored_light.edits", a_minute_of_edits},
                                      {"stored_light.comes_and_goes", comes_and_goes},
                                      {"stored_light.skies", skies}};

}  // namespace

std::span<const Case> stored_light_cases() {
  return kStoredLightCases;
}

}  // namespace skerry::tools::stability
