#include "tools/skerry/stability/place_to_play.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "game/player/collide.h"

namespace skerry::tools::stability {
namespace {

/// Length that two intervals share.
double shared_length(double a_low, double a_high, double b_low, double b_high) {
  return std::max(0.0, std::min(a_high, b_high) - std::max(a_low, b_low));
}

}  // namespace

void PlaceToPlay::islands_near(world::WorldPos place, double radius_blocks, double time_s,
                               std::vector<std::uint64_t>& out) const {
  out.clear();
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    const glm::dvec3 to = world::difference_blocks(place, pose_of(i, time_s).origin);
    if (glm::length(to) <= islands_[i].radius + radius_blocks) out.push_back(i);
  }
}

std::optional<world::Pose> PlaceToPlay::pose(std::uint64_t island, double time_s) const {
  return pose_of(island, time_s);
}

const world::Pose& PlaceToPlay::pose_of(std::uint64_t island, double time_s) const {
  for (const Known& known : known_)
    if (known.island == island && known.time_s == time_s) return known.pose;
  std::swap(known_[0], known_[1]);
  known_[1] = {island, time_s, islands_.at(island).pose(time_s)};
  return known_[1].pose;
}

std::optional<world::BlockId> PlaceToPlay::block(std::uint64_t island, world::IVec3 voxel) const {
  return islands_.at(island).block(voxel);
}

glm::dvec3 PlaceToPlay::lattice(world::WorldPos place, double time_s) const {
  const world::Pose& pose = pose_of(0, time_s);
  return glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin);
}

std::function<world::Pose(double)> moving(double spin, double drift) {
  return [=](double time_s) {
    const double phase = drift * time_s;
    const world::WorldPos origin = world::moved(
        {}, {10.0 * std::cos(phase), 3.0 * std::sin(2.0 * phase), 10.0 * std::sin(phase)});
    return world::Pose{origin, glm::angleAxis(spin * time_s, glm::dvec3(0.0, 1.0, 0.0))};
  };
}

double volume_in_solids(const PlaceToPlay& around, const glm::dvec3& feet) {
  const glm::dvec3 low = feet - glm::dvec3(game::kPlayerHalfWidth, 0.0, game::kPlayerHalfWidth);
  const glm::dvec3 high =
      feet + glm::dvec3(game::kPlayerHalfWidth, game::kPlayerHeight, game::kPlayerHalfWidth);
  const auto first = [](double edge) { return static_cast<std::int32_t>(std::floor(edge)) - 1; };
  double volume = 0.0;
  for (std::int32_t x = first(low.x); x <= high.x; ++x)
    for (std::int32_t y = first(low.y); y <= high.y; ++y)
      for (std::int32_t z = first(low.z); z <= high.z; ++z)
        if (world::is_solid(around.block(0, {x, y, z}).value()))
          volume += shared_length(low.x, high.x, x, x + 1) *
                    shared_length(low.y, high.y, y, y + 1) * shared_length(low.z, high.z, z, z + 1);
  return volume;
}

}  // namespace skerry::tools::stability
