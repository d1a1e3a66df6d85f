// A report's tasks run, and its page.
#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/farm/record.h"
#include "tools/skerry/report/report_tasks.h"
#include "tools/skerry/report/write_topic.h"

namespace skerry::tools {

/// Runs tasks one after another, with a bar and a line a task. @param pictures folder for them.
/// @param keep receives each row. Errors: of a task or of `keep`; what was kept stays.
Result<void> run_tasks(ReportSession& session, std::span<const ReportTask> tasks,
                       const std::filesystem::path& pictures,
                       const std::function<Result<void>(const Record&)>& keep);

/// Writes all of a report to a folder (docs/report.md). @param rows of the plan; where a row's
/// folder is empty, its pictures are in `dir` already. @return the defects it found.
/// Errors: no row at all; a row is damaged; those of reading pictures and of writing.
Result<std::vector<Defect>> write_report(const Plan& plan, const Collected& rows,
                                         const std::filesystem::path& dir);

}  // namespace skerry::tools
