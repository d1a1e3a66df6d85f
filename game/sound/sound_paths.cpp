#include "game/sound/sound_paths.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace skerry::game {
namespace {

constexpr std::uint16_t kUnreached = 0xffff;
constexpr double kMostPathLossDb = 200.0;

struct Neighbour {
  world::IVec3 by;
  int cost = 0;
  int next = 0;             // of SoundRoom::index
  std::uint32_t needs = 0;  // bits of the neighbours that must be open, itself included
};

constexpr int bit_of(int x, int y, int z) {
  return (y + 1) * 9 + (x + 1) * 3 + z + 1;
}
constexpr std::uint32_t kAround = ((1u << 27) - 1) & ~(1u << bit_of(0, 0, 0));

/// The 26 neighbours. One across an edge or a corner needs all voxels of the box between.
constexpr std::array<Neighbour, 26> make_neighbours() {
  std::array<Neighbour, 26> all{};
  std::size_t n = 0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      for (int z = -1; z <= 1; ++z) {
        const int far = (x != 0) + (y != 0) + (z != 0);
        if (far == 0) continue;
        Neighbour& one = all[n++];
        one.by = {x, y, z};
        one.next = (y * SoundRoom::kEdge + x) * SoundRoom::kEdge + z;
        one.cost = far == 1   ? SoundPaths::kFaceCost
                   : far == 2 ? SoundPaths::kEdgeCost
                              : SoundPaths::kCornerCost;
        for (const int b : {0, y})
          for (const int a : {0, x})
            for (const int c : {0, z}) one.needs |= 1u << bit_of(a, b, c);
        one.needs &= ~(1u << bit_of(0, 0, 0));
      }
  return all;
}
constexpr std::array<Neighbour, 26> kNeighbours = make_neighbours();
constexpr std::uint32_t kAllNeighbours = (1u << kNeighbours.size()) - 1;

/// Of a step: all neighbours around the voxel that it comes from are open.
constexpr std::uint8_t kFromOpen = 0x80;

/// By step: the neighbours that are none of the voxel where the step began. If all around that one
/// is open, it has reached the others itself, by a way that is no longer.
constexpr std::array<std::uint32_t, 26> make_onward() {
  std::array<std::uint32_t, 26> onward{};
  for (std::size_t step = 0; step < onward.size(); ++step)
    for (std::size_t n = 0; n < kNeighbours.size(); ++n) {
      const world::IVec3 a = kNeighbours[step].by, b = kNeighbours[n].by;
      const auto beyond = [](int two) { return two < -1 || two > 1; };
      if (beyond(a.x + b.x) || beyond(a.y + b.y) || beyond(a.z + b.z)) onward[step] |= 1u << n;
    }
  return onward;
}
constexpr std::array<std::uint32_t, 26> kOnward = make_onward();

world::IVec3 cell_at(std::size_t index) {
  constexpr std::size_t kEdge = SoundRoom::kEdge;
  return {static_cast<int>(index / kEdge % kEdge), static_cast<int>(index / kEdge / kEdge),
          static_cast<int>(index % kEdge)};
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  const double cosine = glm::dot(a, b) / std::max(1e-12, glm::length(a) * glm::length(b));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

glm::dvec3 direction_to(const glm::dvec3& from, const glm::dvec3& to) {
  const double length = glm::length(to - from);
  return length > 0.0 ? (to - from) / length : glm::dvec3(0.0);
}

/// Which of the 26 neighbours sound can be in: a bit each. Those outside the room are closed.
std::uint32_t open_around(const SoundRoom& room, world::IVec3 cell) {
  std::uint32_t closed = 0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const std::uint64_t row = room.solid_row(cell.x + x, cell.y + y);
      const std::uint64_t three = cell.z == 0 ? row << 1 | 1 : row >> (cell.z - 1);
      closed |= static_cast<std::uint32_t>(three & 7) << bit_of(x, y, -1);
      if (cell.z == SoundRoom::kEdge - 1) closed |= 1u << bit_of(x, y, 1);
    }
  return ~closed;
}

}  // namespace

double SoundPath::gain() const {
  return std::pow(10.0, -loss_db / 20.0) / std::max(1.0, length);
}

void SoundPaths::reach(std::size_t from, int cost) {
  const std::uint32_t open = open_around(room_, cell_at(from));
  const bool all_open = (open & kAround) == kAround;
  const std::uint8_t came_by = step_[from];
  std::uint32_t left = (came_by & kFromOpen) != 0 ? kOnward[came_by & ~kFromOpen] : kAllNeighbours;
  for (; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    const Neighbour& next = kNeighbours[n];
    if (!all_open && (open & next.needs) != next.needs) continue;
    const std::size_t to = from + static_cast<std::size_t>(next.next);
    const int there = cost + next.cost;
    if (there >= cost_[to] || there > kMostLength * kFaceCost) continue;
    cost_[to] = static_cast<std::uint16_t>(there);
    step_[to] = static_cast<std::uint8_t>(n | (all_open ? kFromOpen : 0));
    due_[static_cast<std::size_t>(there)].push_back(static_cast<std::uint32_t>(to));
  }
}

bool SoundPaths::flood_serves() const {
  if (room_.revision() != flooded_revision_) return false;
  const world::IVec3 now = SoundRoom::cell_of(listener_);
  const int gone = std::max({std::abs(now.x - flooded_from_.x), std::abs(now.y - flooded_from_.y),
                             std::abs(now.z - flooded_from_.z)});
  if (gone == 0) return true;
  return gone == 1 && SoundRoom::inside(flooded_from_) &&
         in_sight(room_, listener_, SoundRoom::middle_of(flooded_from_));
}

/// Dijkstra's algorithm with a bucket a cost (R. B. Dial, CACM 12(11), 1969).
void SoundPaths::begin_flood() {
  const world::IVec3 start = SoundRoom::cell_of(listener_);
  flooded_from_ = start;
  flooded_revision_ = room_.revision();
  ++floods_;
  cost_.assign(SoundRoom::kCells, kUnreached);
  step_.resize(SoundRoom::kCells);
  due_.resize(static_cast<std::size_t>(kMostLength) * kFaceCost + 1);
  for (auto& bucket : due_) bucket.clear();
  flooded_cost_ = 0;
  reached_ = 0;
  if (!SoundRoom::inside(start)) return;
  const std::size_t first = SoundRoom::index(start);
  cost_[first] = 0;
  step_[first] = 0;
  due_[0].push_back(static_cast<std::uint32_t>(first));
}

void SoundPaths::flood_to(std::size_t cell) {
  for (; flooded_cost_ < due_.size() && reached_ < kMostCells && cost_[cell] >= flooded_cost_;
       ++flooded_cost_) {
    // No step is free, so a bucket does not grow while it is worked off.
    for (const std::uint32_t at : due_[flooded_cost_]) {
      if (cost_[at] != flooded_cost_) continue;  // a shorter way came later
      reach(at, static_cast<int>(flooded_cost_));
      ++reached_;
    }
  }
}

int SoundPaths::way_cost(world::IVec3 cell) {
  if (!flood_serves()) begin_flood();
  if (!SoundRoom::inside(cell)) return -1;
  flood_to(SoundRoom::index(cell));
  const std::uint16_t cost = cost_[SoundRoom::index(cell)];
  return cost == kUnreached ? -1 : cost;
}

std::vector<glm::dvec3> SoundPaths::corners_to(world::IVec3 cell, const glm::dvec3& source) const {
  std::vector<glm::dvec3> way{source};
  for (world::IVec3 at = cell; at != flooded_from_;) {
    const world::IVec3 by = kNeighbours[step_[SoundRoom::index(at)] & ~kFromOpen].by;
    at = {at.x - by.x, at.y - by.y, at.z - by.z};
    if (at != flooded_from_) way.push_back(SoundRoom::middle_of(at));
  }
  if (SoundRoom::cell_of(listener_) != flooded_from_)
    way.push_back(SoundRoom::middle_of(flooded_from_));
  way.push_back(listener_);
  std::reverse(way.begin(), way.end());
  // From each corner on to the farthest place that it sees.
  std::vector<glm::dvec3> corners{way.front()};
  for (std::size_t at = 0; at + 1 < way.size();) {
    std::size_t next = way.size() - 1;
    while (next > at + 1 && !in_sight(room_, way[at], way[next])) --next;
    corners.push_back(way[next]);
    at = next;
  }
  return corners;
}

SoundPath SoundPaths::tight_path(world::IVec3 cell, const glm::dvec3& source) const {
  const std::vector<glm::dvec3> corners = corners_to(cell, source);
  SoundPath path;
  double turned = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    path.length += glm::length(corners[i] - corners[i - 1]);
    path.loss_db += straight_way(room_, corners[i - 1], corners[i]).loss_db;
    if (i > 1)
      turned += angle_between(corners[i] - corners[i - 1], corners[i - 1] - corners[i - 2]);
  }
  if (corners.size() > 1) path.arrival = direction_to(corners[0], corners[1]);
  const double right_angles = turned / (0.5 * std::numbers::pi);
  path.loss_db = std::min(kMostPathLossDb, path.loss_db + kCornerLossDb * right_angles);
  path.cutoff_hz = 20000.0 / (1.0 + 4.0 * right_angles);
  return path;
}

SoundPath SoundPaths::path_from(const glm::dvec3& source) {
  const StraightWay way = straight_way(room_, listener_, source);
  SoundPath path;
  path.open = way.open;
  path.length = glm::length(source - listener_);
  path.arrival = direction_to(listener_, source);
  path.loss_db = way.loss_db;
  const world::IVec3 cell = SoundRoom::cell_of(source);
  if (!way.open) {
    path.cutoff_hz = kWallCutoffHz;
    if (way_cost(cell) >= 0) {
      const SoundPath round = tight_path(cell, source);
      if (round.gain() > path.gain()) path = round;
    }
  }
  const auto wet = [&](const glm::dvec3& place) {
    return room_.medium(SoundRoom::cell_of(place)) == SoundMedium::kWater;
  };
  if (wet(listener_) || wet(source)) path.cutoff_hz = std::min(path.cutoff_hz, kWaterCutoffHz);
  return path;
}

}  // namespace skerry::game
