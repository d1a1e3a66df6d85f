// Which grids of a file become islands.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "world/vdb/volume_grid.h"
#include "world/vdb_import/import_options.h"

namespace skerry::world {

/// Whether a grid holds block ids: an integer grid, or floats under the name block_id, block_ids,
/// ids or blocks.
bool holds_block_ids(const VolumeGrid& grid);

/// What a grid is to an import that names none, best first: all grids of the best sort that a file
/// has are taken. What name and class say of a grid counts before what its type allows: simulations
/// keep obstacles and labels as integers and masks beside their smoke.
enum class GridSort : std::uint8_t {
  kBlockIds,   ///< by its name
  kLevelSet,   ///< by its class
  kDensity,    ///< by its name
  kFogVolume,  ///< by its class
  kMask,
  kIntegers,
  kOtherValues,
  kObstacle,  ///< by its name, whatever else it is
  kHeat,      ///< by its name; never taken unless named, like those below
  kEmpty,     ///< no value differs from the background
  kNoInside,  ///< colours, and what is not held
};
GridSort sort_of(const VolumeGrid& grid);
/// Why a grid is of its sort: "its name says density".
std::string_view reason_of(GridSort sort);

/// Which grids an import takes when none is named.
std::vector<std::size_t> importable_grids(const std::vector<VolumeGrid>& grids);

/// One line, without the file's name, that says which grids are taken, which are not, and why:
/// names, classes, active voxels. Empty: there was nothing to choose, or the options chose.
std::string choice_line(const std::vector<VolumeGrid>& grids, const ImportOptions& options);

/// Those that the options ask for, in the file's order.
/// Errors: there is none, or none of that name; it has no inside.
Result<std::vector<const VolumeGrid*>> chosen_grids(const std::vector<VolumeGrid>& grids,
                                                    const ImportOptions& options);

}  // namespace skerry::world
