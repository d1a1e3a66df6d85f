// One grid becomes one island.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/core/jobs.h"
#include "engine/core/result.h"
#include "world/vdb_import/import_cost.h"
#include "world/vdb_import/import_options.h"
#include "world/vdb_import/land.h"
#include "world/vdb_import/placement.h"
#include "world/vdb_import/solid.h"
#include "world/vdb_import/volume_field.h"

namespace skerry::world {

/// A grid that becomes an island, with the look-ups that every step needs.
struct IslandSource {
  IslandSource(const VolumeGrid& grid, const ImportOptions& options);

  const VolumeGrid& grid() const { return field.grid(); }

  VolumeField field;
  SolidRule rule;
  Bounds content;  ///< in index space
};

/// Makes one island. What it is made of must outlive it.
class IslandBuilder {
 public:
  /// @param cost of the import so far, which this island adds to.
  IslandBuilder(const IslandSource& source, const ImportOptions& options, double blocks_per_unit,
                ImportCost& cost, Jobs& jobs);

  /// @param colors of the surface; nullptr: it becomes land.
  Result<ImportedIsland> run(const VolumeField* colors, std::uint64_t id,
                             const ReadProgress& progress);

 private:
  struct Made {
    Chunk chunk = Chunk(kAir);
    std::uint64_t blocks = 0, unknown = 0, looks = 0;
  };

  Result<void> prepare(const ReadProgress& progress);
  void find_box();
  std::vector<IVec3> chunk_list(bool with_plants) const;
  Made make(IVec3 chunk, const Land& land) const;
  Result<void> fill(ImportedIsland& out, const Land& land, const ReadProgress& progress);
  IslandSpec spec_of(std::uint64_t id) const;
  Land land_with(const VolumeField* colors) const;

  const IslandSource& source_;
  const ImportOptions& options_;
  double blocks_per_unit_;
  ImportCost& cost_;
  Jobs& jobs_;
  bool holds_ids_;
  Placement placement_;
  SolidMasks masks_;
  IVec3 low_{}, high_{};  // of solid voxels, inclusive
};

}  // namespace skerry::world
