#include "world/vdb_import/import.h"

#include <fmt/format.h>

#include <algorithm>

#include "world/vdb_import/grid_choice.h"
#include "world/vdb_import/island_builder.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

std::vector<IslandSource> sources_of(const std::vector<const VolumeGrid*>& grids,
                                     const ImportOptions& options) {
  std::vector<IslandSource> out;
  out.reserve(grids.size());
  for (const VolumeGrid* grid : grids) out.emplace_back(*grid, options);
  // Beside a grid with something in it, empty ones are no reason to refuse the file.
  std::vector<IslandSource> full;
  for (IslandSource& source : out)
    if (!source.content.empty()) full.push_back(std::move(source));
  return full.empty() ? std::move(out) : std::move(full);
}

double blocks_per_unit_of(const std::vector<IslandSource>& sources, const ImportOptions& options) {
  if (!options.size_blocks) return options.scale.value_or(1.0) / voxel_size(sources[0].grid());
  Bounds all = Bounds::none();
  for (const IslandSource& source : sources) {
    if (source.content.empty()) continue;
    const Bounds placed =
        image_of(blocks_from_index(source.grid(), 1.0, options.up), source.content);
    all.add(placed.low);
    all.add(placed.high);
  }
  if (all.empty()) return 1.0;  // then nothing is solid, which the builder reports
  const glm::dvec3 extent = all.high - all.low;
  return static_cast<double>(*options.size_blocks) / std::max({extent.x, extent.y, extent.z});
}

/// What a file's own size allows, or, to who asks for a scale or a size, all there is.
std::uint64_t looks_allowed(const std::vector<const VolumeGrid*>& grids,
                            const ImportOptions& options) {
  if (options.scale || options.size_blocks) return kMaxImportLooks;
  std::uint64_t parts = 0;
  for (const VolumeGrid* grid : grids) parts += grid->bricks.size() + grid->tiles.size();
  return std::min(kMaxImportLooks, kUnaskedLooks + parts * kLooksPerPart);
}

std::optional<VolumeField> color_field(const std::vector<VolumeGrid>& grids) {
  for (const VolumeGrid& grid : grids)
    if (grid.kind == VolumeKind::kColor) return std::optional<VolumeField>(std::in_place, grid);
  return std::nullopt;
}

}  // namespace

Result<std::vector<ImportedIsland>> import_islands(const std::vector<VolumeGrid>& grids,
                                                   const ImportOptions& options, Jobs& jobs,
                                                   const ReadProgress& progress) {
  const Result<std::vector<const VolumeGrid*>> wanted = chosen_grids(grids, options);
  if (!wanted) return wanted.error();
  const std::vector<IslandSource> sources = sources_of(*wanted, options);
  const double blocks_per_unit = blocks_per_unit_of(sources, options);
  const std::optional<VolumeField> colors = color_field(grids);
  ImportCost cost;
  cost.most_looks = looks_allowed(*wanted, options);
  std::vector<ImportedIsland> islands;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const double share = 1.0 / static_cast<double>(sources.size());
    const ReadProgress part = !progress ? ReadProgress() : [&, i](double done) {
      progress((static_cast<double>(i) + done) * share);
    };
    IslandBuilder builder(sources[i], options, blocks_per_unit, cost, jobs);
    Result<ImportedIsland> island =
        builder.run(colors ? &*colors : nullptr, mix64(i + 0x5ce44), part);
    if (!island)
      return Error{fmt::format("grid '{}': {}", sources[i].grid().name, island.error().message)};
    islands.push_back(std::move(*island));
  }
  return islands;
}

}  // namespace skerry::world
