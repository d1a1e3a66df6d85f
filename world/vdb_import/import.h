// Volumes become islands.
#pragma once
#include <vector>

#include "engine/core/jobs.h"
#include "engine/core/result.h"
#include "world/vdb/volume_grid.h"
#include "world/vdb_import/import_options.h"

namespace skerry::world {

/// Makes one island of each chosen grid. Memory follows bricks, tiles and chunks, never a bounding
/// box. A grid named Cd, color, colour, rgb or albedo decides which block a surface is made of;
/// else slope, depth and height do. Same voxels on every machine and number of threads.
/// @param progress called from this thread with the share that is done.
/// Errors: no such grid, nothing solid, a limit exceeded, a transform out of reach; one line.
Result<std::vector<ImportedIsland>> import_islands(const std::vector<VolumeGrid>& grids,
                                                   const ImportOptions& options, Jobs& jobs,
                                                   const ReadProgress& progress = {});

}  // namespace skerry::world
