#include "world/light/lattice_lines.h"

#include <algorithm>
#include <tuple>

#include "world/light/face_records.h"

namespace skerry::world {
namespace {

VoxelBits solid_of(const AirVolume& air) {
  VoxelBits solid = air.opaque;
  if (!air.has_leaves) return solid;
  for (int y = 0; y < solid.size().y; ++y)
    for (int x = 0; x < solid.size().x; ++x)
      for (int w = 0; w < solid.row_words(); ++w)
        solid.row(x, y)[w] |= air.leaves.row(x, y)[w] | air.plants.row(x, y)[w];
  return solid;
}

}  // namespace

LatticeLines::LatticeLines(const AirVolume& air) : air_(air), solid_(solid_of(air)) {
  ways_.reserve(kWays);
  for (int octant = 0; octant < kOctants; ++octant)
    for (int pattern = 0; pattern < static_cast<int>(shared::kSkyPatternCount); ++pattern)
      ways_.push_back(way_along(sky_direction(octant, pattern)));
}

void LatticeLines::changed(IVec3 voxel) {
  solid_.set(voxel, air_.opaque.at(voxel) ||
                        (air_.has_leaves && (air_.leaves.at(voxel) || air_.plants.at(voxel))));
}

LatticeLines::Way LatticeLines::way_along(IVec3 vector) const {
  struct Place {
    int enter = 0, leave = 0, steps = 0;
    IVec3 offset{};
    auto order() const { return std::tuple(enter, leave, steps); }
  };
  const std::array<int, 3> n{std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)};
  std::vector<IVec3> offsets = voxels_between(vector);
  offsets.push_back(vector);
  std::vector<Place> places;
  for (const IVec3& o : offsets) {
    const std::array<int, 3> at{std::abs(o.x), std::abs(o.y), std::abs(o.z)};
    Place place{0, 8, at[0] + at[1] + at[2], o};
    for (std::size_t a = 0; a < 3; ++a) {
      place.enter = std::max(place.enter, (2 * at[a] - 1) * 4 / n[a]);
      place.leave = std::min(place.leave, (2 * at[a] + 1) * 4 / n[a]);
    }
    places.push_back(place);
  }
  std::ranges::stable_sort(places, {}, &Place::order);
  Way way{vector, {}, 4 / std::max({n[0], n[1], n[2]})};
  int group = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i != 0 && places[i].order() != places[i - 1].order()) ++group;
    Touched touched{places[i].offset,
                    solid_.bit_step(places[i].offset),
                    group,
                    places[i].leave - places[i].enter,
                    {-1, -1, -1}};
    // It can be entered from what the line touches before it, or from where the line begins.
    std::size_t entries = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::array<int, 3> d{vector.x, vector.y, vector.z};
      const int sign = d[static_cast<std::size_t>(axis)] > 0 ? 1 : -1;
      const IVec3 from = places[i].offset + axis_vector(axis, -sign);
      const bool passed =
          from == IVec3{} ||
          std::any_of(way.touched.begin(), way.touched.end(),
                      [&](const Touched& t) { return t.group < group && t.offset == from; });
      if (passed)
        touched.entered[entries++] = static_cast<std::int8_t>(2 * axis + (sign > 0 ? 1 : 0));
    }
    way.touched.push_back(touched);
  }
  return way;
}

bool LatticeLines::inside(IVec3 v) const {
  const IVec3 low = solid_.low(), size = solid_.size();
  return v.x >= low.x && v.x < low.x + size.x && v.y >= low.y && v.y < low.y + size.y &&
         v.z >= low.z && v.z < low.z + size.z;
}

bool LatticeLines::open(IVec3 voxel, std::size_t way) const {
  if (air_.opaque.at(voxel)) return false;
  if (!air_.has_leaves) return true;
  const bool leaves = air_.leaves.at(voxel);
  if (!leaves && !air_.plants.at(voxel)) return true;
  const int leaf_set = static_cast<int>(way % shared::kSkyPatternCount) % kLeafSets;
  const auto word = static_cast<int>(floor_div(voxel.z, 64));
  const std::uint64_t stopped = leaves ? leaves_that_stop(leaf_set, voxel.x, voxel.y, word)
                                       : plants_that_stop(leaf_set, voxel.x, voxel.y, word);
  return (stopped >> (voxel.z & 63) & 1u) == 0;
}

bool LatticeLines::stopped(IVec3 from, std::size_t number) const {
  constexpr int kLongest = 4;  // component of a vector
  const Way& way = ways_[number];
  const IVec3 low = solid_.low(), size = solid_.size();
  const int x = from.x - low.x, y = from.y - low.y;
  const auto closed = [&](const Touched& t) { return !open(from + t.offset, number); };
  if (x < kLongest || y < kLongest || x >= size.x - kLongest || y >= size.y - kLongest)
    return std::any_of(way.touched.begin(), way.touched.end(), closed);
  const std::ptrdiff_t at = solid_.bit_at(from);
  bool any = false;
  for (const Touched& t : way.touched) any |= solid_.bit(at + t.step);
  if (!any || !air_.has_leaves) return any;
  return std::any_of(way.touched.begin(), way.touched.end(), closed);
}

int LatticeLines::stopping_group(IVec3 from, std::size_t number) const {
  const std::vector<Touched>& touched = ways_[number].touched;
  return std::ranges::find_if(touched,
                              [&](const Touched& t) { return !open(from + t.offset, number); })
      ->group;
}

std::optional<IVec3> LatticeLines::end_of(IVec3 from, std::size_t way) const {
  while (!stopped(from, way)) {
    from = from + ways_[way].vector;
    if (!inside(from)) return std::nullopt;
  }
  return from;
}

}  // namespace skerry::world
