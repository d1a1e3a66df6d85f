// Stability cases as tasks, and their rows as records (tools/skerry/farm).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/farm/record.h"
#include "tools/skerry/stability/run.h"

namespace skerry::tools::stability {

/// One task a case. Errors: as task_id.
Result<std::vector<Task>> tasks_of(std::span<const Case> cases, bool validate);

/// Runs a case. @param device as for run_cases; the record names it if the case needs one.
Record run_case(const Case& one, const std::string& task, gpu::Device* device);

/// The rows again. Errors: the record is not of run_case.
Result<std::vector<Outcome>> outcomes_from(const Record& record);

}  // namespace skerry::tools::stability
