#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "engine/core/clock.h"
#include "engine/core/output.h"
#include "tools/measure/html.h"
#include "tools/skerry/report/left_out_topic.h"
#include "tools/skerry/report/measure_topic.h"
#include "tools/skerry/report/report_command.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/report/write_topic.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

using measure::element;
using measure::escape;
using measure::labelled;
using nlohmann::ordered_json;

/// Everything a run has found so far.
struct Run {
  std::string date, device, driver, command;
  double seconds = 0.0;
  std::vector<Defect> defects;
  std::string contents, parts;        ///< of the page: its list of topics, and those, as markup
  std::vector<std::string> left_out;  ///< topics that cannot be measured here, and why
  ordered_json topics = ordered_json::array();

  void add(std::string_view name, std::string_view meaning, const std::string& part,
           ordered_json json, std::vector<Defect> found) {
    contents += element("li", element("a", {{"href", fmt::format("#{}", name)}}, escape(name)) +
                                  escape(fmt::format(": {}", meaning)));
    parts += part;
    topics.push_back(std::move(json));
    for (Defect& defect : found) defects.push_back(std::move(defect));
  }
};

std::string front_page(const Run& run) {
  std::string out = element("h1", "Error against run time") + "\n";
  out += element("p", element("code", escape(run.command)));
  out +=
      labelled("p", "faint",
               fmt::format("{}, {}. {}, {:.0f} s.", run.device, run.driver, run.date, run.seconds));
  out += element("p",
                 "Each topic sweeps a setting of the renderer. A setting is on the Pareto front "
                 "when no other is both faster and no worse, or better and no slower; a default "
                 "that is off its front should be changed. FLIP is the difference that a person "
                 "sees when two pictures alternate, 0 to 1.");
  if (run.defects.empty()) out += labelled("p", "good", "Every default is on its front.");
  for (const std::string& topic : run.left_out) out += labelled("p", "warn", topic) + "\n";
  for (const Defect& defect : run.defects)
    out += labelled("p", defect.certain ? "bad" : "warn", defect.text) + "\n";
  return measure::page("Skerry: error against run time",
                       out + element("ul", run.contents) + "\n" + run.parts);
}

Result<void> write_front(const Run& run, const std::filesystem::path& dir) {
  ordered_json j{{"device", run.device},
                 {"driver", run.driver},
                 {"date", run.date},
                 {"command", run.command},
                 {"seconds", run.seconds}};
  j["defects"] = ordered_json::array();
  for (const Defect& defect : run.defects)
    j["defects"].push_back({{"text", defect.text}, {"certain", defect.certain}});
  j["left_out"] = run.left_out;
  j["topics"] = run.topics;
  if (Result<void> done = write_text(dir / "index.html", front_page(run)); !done) return done;
  return write_text(dir / kReportFile,
                    j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

Result<void> run_topic(ReportSession& session, const Topic& topic, const std::filesystem::path& dir,
                       const std::function<void(double, std::string_view)>& progress, Run& run) {
  Result<TopicResult> result = measure_topic(session, topic, progress);
  if (!result) return result.error();
  const Result<std::string> part = write_topic(*result, dir);
  if (!part) return part.error();
  run.add(topic.name, topic.meaning, *part, topic_json(*result), defects_of(*result));
  return {};
}

Result<void> run_left_out(gpu::Device& device, const std::filesystem::path& dir,
                          const std::function<void(double, std::string_view)>& progress, Run& run) {
  Result<std::vector<LeftOutRow>> rows = measure_left_out_topic(device, progress);
  if (!rows) return rows.error();
  const Result<std::string> part = write_left_out(*rows, dir);
  if (!part) return part.error();
  run.add(kLeftOutTopic, kLeftOutMeaning, *part, left_out_json(*rows), defects_of(*rows));
  return {};
}

/// Those of the topics asked for that can be measured here. Said before any work is done.
std::vector<const Topic*> measurable(const ReportSession& session, Run& run) {
  std::vector<const Topic*> topics;
  for (const Topic* topic : session.request().topics) {
    const std::optional<std::string> why = session.why_not(*topic);
    if (!why) {
      topics.push_back(topic);
      continue;
    }
    run.left_out.push_back(fmt::format("{}: left out: {}", topic->name, *why));
    fmt::print("{}\n", run.left_out.back());
  }
  return topics;
}

/// All that was asked for, with a bar. Prints a line a topic when it is done.
Result<void> run_topics(ReportSession& session, const std::filesystem::path& dir, Run& run) {
  const ReportRequest& request = session.request();
  const std::vector<const Topic*> topics = measurable(session, run);
  const std::size_t count = topics.size() + (request.left_out ? 1 : 0);
  if (count == 0) return Error{"no topic is left that can be measured here"};
  for (std::size_t t = 0; t < count; ++t) {
    const bool left_out = t == topics.size();
    const Stopwatch watch;
    Result<void> done;
    {
      ProgressBar bar;
      const auto progress = [&](double share, std::string_view what) {
        bar.show((static_cast<double>(t) + share) / static_cast<double>(count), what);
      };
      done = left_out ? run_left_out(session.device(), dir, progress, run)
                      : run_topic(session, *topics[t], dir, progress, run);
    }
    if (!done) return done;
    fmt::print("{} ({:.1f} s)\n", left_out ? kLeftOutTopic : topics[t]->name, watch.seconds());
  }
  return {};
}

}  // namespace

int report(const ReportRequest& request) {
  const Stopwatch watch;
  Result<ReportFolder> folder = ReportFolder::create(request.out, "--out");
  if (!folder) return fail(kFailed, folder.error());
  Result<std::unique_ptr<gpu::Device>> device = open_device(request.scene);
  if (!device) return fail(kNoDevice, device.error());
  ReportSession session(**device, request);
  Run run;
  run.date = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  run.device = (*device)->info().name;
  run.driver = (*device)->info().driver;
  run.command = request.command;
  if (Result<void> done = run_topics(session, folder->path(), run); !done)
    return fail(kFailed, done.error());
  run.seconds = watch.seconds();
  if (Result<void> done = write_front(run, folder->path()); !done)
    return fail(kFailed, done.error());
  if (Result<void> done = folder->publish(); !done) return fail(kFailed, done.error());
  for (const Defect& defect : run.defects)
    fmt::print("{}: {}\n", defect.certain ? "DEFECT" : "doubtful", defect.text);
  fmt::print("{}\n", (std::filesystem::path(request.out) / "index.html").string());
  return status_after(**device);
}

}  // namespace skerry::tools
