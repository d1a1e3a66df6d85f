#include "engine/render/sky/sky_irradiance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/packing.hpp>
#include <map>
#include <numbers>
#include <optional>

#include "engine/core/harmonics.h"
#include "engine/render/sky/island_shade.h"
#include "engine/render/sky/sky_cube.h"
#include "shaders/shared/indirect.h"

namespace skerry::render {
namespace {

constexpr int kStrata = 8;  // samples of an octant, each way
constexpr float kMostHalf = 65504.0f;
constexpr std::size_t kFaces = 6;

/// A direction of the lattice, and for each axis the face it lights, the lobe and its share.
struct LobeSample {
  glm::vec3 direction{};
  std::array<std::uint8_t, 3> face{}, lobe{};
  glm::vec3 weight{};  ///< cosine times solid angle, so that a whole sky of 1 sums to pi a face
};

/// Whether the pattern nearest to a direction of the first octant is steep for an axis.
std::array<bool, 3> steep_of(const glm::dvec3& d) {
  glm::dvec3 best(0.0);
  for (const glm::ivec3& pattern : shared::kSkyPatterns) {
    const glm::dvec3 p = glm::normalize(glm::dvec3(pattern));
    if (glm::dot(p, d) > glm::dot(best, d)) best = p;
  }
  const auto steep = static_cast<double>(shared::kSteepCosine);
  return {best.x >= steep, best.y >= steep, best.z >= steep};
}

std::vector<LobeSample> make_samples() {
  std::vector<LobeSample> out;
  glm::dvec3 sum(0.0);
  for (int octant = 0; octant < 8; ++octant)
    for (int i = 0; i < kStrata; ++i)
      for (int j = 0; j < kStrata; ++j) {
        const double y = (i + 0.5) / kStrata, turn = (j + 0.5) / kStrata * std::numbers::pi / 2.0,
                     flat = std::sqrt(1.0 - y * y);
        const glm::dvec3 d{flat * std::cos(turn), y, flat * std::sin(turn)};
        const std::array<bool, 3> steep = steep_of(d);
        LobeSample sample;
        for (int axis = 0; axis < 3; ++axis) {
          const auto a = static_cast<std::size_t>(axis);
          const auto negative = [&](int which) { return octant >> (which % 3) & 1; };
          sample.face[a] = static_cast<std::uint8_t>(2 * axis + negative(axis));
          sample.lobe[a] = static_cast<std::uint8_t>(
              2 * (negative(axis + 1) + 2 * negative(axis + 2)) + (steep[a] ? 0 : 1));
          sample.direction[axis] = static_cast<float>(negative(axis) ? -d[axis] : d[axis]);
        }
        sample.weight = glm::vec3(d);
        sum += d;
        out.push_back(sample);
      }
  // Two faces share each axis.
  const glm::vec3 scale(2.0 * std::numbers::pi / sum);
  for (LobeSample& sample : out) sample.weight *= scale;
  return out;
}

/// Headings that far islands are rounded to.
constexpr double kHeadingStep = 2.0 * std::numbers::pi / 64.0;

bool is_upright(const glm::dquat& rotation) {
  return std::abs(rotation.x) + std::abs(rotation.z) < 1e-6;
}

int heading_of(const glm::dquat& rotation) {
  return static_cast<int>(std::lround(2.0 * std::atan2(rotation.y, rotation.w) / kHeadingStep));
}

using Lobes = std::array<glm::vec3, shared::kSkyLobes>;
using Harmonics = std::array<glm::vec3, kHarmonics>;

void add(Harmonics& sum, const glm::vec3& direction, const glm::vec3& light) {
  const std::array<float, kHarmonics> basis = harmonics_of(direction.x, direction.y, direction.z);
  for (std::size_t i = 0; i < kHarmonics; ++i) sum[i] += light * basis[i];
}

std::uint32_t packed(float a, float b) {
  return glm::packHalf2x16(
      {std::clamp(a, -kMostHalf, kMostHalf), std::clamp(b, -kMostHalf, kMostHalf)});
}

glm::uvec4 packed(const Lobes& lobes, int channel) {
  glm::uvec4 out;
  for (std::size_t i = 0; i < 4; ++i)
    out[static_cast<int>(i)] = packed(lobes[2 * i][channel], lobes[2 * i + 1][channel]);
  return out;
}

/// Degrees 1 and 2.
glm::uvec4 packed(const Harmonics& harmonics, int channel) {
  glm::uvec4 out;
  for (std::size_t i = 0; i < 4; ++i)
    out[static_cast<int>(i)] = packed(harmonics[2 * i + 1][channel], harmonics[2 * i + 2][channel]);
  return out;
}

const std::vector<LobeSample>& samples() {
  static const std::vector<LobeSample> kSamples = make_samples();
  return kSamples;
}

/// What islands send to each other from where they hide the sky: as diffuse surfaces that face the
/// one that looks, lit by sky, sun and moon as if nothing else was there.
class IslandsRadiance {
 public:
  IslandsRadiance(const SkyCube& cube, const Celestial& bodies) {
    for (const LobeSample& sample : samples())
      add(light_, sample.direction,
          cube.at(sample.direction) *
              (4.0f * std::numbers::pi_v<float> / static_cast<float>(samples().size())));
    add(light_, glm::vec3(bodies.to_sun), bodies.sun_irradiance);
    add(light_, glm::vec3(bodies.to_moon), bodies.moon_irradiance);
  }
  /// @param direction from the one that looks, in the world.
  glm::vec3 towards(const glm::vec3& direction) const {
    constexpr float kAlbedo = 0.25f;  // of earth, stone and leaves
    // Of the cosine's harmonics, over pi: R. Ramamoorthi and P. Hanrahan, 2001.
    constexpr std::array<float, 3> kOfDegree{1.0f, 2.0f / 3.0f, 0.25f};
    const std::array<float, kHarmonics> basis =
        harmonics_of(-direction.x, -direction.y, -direction.z);
    glm::vec3 sum(0.0f);
    for (std::size_t i = 0; i < kHarmonics; ++i)
      sum += light_[i] * (basis[i] * kOfDegree[i == 0 ? 0 : i < 4 ? 1 : 2]);
    return glm::max(sum, 0.0f) * kAlbedo;
  }

 private:
  Harmonics light_{};
};

void put_island(const SkyCube& cube, const Celestial& bodies, const glm::dquat& rotation,
                const IslandShade& shade, const IslandsRadiance& islands,
                std::span<glm::uvec4> out) {
  const float solid_angle = 4.0f * std::numbers::pi_v<float> / static_cast<float>(samples().size());
  const glm::mat3 world_from_lattice(glm::mat3_cast(rotation));
  const glm::dquat lattice_from_world = glm::conjugate(rotation);
  std::array<Lobes, kFaces> faces{};
  Harmonics harmonics{};
  for (const LobeSample& sample : samples()) {
    const glm::vec3 direction = world_from_lattice * sample.direction, sky = cube.at(direction);
    const IslandShade::Open open = shade.empty() ? IslandShade::Open{} : shade.towards(direction);
    const glm::vec3 before = open.all < 1.0f ? islands.towards(direction) : sky;
    for (std::size_t axis = 0; axis < 3; ++axis)
      faces[sample.face[axis]][sample.lobe[axis]] +=
          glm::mix(before, sky, open.face[sample.face[axis]]) *
          sample.weight[static_cast<int>(axis)];
    add(harmonics, sample.direction, glm::mix(before, sky, open.all) * solid_angle);
  }
  const auto add_body = [&](const glm::dvec3& to_body, const glm::vec3& irradiance) {
    const float open = shade.empty() ? 1.0f : shade.towards(glm::vec3(to_body)).all;
    add(harmonics, glm::vec3(lattice_from_world * to_body), open * irradiance);
  };
  add_body(bodies.to_sun, bodies.sun_irradiance);
  add_body(bodies.to_moon, bodies.moon_irradiance);
  std::size_t at = 0;
  for (const Lobes& lobes : faces)
    for (int channel = 0; channel < 3; ++channel) out[at++] = packed(lobes, channel);
  for (int channel = 0; channel < 3; ++channel) out[at++] = packed(harmonics, channel);
  for (int channel = 0; channel < 3; ++channel)
    out[at][channel] = std::bit_cast<std::uint32_t>(harmonics[0][channel]);
}

}  // namespace

std::vector<glm::uvec4> sky_irradiance(const SkyModel& sky, const Celestial& bodies,
                                       std::span<const IslandPlacement> islands,
                                       const std::vector<bool>& shown) {
  std::optional<SkyCube> made;  // discs are not in it: smooth enough to be interpolated
  if (!sky.panorama) made.emplace([&](glm::dvec3 d) { return sky_radiance(d, sky); });
  const SkyCube& cube = made ? *made : sky.panorama->smooth();
  constexpr std::size_t kTexels = shared::kIndirectIslandTexels;
  static_assert(kFaces * shared::kIndirectSkyTexels == shared::kIndirectHarmonics);
  const IslandsRadiance sent(cube, bodies);
  std::vector<glm::uvec4> out(islands.size() * kTexels, glm::uvec4(0));
  std::map<int, std::size_t> of_heading;  // the first far island of each
  for (std::size_t i = 0; i < islands.size(); ++i) {
    if (!shown[i]) continue;
    const std::span to = std::span(out).subspan(i * kTexels, kTexels);
    glm::dquat rotation = islands[i].rotation;
    if (islands[i].far && is_upright(rotation)) {
      const int heading = heading_of(rotation);
      const auto [same, is_first] = of_heading.emplace(heading, i);
      if (!is_first) {
        std::copy_n(out.begin() + static_cast<std::ptrdiff_t>(same->second * kTexels), kTexels,
                    to.begin());
        continue;
      }
      rotation = glm::angleAxis(heading * kHeadingStep, glm::dvec3(0.0, 1.0, 0.0));
    }
    put_island(cube, bodies, rotation, IslandShade(islands, i), sent, to);
  }
  return out;
}

}  // namespace skerry::render
