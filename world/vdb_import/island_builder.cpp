#include "world/vdb_import/island_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "world/vdb_import/block_colors.h"
#include "world/vdb_import/grid_choice.h"
#include "world/vdb_import/id_chunk.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr double kHalfDiagonal = 0.8660254037844386;  // of a block
constexpr std::size_t kBatch = 256;                   // chunks between two steps of progress

SolidRule rule_for(const VolumeGrid& grid, const ImportOptions& options) {
  if (holds_block_ids(grid) || grid.kind == VolumeKind::kMask) return {false, 0.5f, true};
  const bool below = grid.kind == VolumeKind::kLevelSet;
  const double usual = below ? 0.0 : 0.5 * static_cast<double>(grid.mean_value);
  return {below, static_cast<float>(options.threshold.value_or(usual))};
}

/// Tight box of a mask's solid voxels, added to a lattice box with inclusive corners.
void widen(IVec3& low, IVec3& high, IVec3 chunk, const ChunkMask& mask) {
  const IVec3 origin{chunk.x * kChunkEdge, chunk.y * kChunkEdge, chunk.z * kChunkEdge};
  for (int y = 0; y < kChunkEdge; ++y) {
    for (int x = 0; x < kChunkEdge; ++x) {
      const std::uint64_t row = mask.row(x, y);
      if (row == 0) continue;
      low = {std::min(low.x, origin.x + x), std::min(low.y, origin.y + y),
             std::min(low.z, origin.z + std::countr_zero(row))};
      high = {std::max(high.x, origin.x + x), std::max(high.y, origin.y + y),
              std::max(high.z, origin.z + 63 - std::countl_zero(row))};
    }
  }
}

std::uint64_t count_blocks(const Chunk& chunk) {
  if (chunk.is_uniform()) return chunk.at(std::size_t{0}) == kAir ? 0 : kChunkVoxels;
  std::vector<BlockId> voxels(kChunkVoxels);
  chunk.unpack(voxels);
  return kChunkVoxels - static_cast<std::uint64_t>(std::count(voxels.begin(), voxels.end(), kAir));
}

}  // namespace

IslandSource::IslandSource(const VolumeGrid& grid, const ImportOptions& options)
    : field(grid), rule(rule_for(grid, options)), content(content_of(field, rule)) {}

IslandBuilder::IslandBuilder(const IslandSource& source, const ImportOptions& options,
                             double blocks_per_unit, ImportCost& cost, Jobs& jobs)
    : source_(source),
      options_(options),
      blocks_per_unit_(blocks_per_unit),
      cost_(cost),
      jobs_(jobs),
      holds_ids_(holds_block_ids(source.grid())) {}

Result<void> IslandBuilder::prepare(const ReadProgress& progress) {
  const VolumeGrid& grid = source_.grid();
  const SolidRule& rule = source_.rule;
  if (rule(grid.background)) return Error{"its outside is solid; give another --threshold"};
  if (source_.content.empty())
    return Error{fmt::format("nothing in it is solid at threshold {}; its values are {} to {}",
                             rule.threshold, grid.min_value, grid.max_value)};
  Result<Placement> placement = place(grid, source_.content, blocks_per_unit_, options_.up);
  if (!placement) return placement.error();
  placement_ = *placement;
  const Result<std::set<IVec3>> chunks = chunks_of(grid, rule, placement_, cost_);
  if (!chunks) return chunks.error();
  Result<SolidMasks> masks =
      solid_masks(source_.field, rule, placement_, *chunks, {cost_, jobs_, progress});
  if (!masks) return masks.error();
  masks_ = std::move(*masks);
  if (masks_.empty())
    return Error{"it is too small to fill a single block; give a larger --scale or --size"};
  find_box();
  return {};
}

void IslandBuilder::find_box() {
  low_ = {INT32_MAX, INT32_MAX, INT32_MAX};
  high_ = {INT32_MIN, INT32_MIN, INT32_MIN};
  for (const auto& [chunk, mask] : masks_) widen(low_, high_, chunk, mask);
}

std::vector<IVec3> IslandBuilder::chunk_list(bool with_plants) const {
  std::vector<IVec3> list;
  for (const auto& [chunk, mask] : masks_) {
    list.push_back(chunk);
    // Plants may stand on the highest voxels of a chunk.
    const IVec3 above{chunk.x, chunk.y + 1, chunk.z};
    if (with_plants && !masks_.contains(above)) list.push_back(above);
  }
  return list;
}

IslandBuilder::Made IslandBuilder::make(IVec3 at, const Land& land) const {
  Made made;
  if (holds_ids_) {
    IdChunk ids = id_chunk(source_.field, source_.rule, placement_, at);
    made = {std::move(ids.chunk), 0, ids.unknown, ids.looks};
  } else {
    made = {land_chunk(masks_, at, land), 0, 0, is_buried(masks_, at) ? 0 : kPaintLooks};
  }
  made.blocks = count_blocks(made.chunk);
  return made;
}

Result<void> IslandBuilder::fill(ImportedIsland& out, const Land& land,
                                 const ReadProgress& progress) {
  const std::vector<IVec3> list = chunk_list(!holds_ids_);
  std::vector<Made> made;
  for (std::size_t first = 0; first < list.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, list.size() - first);
    made.assign(count, {});
    jobs_.parallel_for(static_cast<int>(count), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      made[at] = make(list[first + at], land);
    });
    for (std::size_t i = 0; i < count; ++i) {
      cost_.looks += made[i].looks;
      if (made[i].blocks == 0) continue;
      out.blocks += made[i].blocks;
      out.unknown_ids += made[i].unknown;
      cost_.detailed_chunks += made[i].chunk.is_uniform() ? 0 : 1;
      out.chunks.emplace(list[first + i], std::move(made[i].chunk));
    }
    if (cost_.detailed_chunks > 2 * kMaxDetailedChunks)
      return Error{
          fmt::format("it would have more than {} chunks of several blocks; give a smaller "
                      "--scale or --size",
                      2 * kMaxDetailedChunks)};
    if (cost_.looks > cost_.most_looks) return too_many_looks(cost_);
    if (progress) progress(static_cast<double>(first + count) / static_cast<double>(list.size()));
  }
  return {};
}

IslandSpec IslandBuilder::spec_of(std::uint64_t id) const {
  IslandSpec spec;
  spec.id = spec.seed = id;
  spec.origin = placement_.origin;
  spec.yaw_rad = placement_.yaw_rad;
  spec.box_min = low_;
  // A plant may stand on the highest voxel.
  spec.box_max = {high_.x + 1, high_.y + 2, high_.z + 1};
  const glm::dvec3 low{low_.x, low_.y, low_.z};
  const glm::dvec3 high{spec.box_max.x, spec.box_max.y, spec.box_max.z};
  spec.bounding_radius = glm::length(glm::max(glm::abs(low), glm::abs(high)));
  return spec;
}

Land IslandBuilder::land_with(const VolumeField* colors) const {
  const VolumeGrid& grid = source_.grid();
  Land land{static_cast<std::uint32_t>(mix64(grid.active_voxels)), snow_line(low_.y, high_.y)};
  if (!colors) return land;
  // Both grids are placed in the file's space, each by a transform of its own.
  const Affine blocks_from_lattice = [&] {
    const Affine blocks = blocks_from_index(grid, blocks_per_unit_, options_.up);
    const Affine& index = placement_.index_from_lattice;
    return Affine{blocks.linear * index.linear, blocks(index.shift)};
  }();
  const Affine color_index =
      blocks_from_index(colors->grid(), blocks_per_unit_, options_.up).inverse();
  land.colored = [=](IVec3 voxel) {
    const glm::dvec3 centre = glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5;
    const glm::dvec3 place = color_index(blocks_from_lattice(centre));
    return nearest_block(static_cast<std::uint32_t>(colors->nearest(place)));
  };
  return land;
}

Result<ImportedIsland> IslandBuilder::run(const VolumeField* colors, std::uint64_t id,
                                          const ReadProgress& progress) {
  const auto part = [&progress](double from, double share) -> ReadProgress {
    if (!progress) return {};
    return [=](double done) { progress(from + share * done); };
  };
  if (const Result<void> ready = prepare(part(0.0, 0.5)); !ready) return ready.error();
  ImportedIsland out;
  out.grid = source_.grid().name;
  out.spec = spec_of(id);
  out.threshold = source_.rule.threshold;
  const bool smooth =
      !source_.rule.nearest && voxel_size(source_.grid()) * blocks_per_unit_ > 1.0 + 1e-6;
  out.error_blocks = placement_.exact && !smooth ? 0.0 : kHalfDiagonal;
  const Result<void> filled = fill(out, land_with(colors), part(0.5, 0.5));
  if (!filled) return filled.error();
  return out;
}

}  // namespace skerry::world
