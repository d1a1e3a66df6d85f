#include "game/view/scatter_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>

#include "world/islands/march.h"
#include "world/voxel/hash.h"

namespace skerry::game {
namespace {

using world::BlockKind;

constexpr double kLightsPerPixel = 20.0;
constexpr double kMinRange = 0.25, kMaxRange = 24.0;  // blocks
constexpr double kOffSurface = 0.75;                  // blocks
constexpr float kIrradianceInReach = 0.02f;           // intensity over the square of the range
constexpr std::uint32_t kRaysPerLight = 16;

struct Island {
  std::uint64_t id;
  glm::dmat3 lattice_from_world;
  glm::dvec3 camera;  // in the lattice
  double radius;
  std::shared_ptr<const world::Volume> voxels;
};

struct Met {
  double t;
  std::size_t island;
  glm::dvec3 point, normal;  // in the lattice
};

/// The first block that has a surface to stand on.
struct Finder {
  double t = std::numeric_limits<double>::infinity();
  glm::dvec3 normal{};
  bool crossed(const world::Crossing& c) {
    const BlockKind kind = world::block_kind(c.to);
    if (kind == BlockKind::kAir || kind == BlockKind::kPlant) return false;
    t = c.t;
    normal[c.axis] = c.positive ? -1.0 : 1.0;
    return true;
  }
  bool inside(const world::IVec3&, world::BlockId, double, double) { return false; }
};

std::vector<Island> islands_in_view(world::World& world, const ScatterView& view) {
  std::vector<Island> out;
  for (const world::IslandSpec& spec :
       world.islands_near(view.camera, view.view_distance_blocks, view.time_s)) {
    const world::Pose pose = *world.pose(spec.id, view.time_s);
    const glm::dmat3 lattice_from_world = glm::transpose(glm::mat3_cast(pose.rotation));
    out.push_back({spec.id, lattice_from_world,
                   lattice_from_world * world::difference_blocks(view.camera, pose.origin),
                   spec.bounding_radius, world::Volume::of_island(world, spec)});
  }
  return out;
}

bool may_meet(const Island& island, glm::dvec3 direction, double t_max) {
  const double along = -glm::dot(island.camera, direction);
  const double away2 = glm::dot(island.camera, island.camera);
  const double radius2 = island.radius * island.radius;
  if (away2 <= radius2) return true;
  return along > 0.0 && away2 - along * along <= radius2 && along - island.radius < t_max;
}

std::optional<Met> first_met(const std::vector<Island>& islands, glm::dvec3 direction,
                             double t_max) {
  std::optional<Met> nearest;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const Island& island = islands[i];
    const glm::dvec3 local = island.lattice_from_world * direction;
    if (!may_meet(island, local, t_max)) continue;
    Finder finder;
    world::march(*island.voxels, island.camera, local, 0.0, t_max, finder);
    if (!(finder.t < t_max)) continue;
    t_max = finder.t;
    nearest = Met{finder.t, i, island.camera + local * finder.t, finder.normal};
  }
  return nearest;
}

/// Direction through point `i` of the R2 sequence over the picture (M. Roberts, The Unreasonable
/// Effectiveness of Quasirandom Sequences, 2018), in 2^-64 so that it is exact.
glm::dvec3 direction_of(const render::CameraView& lens, std::uint64_t i) {
  constexpr std::uint64_t kStepX = 0xc13fa9a902a6328fu, kStepY = 0x91e10da5c79e7b1cu;
  const double x = static_cast<double>((i * kStepX + (1ull << 63)) >> 11) * 0x1p-53;
  const double y = static_cast<double>((i * kStepY + (1ull << 63)) >> 11) * 0x1p-53;
  return glm::normalize(glm::dvec3(lens.forward) +
                        glm::dvec3(lens.right) * (lens.tan_half_x * (2.0 * x - 1.0)) +
                        glm::dvec3(lens.up) * (lens.tan_half_y * (1.0 - 2.0 * y)));
}

/// Hues of flames, of even luminance.
glm::vec3 flame_colour(std::uint64_t i) {
  const float t = static_cast<float>(world::mix64(i + 1) >> 40) * 0x1p-24f;
  const glm::vec3 colour = glm::mix(glm::vec3(1.0f, 0.32f, 0.07f), glm::vec3(1.0f, 0.62f, 0.3f), t);
  return colour / (0.2126f * colour.x + 0.7152f * colour.y + 0.0722f * colour.z);
}

/// How far a torch at a distance may shine for so many a pixel: discs of this radius cover the
/// picture so often.
double range_at(const render::CameraView& lens, double distance, std::uint32_t count) {
  const double picture = 4.0 * lens.tan_half_x * lens.tan_half_y;
  const double share = std::sqrt(kLightsPerPixel * picture / (std::numbers::pi * count));
  return std::clamp(distance * share, kMinRange, kMaxRange);
}

}  // namespace

std::map<world::SectionKey, std::vector<LatticeLight>> scatter_lights(world::World& world,
                                                                      const ScatterView& view,
                                                                      std::uint32_t count) {
  std::map<world::SectionKey, std::vector<LatticeLight>> out;
  if (count == 0) return out;
  const std::vector<Island> islands = islands_in_view(world, view);
  std::uint32_t found = 0;
  for (std::uint64_t ray = 0; ray < std::uint64_t{kRaysPerLight} * count && found < count; ++ray) {
    const std::optional<Met> met =
        first_met(islands, direction_of(view.lens, ray), view.view_distance_blocks);
    if (!met) continue;
    ++found;
    const auto range = static_cast<float>(range_at(view.lens, met->t, count));
    const glm::dvec3 place = met->point + met->normal * std::min(kOffSurface, 0.5 * range);
    const world::IVec3 chunk = world::chunk_of(
        {world::floor_to_int(place.x), world::floor_to_int(place.y), world::floor_to_int(place.z)});
    const glm::dvec3 corner =
        glm::dvec3(chunk.x, chunk.y, chunk.z) * static_cast<double>(world::kChunkEdge);
    out[{islands[met->island].id, chunk, 0}].push_back(
        {place - corner, flame_colour(ray) * (kIrradianceInReach * range * range), range});
  }
  return out;
}

}  // namespace skerry::game
