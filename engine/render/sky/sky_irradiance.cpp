#include "engine/render/sky/sky_irradiance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "engine/core/halves.h"
#include "engine/core/harmonics.h"
#include "engine/core/shared_work.h"
#include "engine/render/sky/island_shade.h"
#include "engine/render/sky/sky_rows.h"
#include "shaders/shared/indirect.h"

namespace skerry::render {
namespace {

constexpr std::size_t kFaces = 6;
/// Of the sky about an island: every other azimuth of SkyRows, which one depends on the heading.
constexpr int kAround = SkyRows::kAzimuths / 2;
constexpr int kHeadings = SkyRows::kAzimuths;

/// A direction of the lattice, and for each axis the face and lobe it lights, and its share.
struct LobeSample {
  glm::vec3 direction{};
  std::array<std::uint8_t, 3> slot{};  ///< of Lobes, red
  glm::vec3 weight{};  ///< cosine times solid angle, so that a whole sky of 1 sums to pi a face
  std::array<float, kHarmonics> basis{};  ///< harmonics of the direction
};

/// How high the pattern is that is nearest to a direction of the first octant.
float sine_of_pattern(const glm::dvec3& d) {
  glm::dvec3 best(0.0);
  for (const glm::ivec3& pattern : shared::kSkyPatterns) {
    const glm::dvec3 p = glm::normalize(glm::dvec3(pattern));
    if (glm::dot(p, d) > glm::dot(best, d)) best = p;
  }
  return static_cast<float>(best.y);
}

/// By row, then azimuth k + 1/2 of kAround.
std::vector<LobeSample> make_samples() {
  std::vector<LobeSample> out;
  glm::dvec3 sum(0.0);
  for (int row = 0; row < SkyRows::kRows; ++row)
    for (int k = 0; k < kAround; ++k) {
      const glm::dvec3 d = SkyRows::direction(row, 2 * k + 1), size = glm::abs(d);
      const float sine = sine_of_pattern(size);
      std::uint32_t octant = 0;
      for (int axis = 0; axis < 3; ++axis) octant |= (d[axis] < 0.0 ? 1u : 0u) << axis;
      LobeSample sample{.direction = glm::vec3(d), .slot = {}, .weight = glm::vec3(size)};
      sample.basis = harmonics_of(sample.direction.x, sample.direction.y, sample.direction.z);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::uint32_t>(axis);
        const std::uint32_t face = 2 * a + (octant >> a & 1u);
        sample.slot[a] = static_cast<std::uint8_t>(face * 3 * shared::kSkyLobes +
                                                   shared::sky_lobe(a, octant, sine));
      }
      sum += size;
      out.push_back(sample);
    }
  // Two faces share each axis.
  const glm::vec3 scale(2.0 * std::numbers::pi / sum);
  for (LobeSample& sample : out) sample.weight *= scale;
  return out;
}

constexpr double kHeadingStep = 2.0 * std::numbers::pi / kHeadings;

bool is_upright(const glm::dquat& rotation) {
  return std::abs(rotation.x) + std::abs(rotation.z) < 1e-6;
}

/// In steps of kHeadingStep, any number of turns.
template <class T>
T heading_of(const glm::qua<T>& rotation) {
  return T(2) * std::atan2(rotation.y, rotation.w) / static_cast<T>(kHeadingStep);
}

/// By face, channel and lobe, as the texels of a sky are.
using Lobes = std::array<float, kFaces * 3 * shared::kSkyLobes>;
using Harmonics = std::array<glm::vec3, kHarmonics>;

using Basis = std::array<float, kHarmonics>;
/// Irradiance of bodies, by slot of key directions.
using Keyed = std::array<glm::vec3, std::tuple_size_v<decltype(IslandPlacement::keyed)>>;

void add(Harmonics& sum, const Basis& basis, const glm::vec3& light) {
  for (std::size_t i = 0; i < kHarmonics; ++i) sum[i] += light * basis[i];
}

/// Of degrees 1 and 2 of sun and moon, for what faces reflect. A point that is cut off at degree 2
/// is negative to its sides and too bright behind them. The share was measured: decision 0067.
constexpr float kShapeOfBodies = 0.8f;

/// Sun or moon. @param shape share of degrees 1 and 2.
void add_body(Harmonics& sum, const glm::vec3& direction, const glm::vec3& irradiance, float mean,
              float shape) {
  const Basis basis = harmonics_of(direction.x, direction.y, direction.z);
  for (std::size_t i = 0; i < kHarmonics; ++i)
    sum[i] += irradiance * (basis[i] * (i == 0 ? mean : shape));
}

/// 1 near the direction, 0 far from it.
float near_key(const glm::vec3& to_body, const KeyedBody& key) {
  if (key.weight == 0.0f) return 0.0f;
  // By the chord, which is exact where the cosine is not.
  const double chord = glm::length(glm::dvec3(to_body) - glm::dvec3(key.direction));
  const double angle_deg = glm::degrees(2.0 * std::asin(std::min(0.5 * chord, 1.0)));
  return static_cast<float>(1.0 - glm::smoothstep(kNearKeyDeg, kFarFromKeyDeg, angle_deg));
}

glm::vec3 sum_of(const Harmonics& harmonics, const Basis& basis) {
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < kHarmonics; ++i) sum += harmonics[i] * basis[i];
  return sum;
}

void add(Lobes& sum, std::size_t slot, const glm::vec3& irradiance) {
  for (int channel = 0; channel < 3; ++channel)
    sum[slot + static_cast<std::size_t>(channel) * shared::kSkyLobes] += irradiance[channel];
}

void keep_positive(Lobes& lobes) {
  for (float& lobe : lobes) lobe = std::max(lobe, 0.0f);
}

/// Of a function about the world's axes, those about other axes: degree 1 is a vector, degree 2 a
/// symmetric matrix without trace. @param from_world rotation.
Harmonics turned(const Harmonics& harmonics, const glm::mat3& from_world) {
  const glm::mat3 world_from = glm::transpose(from_world);
  Harmonics out;
  out[0] = harmonics[0];
  for (int c = 0; c < 3; ++c) {
    const auto of = [&](std::size_t i) { return harmonics[i][c]; };
    const glm::vec3 vector = from_world * glm::vec3(of(3), of(1), of(2));
    out[1][c] = vector.y, out[2][c] = vector.z, out[3][c] = vector.x;
    // That of the function over half the factor of xy, yz and xz in harmonics_of().
    constexpr float kRoot = std::numbers::inv_sqrt3_v<float>;
    const float xx = of(8) - kRoot * of(6), yy = -of(8) - kRoot * of(6);
    const glm::mat3 square(xx, of(4), of(7), of(4), yy, of(5), of(7), of(5), -xx - yy);
    const glm::mat3 to = from_world * square * world_from;
    out[4][c] = to[0][1], out[5][c] = to[1][2], out[7][c] = to[0][2];
    out[6][c] = to[2][2] * (0.5f / kRoot), out[8][c] = 0.5f * (to[0][0] - to[1][1]);
  }
  return out;
}

/// What the sky sends to islands by their headings.
class OpenSky {
 public:
  OpenSky(const SkyRows& rows, const Celestial& bodies);
  /// To an island of any heading, by those of the four nearest of kHeadings.
  Lobes upright(double heading) const;
  const Lobes& at_heading(int heading) const {
    return of_heading_[static_cast<std::size_t>(heading & (kHeadings - 1))];
  }
  Lobes tilted(const glm::dquat& rotation) const;
  Harmonics harmonics(const glm::dquat& rotation) const;
  /// Takes away what other islands hide from one, and puts in its place what they send.
  void hide(const IslandShade& shade, const glm::dquat& rotation, Lobes& lobes,
            Harmonics& harmonics) const;
  /// Takes sun and moon out of what an island gets as harmonics, as far as their light has been
  /// followed from key directions. @return that light.
  Keyed take_keyed(const IslandPlacement& island, const IslandShade& shade,
                   Harmonics& harmonics) const;

 private:
  void sum_headings();
  /// Sun and moon. @param mean share of degree 0. @param shape of degrees 1 and 2.
  void add_bodies(Harmonics& sum, const glm::dquat& lattice_from_world, float mean,
                  float shape) const;
  const SkyRows& rows_;
  const Celestial& bodies_;
  Harmonics harmonics_{};  // about the world's axes, without bodies
  std::array<Lobes, kHeadings> of_heading_;
};

const std::vector<LobeSample>& samples() {
  static const std::vector<LobeSample> kSamples = make_samples();
  return kSamples;
}

/// Of the directions of SkyRows, row by row.
std::vector<Basis> make_bases() {
  std::vector<Basis> out;
  for (int row = 0; row < SkyRows::kRows; ++row)
    for (int k = 0; k < SkyRows::kAzimuths; ++k) {
      const glm::vec3 d(SkyRows::direction(row, k));
      out.push_back(harmonics_of(d.x, d.y, d.z));
    }
  return out;
}

OpenSky::OpenSky(const SkyRows& rows, const Celestial& bodies) : rows_(rows), bodies_(bodies) {
  static const std::vector<Basis> kBases = make_bases();
  constexpr float kSolidAngle =
      4.0f * std::numbers::pi_v<float> / float{SkyRows::kRows * SkyRows::kAzimuths};
  const Basis* basis = kBases.data();
  for (int row = 0; row < SkyRows::kRows; ++row)
    for (int k = 0; k < SkyRows::kAzimuths; ++k)
      add(harmonics_, *basis++, rows.at(row, k) * kSolidAngle);
  sum_headings();
}

// A direction counts for all headings at once, side by side, for vectors of them.
void OpenSky::sum_headings() {
  std::array<std::array<float, kHeadings>, std::tuple_size_v<Lobes>> sums{};
  const LobeSample* sample = samples().data();
  for (int row = 0; row < SkyRows::kRows; ++row) {
    // By how far an azimuth is before that of heading 0, twice around.
    std::array<std::array<float, 2 * kHeadings>, 3> sky;
    for (int back = 0; back < 2 * kHeadings; ++back) {
      const glm::vec3& radiance = rows_.at(row, -back & (kHeadings - 1));
      for (int channel = 0; channel < 3; ++channel)
        sky[static_cast<std::size_t>(channel)][static_cast<std::size_t>(back)] = radiance[channel];
    }
    for (int k = 0; k < kAround; ++k, ++sample)
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const float* seen = sky[channel].data() + (-(2 * k + 1) & (kHeadings - 1));
          float* sum = sums[sample->slot[axis] + channel * shared::kSkyLobes].data();
          const float weight = sample->weight[static_cast<int>(axis)];
          for (int heading = 0; heading < kHeadings; ++heading)
            sum[heading] += seen[heading] * weight;
        }
  }
  for (std::size_t heading = 0; heading < kHeadings; ++heading)
    for (std::size_t i = 0; i < sums.size(); ++i) of_heading_[heading][i] = sums[i][heading];
}

Lobes OpenSky::upright(double heading) const {
  const double below = std::floor(heading);
  const auto first = static_cast<int>(below);
  const auto t = static_cast<float>(heading - below);
  // A cubic through them (E. Catmull, R. Rom, 1974).
  const std::array<float, 4> shares{t * (-0.5f + t * (1.0f - 0.5f * t)),
                                    1.0f + t * t * (-2.5f + 1.5f * t),
                                    t * (0.5f + t * (2.0f - 1.5f * t)), t * t * (-0.5f + 0.5f * t)};
  Lobes out{};
  for (int i = 0; i < 4; ++i) {
    const Lobes& one = at_heading(first - 1 + i);
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] += one[k] * shares[static_cast<std::size_t>(i)];
  }
  keep_positive(out);
  return out;
}

Lobes OpenSky::tilted(const glm::dquat& rotation) const {
  const glm::mat3 world_from_lattice(glm::mat3_cast(rotation));
  Lobes out{};
  for (const LobeSample& sample : samples()) {
    const glm::vec3 radiance = rows_.towards(world_from_lattice * sample.direction);
    for (std::size_t axis = 0; axis < 3; ++axis)
      add(out, sample.slot[axis], radiance * sample.weight[static_cast<int>(axis)]);
  }
  return out;
}

void OpenSky::add_bodies(Harmonics& sum, const glm::dquat& lattice_from_world, float mean,
                         float shape) const {
  add_body(sum, glm::vec3(lattice_from_world * bodies_.to_sun), bodies_.sun_irradiance, mean,
           shape);
  add_body(sum, glm::vec3(lattice_from_world * bodies_.to_moon), bodies_.moon_irradiance, mean,
           shape);
}

Harmonics OpenSky::harmonics(const glm::dquat& rotation) const {
  const glm::dquat lattice_from_world = glm::conjugate(rotation);
  Harmonics out = turned(harmonics_, glm::mat3(glm::mat3_cast(lattice_from_world)));
  add_bodies(out, lattice_from_world, 1.0f, kShapeOfBodies);
  return out;
}

/// What islands send to one: as diffuse surfaces that face it, lit by sky, sun and moon as if
/// nothing else was there. @param light that arrives. @return about the same axes, by the direction
/// that it comes from: radiance.
Harmonics sent_by_islands(Harmonics light) {
  constexpr float kAlbedo = 0.25f;  // of earth, stone and leaves
  // Of the cosine's harmonics, over pi: R. Ramamoorthi and P. Hanrahan, 2001. Those of degree 1
  // are of the other sign in the opposite direction.
  for (std::size_t i = 0; i < kHarmonics; ++i)
    light[i] *= kAlbedo * (i == 0 ? 1.0f : i < 4 ? -2.0f / 3.0f : 0.25f);
  return light;
}

/// A direction in which islands may hide the sky.
struct Look {
  int row, k;  ///< of make_samples()
  const LobeSample* sample;
};

/// Every other direction stands for two: what is hidden has soft edges.
std::vector<Look> make_looks() {
  static_assert(SkyRows::kRows * kAround / 2 == IslandShade::kDirections);
  std::vector<Look> out;
  for (int row = 0; row < SkyRows::kRows; ++row)
    for (int k = row & 1; k < kAround; k += 2)
      out.push_back({row, k, &samples()[static_cast<std::size_t>(row * kAround + k)]});
  return out;
}

void OpenSky::hide(const IslandShade& shade, const glm::dquat& rotation, Lobes& lobes,
                   Harmonics& harmonics) const {
  if (shade.empty()) return;
  static const std::vector<Look> kLooks = make_looks();
  const float solid_angle = 4.0f * std::numbers::pi_v<float> / static_cast<float>(kLooks.size());
  const glm::mat3 world_from_lattice(glm::mat3_cast(rotation));
  const glm::dquat lattice_from_world = glm::conjugate(rotation);
  IslandShade::Directions directions;
  for (std::size_t i = 0; i < kLooks.size(); ++i)
    directions.set(i, world_from_lattice * kLooks[i].sample->direction);
  const IslandShade::Near near = shade.near(directions);
  Harmonics arriving = harmonics;
  add_bodies(arriving, lattice_from_world, 0.0f, 1.0f - kShapeOfBodies);
  const Harmonics sent = sent_by_islands(arriving);
  const bool upright = is_upright(rotation);
  const double heading = upright ? heading_of(rotation) : 0.0, below = std::floor(heading);
  const auto part = static_cast<float>(heading - below);
  const auto sky_at = [&](int row, int k) {
    const int azimuth = 2 * k + 1 - static_cast<int>(below);
    constexpr int kAll = SkyRows::kAzimuths - 1;
    return glm::mix(rows_.at(row, azimuth & kAll), rows_.at(row, (azimuth - 1) & kAll), part);
  };
  for (std::size_t i = 0; i < kLooks.size(); ++i) {
    if (near[i] == 0) continue;
    const auto& [row, k, sample] = kLooks[i];
    const glm::vec3 direction = directions.at(i);
    const std::optional<IslandShade::Open> open = shade.towards(direction, near[i]);
    if (!open) continue;
    const glm::vec3 sky = upright ? sky_at(row, k) : rows_.towards(direction);
    const glm::vec3 change = glm::max(sum_of(sent, sample->basis), 0.0f) - sky;
    for (std::size_t axis = 0; axis < 3; ++axis)
      add(lobes, sample->slot[axis],
          change * ((1.0f - open->face[sample->slot[axis] / (3 * shared::kSkyLobes)]) * 2.0f *
                    sample->weight[static_cast<int>(axis)]));
    add(harmonics, sample->basis, change * ((1.0f - open->all) * solid_angle));
  }
  keep_positive(lobes);
  const auto hide_body = [&](const glm::dvec3& to_body, const glm::vec3& irradiance) {
    if (const std::optional<IslandShade::Open> open = shade.towards(glm::vec3(to_body)))
      add_body(harmonics, glm::vec3(lattice_from_world * to_body), irradiance * (open->all - 1.0f),
               1.0f, kShapeOfBodies);
  };
  hide_body(bodies_.to_sun, bodies_.sun_irradiance);
  hide_body(bodies_.to_moon, bodies_.moon_irradiance);
}

Keyed OpenSky::take_keyed(const IslandPlacement& island, const IslandShade& shade,
                          Harmonics& harmonics) const {
  Keyed out{};
  if (island.keyed[0].weight == 0.0f && island.keyed[1].weight == 0.0f) return out;
  const auto take = [&](const glm::dvec3& to_body, glm::vec3 irradiance) {
    if (irradiance == glm::vec3(0.0f)) return;
    if (const std::optional<IslandShade::Open> open = shade.towards(glm::vec3(to_body)))
      irradiance *= open->all;
    const glm::vec3 direction(glm::conjugate(island.rotation) * to_body);
    for (std::size_t slot = 0; slot < out.size(); ++slot) {
      const glm::vec3 part =
          irradiance * (island.keyed[slot].weight * near_key(direction, island.keyed[slot]));
      add_body(harmonics, direction, -part, 1.0f, kShapeOfBodies);
      out[slot] += part;
    }
  };
  take(bodies_.to_sun, bodies_.sun_irradiance);
  take(bodies_.to_moon, bodies_.moon_irradiance);
  return out;
}

/// Takes away what steps and overhangs hide that voxels of a coarse level have not got: shares of
/// light that arrives at levels 1, 2 and from 3 on, measured: decision 0065.
void coarsen(int level, Lobes& lobes, Harmonics& harmonics) {
  constexpr std::array<float, 4> kSide{1.0f, 0.93f, 0.92f, 0.88f},
      kLevel{1.0f, 0.98f, 0.95f, 0.95f};
  if (level == 0) return;
  const auto at = static_cast<std::size_t>(std::min(level, 3));
  for (std::size_t i = 0; i < lobes.size(); ++i)
    lobes[i] *= i / (3 * shared::kSkyLobes) / 2 == 1 ? kLevel[at] : kSide[at];
  for (glm::vec3& harmonic : harmonics) harmonic *= kSide[at];
}

/// @param out of kIndirectIslandTexels.
void write(std::span<glm::uvec4> out, const Lobes& lobes, const Harmonics& harmonics,
           const Keyed& keyed = {}) {
  static_assert(shared::kIndirectKeys + std::tuple_size_v<Keyed> == shared::kIndirectIslandTexels);
  constexpr std::size_t kOfHalves = shared::kIndirectKeys - 1, kShape = kHarmonics - 1;
  std::array<float, std::tuple_size_v<Lobes> + 3 * kShape> numbers;
  std::copy(lobes.begin(), lobes.end(), numbers.begin());
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (std::size_t i = 0; i < kShape; ++i)
      numbers[lobes.size() + channel * kShape + i] = harmonics[i + 1][static_cast<int>(channel)];
  std::array<std::uint16_t, numbers.size()> halves;
  halves_of(numbers, halves);
  static_assert(sizeof(halves) == kOfHalves * sizeof(glm::uvec4));
  std::memcpy(out.data(), halves.data(), sizeof(halves));
  out[kOfHalves] = glm::uvec4(std::bit_cast<glm::uvec3>(harmonics[0]), 0);
  for (std::size_t slot = 0; slot < keyed.size(); ++slot)
    out[shared::kIndirectKeys + slot] = glm::uvec4(std::bit_cast<glm::uvec3>(keyed[slot]), 0);
}

/// A sky of one island, or of all far ones of a heading.
struct SkyToWorkOut {
  std::size_t island;
  std::optional<int> heading{};  ///< of far ones; none: it is of one that is near
};
constexpr std::size_t kSkiesAPiece = 16;  // that a thread works out at a time

/// Chooses the sky of each island. @param dark first texel of the sky of 0, which others follow.
/// @param of_islands out: first texels. @return the others, in order.
std::vector<SkyToWorkOut> share_out(std::span<const IslandPlacement> islands,
                                    const std::vector<bool>& shown, std::size_t dark,
                                    std::span<glm::uvec4> of_islands) {
  std::vector<SkyToWorkOut> skies;
  std::array<std::size_t, kHeadings> of_far{};  // 0: none yet
  for (std::size_t i = 0; i < islands.size(); ++i) {
    std::uint32_t& place = of_islands[i / 4][static_cast<int>(i % 4)];
    place = static_cast<std::uint32_t>(dark);
    if (!shown[i]) continue;
    const std::size_t end = dark + (1 + skies.size()) * shared::kIndirectIslandTexels;
    if (!islands[i].far || !is_upright(islands[i].rotation)) {
      place = static_cast<std::uint32_t>(end);
      skies.push_back({i});
      continue;
    }
    // Of floats, which are faster: there are thousands of islands.
    const auto heading = static_cast<int>(std::lround(heading_of(glm::quat(islands[i].rotation))));
    std::size_t& far = of_far[static_cast<std::size_t>(heading & (kHeadings - 1))];
    if (far == 0) skies.push_back({i, heading});
    if (far == 0) far = end;
    place = static_cast<std::uint32_t>(far);
  }
  return skies;
}

}  // namespace

std::vector<glm::uvec4> sky_irradiance(const SkyModel& sky, const Celestial& bodies,
                                       std::span<const IslandPlacement> islands,
                                       const std::vector<bool>& shown, const FixedPos& eye) {
  // Discs are not in it: smooth enough to be interpolated.
  const SkyRows rows([&](const SkyRows::Row& directions) {
    SkyRows::Row out;
    if (!sky.panorama) {
      sky_radiance(directions, sky, out);
      return out;
    }
    std::ranges::transform(directions, out.begin(), [&](const glm::dvec3& d) {
      return glm::dvec3(sky.panorama->smooth().at(glm::vec3(d)));
    });
    return out;
  });
  const OpenSky open(rows, bodies);
  static_assert(kFaces * shared::kIndirectSkyTexels == shared::kIndirectHarmonics);
  std::vector<glm::uvec4> out((islands.size() + 3) / 4, glm::uvec4(0));
  const std::size_t dark = out.size(), first = dark + shared::kIndirectIslandTexels;
  const std::vector<SkyToWorkOut> skies = share_out(islands, shown, dark, out);
  out.resize(first + skies.size() * shared::kIndirectIslandTexels, glm::uvec4(0));
  const std::vector<HidingIsland> hiding = islands_that_hide(islands);
  const auto work_out = [&](const SkyToWorkOut& sky_of, std::span<glm::uvec4> to) {
    const IslandPlacement& island = islands[sky_of.island];
    if (sky_of.heading) {
      Lobes lobes = open.at_heading(*sky_of.heading);
      Harmonics harmonics =
          open.harmonics(glm::angleAxis(*sky_of.heading * kHeadingStep, glm::dvec3(0.0, 1.0, 0.0)));
      coarsen(island.level, lobes, harmonics);
      write(to, lobes, harmonics);
      return;
    }
    const glm::dquat& rotation = island.rotation;
    Lobes lobes = is_upright(rotation) ? open.upright(heading_of(rotation)) : open.tilted(rotation);
    Harmonics harmonics = open.harmonics(rotation);
    coarsen(island.level, lobes, harmonics);
    const IslandShade shade(islands, hiding, sky_of.island, share_of_shade(island, eye));
    open.hide(shade, rotation, lobes, harmonics);
    const Keyed keyed = open.take_keyed(island, shade, harmonics);
    write(to, lobes, harmonics, keyed);
  };
  share_calls(skies.size(), kSkiesAPiece, [&](std::size_t k) {
    work_out(skies[k], std::span(out).subspan(first + k * shared::kIndirectIslandTexels,
                                              shared::kIndirectIslandTexels));
  });
  return out;
}

}  // namespace skerry::render
