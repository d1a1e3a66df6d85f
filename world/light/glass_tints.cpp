#include "world/light/glass_tints.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>

#include "world/light/base/face_records.h"
#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

constexpr double kDepthSteps = 1 << 20;

/// RGB, a block.
glm::vec3 extinction(BlockId block) {
  const BlockType& type = block_types()[block];
  return glm::vec3(type.absorption[0], type.absorption[1], type.absorption[2]) + type.scattering;
}

bool is_clear(const GlassTints::Depth& depth) {
  return depth == GlassTints::Depth(0);
}

}  // namespace

glm::vec3 left_by_glass(BlockId block, float blocks) {
  return glm::exp(-extinction(block) * blocks);
}

GlassTints::GlassTints(const AirVolume& air, const LatticeLines& lines, const VoxelIndex& wanted)
    : air_(air), lines_(lines), wanted_(wanted) {
  if (!any()) return;
  for (BlockId block = 0; block < block_types().size(); ++block)
    for (std::size_t pattern = 0; pattern < shared::kSkyPatternCount; ++pattern) {
      const glm::ivec3 v = shared::kSkyPatterns[pattern];
      const double blocks = std::sqrt(static_cast<double>(v.x * v.x + v.y * v.y + v.z * v.z)) /
                            8.0 * static_cast<double>(air.stained.voxel_blocks());
      const glm::dvec3 depth = glm::dvec3(extinction(block)) * blocks * kDepthSteps;
      per_eighth_.emplace_back(std::llround(depth.x), std::llround(depth.y), std::llround(depth.z));
    }
}

void GlassTints::add(Depth& depth, IVec3 voxel, int eighths, std::size_t way) const {
  const BlockId block = air_.stained.at(voxel);
  if (block == kAir) return;
  depth += std::int64_t{eighths} * per_eighth(block, way);
}

GlassTints::Depth GlassTints::depth_of_step(IVec3 from, std::size_t number) const {
  const LatticeLines::Way& way = lines_.way(number);
  const std::size_t count =
      lines_.stopped(from, number) ? lines_.passed_before_stop(from, number) : way.passed.size();
  Depth depth(0);
  add(depth, from, way.own_eighths, number);
  for (const LatticeLines::Passed& passed : std::span(way.passed).first(count))
    if (passed.eighths != 0) add(depth, from + passed.offset, passed.eighths, number);
  return depth;
}

GlassTints::Depth GlassTints::depth_from(IVec3 from, std::size_t way) const {
  Depth sum(0);
  for (; lines_.inside(from); from = from + lines_.way(way).vector) {
    sum += depth_of_step(from, way);
    if (lines_.stopped(from, way)) break;
  }
  return sum;
}

bool GlassTints::set(IVec3 voxel, std::size_t way, const Depth& depth) {
  const std::size_t number = wanted_.of(voxel);
  Fan& fan = fans_[way / shared::kSkyPatternCount];
  const auto pattern = static_cast<std::uint8_t>(way % shared::kSkyPatternCount);
  if (number / 64 >= fan.has.size()) fan.has.resize(wanted_.size() / 64 + 1, 0);
  std::uint64_t& word = fan.has[number / 64];
  const std::uint64_t bit = std::uint64_t{1} << number % 64;
  if (is_clear(depth)) {
    if ((word & bit) == 0) return false;
    const auto found = fan.lines.find(number);
    const bool was = std::erase_if(found->second,
                                   [&](const Tint& tint) { return tint.pattern == pattern; }) != 0;
    if (!found->second.empty()) return was;
    fan.lines.erase(found);
    word &= ~bit;
    return was;
  }
  const Tint tint{pattern, glm::vec3(glm::exp(glm::dvec3(-depth) / kDepthSteps))};
  word |= bit;
  Tints& tints = fan.lines[number];
  const auto place = std::ranges::lower_bound(tints, pattern, {}, &Tint::pattern);
  if (place == tints.end() || place->pattern != pattern) {
    tints.insert(place, tint);
    return true;
  }
  const bool other = place->left != tint.left;
  *place = tint;
  return other;
}

const GlassTints::Tints* GlassTints::find(std::size_t number, std::size_t fan) const {
  const Fan& its = fans_[fan];
  return its.holds(number) ? &its.lines.at(number) : nullptr;
}

bool GlassTints::has(std::size_t number) const {
  return any() && std::ranges::any_of(fans_, [&](const Fan& fan) { return fan.holds(number); });
}

void GlassTints::look(std::size_t fan) {
  if (!any()) return;
  VoxelBits visited(air_.stained.voxels().low(), air_.stained.voxels().size(), false);
  for (std::size_t pattern = 0; pattern < shared::kSkyPatternCount; ++pattern)
    look_along(LatticeLines::way_number(fan, pattern), visited);
}

/// From each voxel of glass backwards: who is on a line that passes it.
/// @param visited working memory, empty before and after.
void GlassTints::look_along(std::size_t number, VoxelBits& visited) {
  const LatticeLines::Way& way = lines_.way(number);
  const IVec3 back{-way.vector.x, -way.vector.y, -way.vector.z};
  std::vector<IVec3> all;
  const auto walk = [&](IVec3 from) {
    if (!lines_.inside(from) || visited.at(from)) return;
    Depth depth = depth_from(from, number);
    for (;;) {
      visited.set(from);
      all.push_back(from);
      if (wanted_.has(from)) set(from, number, depth);
      from = from + back;
      if (!lines_.inside(from) || visited.at(from) || lines_.stopped(from, number)) return;
      depth += depth_of_step(from, number);
    }
  };
  for_each_voxel(air_.stained.voxels(), [&](IVec3 glass) {
    walk(glass);
    for (const LatticeLines::Passed& passed : way.passed)
      if (passed.eighths != 0)
        walk({glass.x - passed.offset.x, glass.y - passed.offset.y, glass.z - passed.offset.z});
  });
  for (const IVec3& voxel : all) visited.set(voxel, false);
}

std::size_t GlassTints::bytes() const {
  std::size_t bytes = 0;
  for (const Fan& fan : fans_) {
    bytes += fan.has.size() * sizeof(std::uint64_t);
    for (const auto& [number, tints] : fan.lines)
      bytes += sizeof(number) + sizeof(tints) + tints.capacity() * sizeof(Tint);
  }
  return bytes;
}

void GlassTints::move(std::size_t from, std::size_t to) {
  for (Fan& fan : fans_) {
    if (!fan.holds(from)) continue;
    auto node = fan.lines.extract(from);
    fan.has[from / 64] &= ~(std::uint64_t{1} << from % 64);
    if (to / 64 >= fan.has.size()) fan.has.resize(to / 64 + 1, 0);
    fan.has[to / 64] |= std::uint64_t{1} << to % 64;
    node.key() = to;
    fan.lines.insert(std::move(node));
  }
}

void GlassTints::forget(std::size_t number) {
  for (Fan& fan : fans_)
    if (fan.lines.erase(number) != 0) fan.has[number / 64] &= ~(std::uint64_t{1} << number % 64);
}

}  // namespace skerry::world
