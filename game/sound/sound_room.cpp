#include "game/sound/sound_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace skerry::game {
namespace {

/// A walk from voxel to voxel along a ray (J. Amanatides and A. Woo, Eurographics 1987).
class Walk {
 public:
  Walk(const glm::dvec3& from, const glm::dvec3& direction) {
    const world::IVec3 start = SoundRoom::cell_of(from);
    cell_ = {start.x, start.y, start.z};
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = direction[static_cast<int>(a)], at = from[static_cast<int>(a)];
      sign_[a] = d < 0.0 ? -1 : 1;
      pitch_[a] = d == 0.0 ? std::numeric_limits<double>::infinity() : std::abs(1.0 / d);
      const double ahead = d < 0.0 ? at - cell_[a] : cell_[a] + 1.0 - at;
      next_[a] = d == 0.0 ? pitch_[a] : ahead * pitch_[a];
    }
  }
  world::IVec3 cell() const { return {cell_[0], cell_[1], cell_[2]}; }
  double leaves_at() const { return *std::min_element(next_.begin(), next_.end()); }
  int axis() const { return axis_; }  ///< of the face that was crossed last
  void step() {
    const auto a =
        static_cast<std::size_t>(std::min_element(next_.begin(), next_.end()) - next_.begin());
    cell_[a] += sign_[a];
    next_[a] += pitch_[a];
    axis_ = static_cast<int>(a);
  }

 private:
  std::array<int, 3> cell_{}, sign_{};
  std::array<double, 3> pitch_{}, next_{};
  int axis_ = 0;
};

constexpr double kMostLossDb = 200.0;

}  // namespace

void SoundRoom::clear() {
  std::fill(blocks_.begin(), blocks_.end(), world::kAir);
  std::fill(media_.begin(), media_.end(), SoundMedium::kAir);
  std::fill(solid_rows_.begin(), solid_rows_.end(), 0);
  ++revision_;
}

StraightWay straight_way(const SoundRoom& room, const glm::dvec3& from, const glm::dvec3& to) {
  StraightWay way;
  const double length = glm::length(to - from);
  const world::IVec3 last = SoundRoom::cell_of(to);
  const world::IVec3 first = SoundRoom::cell_of(from);
  if (length == 0.0 || first == last) return way;
  Walk walk(from, (to - from) / length);
  SoundMedium before = room.medium(first);
  double solid_db = 0.0, thickest_db = 0.0, entered_at = walk.leaves_at();
  walk.step();
  while (walk.cell() != last && entered_at < length) {
    const world::IVec3 cell = walk.cell();
    const double leaves_at = std::min(walk.leaves_at(), length);
    const SoundMedium medium = room.medium(cell);
    const double db = medium == SoundMedium::kAir || medium == SoundMedium::kWater
                          ? 0.0
                          : loss_db_per_block(room.block(cell));
    if (medium == SoundMedium::kSolid) {
      way.open = false;
      solid_db += db * (leaves_at - entered_at);
      thickest_db = std::max(thickest_db, db);
    } else {
      way.loss_db += db * (leaves_at - entered_at);
      if ((medium == SoundMedium::kWater) != (before == SoundMedium::kWater))
        way.loss_db += kSurfaceLossDb;
      before = medium;
    }
    entered_at = leaves_at;
    walk.step();
  }
  const SoundMedium end = room.medium(last);
  if (end != SoundMedium::kSolid && (end == SoundMedium::kWater) != (before == SoundMedium::kWater))
    way.loss_db += kSurfaceLossDb;
  way.loss_db = std::min(kMostLossDb, way.loss_db + std::max(solid_db, thickest_db));
  return way;
}

bool in_sight(const SoundRoom& room, const glm::dvec3& from, const glm::dvec3& to) {
  const double length = glm::length(to - from);
  const world::IVec3 last = SoundRoom::cell_of(to);
  Walk walk(from, (to - from) / std::max(length, 1e-12));
  while (walk.cell() != last && walk.leaves_at() < length) {
    walk.step();
    if (walk.cell() != last && room.is_solid(walk.cell())) return false;
  }
  return true;
}

RayHit first_hit(const SoundRoom& room, const glm::dvec3& from, const glm::dvec3& direction,
                 double reach) {
  Walk walk(from, direction);
  const bool in_water = room.medium(walk.cell()) == SoundMedium::kWater;
  while (true) {
    const double at = walk.leaves_at();
    walk.step();
    if (at >= reach || !SoundRoom::inside(walk.cell())) return {false, std::min(at, reach)};
    const SoundMedium medium = room.medium(walk.cell());
    if (medium == SoundMedium::kSolid || (medium == SoundMedium::kWater) != in_water)
      return {true, at, std::abs(direction[walk.axis()]), room.block(walk.cell())};
  }
}

}  // namespace skerry::game
