// Which grids of a file become islands.
#pragma once
#include <cstddef>
#include <vector>

#include "engine/core/result.h"
#include "world/vdb/volume_grid.h"
#include "world/vdb_import/import_options.h"

namespace skerry::world {

/// Whether a grid holds block ids: an integer grid, or floats under the name block_id, block_ids,
/// ids or blocks.
bool holds_block_ids(const VolumeGrid& grid);

/// Which grids an import takes when none is named: block ids if there are any, else level sets,
/// else masks, else fog (of several, those whose name begins with "density"). Colours never.
std::vector<std::size_t> importable_grids(const std::vector<VolumeGrid>& grids);

/// Those that the options ask for, in the file's order.
/// Errors: there is none, or none of that name; it has no inside.
Result<std::vector<const VolumeGrid*>> chosen_grids(const std::vector<VolumeGrid>& grids,
                                                    const ImportOptions& options);

}  // namespace skerry::world
