#include "world/light/lattice_lines.h"

#include <algorithm>

#include "world/light/base/face_records.h"

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
  for (std::size_t fan = 0; fan < kFans; ++fan)
    for (int pattern = 0; pattern < static_cast<int>(shared::kSkyPatternCount); ++pattern)
      ways_.push_back(way_along(sky_direction(octant_of(fan), pattern), axis_of(fan)));
}

void LatticeLines::changed(IVec3 voxel) {
  solid_.set(voxel, air_.opaque.at(voxel) ||
                        (air_.has_leaves && (air_.leaves.at(voxel) || air_.plants.at(voxel))));
}

LatticeLines::Way LatticeLines::way_along(IVec3 vector, int face_axis) const {
  constexpr int kWhole = 8;  // eighths
  const std::array<int, 3> d{vector.x, vector.y, vector.z};
  const std::vector<LineVoxel> voxels = line_voxels(vector, face_axis);
  Way way{vector, {}, voxels.front().entered};
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const LineVoxel& voxel = voxels[i];
    const int left = i + 1 < voxels.size() ? voxels[i + 1].entered : kWhole;
    const bool forward = d[static_cast<std::size_t>(voxel.axis)] > 0;
    way.passed.push_back({voxel.offset, solid_.bit_step(voxel.offset), left - voxel.entered,
                          2 * voxel.axis + (forward ? 1 : 0)});
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
  const auto closed = [&](const Passed& p) { return !open(from + p.offset, number); };
  if (x < kLongest || y < kLongest || x >= size.x - kLongest || y >= size.y - kLongest)
    return std::ranges::any_of(way.passed, closed);
  const std::ptrdiff_t at = solid_.bit_at(from);
  bool any = false;
  for (const Passed& p : way.passed) any |= solid_.bit(at + p.step);
  if (!any || !air_.has_leaves) return any;
  return std::ranges::any_of(way.passed, closed);
}

std::size_t LatticeLines::passed_before_stop(IVec3 from, std::size_t number) const {
  const std::vector<Passed>& passed = ways_[number].passed;
  const auto stop =
      std::ranges::find_if(passed, [&](const Passed& p) { return !open(from + p.offset, number); });
  return static_cast<std::size_t>(stop - passed.begin());
}

std::optional<IVec3> LatticeLines::end_of(IVec3 from, std::size_t way) const {
  while (!stopped(from, way)) {
    from = from + ways_[way].vector;
    if (!inside(from)) return std::nullopt;
  }
  return from;
}

}  // namespace skerry::world
