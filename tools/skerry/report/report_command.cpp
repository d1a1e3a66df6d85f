#include "tools/skerry/report/report_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>

#include "engine/platform/files.h"
#include "game/scene_file/parse.h"
#include "tools/reference/reference.h"
#include "tools/skerry/report/left_out_topic.h"
#include "tools/skerry/report/report.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

std::string topic_list() {
  std::string text = "Topics (default: all):\n";
  for (const Topic& topic : topics())
    text += fmt::format("  {:<18} {}\n", topic.name, topic.meaning);
  text += fmt::format("  {:<18} {}\n", kLeftOutTopic, kLeftOutMeaning);
  return text +
         "Scenes are the topic's own unless --seed, --world, --scene, --cloud or --camera names "
         "one.";
}

/// Whether a scene file, if there is one, says a size. @pre resolve() could read it.
bool file_says_size(const std::optional<std::string>& file) {
  if (!file) return false;
  const Result<std::string> text = platform::read_text(*file, game::kMaxSceneBytes);
  if (!text) return false;
  const Result<game::SceneText> scene = game::parse_scene(*text);
  return scene && scene->size.has_value();
}

std::vector<Task> names_of(const ReportTasks& tasks) {
  std::vector<Task> names;
  for (const ReportTask& one : tasks.tasks) names.push_back(one.task);
  return names;
}

/// How long a task takes against others, roughly: by its points, which are drawn and timed in
/// turns, half a second each on a GPU.
std::size_t effort_of(const ReportTask& task) {
  if (task.topic == nullptr) return 17;  // what is left out opens devices again and again: 8.5 s
  return task.topic->points.size() * (task.topic->loads ? 4 : 1);
}

/// Writes the report, gives it its name and prints what it found.
std::optional<Refusal> publish(const Plan& plan, const Collected& rows, ReportFolder& folder,
                               const std::string& name) {
  const Result<std::vector<Defect>> defects = write_report(plan, rows, folder.path());
  if (!defects) return Refusal{kFailed, defects.error()};
  if (Result<void> done = folder.publish(); !done) return Refusal{kFailed, done.error()};
  for (const Defect& defect : *defects)
    fmt::print("{}: {}\n", defect.certain ? "DEFECT" : "doubtful", defect.text);
  fmt::print("{}\n", (std::filesystem::path(name) / "index.html").string());
  return std::nullopt;
}

}  // namespace

ReportCommand::ReportCommand(CLI::App& app)
    : report_(app.add_subcommand("report", "Report error against run time, setting by setting")) {
  report_->allow_extras();
  report_->footer(topic_list());
  verbs_ = std::make_unique<Verbs>(*report_);
  verbs_->plan().footer(topic_list());
  for (CLI::App* command : {report_, &verbs_->plan()}) add_options(*command);
  for (CLI::App* command : {report_, &verbs_->merge()})
    command->add_option("--out", out_, "Folder for the report")->type_name("DIR");
  for (CLI::App* command : {report_, &verbs_->run()})
    command
        ->add_option("--references", references_,
                     "Folder that keeps references for other runs (run: in the plan's folder)")
        ->type_name("DIR");
  verbs_->plan()
      .add_option("--reference-parts", reference_parts_,
                  "Parts that each reference is drawn in, by any of the processes that need it")
      ->type_name("1..8");
  verbs_->run()
      .add_option("--devices", devices_, "All devices of the best one's kind at once")
      ->type_name("all");
}

/// What decides the rows.
void ReportCommand::add_options(CLI::App& command) {
  command.add_option("topic", topics_, "What to measure (default: everything)")->type_name("TOPIC");
  add_scene_options(command, scene_);
}

std::optional<Refusal> ReportCommand::read_topics(ReportRequest& request) const {
  std::vector<std::string_view> names;
  for (const Topic& topic : topics()) names.push_back(topic.name);
  names.push_back(kLeftOutTopic);
  request.left_out = topics_.empty();
  for (const std::string& name : topics_) {
    if (name == kLeftOutTopic) {
      request.left_out = true;
      continue;
    }
    const Topic* topic = find_topic(name);
    if (!topic)
      return Refusal{kUsage,
                     {fmt::format("there is no topic {}: did you mean '{}'? See skerry report "
                                  "--help",
                                  game::quote_text(name), game::nearest_name(name, names))}};
    if (std::ranges::find(request.topics, topic) == request.topics.end())
      request.topics.push_back(topic);
  }
  if (topics_.empty())
    for (const Topic& topic : topics()) request.topics.push_back(&topic);
  return std::nullopt;
}

std::optional<Refusal> ReportCommand::read(ReportRequest& request, ReportTasks& tasks) const {
  if (auto refusal = read_topics(request)) return refusal;
  if (auto refusal = resolve(scene_, false, request.scene)) return refusal;
  if (auto refusal = check_draws_frames(request.scene)) return refusal;
  if (reference_parts_) {
    const Result<std::int64_t> parts =
        game::parse_integer(*reference_parts_, "--reference-parts", 1, reference::kBatches);
    if (!parts) return usage(parts.error());
    request.reference_parts = static_cast<std::uint32_t>(*parts);
  }
  request.typed = scene_.text;
  if (scene_.renderer) request.typed.settings.push_back("renderer=" + *scene_.renderer);
  if (scene_.shading) request.typed.settings.push_back("shading=" + *scene_.shading);
  request.own_scene = scene_.text.seed || scene_.text.world || scene_.text.camera ||
                      scene_.text.ambient || scene_.scene_file || !scene_.clouds.empty();
  request.own_size = scene_.text.size || file_says_size(scene_.scene_file);
  Result<ReportTasks> found = tasks_of(request);
  if (!found) return Refusal{kFailed, found.error()};
  tasks = *std::move(found);
  for (const std::string& note : tasks.left_out) fmt::print("{}\n", note);
  if (tasks.tasks.empty()) return Refusal{kFailed, {"no topic is left that can be measured here"}};
  return std::nullopt;
}

int ReportCommand::run(std::span<const std::string> typed) {
  const CLI::App* verb = verbs_->chosen();
  if (!verb) return run_here(typed);
  if (const auto refusal = verbs_->check(*verb)) return refuse(*refusal);
  if (verb == &verbs_->plan()) return write_plan(typed);
  return verb == &verbs_->run() ? run_planned() : merge();
}

int ReportCommand::run_here(std::span<const std::string> typed) {
  if (const auto refusal = check_leftovers(*report_)) return refuse(*refusal);
  ReportRequest request;
  ReportTasks tasks;
  if (const auto refusal = read(request, tasks)) return refuse(*refusal);
  if (!out_) return fail(kUsage, {"the report has no place: give --out DIR"});
  Result<ReportFolder> folder = ReportFolder::create(*out_, "--out");
  if (!folder) return fail(kFailed, folder.error());
  Result<std::unique_ptr<gpu::Device>> device = open_device(request.scene);
  if (!device) return fail(kNoDevice, device.error());
  const Plan plan{
      "report", {typed.begin() + 1, typed.end()}, date_now(), names_of(tasks), tasks.left_out};
  request.references = references_;
  ReportSession session(**device, request);
  Collected rows;
  const Result<void> done =
      run_tasks(session, tasks.tasks, folder->path(), [&](const Record& record) {
        rows.records.emplace_back(record);
        return Result<void>();
      });
  if (!done) return fail(kFailed, done.error());
  rows.folders.resize(rows.records.size());
  rows.faults.resize(rows.records.size());
  if (const auto refusal = publish(plan, rows, *folder, *out_)) return refuse(*refusal);
  return status_after(**device);
}

int ReportCommand::write_plan(std::span<const std::string> typed) {
  ReportRequest request;
  ReportTasks tasks;
  if (const auto refusal = read(request, tasks)) return refuse(*refusal);
  if (const auto refusal = verbs_->write(typed, names_of(tasks), tasks.left_out))
    return refuse(*refusal);
  return kDone;
}

/// Runs tasks in this process, on one device, as long as there are any.
int ReportCommand::run_on(const ReportRequest& request, std::span<const ReportTask> tasks,
                          const NextTask& next) const {
  Result<std::unique_ptr<gpu::Device>> device = open_device(request.scene);
  if (!device) return fail(kNoDevice, device.error());
  ReportSession session(**device, request);
  while (const std::optional<std::size_t> task = next()) {
    const Result<void> done =
        run_tasks(session, tasks.subspan(*task, 1), pictures_dir(verbs_->dir()),
                  [&](const Record& record) { return write_record(verbs_->dir(), record); });
    if (!done) return fail(kFailed, done.error());
  }
  return status_after(**device);
}

int ReportCommand::run_planned() {
  Plan plan;
  if (const auto refusal = verbs_->read(plan)) return refuse(*refusal);
  CLI::App app;
  ReportCommand planned(app);
  if (const Result<void> parsed = parse_again(app, plan); !parsed)
    return fail(kFailed, parsed.error());
  if (verbs_->device()) planned.scene_.device = verbs_->device();
  std::vector<std::uint32_t> devices;
  if (devices_)
    if (const auto refusal = parse_devices(devices_, planned.scene_.device, devices))
      return refuse(*refusal);
  ReportRequest request;
  ReportTasks tasks;
  if (const auto refusal = planned.read(request, tasks)) return refuse(*refusal);
  if (const Result<void> same = check_same_tasks(plan, names_of(tasks)); !same)
    return fail(kFailed, same.error());
  std::vector<std::size_t> chosen;
  if (const auto refusal = verbs_->to_run(plan, chosen)) return refuse(*refusal);
  if (chosen.empty()) return kDone;
  if (const Result<void> made = platform::make_dirs(pictures_dir(verbs_->dir())); !made)
    return fail(kFailed, made.error());
  request.references =
      references_ ? std::filesystem::path(*references_) : verbs_->dir() / "references";
  std::vector<ReportTask> wanted;
  for (const std::size_t i : chosen) wanted.push_back(tasks.tasks[i]);
  if (devices.size() < 2) {
    if (!devices.empty()) request.scene.device = devices.front();
    std::size_t next = 0;
    return run_on(request, wanted, [&]() -> std::optional<std::size_t> {
      if (next == wanted.size()) return std::nullopt;
      return next++;
    });
  }
  // The last task to end keeps the other devices waiting: long ones begin first.
  std::ranges::stable_sort(wanted, std::ranges::greater{}, effort_of);
  return run_on_devices(devices, wanted.size(), [&](std::uint32_t device, const NextTask& next) {
    request.scene.device = device;
    return run_on(request, wanted, next);
  });
}

int ReportCommand::merge() {
  if (!out_) return fail(kUsage, {"the report has no place: give --out DIR"});
  Plan plan;
  if (const auto refusal = verbs_->read(plan)) return refuse(*refusal);
  Result<ReportFolder> folder = ReportFolder::create(*out_, "--out");
  if (!folder) return fail(kFailed, folder.error());
  Collected rows;
  if (const auto refusal = verbs_->read_rows(plan, rows)) return refuse(*refusal);
  const bool faults = print_faults(plan, rows);
  if (const auto refusal = publish(plan, rows, *folder, *out_)) return refuse(*refusal);
  return faults ? kFailed : kDone;
}

}  // namespace skerry::tools
