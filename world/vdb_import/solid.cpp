#include "world/vdb_import/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace skerry::world {
namespace {

constexpr int kLeastCube = 4;  // blocks; below, asking each block costs less than asking for bounds

IVec3 clamped(glm::dvec3 v) {
  constexpr double kFar = kMaxVolumeIndex;
  const glm::dvec3 c = glm::clamp(v, -kFar, kFar);
  return {static_cast<std::int32_t>(c.x), static_cast<std::int32_t>(c.y),
          static_cast<std::int32_t>(c.z)};
}

/// Fills one chunk's mask by cubes.
class Sampler {
 public:
  Sampler(const VolumeField& field, const SolidRule& rule, const Placement& placement, IVec3 chunk)
      : field_(field), rule_(rule), placement_(placement), rows_(new ChunkMask::Rows{}) {
    const glm::dvec3 at{chunk.x, chunk.y, chunk.z};
    origin_ = at * static_cast<double>(kChunkEdge);
  }

  /// How often this one has looked into the grid.
  std::uint64_t looks() const { return looks_; }

  ChunkMask run() {
    ChunkMask out;
    out.fill = settle({0, 0, 0}, kChunkEdge);
    if (out.fill == ChunkMask::Fill::kMixed) {
      const auto all = [this](std::uint64_t wanted) {
        return std::all_of(rows_->begin(), rows_->end(),
                           [wanted](std::uint64_t row) { return row == wanted; });
      };
      if (all(0)) out.fill = ChunkMask::Fill::kEmpty;
      if (all(~std::uint64_t{0})) out.fill = ChunkMask::Fill::kFull;
    }
    if (out.fill == ChunkMask::Fill::kMixed) out.rows = std::move(rows_);
    return out;
  }

 private:
  /// Writes a cube of the mask. @return what it is; of a whole chunk of one kind nothing is
  /// written.
  ChunkMask::Fill settle(IVec3 low, int edge) {
    const VolumeField::Range range = values_in(low, edge);
    const bool min_solid = rule_(range.min), max_solid = rule_(range.max);
    if (min_solid == max_solid) {
      if (min_solid && edge < kChunkEdge) fill(low, edge);
      return min_solid ? ChunkMask::Fill::kFull : ChunkMask::Fill::kEmpty;
    }
    if (edge <= kLeastCube) {
      ask(low, edge);
      return ChunkMask::Fill::kMixed;
    }
    const int half = edge / 2;
    for (int part = 0; part < 8; ++part) {
      settle({low.x + half * (part & 1), low.y + half * (part >> 1 & 1),
              low.z + half * (part >> 2 & 1)},
             half);
    }
    return ChunkMask::Fill::kMixed;
  }

  /// Bounds of all values that blocks of the cube can see.
  VolumeField::Range values_in(IVec3 low, int edge) {
    looks_ += kBoundsLooks;
    return values_in_cube(field_, placement_, origin_ + glm::dvec3{low.x, low.y, low.z}, edge);
  }

  void fill(IVec3 low, int edge) {
    const std::uint64_t bits = ((std::uint64_t{1} << edge) - 1) << low.z;
    for (int y = low.y; y < low.y + edge; ++y)
      for (int x = low.x; x < low.x + edge; ++x) row(x, y) |= bits;
  }

  void ask(IVec3 low, int edge) {
    looks_ += static_cast<std::uint64_t>(edge * edge * edge);
    for (int y = low.y; y < low.y + edge; ++y) {
      for (int x = low.x; x < low.x + edge; ++x) {
        std::uint64_t bits = 0;
        for (int z = low.z; z < low.z + edge; ++z)
          bits |= static_cast<std::uint64_t>(solid(x, y, z)) << z;
        row(x, y) |= bits;
      }
    }
  }

  bool solid(int x, int y, int z) const {
    const glm::dvec3 place =
        placement_.index_from_lattice(origin_ + glm::dvec3{x + 0.5, y + 0.5, z + 0.5});
    return rule_(rule_.nearest ? field_.nearest(place) : field_.interpolated(place));
  }

  std::uint64_t& row(int x, int y) {
    return (*rows_)[static_cast<std::size_t>(x + kChunkEdge * y)];
  }

  const VolumeField& field_;
  const SolidRule& rule_;
  const Placement& placement_;
  glm::dvec3 origin_;
  std::unique_ptr<ChunkMask::Rows> rows_;
  std::uint64_t looks_ = 0;
};

/// Adds the chunks under a cube of indices.
class ChunkCollector {
 public:
  ChunkCollector(const Placement& placement, ImportCost& cost)
      : placement_(placement), cost_(cost) {}

  Result<void> add(IVec3 origin, std::int32_t edge) {
    const glm::dvec3 low{origin.x, origin.y, origin.z};
    // Interpolation carries a sample's value almost a whole index further.
    const Bounds box =
        image_of(placement_.lattice_from_index, {low - 1.0, low + static_cast<double>(edge)});
    const glm::dvec3 far = glm::max(glm::abs(box.low), glm::abs(box.high));
    if (!(std::max({far.x, far.y, far.z}) <= kMaxImportReach)) {
      return Error{
          fmt::format("it would reach further than {} blocks from its middle; give a "
                      "smaller --scale or --size",
                      kMaxImportReach)};
    }
    const auto chunk = [](double v) {
      return static_cast<std::int32_t>(std::floor(v / static_cast<double>(kChunkEdge)));
    };
    const IVec3 first{chunk(box.low.x), chunk(box.low.y), chunk(box.low.z)};
    const IVec3 last{chunk(box.high.x), chunk(box.high.y), chunk(box.high.z)};
    const double count =
        (last.x - first.x + 1.0) * (last.y - first.y + 1.0) * (last.z - first.z + 1.0);
    const bool again = first == last_first_ && last == last_last_ && !chunks_.empty();
    const bool few = count <= static_cast<double>(kMaxImportChunks);
    if (few && !again) {
      insert(first, last);
      cost_.named_chunks += static_cast<std::uint64_t>(count);
    }
    if (cost_.named_chunks > kMaxNamedChunks)
      return Error{"its bricks overlap too many chunks; give a smaller --scale or --size"};
    if (!few || cost_.chunks + chunks_.size() > kMaxImportChunks) {
      return Error{
          fmt::format("it would fill more than {} chunks of 64^3 blocks; give a smaller "
                      "--scale or --size",
                      kMaxImportChunks)};
    }
    return {};
  }

  std::set<IVec3> take() {
    cost_.chunks += chunks_.size();
    return std::move(chunks_);
  }

 private:
  void insert(IVec3 first, IVec3 last) {
    for (std::int32_t x = first.x; x <= last.x; ++x)
      for (std::int32_t y = first.y; y <= last.y; ++y)
        for (std::int32_t z = first.z; z <= last.z; ++z) chunks_.insert({x, y, z});
    last_first_ = first;
    last_last_ = last;
  }

  const Placement& placement_;
  ImportCost& cost_;
  std::set<IVec3> chunks_;
  IVec3 last_first_, last_last_;  // bricks come sorted: neighbours mostly ask for the same
};

}  // namespace

VolumeField::Range values_in_cube(const VolumeField& field, const Placement& placement,
                                  glm::dvec3 corner, int edge) {
  const Bounds seen = image_of(placement.index_from_lattice,
                               {corner + 0.5, corner + (static_cast<double>(edge) - 0.5)});
  return field.range(clamped(glm::floor(seen.low)), clamped(glm::ceil(seen.high)));
}

Result<std::set<IVec3>> chunks_of(const VolumeGrid& grid, const SolidRule& rule,
                                  const Placement& placement, ImportCost& cost) {
  ChunkCollector collector(placement, cost);
  for (const VolumeTile& tile : grid.tiles) {
    if (!rule(tile.value)) continue;
    if (const Result<void> added = collector.add(tile.origin, tile.edge); !added)
      return added.error();
  }
  for (const VolumeBrick& brick : grid.bricks) {
    if (std::none_of(brick.values.begin(), brick.values.end(), rule)) continue;
    if (const Result<void> added = collector.add(brick.origin, kBrickEdge); !added)
      return added.error();
  }
  return collector.take();
}

Result<SolidMasks> solid_masks(const VolumeField& field, const SolidRule& rule,
                               const Placement& placement, const std::set<IVec3>& chunks,
                               const ImportRun& run) {
  const std::vector<IVec3> list(chunks.begin(), chunks.end());
  constexpr std::size_t kChunkBatch =
      256;  // between two looks at the limits and two steps of progress
  struct Made {
    ChunkMask mask;
    std::uint64_t looks = 0;
  };
  SolidMasks masks;
  std::vector<Made> made;
  for (std::size_t first = 0; first < list.size(); first += kChunkBatch) {
    const std::size_t count = std::min(kChunkBatch, list.size() - first);
    made.clear();
    made.resize(count);
    run.jobs.parallel_for(static_cast<int>(count), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      Sampler sampler(field, rule, placement, list[first + at]);
      made[at].mask = sampler.run();
      made[at].looks = sampler.looks();
    });
    for (std::size_t i = 0; i < count; ++i) {
      const ChunkMask::Fill fill = made[i].mask.fill;
      run.cost.looks += made[i].looks;
      run.cost.mixed_chunks += fill == ChunkMask::Fill::kMixed ? 1 : 0;
      if (fill != ChunkMask::Fill::kEmpty)
        masks.emplace_hint(masks.end(), list[first + i], std::move(made[i].mask));
    }
    if (run.cost.mixed_chunks > kMaxDetailedChunks) {
      return Error{
          fmt::format("its surface would pass through more than {} chunks of 64^3 blocks; "
                      "give a smaller --scale or --size",
                      kMaxDetailedChunks)};
    }
    if (run.cost.looks > run.cost.most_looks) return too_many_looks(run.cost);
    if (run.progress)
      run.progress(static_cast<double>(first + count) / static_cast<double>(list.size()));
  }
  return masks;
}

Error too_many_looks(const ImportCost& cost) {
  return {fmt::format(
      "finding what is solid would take too long, most likely because its transform is so slanted; "
      "give a smaller --scale or --size{}",
      cost.most_looks < kMaxImportLooks ? ", or --scale 1 if it may take minutes" : "")};
}

}  // namespace skerry::world
