#include "world/generate/generate.h"

#include <algorithm>

#include "engine/core/check.h"
#include "world/generate/plan.h"
#include "world/generate/sideways.h"

namespace skerry::world {

IslandGenerator::IslandGenerator(const IslandSpec& spec)
    : plan_(std::make_unique<const IslandPlan>(spec)) {}
IslandGenerator::~IslandGenerator() = default;
IslandGenerator::IslandGenerator(IslandGenerator&&) noexcept = default;
IslandGenerator& IslandGenerator::operator=(IslandGenerator&&) noexcept = default;

bool IslandGenerator::generate_padded(IVec3 chunk, int level, std::span<BlockId> out) const {
  constexpr std::size_t kPadded = kChunkEdge + 2;
  SKERRY_ASSERT(level >= 0 && level <= 4);
  SKERRY_ASSERT(out.size() == kPadded * kPadded * kPadded);
  return fill_padded(*plan_, chunk, level, out);
}

std::vector<IVec3> IslandGenerator::chunks(int level) const {
  SKERRY_ASSERT(level >= 0 && level <= 4);
  const Columns& columns = plan_->columns;
  const int size = kChunkEdge << level;
  const auto chunk_of = [size](int block) { return sideways::floor_to(block, size); };
  const int first = chunk_of(-columns.half);
  const int edge = chunk_of(columns.half - 1) - first + 1;
  struct Range {
    int low = Columns::kNoRock, high = Columns::kNoGround;
  };
  std::vector<Range> ranges(static_cast<std::size_t>(edge) * edge);
  const auto mark = [&](int x, int z, int reach, int low, int high) {
    for (int cx = std::max(chunk_of(x - reach) - first, 0);
         cx <= std::min(chunk_of(x + reach) - first, edge - 1); ++cx) {
      for (int cz = std::max(chunk_of(z - reach) - first, 0);
           cz <= std::min(chunk_of(z + reach) - first, edge - 1); ++cz) {
        Range& range = ranges[static_cast<std::size_t>(cx) * edge + cz];
        range.low = std::min(range.low, low);
        range.high = std::max(range.high, high);
      }
    }
  };
  constexpr int kShift = 6;  // ragged rock reaches this far from its column
  for (int x = -columns.half; x < columns.half; ++x) {
    for (int z = -columns.half; z < columns.half; ++z) {
      const std::size_t i = columns.index(x, z);
      if (columns.top[i] == Columns::kNoGround) continue;
      mark(x, z, columns.ragged[i] > 0 ? kShift : 0, columns.bottom[i],
           std::max(columns.top[i], columns.water[i]) + 1);
    }
  }
  for (const Ball& b : plan_->solids) mark(b.x, b.z, b.radius, b.y - b.radius, b.y + b.radius + 1);
  for (const Tree& tree : plan_->trees)
    mark(tree.x, tree.z, kTreeReach, tree.y, tree.y + kTreeHeight);
  for (const Stamp& stamp : plan_->stamps) mark(stamp.x, stamp.z, 0, stamp.y, stamp.y + 1);

  std::vector<IVec3> found;
  for (int cy = chunk_of(plan_->lowest); cy <= chunk_of(plan_->highest); ++cy) {
    for (int cx = 0; cx < edge; ++cx) {
      for (int cz = 0; cz < edge; ++cz) {
        const Range& range = ranges[static_cast<std::size_t>(cx) * edge + cz];
        if (range.low < (cy + 1) * size && range.high > cy * size)
          found.push_back({cx + first, cy, cz + first});
      }
    }
  }
  return found;
}

}  // namespace skerry::world
