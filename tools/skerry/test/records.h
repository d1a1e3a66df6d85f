// Scenes of a test as tasks, and their rows as records (tools/skerry/farm).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/farm/record.h"
#include "tools/skerry/test/pool_options.h"
#include "tools/skerry/test/scene_set.h"

namespace skerry::tools {

/// One task a scene, named as it is. Its inputs are the scene's file and those that it names, the
/// reference, the approved hashes, and how often it is drawn.
/// Errors: a file cannot be read.
Result<std::vector<Task>> tasks_of(std::span<const TestScene> scenes, const PoolOptions& options);

/// A row as a record, which says the driver as row_of's driver key, and again.
/// Errors of the second: it is not of record_of.
Record record_of(const Row& row, const std::string& task);
Result<Row> row_of(const Record& record);

}  // namespace skerry::tools
