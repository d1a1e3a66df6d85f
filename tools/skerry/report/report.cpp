#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "engine/core/clock.h"
#include "engine/platform/files.h"
#include "tools/measure/html.h"
#include "tools/skerry/progress_bar.h"
#include "tools/skerry/report/measure_topic.h"
#include "tools/skerry/report/report_command.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/report/write_topic.h"
#include "tools/skerry/scene_device.h"

namespace skerry::tools {
namespace {

using measure::element;
using measure::escape;
using measure::labelled;
using nlohmann::ordered_json;

/// Everything about a run that is no topic's.
struct Run {
  std::string date, device, driver, command;
  double seconds = 0.0;
  std::vector<Defect> defects;
};

std::string front_page(const Run& run, std::span<const Topic* const> topics,
                       const std::string& parts) {
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
  if (run.defects.empty())
    out += labelled("p", "good", "Every default is on its front.");
  else
    for (const Defect& defect : run.defects)
      out += labelled("p", defect.certain ? "bad" : "warn", defect.text) + "\n";
  std::string links;
  for (const Topic* topic : topics) {
    const std::string target = fmt::format("#{}", topic->name);
    const measure::Attribute link{"href", target};
    links += element("li", element("a", {&link, 1}, escape(topic->name)) +
                               escape(fmt::format(": {}", topic->meaning)));
  }
  return measure::page("Skerry: error against run time", out + element("ul", links) + "\n" + parts);
}

Result<void> write_front(const Run& run, const ReportRequest& request, const std::string& parts,
                         ordered_json topics_json, const std::filesystem::path& dir) {
  ordered_json j{{"device", run.device},   {"driver", run.driver},   {"date", run.date},
                 {"command", run.command}, {"seconds", run.seconds}, {"defects", {}}};
  j["defects"] = ordered_json::array();
  for (const Defect& defect : run.defects)
    j["defects"].push_back({{"text", defect.text}, {"certain", defect.certain}});
  j["topics"] = std::move(topics_json);
  if (Result<void> done =
          platform::write_text(dir / "index.html", front_page(run, request.topics, parts));
      !done)
    return done;
  return platform::write_text(dir / kReportFile,
                              j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

void print_topic(const TopicResult& result, double seconds) {
  fmt::print("{} ({:.1f} s)\n", result.topic->name, seconds);
  for (const PointRow& row : result.rows)
    fmt::print("  {:<16} {:>10.3f} ms ({:.3f} to {:.3f})  FLIP {:.5f}{}{}\n", row.point->label,
               row.ms.median, row.ms.p10, row.ms.p90, row.errors.flip_mean,
               row.defaults.empty() ? "" : "  default of ", fmt::join(row.defaults, ", "));
}

}  // namespace

int report(const ReportRequest& request) {
  const Stopwatch watch;
  Result<ReportFolder> folder = ReportFolder::create(request.out);
  if (!folder) return fail(kFailed, folder.error());
  Result<std::unique_ptr<gpu::Device>> device = open_device(request.scene);
  if (!device) return fail(kNoDevice, device.error());
  ReportSession session(**device, request);
  Run run{fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr))),
          (*device)->info().name,
          (*device)->info().driver,
          request.command,
          0.0,
          {}};
  std::string parts;
  ordered_json topics_json = ordered_json::array();
  ProgressBar bar;
  for (std::size_t t = 0; t < request.topics.size(); ++t) {
    const Stopwatch topic_watch;
    Result<TopicResult> result =
        measure_topic(session, *request.topics[t], [&](double share, std::string_view what) {
          bar.show((static_cast<double>(t) + share) / static_cast<double>(request.topics.size()),
                   what);
        });
    bar.clear();
    if (!result) return fail(kFailed, result.error());
    Result<std::string> part = write_topic(*result, folder->path());
    if (!part) return fail(kFailed, part.error());
    parts += *part;
    topics_json.push_back(topic_json(*result));
    for (Defect& defect : defects_of(*result)) run.defects.push_back(std::move(defect));
    print_topic(*result, topic_watch.seconds());
  }
  run.seconds = watch.seconds();
  if (Result<void> done = write_front(run, request, parts, std::move(topics_json), folder->path());
      !done)
    return fail(kFailed, done.error());
  if (Result<void> done = folder->publish(); !done) return fail(kFailed, done.error());
  for (const Defect& defect : run.defects) fmt::print("DEFECT {}\n", defect.text);
  fmt::print("{}\n", (std::filesystem::path(request.out) / "index.html").string());
  return status_after(**device);
}

}  // namespace skerry::tools
