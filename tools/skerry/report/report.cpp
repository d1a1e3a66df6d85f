#include "tools/skerry/report/report.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/options.h"
#include "game/scene_file/parse.h"
#include "tools/measure/html.h"
#include "tools/skerry/report/left_out_topic.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/scene/progress.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using measure::element;
using measure::escape;
using measure::labelled;
using nlohmann::ordered_json;

/// What the front page says.
struct Front {
  std::string device, driver, command;
  double seconds = 0.0;
  std::vector<Defect> defects;
  std::vector<std::string> faults;  ///< rows that are missing or contradict each other
  std::string contents, parts;      ///< of the page: its list of topics, and those, as markup
  ordered_json topics = ordered_json::array();

  void add(std::string_view name, std::string_view meaning, const std::string& part,
           ordered_json topic, std::vector<Defect> found) {
    contents += element("li", element("a", {{"href", fmt::format("#{}", name)}}, escape(name)) +
                                  escape(fmt::format(": {}", meaning)));
    parts += part;
    topics.push_back(std::move(topic));
    for (Defect& defect : found) defects.push_back(std::move(defect));
  }
};

std::string front_page(const Plan& plan, const Front& front) {
  std::string out = element("h1", "Error against run time") + "\n";
  out += element("p", element("code", escape(front.command)));
  out += labelled(
      "p", "faint",
      fmt::format("{}, {}. {}, {:.0f} s.", front.device, front.driver, plan.date, front.seconds));
  out += element("p",
                 "Each topic sweeps a setting of the renderer. A setting is on the Pareto front "
                 "when no other is both faster and no worse, or better and no slower; a default "
                 "that is off its front should be changed. FLIP is the difference that a person "
                 "sees when two pictures alternate, 0 to 1.");
  for (const std::string& fault : front.faults) out += labelled("p", "bad", fault) + "\n";
  if (front.defects.empty() && front.faults.empty())
    out += labelled("p", "good", "Every default is on its front.");
  for (const std::string& note : plan.notes) out += labelled("p", "warn", note) + "\n";
  for (const Defect& defect : front.defects)
    out += labelled("p", defect.certain ? "bad" : "warn", defect.text) + "\n";
  return measure::page("Skerry: error against run time",
                       out + element("ul", front.contents) + "\n" + front.parts);
}

Result<void> write_front(const Plan& plan, const Front& front, const fs::path& dir) {
  ordered_json j{{"device", front.device},
                 {"driver", front.driver},
                 {"date", plan.date},
                 {"command", front.command},
                 {"seconds", front.seconds}};
  j["defects"] = ordered_json::array();
  for (const Defect& defect : front.defects)
    j["defects"].push_back({{"text", defect.text}, {"certain", defect.certain}});
  j["faults"] = front.faults;
  j["left_out"] = plan.notes;
  j["topics"] = front.topics;
  if (Result<void> done = write_text(dir / "index.html", front_page(plan, front)); !done)
    return done;
  return write_text(dir / kReportFile,
                    j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

Result<void> copy_pictures(const Topic& topic, const SceneRows& scene, const fs::path& from,
                           const fs::path& to) {
  for (const std::string& file : picture_files(topic, scene)) {
    const Result<std::string> picture =
        platform::read_text(from / file, platform::kMaxPngFileBytes);
    if (!picture) return picture.error();
    if (Result<void> done = write_text(to / file, *picture); !done) return done;
  }
  return {};
}

/// A topic from its rows, if there are any. @param tasks of the topic, in the plan.
Result<void> add_topic(const Topic& topic, std::span<const std::size_t> tasks, const Plan& plan,
                       const Collected& rows, const fs::path& dir, Front& front) {
  std::vector<SceneRows> scenes;
  for (const std::size_t i : tasks) {
    if (!rows.records[i]) continue;
    Result<SceneRows> scene = scene_from(*rows.records[i], topic);
    if (!scene) return scene.error();
    // The name leads to files.
    if (fmt::format("{}/{}", topic.name, scene->scene) != plan.tasks[i].name)
      return Error{
          fmt::format("the row {} is of another scene; run its task again", rows.records[i]->task)};
    if (!rows.folders[i].empty())
      if (Result<void> copied = copy_pictures(topic, *scene, pictures_dir(rows.folders[i]), dir);
          !copied)
        return copied;
    scenes.push_back(*std::move(scene));
  }
  if (scenes.empty()) return {};
  const TopicResult result = over_scenes(topic, std::move(scenes));
  const Result<std::string> part = write_topic(result, dir);
  if (!part) return part.error();
  front.add(topic.name, topic.meaning, *part, topic_json(result), defects_of(result));
  return {};
}

Result<void> add_left_out(std::span<const std::size_t> tasks, const Collected& rows,
                          const fs::path& dir, Front& front) {
  std::vector<LeftOutRow> found;
  for (const std::size_t i : tasks) {
    if (!rows.records[i]) continue;
    Result<LeftOutRow> row = left_out_from(*rows.records[i]);
    if (!row) return row.error();
    found.push_back(*std::move(row));
  }
  if (found.empty()) return {};
  const Result<std::string> part = write_left_out(found, dir);
  if (!part) return part.error();
  front.add(kLeftOutTopic, kLeftOutMeaning, *part, left_out_json(found), defects_of(found));
  return {};
}

std::string_view topic_of(const Task& task) {
  return std::string_view(task.name).substr(0, task.name.find('/'));
}

/// What the page says besides its topics.
Front front_of(const Plan& plan, const Collected& rows) {
  Front front;
  front.command = "skerry " + plan.command;
  for (const std::string& word : plan.arguments) front.command += " " + game::shell_word(word);
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    if (!rows.faults[i].empty())
      front.faults.push_back(fmt::format("{}: {}", plan.tasks[i].name, rows.faults[i]));
    if (!rows.records[i]) continue;
    front.device = rows.records[i]->device;
    front.driver = rows.records[i]->driver;
    front.seconds += measured_number(*rows.records[i], "seconds");
  }
  return front;
}

}  // namespace

Result<void> run_tasks(ReportSession& session, std::span<const ReportTask> tasks,
                       const fs::path& pictures,
                       const std::function<Result<void>(const Record&)>& keep) {
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    Result<Record> record = [&] {
      ProgressBar bar;
      return run_task(session, tasks[t], pictures, [&](double share, std::string_view what) {
        bar.show((static_cast<double>(t) + share) / static_cast<double>(tasks.size()), what);
      });
    }();
    if (!record) return record.error();
    if (Result<void> kept = keep(*record); !kept) return kept;
    fmt::print("{} ({:.1f} s)\n", tasks[t].task.name, measured_number(*record, "seconds"));
    std::fflush(stdout);
  }
  return {};
}

Result<std::vector<Defect>> write_report(const Plan& plan, const Collected& rows,
                                         const fs::path& dir) {
  Front front = front_of(plan, rows);
  for (std::size_t first = 0, next = 0; first < plan.tasks.size(); first = next) {
    const std::string_view name = topic_of(plan.tasks[first]);
    std::vector<std::size_t> tasks;
    for (next = first; next < plan.tasks.size() && topic_of(plan.tasks[next]) == name; ++next)
      tasks.push_back(next);
    const Topic* topic = find_topic(name);
    if (!topic && name != kLeftOutTopic)
      return Error{fmt::format("this program has no topic {}; merge with the one that planned",
                               game::quote_text(name))};
    const Result<void> added = topic ? add_topic(*topic, tasks, plan, rows, dir, front)
                                     : add_left_out(tasks, rows, dir, front);
    if (!added) return added.error();
  }
  if (front.topics.empty()) return Error{"there is no row of this report yet; run its tasks"};
  if (Result<void> done = write_front(plan, front, dir); !done) return done.error();
  return front.defects;
}

}  // namespace skerry::tools
