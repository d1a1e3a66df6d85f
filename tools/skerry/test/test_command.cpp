#include "tools/skerry/test/test_command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <ctime>
#include <set>

#include "engine/core/clock.h"
#include "engine/core/log.h"
#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"
#include "game/scene_file/vdb_options.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/test/compare_folders.h"
#include "tools/skerry/test/page.h"
#include "tools/skerry/test/records.h"
#include "world/vdb/worker.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

bool needs_openvdb(const game::SceneOptions& scene) {
  return !scene.clouds.empty() || (scene.world && game::is_vdb(*scene.world));
}

/// Reads a whole number, if one was given, into `field`.
template <class T>
std::optional<Refusal> read_count(const std::optional<std::string>& text, const char* option,
                                  int most, T& field) {
  if (!text) return std::nullopt;
  const Result<std::int64_t> count = game::parse_integer(*text, option, 1, most);
  if (!count) return usage(count.error());
  field = static_cast<int>(*count);
  return std::nullopt;
}

/// Takes another run of a scene into its row: the first failure stays.
void add_run(Outcome& sum, const Outcome& run) {
  Row row = sum.row.failed() || !run.row.failed() ? sum.row : run.row;
  row.runs = sum.row.runs + run.row.runs;
  row.failed_runs = sum.row.failed_runs + run.row.failed_runs;
  row.seconds = sum.row.seconds + run.row.seconds;
  sum.row = std::move(row);
}

void print_row(const Row& row) {
  if (row.failed() || row.verdict == Verdict::kApproved)
    fmt::print("{}: {}: {}\n", verdict_name(row.verdict), one_line(row.scene),
               one_line(row.explanation()));
}

/// @return how many scenes failed.
std::ptrdiff_t print_summary(const std::vector<Row>& rows, int runs, double seconds) {
  std::ptrdiff_t failed = 0, failed_runs = 0, differing = 0;
  for (const Row& row : rows) {
    failed += row.failed() ? 1 : 0;
    failed_runs += row.failed_runs;
    differing += row.pictures > 1 ? 1 : 0;
    print_row(row);
  }
  fmt::print("{} of {} scenes passed in {:.1f} s\n",
             static_cast<std::ptrdiff_t>(rows.size()) - failed, rows.size(), seconds);
  if (runs > 1) {
    fmt::print("{} runs of each: {} failed; {} scenes gave more than one picture\n", runs,
               failed_runs, differing);
  }
  return failed;
}

}  // namespace

TestCommand::TestCommand(CLI::App& app)
    : test_(app.add_subcommand("test", "Draw scenes and compare them with their references")) {
  test_->allow_extras();
  test_->footer("");
  verbs_ = std::make_unique<Verbs>(*test_);
  approve_command_ = std::make_unique<ApproveCommand>(*test_);
  add_drawing_options(*test_);
  add_drawing_options(verbs_->plan());
  add_output_options(*test_);
  add_output_options(verbs_->merge());
  add_jobs(*test_);
  add_jobs(verbs_->run());
  test_->add_flag("--approve", approve_, "Make the pictures the references");
  test_->add_option("--shard", shard_text_, "Only each N-th scene, from the I-th on")
      ->type_name("I/N");
  test_->add_flag("--merge", merge_, "SCENES are the --json files of all shards: join them");
  test_->add_flag("--compare", compare_,
                  "SCENES are two folders of PNG files, references first: compare them");
  test_
      ->add_option("--tolerance", tolerance_text_,
                   "Of --compare, as in a scene file (docs/settings.md)")
      ->type_name("JSON");
  test_->add_option("--device", device_text_, "Vulkan device, as 'skerry devices' counts")
      ->type_name("N");
}

/// What decides the rows.
void TestCommand::add_drawing_options(CLI::App& command) {
  command.add_option("SCENES", paths_, "Scene files, or folders of them (docs/testing.md)");
  command
      .add_option("--baseline", baseline_,
                  "References and hashes are here, a folder a driver, not beside the scenes")
      ->type_name("DIR|FILE.tar");
  command.add_option("--repeat", repeat_text_, "Draw every scene so many times (default 1)")
      ->type_name("N");
  command.add_flag("--validate", validate_, "Turn the Vulkan validation layer on");
}

void TestCommand::add_output_options(CLI::App& command) {
  command.add_option("--html", html_, "Write a report with pictures")->type_name("DIR");
  command.add_option("--json", json_, "Write the rows as JSON")->type_name("FILE");
  command.add_option("--junit", junit_, "Write the rows as JUnit XML")->type_name("FILE");
  command
      .add_option("--history", history_path_,
                  "Add the rows to those of earlier runs, which the report shows")
      ->type_name("FILE");
}

void TestCommand::add_jobs(CLI::App& command) {
  command
      .add_option("--jobs", jobs_text_,
                  "Processes that draw, a device (default: one a core on a CPU, else one)")
      ->type_name("N");
  command.add_option("--devices", devices_text_, "All devices of the best one's kind at once")
      ->type_name("all");
}

int TestCommand::run(std::span<const std::string> typed) {
  if (approve_command_->command().parsed()) {
    const auto refusal = verbs_->check(approve_command_->command());
    return refusal ? refuse(*refusal) : approve_command_->run();
  }
  const CLI::App* verb = verbs_->chosen();
  if (!verb) {
    if (const auto refusal = check_leftovers(*test_)) return refuse(*refusal);
    if (const auto refusal = check_typed()) return refuse(*refusal);
    if (compare_) return compare_pictures();
    return merge_ ? merge_shards() : draw_and_judge();
  }
  if (const auto refusal = verbs_->check(*verb)) return refuse(*refusal);
  if (verb == &verbs_->plan()) return write_plan(typed);
  return verb == &verbs_->run() ? run_tasks() : merge_rows();
}

std::optional<Refusal> TestCommand::check_typed() {
  if (paths_.empty()) {
    return Refusal{merge_ ? kUsage : kFailed,
                   {"there is nothing to test: give scene files or folders of them"}};
  }
  const bool draws = approve_ || shard_text_ || device_text_ || devices_text_ || jobs_text_ ||
                     baseline_ || repeat_text_ || validate_;
  if ((merge_ || compare_) && draws) {
    return usage({fmt::format("{} draws nothing: leave out the options that say how to draw",
                              merge_ ? "--merge" : "--compare")});
  }
  if (merge_ && compare_) return usage({"--merge and --compare exclude each other: leave out one"});
  if (compare_ && paths_.size() != 2)
    return usage({"--compare needs two folders: the references, and what is judged"});
  if (tolerance_text_ && !compare_)
    return usage({"--tolerance is for --compare: a scene states its own"});
  if (shard_text_) {
    const Result<Shard> shard = parse_shard(*shard_text_);
    if (!shard) return usage(shard.error());
    shard_ = *shard;
  }
  if (const auto refusal = read_count(jobs_text_, "--jobs", 1024, pool_.processes)) return refusal;
  if (const auto refusal = read_count(repeat_text_, "--repeat", 100000, pool_.runs)) return refusal;
  if (const auto refusal = parse_devices(devices_text_, device_text_, pool_.devices))
    return refusal;
  if (approve_ && pool_.runs > 1) return usage({"--approve needs one run: leave out --repeat"});
  if (baseline_) {
    Result<Baseline> opened = Baseline::open(*baseline_, approve_);
    if (!opened) return usage(opened.error());
    opened_baseline_.emplace(*std::move(opened));
  }
  pool_.validate = validate_;
  pool_.judge.approve = approve_;
  return std::nullopt;
}

/// Before any work is done.
std::optional<Refusal> TestCommand::check_outputs() {
  if (html_) {
    std::error_code code;
    const fs::path above = fs::absolute(fs::path(*html_) / "..", code).lexically_normal();
    if (const auto made = platform::make_dirs(above); !made) return usage(made.error());
    auto report = ReportFolder::create(*html_, "--html");
    if (!report) return usage(report.error());
    report_.emplace(*std::move(report));
    pool_.judge.html = report_->path();
  }
  if (history_path_) {
    Result<History> history = History::open(*history_path_);
    if (!history) return usage(history.error());
    history_.emplace(*std::move(history));
  }
  if (auto refusal = check_output(json_)) return refusal;
  return check_output(junit_);
}

std::optional<Refusal> TestCommand::read_set(std::vector<TestScene>& scenes,
                                             std::size_t& in_set) const {
  const Result<std::vector<fs::path>> files = find_scenes(paths_);
  if (!files) return Refusal{kFailed, files.error()};
  for (const fs::path& file : *files) {
    Result<TestScene> scene = read_scene(file);
    if (!scene) return usage(scene.error());
    if (needs_openvdb(scene->scene) && !world::has_openvdb()) {
      fmt::print("skipped: {}: this build has no OpenVDB\n", one_line(scene->name));
      continue;
    }
    if (opened_baseline_) {
      scene->baseline = opened_baseline_->folder();
      scene->unpacked = opened_baseline_->unpacked();
    }
    scenes.push_back(*std::move(scene));
  }
  in_set = scenes.size();
  if (in_set == 0) return Refusal{kFailed, {"no scene is left that this build can draw"}};
  scenes = shard_of(std::move(scenes), shard_);
  if (!scenes.empty()) return std::nullopt;
  return Refusal{kFailed,
                 {fmt::format("shard {}/{} holds none of {} scenes: use fewer shards", shard_.index,
                              shard_.count, in_set)}};
}

/// Draws scenes. @param finished is told each scene's outcome over all runs; an error ends all.
PoolResult TestCommand::draw(
    const std::vector<TestScene>& scenes,
    const std::function<Result<void>(std::size_t, const Outcome&)>& finished) const {
  std::vector<std::optional<Outcome>> seen(scenes.size());
  std::vector<std::set<std::string>> pictures(scenes.size());
  std::size_t done = 0;
  std::optional<Error> failure;
  ProgressBar bar;
  PoolResult end = run_pool(scenes, pool_, [&](std::size_t index, const Outcome& outcome) {
    if (!outcome.hash.empty()) pictures[index].insert(outcome.hash);
    if (seen[index]) {
      add_run(*seen[index], outcome);
    } else {
      seen[index] = outcome;
    }
    const double all = static_cast<double>(scenes.size()) * pool_.runs;
    bar.show(static_cast<double>(++done) / all, scenes[index].name);
    if (seen[index]->row.runs < pool_.runs) return;
    seen[index]->row.pictures = static_cast<int>(pictures[index].size());
    if (Result<void> kept = finished(index, *seen[index]); !kept && !failure)
      failure = kept.error();
  });
  if (failure && !end.refusal) end.refusal = Refusal{kFailed, *failure};
  return end;
}

/// Of scenes that were approved, until one fails. An archive keeps those before it, as a folder
/// does.
Result<void> TestCommand::store_approved(std::span<const TestScene> scenes,
                                         std::span<const Outcome> outcomes) const {
  Result<void> stored;
  for (std::size_t i = 0; i < scenes.size() && stored; ++i)
    if (outcomes[i].row.verdict == Verdict::kApproved) stored = store_hash(scenes[i], outcomes[i]);
  if (opened_baseline_)
    if (Result<void> saved = opened_baseline_->save(); !saved) return saved;
  return stored;
}

int TestCommand::draw_and_judge() {
  Results results;
  results.shard = shard_;
  std::vector<TestScene> scenes;
  if (const auto refusal = read_set(scenes, results.scenes_in_set)) return refuse(*refusal);
  if (const auto refusal = check_outputs()) return refuse(*refusal);

  if (history_)
    for (const TestScene& scene : scenes)
      pool_.expected_s.push_back(history_->seconds_of(scene.name));
  const Stopwatch watch;
  std::vector<Outcome> outcomes(scenes.size());
  const PoolResult end = draw(scenes, [&](std::size_t scene, const Outcome& outcome) {
    outcomes[scene] = outcome;
    return Result<void>();
  });
  if (end.refusal) return refuse(*end.refusal);
  for (const Outcome& outcome : outcomes) {
    Result<Row> row = row_of(record_of(outcome.row, {}));
    if (!row) return fail(kFailed, row.error());
    results.rows.push_back(*std::move(row));
  }
  if (approve_)
    if (const Result<void> stored = store_approved(scenes, outcomes); !stored)
      return fail(kFailed, stored.error());
  const std::ptrdiff_t failed = print_summary(results.rows, pool_.runs, watch.seconds());
  if (const Result<void> written = write_outputs(std::move(results)); !written)
    return fail(kFailed, written.error());
  if (end.validation_messages > 0) {
    fail(kValidationMessage,
         {fmt::format("{} validation messages were printed above; this is a bug in Skerry or the "
                      "driver",
                      end.validation_messages)});
  }
  if (failed > 0) return kFailed;
  return end.validation_messages > 0 ? kValidationMessage : kDone;
}

/// @param date of the run, if it was an earlier one that may be in the history already.
Result<void> TestCommand::write_outputs(Results results, const std::optional<std::string>& date) {
  if (history_) {
    const std::string now =
        date.value_or(fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::time(nullptr))));
    for (const Row& row : results.rows)
      date ? history_->add_new(past_run(row, now)) : history_->add(past_run(row, now));
  }
  const auto json_text = [&] {
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    return results_json(results).dump(2, ' ', false, replace) + "\n";
  };
  Outputs files;
  if (junit_)
    if (auto added = files.add(*junit_, junit_xml(results)); !added) return added;
  if (report_) {
    const std::string page = test_page(results, report_->path(), history_ ? &*history_ : nullptr);
    if (auto done = write_text(report_->path() / "index.html", page); !done) return done;
    results.html = ".";
    if (auto done = write_text(report_->path() / kReportFile, json_text()); !done) return done;
  }
  if (json_) {
    std::error_code code;
    const fs::path base = fs::absolute(*json_, code).parent_path();
    if (html_) results.html = fs::relative(fs::absolute(*html_, code), base, code).string();
    if (auto added = files.add(*json_, json_text()); !added) return added;
  }
  if (report_)
    if (auto done = report_->publish(); !done) return done;
  if (auto done = files.publish(); !done) return done;
  return history_ ? history_->append() : Result<void>();
}

/// Brings the pictures of the shards' reports together. @param shards in the order of the files.
Result<void> TestCommand::copy_pictures(const std::vector<Results>& shards) const {
  for (std::size_t i = 0; i < shards.size(); ++i) {
    const fs::path from = fs::path(paths_[i]).parent_path() / shards[i].html;
    std::error_code code;
    if (shards[i].html.empty() || !fs::is_directory(from, code)) {
      return Error{
          fmt::format("cannot find the pictures of {}: give its shard --html, and keep the "
                      "folder where it was beside the file",
                      game::quote_text(paths_[i]))};
    }
    for (const Row& row : shards[i].rows)
      if (const auto copied = copy_pictures_of(row.scene, from); !copied) return copied;
  }
  return {};
}

/// Those of a scene that a folder has.
Result<void> TestCommand::copy_pictures_of(const std::string& scene, const fs::path& from) const {
  // Names come from a file, and must not lead out of the folders.
  if (fs::path(scene).filename() != scene) return {};
  std::error_code code;
  for (const ReportPicture kind : kReportPictures) {
    const std::string name = report_picture_name(scene, kind);
    if (!fs::exists(from / name, code)) continue;
    const auto picture = platform::read_text(from / name, platform::kMaxPngFileBytes);
    if (!picture) return picture.error();
    if (const auto copied = write_text(report_->path() / name, *picture); !copied) return copied;
  }
  return {};
}

int TestCommand::merge_shards() {
  std::vector<Results> shards;
  for (const std::string& path : paths_) {
    Result<Results> part = read_results(path);
    if (!part) return fail(kFailed, part.error());
    shards.push_back(*std::move(part));
  }
  Result<Results> merged = merge(shards);
  if (!merged) return fail(kFailed, merged.error());
  if (const auto refusal = check_outputs()) return refuse(*refusal);
  if (html_) {
    if (const auto copied = copy_pictures(shards); !copied) return fail(kFailed, copied.error());
  }
  double seconds = 0.0;
  int runs = 1;
  for (const Row& row : merged->rows) {
    seconds += row.seconds;
    runs = std::max(runs, row.runs);
  }
  const std::ptrdiff_t failed = print_summary(merged->rows, runs, seconds);
  if (const auto written = write_outputs(*std::move(merged)); !written)
    return fail(kFailed, written.error());
  return failed > 0 ? kFailed : kDone;
}

int TestCommand::compare_pictures() {
  game::Expectations expected;
  if (tolerance_text_) {
    const Result<nlohmann::json> text = game::parse_json(*tolerance_text_);
    if (!text) return fail(kUsage, Error{"--tolerance " + text.error().message});
    if (const auto read = game::read_expectation("tolerance", *text, expected); !read)
      return fail(kUsage, read.error());
  }
  if (const auto refusal = check_outputs()) return refuse(*refusal);
  const Stopwatch watch;
  Result<std::vector<Row>> rows =
      compare_folders({paths_[0], paths_[1], expected, pool_.judge.html});
  if (!rows) return fail(kFailed, rows.error());
  Results results;
  results.scenes_in_set = rows->size();
  results.rows = *std::move(rows);
  const std::ptrdiff_t failed = print_summary(results.rows, 1, watch.seconds());
  if (const Result<void> written = write_outputs(std::move(results)); !written)
    return fail(kFailed, written.error());
  return failed > 0 ? kFailed : kDone;
}

int TestCommand::write_plan(std::span<const std::string> typed) {
  if (const auto refusal = check_typed()) return refuse(*refusal);
  std::vector<TestScene> scenes;
  std::size_t in_set = 0;
  if (const auto refusal = read_set(scenes, in_set)) return refuse(*refusal);
  const Result<std::vector<Task>> tasks = tasks_of(scenes, pool_);
  if (!tasks) return fail(kFailed, tasks.error());
  if (const auto refusal = verbs_->write(typed, *tasks)) return refuse(*refusal);
  return kDone;
}

/// The scenes of a plan, and how to draw them. Errors: something has changed since.
std::optional<Refusal> TestCommand::read_planned(const Plan& plan, std::vector<TestScene>& scenes) {
  CLI::App app;
  TestCommand planned(app);
  if (Result<void> parsed = parse_again(app, plan); !parsed)
    return Refusal{kFailed, parsed.error()};
  planned.device_text_ = verbs_->device();
  planned.devices_text_ = devices_text_;
  planned.jobs_text_ = jobs_text_;
  if (auto refusal = planned.check_typed()) return refusal;
  std::size_t in_set = 0;
  if (auto refusal = planned.read_set(scenes, in_set)) return refusal;
  const Result<std::vector<Task>> tasks = tasks_of(scenes, planned.pool_);
  if (!tasks) return Refusal{kFailed, tasks.error()};
  if (Result<void> same = check_same_tasks(plan, *tasks); !same)
    return Refusal{kFailed, same.error()};
  pool_ = planned.pool_;
  if (planned.opened_baseline_)  // the scenes' references are there
    opened_baseline_.emplace(*std::move(planned.opened_baseline_));
  return std::nullopt;
}

int TestCommand::run_tasks() {
  Plan plan;
  if (const auto refusal = verbs_->read(plan)) return refuse(*refusal);
  std::vector<TestScene> scenes;
  if (const auto refusal = read_planned(plan, scenes)) return refuse(*refusal);
  std::vector<std::size_t> chosen;
  if (const auto refusal = verbs_->to_run(plan, chosen)) return refuse(*refusal);
  if (chosen.empty()) return kDone;
  pool_.judge.html = pictures_dir(verbs_->dir());
  if (const Result<void> made = platform::make_dirs(*pool_.judge.html); !made)
    return fail(kFailed, made.error());
  std::vector<TestScene> wanted;
  for (const std::size_t i : chosen) wanted.push_back(scenes[i]);
  const PoolResult end = draw(wanted, [&](std::size_t scene, const Outcome& outcome) {
    return write_record(verbs_->dir(), record_of(outcome.row, plan.tasks[chosen[scene]].id));
  });
  if (end.refusal) return refuse(*end.refusal);
  fmt::print("{} tasks run\n", wanted.size());
  if (end.validation_messages == 0) return kDone;
  return fail(kValidationMessage,
              {fmt::format("{} validation messages were printed above", end.validation_messages)});
}

int TestCommand::merge_rows() {
  Plan plan;
  if (const auto refusal = verbs_->read(plan)) return refuse(*refusal);
  if (const auto refusal = check_outputs()) return refuse(*refusal);
  Collected rows;
  if (const auto refusal = verbs_->read_rows(plan, rows)) return refuse(*refusal);
  Results results;
  results.scenes_in_set = plan.tasks.size();
  double seconds = 0.0;
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    Result<Row> row = rows.records[i] ? row_of(*rows.records[i]) : Row{};
    if (!row) return fail(kFailed, row.error());
    row->scene = plan.tasks[i].name;
    if (!rows.faults[i].empty()) {
      row->verdict = Verdict::kFail;
      row->message = rows.faults[i];
    }
    seconds += row->seconds;
    results.rows.push_back(*std::move(row));
    if (!html_ || !rows.records[i]) continue;
    const auto copied = copy_pictures_of(plan.tasks[i].name, pictures_dir(rows.folders[i]));
    if (!copied) return fail(kFailed, copied.error());
  }
  int runs = 1;
  for (const Row& row : results.rows) runs = std::max(runs, row.runs);
  const std::ptrdiff_t failed = print_summary(results.rows, runs, seconds);
  if (const Result<void> written = write_outputs(std::move(results), plan.date); !written)
    return fail(kFailed, written.error());
  return failed > 0 ? kFailed : kDone;
}

}  // namespace skerry::tools
