// Imports for tests.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "world/vdb_import/import.h"

namespace skerry::world {

inline std::vector<ImportedIsland> imported(const std::vector<VolumeGrid>& grids,
                                            const ImportOptions& options = {}, int threads = 2) {
  Jobs jobs(threads);
  auto islands = import_islands(grids, options, jobs);
  EXPECT_TRUE(islands) << islands.error().message;
  return islands ? std::move(*islands) : std::vector<ImportedIsland>();
}

inline std::string refusal_of(const std::vector<VolumeGrid>& grids,
                              const ImportOptions& options = {}) {
  Jobs jobs(2);
  const auto islands = import_islands(grids, options, jobs);
  return islands ? "" : islands.error().message;
}

}  // namespace skerry::world
