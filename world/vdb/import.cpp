#include "world/vdb/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "world/edits.h"
#include "world/hash.h"
#include "world/vdb/answer.h"
#include "world/vdb/block_colors.h"
#include "world/vdb/land.h"
#include "world/vdb/placement.h"
#include "world/vdb/solid.h"
#include "world/vdb/volume_field.h"

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

std::string list_of(const std::vector<VolumeGrid>& grids) {
  std::string names;
  for (const VolumeGrid& grid : grids)
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", grid.name);
  return names;
}

/// A grid that becomes an island, with the look-ups that every step needs.
struct Source {
  Source(const VolumeGrid& grid, const ImportOptions& options)
      : field(grid), rule(rule_for(grid, options)), content(content_of(field, rule)) {}

  const VolumeGrid& grid() const { return field.grid(); }

  VolumeField field;
  SolidRule rule;
  Bounds content;  // in index space
};

Result<std::vector<const VolumeGrid*>> chosen(const std::vector<VolumeGrid>& grids,
                                              const ImportOptions& options) {
  std::vector<const VolumeGrid*> out;
  for (const std::size_t i : importable_grids(grids))
    if (!options.grid) out.push_back(&grids[i]);
  for (const VolumeGrid& grid : grids)
    if (options.grid && grid.name == *options.grid) out.push_back(&grid);
  if (out.empty() && grids.empty()) return Error{"it holds no grid"};
  if (out.empty() && options.grid)
    return Error{fmt::format("it has no grid '{}'; give one of {}", printable(*options.grid),
                             list_of(grids))};
  if (out.empty()) return Error{"none of its grids has an inside; see skerry vdb info"};
  const VolumeGrid& first = *out.front();
  if (first.kind == VolumeKind::kOther || first.kind == VolumeKind::kColor)
    return Error{fmt::format("grid '{}' has no inside: {}; give another --grid", first.name,
                             first.remark.empty() ? "it holds colours" : first.remark)};
  return out;
}

std::vector<Source> sources_of(const std::vector<const VolumeGrid*>& grids,
                               const ImportOptions& options) {
  std::vector<Source> out;
  out.reserve(grids.size());
  for (const VolumeGrid* grid : grids) out.emplace_back(*grid, options);
  // Beside a grid with something in it, empty ones are no reason to refuse the file.
  const auto empty = [](const Source& source) { return source.content.empty(); };
  std::vector<Source> full;
  for (Source& source : out)
    if (!empty(source)) full.push_back(std::move(source));
  return full.empty() ? std::move(out) : std::move(full);
}

bool names_density(const VolumeGrid& grid) {
  return grid.name.starts_with("density");
}

/// Fog that says how hot rather than how dense a place is.
bool names_heat(const VolumeGrid& grid) {
  constexpr std::array<std::string_view, 4> kNames = {"temperature", "heat", "flame", "fuel"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](std::string_view name) { return grid.name.starts_with(name); });
}

double blocks_per_unit_of(const std::vector<Source>& sources, const ImportOptions& options) {
  if (!options.size_blocks) return options.scale.value_or(1.0) / voxel_size(sources[0].grid());
  Bounds all = Bounds::none();
  for (const Source& source : sources) {
    if (source.content.empty()) continue;
    const Bounds placed =
        image_of(blocks_from_index(source.grid(), 1.0, options.up), source.content);
    all.add(placed.low);
    all.add(placed.high);
  }
  if (all.empty()) return 1.0;  // then nothing is solid, which build() tells
  const glm::dvec3 extent = all.high - all.low;
  return static_cast<double>(*options.size_blocks) / std::max({extent.x, extent.y, extent.z});
}

std::optional<VolumeField> color_field(const std::vector<VolumeGrid>& grids) {
  for (const VolumeGrid& grid : grids)
    if (grid.kind == VolumeKind::kColor) return std::optional<VolumeField>(std::in_place, grid);
  return std::nullopt;
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

/// Whether this program knows the block of an id above air's.
bool is_known(float id) {
  return id < static_cast<float>(block::kBuiltInCount) - 0.5f;
}

BlockId block_of(float id) {
  return is_known(id) ? static_cast<BlockId>(id + 0.5f) : BlockId{block::kStone};
}

glm::dvec3 centre_of(IVec3 voxel) {
  return glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5;
}

/// Makes one island.
class Builder {
 public:
  Builder(const Source& source, const ImportOptions& options, double blocks_per_unit, Jobs& jobs)
      : grid_(source.grid()),
        field_(source.field),
        content_(source.content),
        rule_(source.rule),
        options_(options),
        blocks_per_unit_(blocks_per_unit),
        jobs_(jobs) {}

  Result<ImportedIsland> run(const VolumeField* colors, std::uint64_t id,
                             const ReadProgress& progress);

 private:
  Result<void> prepare(const ReadProgress& progress);
  void find_box();
  Chunk land_of(IVec3 chunk, const Land& land) const { return land_chunk(masks_, chunk, land); }
  Chunk ids_of(IVec3 chunk, std::uint64_t& unknown) const;
  std::optional<float> id_of_all(IVec3 low, int edge) const;
  void fill_ids(IVec3 low, int edge, std::vector<BlockId>& voxels, std::uint64_t& unknown) const;
  std::vector<IVec3> chunk_list(bool with_plants) const;
  Result<void> fill(ImportedIsland& out, const Land& land, const ReadProgress& progress);
  IslandSpec spec_of(std::uint64_t id) const;
  Land land_with(const VolumeField* colors) const;

  const VolumeGrid& grid_;
  const VolumeField& field_;
  const Bounds& content_;
  SolidRule rule_;
  const ImportOptions& options_;
  double blocks_per_unit_;
  Jobs& jobs_;
  Placement placement_;
  SolidMasks masks_;
  IVec3 low_{}, high_{};  // of solid voxels, inclusive
};

Result<void> Builder::prepare(const ReadProgress& progress) {
  if (rule_(grid_.background)) return Error{"its outside is solid; give another --threshold"};
  if (content_.empty())
    return Error{fmt::format("nothing in it is solid at threshold {}; its values are {} to {}",
                             rule_.threshold, grid_.min_value, grid_.max_value)};
  Result<Placement> placement = place(grid_, content_, blocks_per_unit_, options_.up);
  if (!placement) return placement.error();
  placement_ = *placement;
  const Result<std::set<IVec3>> chunks = chunks_of(grid_, rule_, placement_);
  if (!chunks) return chunks.error();
  Result<SolidMasks> masks = solid_masks(field_, rule_, placement_, *chunks, jobs_, progress);
  if (!masks) return masks.error();
  masks_ = std::move(*masks);
  if (masks_.empty())
    return Error{"it is too small to fill a single block; give a larger --scale or --size"};
  find_box();
  return {};
}

void Builder::find_box() {
  low_ = {INT32_MAX, INT32_MAX, INT32_MAX};
  high_ = {INT32_MIN, INT32_MIN, INT32_MIN};
  for (const auto& [chunk, mask] : masks_) widen(low_, high_, chunk, mask);
}

Chunk Builder::ids_of(IVec3 chunk, std::uint64_t& unknown) const {
  const IVec3 origin{chunk.x * kChunkEdge, chunk.y * kChunkEdge, chunk.z * kChunkEdge};
  if (const std::optional<float> id = id_of_all(origin, kChunkEdge)) {
    unknown += is_known(*id) ? 0 : kChunkVoxels;
    return Chunk(block_of(*id));
  }
  std::vector<BlockId> voxels(kChunkVoxels, kAir);
  fill_ids(origin, kChunkEdge, voxels, unknown);
  return Chunk::from_voxels(voxels);
}

/// The id of all voxels of a cube where bounds of the values tell it, 0 for air.
std::optional<float> Builder::id_of_all(IVec3 low, int edge) const {
  const VolumeField::Range seen =
      values_in_cube(field_, placement_, glm::dvec3{low.x, low.y, low.z}, edge);
  if (seen.min != seen.max) return std::nullopt;
  return rule_(seen.min) ? seen.min : 0.0f;
}

/// Whole cubes at once where that is possible: tiles may be large.
void Builder::fill_ids(IVec3 low, int edge, std::vector<BlockId>& voxels,
                       std::uint64_t& unknown) const {
  constexpr int kLeastCube = 4;
  const std::optional<float> all = id_of_all(low, edge);
  if (all == 0.0f) return;
  if (!all && edge > kLeastCube) {
    const int half = edge / 2;
    for (int part = 0; part < 8; ++part)
      fill_ids(
          {low.x + half * (part & 1), low.y + half * (part >> 1 & 1), low.z + half * (part >> 2)},
          half, voxels, unknown);
    return;
  }
  for (int y = low.y; y < low.y + edge; ++y) {
    for (int x = low.x; x < low.x + edge; ++x) {
      for (int z = low.z; z < low.z + edge; ++z) {
        const IVec3 voxel{x, y, z};
        const float id =
            all ? *all : field_.nearest(placement_.index_from_lattice(centre_of(voxel)));
        if (!rule_(id)) continue;
        unknown += is_known(id) ? 0 : 1;
        voxels[index_in_chunk(voxel)] = block_of(id);
      }
    }
  }
}

std::vector<IVec3> Builder::chunk_list(bool with_plants) const {
  std::vector<IVec3> list;
  for (const auto& [chunk, mask] : masks_) {
    list.push_back(chunk);
    // Plants may stand on the highest voxels of a chunk.
    const IVec3 above{chunk.x, chunk.y + 1, chunk.z};
    if (with_plants && !masks_.contains(above)) list.push_back(above);
  }
  return list;
}

Result<void> Builder::fill(ImportedIsland& out, const Land& land, const ReadProgress& progress) {
  const bool ids = holds_block_ids(grid_);
  const std::vector<IVec3> list = chunk_list(!ids);
  std::size_t detailed = 0;
  struct Made {
    Chunk chunk = Chunk(kAir);
    std::uint64_t blocks = 0, unknown = 0;
  };
  std::vector<Made> made;
  for (std::size_t first = 0; first < list.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, list.size() - first);
    made.assign(count, {});
    jobs_.parallel_for(static_cast<int>(count), [&](int i) {
      Made& one = made[static_cast<std::size_t>(i)];
      const IVec3 at = list[first + static_cast<std::size_t>(i)];
      one.chunk = ids ? ids_of(at, one.unknown) : land_of(at, land);
      one.blocks = count_blocks(one.chunk);
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (made[i].blocks == 0) continue;
      out.blocks += made[i].blocks;
      out.unknown_ids += made[i].unknown;
      detailed += made[i].chunk.is_uniform() ? 0 : 1;
      out.chunks.emplace(list[first + i], std::move(made[i].chunk));
    }
    if (detailed > 2 * kMaxDetailedChunks)
      return Error{
          fmt::format("it would have more than {} chunks of several blocks; give a smaller "
                      "--scale or --size",
                      2 * kMaxDetailedChunks)};
    if (progress) progress(static_cast<double>(first + count) / static_cast<double>(list.size()));
  }
  return {};
}

IslandSpec Builder::spec_of(std::uint64_t id) const {
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

Land Builder::land_with(const VolumeField* colors) const {
  Land land{static_cast<std::uint32_t>(mix64(grid_.active_voxels)), snow_line(low_.y, high_.y)};
  if (!colors) return land;
  // Both grids are placed in the file's space, each by a transform of its own.
  const Affine blocks_from_lattice = [this] {
    const Affine blocks = blocks_from_index(grid_, blocks_per_unit_, options_.up);
    const Affine& index = placement_.index_from_lattice;
    return Affine{blocks.linear * index.linear, blocks(index.shift)};
  }();
  const Affine color_index =
      blocks_from_index(colors->grid(), blocks_per_unit_, options_.up).inverse();
  land.colored = [=](IVec3 voxel) {
    const glm::dvec3 place = color_index(blocks_from_lattice(centre_of(voxel)));
    return nearest_block(static_cast<std::uint32_t>(colors->nearest(place)));
  };
  return land;
}

Result<ImportedIsland> Builder::run(const VolumeField* colors, std::uint64_t id,
                                    const ReadProgress& progress) {
  const auto part = [&progress](double from, double share) -> ReadProgress {
    if (!progress) return {};
    return [=](double done) { progress(from + share * done); };
  };
  if (const Result<void> ready = prepare(part(0.0, 0.5)); !ready) return ready.error();
  ImportedIsland out;
  out.grid = grid_.name;
  out.spec = spec_of(id);
  out.threshold = rule_.threshold;
  const bool smooth = !rule_.nearest && voxel_size(grid_) * blocks_per_unit_ > 1.0 + 1e-6;
  out.error_blocks = placement_.exact && !smooth ? 0.0 : kHalfDiagonal;
  const Result<void> filled = fill(out, land_with(colors), part(0.5, 0.5));
  if (!filled) return filled.error();
  return out;
}

}  // namespace

bool holds_block_ids(const VolumeGrid& grid) {
  constexpr std::array<std::string_view, 4> kNames = {"block_id", "block_ids", "ids", "blocks"};
  if (grid.kind == VolumeKind::kIds) return true;
  const std::string_view name = std::string_view(grid.name).substr(0, grid.name.find('['));
  return grid.kind == VolumeKind::kFog &&
         std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

std::vector<std::size_t> importable_grids(const std::vector<VolumeGrid>& grids) {
  const auto all = [&grids](auto&& wanted) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < grids.size(); ++i)
      if (wanted(grids[i])) out.push_back(i);
    return out;
  };
  const auto of_kind = [](VolumeKind kind) {
    return [kind](const VolumeGrid& grid) { return grid.kind == kind; };
  };
  if (auto ids = all(holds_block_ids); !ids.empty()) return ids;
  if (auto sets = all(of_kind(VolumeKind::kLevelSet)); !sets.empty()) return sets;
  if (auto masks = all(of_kind(VolumeKind::kMask)); !masks.empty()) return masks;
  if (auto dense = all([](const VolumeGrid& grid) {
        return grid.kind == VolumeKind::kFog && names_density(grid);
      });
      !dense.empty())
    return dense;
  return all(
      [](const VolumeGrid& grid) { return grid.kind == VolumeKind::kFog && !names_heat(grid); });
}

Result<std::vector<ImportedIsland>> import_islands(const std::vector<VolumeGrid>& grids,
                                                   const ImportOptions& options, Jobs& jobs,
                                                   const ReadProgress& progress) {
  const Result<std::vector<const VolumeGrid*>> wanted = chosen(grids, options);
  if (!wanted) return wanted.error();
  const std::vector<Source> sources = sources_of(*wanted, options);
  const double blocks_per_unit = blocks_per_unit_of(sources, options);
  const std::optional<VolumeField> colors = color_field(grids);
  std::vector<ImportedIsland> islands;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const double share = 1.0 / static_cast<double>(sources.size());
    const ReadProgress part = !progress ? ReadProgress() : [&, i](double done) {
      progress((static_cast<double>(i) + done) * share);
    };
    Builder builder(sources[i], options, blocks_per_unit, jobs);
    Result<ImportedIsland> island =
        builder.run(colors ? &*colors : nullptr, mix64(i + 0x5ce44), part);
    if (!island)
      return Error{fmt::format("grid '{}': {}", sources[i].grid().name, island.error().message)};
    islands.push_back(std::move(*island));
  }
  return islands;
}

}  // namespace skerry::world
