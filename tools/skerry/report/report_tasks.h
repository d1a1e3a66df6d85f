// A report as tasks, each of a topic in a scene, and their rows as records (tools/skerry/farm).
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/farm/record.h"
#include "tools/skerry/report/measure_topic.h"
#include "tools/skerry/report/report_session.h"
#include "tools/skerry/scene/left_out.h"

namespace skerry::tools {

/// What one task measures.
struct ReportTask {
  Task task;                     ///< named "TOPIC/SCENE", or "left_out/FEATURE"
  const Topic* topic = nullptr;  ///< nullptr: kLeftOutTopic
  std::string scene;             ///< or the feature
};

/// All tasks of a report, and why topics were left out of it, a line each.
struct ReportTasks {
  std::vector<ReportTask> tasks;
  std::vector<std::string> left_out;
};

/// Errors: a file that a scene names cannot be read.
Result<ReportTasks> tasks_of(const ReportRequest& request);

/// Measures, and writes the pictures to a folder. @param progress receives 0..1 and what is done.
Result<Record> run_task(ReportSession& session, const ReportTask& task,
                        const std::filesystem::path& pictures,
                        const std::function<void(double, std::string_view)>& progress);

/// A task's rows again; pictures stay files. Errors: the record is not one of run_task.
Result<SceneRows> scene_from(const Record& record, const Topic& topic);
Result<LeftOutRow> left_out_from(const Record& record);

}  // namespace skerry::tools
