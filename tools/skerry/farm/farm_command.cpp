#include "tools/skerry/farm/farm_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <system_error>

#include "engine/core/log.h"
#include "engine/core/output.h"
#include "engine/core/output_place.h"
#include "engine/platform/files.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/farm/programs.h"
#include "tools/skerry/farm/record.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// Slurm's own limit is 1001 unless the cluster says otherwise (MaxArraySize).
constexpr std::size_t kUsualMostJobs = 1000;
constexpr std::size_t kNamedAtMost = 20;

/// Runs one of Slurm's programs. Errors: it is not there or fails; one line with what it said.
Result<std::string> ask_slurm(std::vector<std::string> words, std::string_view what_to_do) {
  const std::string program = words.front();
  const Result<ProgramEnd> end = run_program(std::move(words));
  if (!end)
    return Error{end.error().message + "; use a machine from which jobs of Slurm are submitted"};
  if (end->status == 0) return end->out;
  const std::string said = last_line(end->err);
  return Error{fmt::format("{} failed: {}; {}", program,
                           said.empty() ? fmt::format("exit status {}", end->status) : said,
                           what_to_do)};
}

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code code;
    std::string name = (fs::temp_directory_path(code) / "skerry_plan_XXXXXX").string();
    if (!code && ::mkdtemp(name.data())) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code code;
    if (!path_.empty()) fs::remove_all(path_, code);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  /// Empty: it could not be made.
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Makes the plan again, as each job will, so that what keeps all jobs from running is said before
/// there are any.
Result<void> check_plan(const fs::path& program, const Plan& plan) {
  const TemporaryFolder folder;
  if (folder.path().empty())
    return Error{"cannot make a temporary folder; check TMPDIR and the disk"};
  std::vector<std::string> words{program.string(), plan.command, "plan", "--dir",
                                 folder.path().string()};
  words.insert(words.end(), plan.arguments.begin(), plan.arguments.end());
  const Result<ProgramEnd> end = run_program(std::move(words));
  if (!end) return end.error();
  if (end->status != 0)
    return Error{fmt::format("the plan cannot be made again here: {}; submit where it was made",
                             last_line(end->err))};
  const Result<Plan> again = read_plan(folder.path(), plan.command);
  if (!again) return again.error();
  return check_same_tasks(plan, again->tasks);
}

/// Jobs that have a task among `missing`.
std::vector<std::size_t> jobs_of(std::span<const std::size_t> missing, std::size_t count) {
  std::set<std::size_t> jobs;
  for (const std::size_t task : missing) jobs.insert(job_of(task, count));
  return {jobs.begin(), jobs.end()};
}

/// Copies a file, so that it is whole or not there.
Result<void> copy_whole(const fs::path& from, const fs::path& to) {
  const Result<std::string> bytes = platform::read_text(from, platform::kMaxPngFileBytes);
  if (!bytes) return bytes.error();
  return write_text(to, *bytes);
}

Result<void> copy_files(const fs::path& from, const fs::path& to) {
  std::error_code code;
  if (!fs::exists(from, code) && !code) return {};
  if (Result<void> made = platform::make_dirs(to); !made) return made;
  fs::directory_iterator file(from, code);
  for (; !code && file != fs::directory_iterator(); file.increment(code)) {
    // A row or a picture that is being written has another name until it is whole.
    if (!file->is_regular_file(code) || file->path().filename().string().starts_with(".")) continue;
    const std::string ending = file->path().extension().string();
    if (ending != ".json" && ending != ".png") continue;
    if (Result<void> done = copy_whole(file->path(), to / file->path().filename()); !done)
      return done;
  }
  if (!code) return {};
  return Error{fmt::format("cannot read the folder {}: {}; check it and fetch again",
                           quoted_path(from), code.message())};
}

/// Where the tasks of a plan are.
struct Progress {
  std::vector<std::size_t> running, waiting, failed, idle;
};

Progress progress_of(std::span<const std::size_t> missing, const Submitted& submitted,
                     const Queue& queue) {
  Progress out;
  const auto has = [](const std::vector<std::size_t>& jobs, std::size_t job) {
    return std::ranges::find(jobs, job) != jobs.end();
  };
  for (const std::size_t task : missing) {
    const std::size_t job = submitted.array.empty() ? 0 : job_of(task, submitted.count);
    if (has(queue.running, job)) {
      out.running.push_back(task);
    } else if (has(queue.waiting, job)) {
      out.waiting.push_back(task);
    } else if (has(submitted.jobs, job)) {
      out.failed.push_back(task);
    } else {
      out.idle.push_back(task);
    }
  }
  return out;
}

}  // namespace

FarmCommand::FarmCommand(CLI::App& app)
    : farm_(app.add_subcommand("farm", "Run the tasks of a plan as jobs of Slurm")),
      submit_(add("submit", "Submit the tasks of DIR that have no row, and a job that merges")),
      status_(add("status", "Count tasks that have rows, run, wait and failed")),
      fetch_(add("fetch", "Copy the rows of DIR to a folder, and merge them there")) {
  farm_->require_subcommand(1, 1);
  farm_->footer("DIR is what skerry test, report or stability plan --dir made (docs/farm.md).");
  submit_->add_option("--tasks-per-job", tasks_text_, "Default: so many that 1000 jobs suffice")
      ->type_name("N");
  submit_->add_option("--time", request_.time, "Limit of a job, as sbatch takes it")
      ->type_name("TIME");
  submit_->add_option("--gres", request_.gres, "What a job needs of a node, such as gpu:1")
      ->type_name("LIST");
  submit_->add_option("--partition", request_.partition, "Where jobs run")->type_name("NAME");
  submit_->add_option("--constraint", request_.constraint, "Features of the nodes of all jobs")
      ->type_name("FEATURE");
  submit_->add_option("--cpus", cpus_text_, "Processors of a job (default 1)")->type_name("N");
  submit_->add_flag("--dry-run", dry_run_, "Print the scripts and submit nothing");
  fetch_->add_option("--to", to_, "Folder for copies (default: merge in DIR)")->type_name("FOLDER");
}

CLI::App* FarmCommand::add(const char* name, const char* description) {
  CLI::App* command = farm_->add_subcommand(name, description);
  command->allow_extras();
  command->footer("");
  command->add_option("DIR", dir_text_, "Folder of a plan and of its rows")->required();
  return command;
}

int FarmCommand::run() {
  for (const CLI::App* command : {submit_, status_, fetch_})
    if (command->parsed())
      if (const auto refusal = check_leftovers(*command)) return refuse(*refusal);
  if (const auto refusal = read()) return refuse(*refusal);
  if (submit_->parsed()) return submit();
  return status_->parsed() ? status() : fetch();
}

/// The plan and what there is of it.
std::optional<Refusal> FarmCommand::read() {
  std::error_code code;
  dir_ = fs::absolute(dir_text_, code).lexically_normal();
  if (!dir_.has_filename()) dir_ = dir_.parent_path();
  Result<Plan> plan = read_plan(dir_, {});
  if (!plan) return Refusal{kFailed, plan.error()};
  plan_ = *std::move(plan);
  for (std::size_t task = 0; task < plan_.tasks.size(); ++task)
    if (!fs::exists(record_file(dir_, plan_.tasks[task].id), code)) missing_.push_back(task);
  Result<Submitted> submitted = read_submitted(dir_);
  if (!submitted) return Refusal{kFailed, submitted.error()};
  submitted_ = *std::move(submitted);
  return std::nullopt;
}

std::optional<Refusal> FarmCommand::read_submit() {
  if (tasks_text_) {
    const auto tasks = game::parse_integer(*tasks_text_, "--tasks-per-job", 1, 1'000'000);
    if (!tasks) return Refusal{kUsage, tasks.error()};
    tasks_per_job_ = static_cast<std::size_t>(*tasks);
  }
  if (cpus_text_) {
    const auto cpus = game::parse_integer(*cpus_text_, "--cpus", 1, 1024);
    if (!cpus) return Refusal{kUsage, cpus.error()};
    request_.cpus = static_cast<int>(*cpus);
  }
  if (std::string fault = fault_of(request_, plan_.command); !fault.empty())
    return Refusal{kUsage, {std::move(fault)}};
  if (one_line(dir_.string()) != dir_.string())
    return Refusal{kUsage, {"the folder's name has a control character: rename it"}};
  return std::nullopt;
}

std::optional<Refusal> FarmCommand::read_queue(Queue& queue) const {
  if (submitted_.array.empty()) return std::nullopt;
  const Result<std::string> listing =
      ask_slurm({"squeue", "--noheader", "--array", "--name=skerry", "--format=%F %K %t"},
                "try again when the controller answers");
  if (!listing) return Refusal{kFailed, listing.error()};
  queue = queue_from(*listing, submitted_);
  return std::nullopt;
}

int FarmCommand::submit() {
  if (const auto refusal = read_submit()) return refuse(*refusal);
  if (missing_.empty()) {
    fmt::print("all {} tasks have rows; skerry farm fetch merges them\n", plan_.tasks.size());
    return kDone;
  }
  JobArray array;
  array.command = plan_.command;
  array.dir = dir_;
  array.request = request_;
  std::error_code code;
  array.working_dir = fs::current_path(code);
  const Result<fs::path> program = own_program();
  if (!program) return fail(kFailed, program.error());
  array.program = *program;
  const std::size_t tasks = plan_.tasks.size();
  const std::size_t each =
      tasks_per_job_ ? tasks_per_job_ : (tasks + kUsualMostJobs - 1) / kUsualMostJobs;
  array.count = (tasks + each - 1) / each;
  array.jobs = jobs_of(missing_, array.count);
  if (const Result<void> same = check_plan(array.program, plan_); !same)
    return fail(kFailed, same.error());
  if (dry_run_) {
    fmt::print("{}\n# When all of these have ended, whatever their end:\n{}", array_script(array),
               merge_script(array));
    return kDone;
  }
  Queue queue;
  if (const auto refusal = read_queue(queue)) return refuse(*refusal);
  if (!queue.running.empty() || !queue.waiting.empty() || queue.merge)
    return fail(kFailed, {fmt::format("job {} of this folder has not ended; wait, or end it with "
                                      "scancel {} {}",
                                      submitted_.array, submitted_.array, submitted_.merge)});
  return submit_jobs(array);
}

int FarmCommand::submit_jobs(const JobArray& array) const {
  const fs::path jobs = jobs_dir(dir_);
  if (const auto made = platform::make_dirs(jobs); !made) return fail(kFailed, made.error());
  const std::pair<const char*, std::string> scripts[] = {{"array.sh", array_script(array)},
                                                         {"merge.sh", merge_script(array)}};
  for (const auto& [name, text] : scripts)
    if (const auto written = write_text(jobs / name, text); !written)
      return fail(kFailed, written.error());
  // --parsable prints "ID" or "ID;CLUSTER".
  const auto sbatch = [&](std::vector<std::string> words) -> Result<std::string> {
    words.insert(words.begin(), {"sbatch", "--parsable"});
    const Result<std::string> out =
        ask_slurm(std::move(words), "check the options, or try again when the controller answers");
    if (!out) return out.error();
    return game::split(game::split(*out, '\n').front(), ';').front();
  };
  const Result<std::string> id = sbatch({(jobs / "array.sh").string()});
  if (!id) return fail(kFailed, id.error());
  Submitted done{*id, {}, array.count, array.jobs};
  // First without the merge: nothing may be submitted twice if this ends here.
  Result<void> kept = write_submitted(dir_, done);
  const Result<std::string> merge =
      kept ? sbatch({"--dependency=afterany:" + *id, (jobs / "merge.sh").string()}) : kept.error();
  if (merge) {
    done.merge = *merge;
    kept = write_submitted(dir_, done);
  }
  if (!kept || !merge)
    return fail(kFailed, {fmt::format("job {} was submitted, but {}", *id,
                                      !kept ? kept.error().message : merge.error().message)});
  fmt::print("{} tasks in {} jobs: array {}, merge {}\n", missing_.size(), array.jobs.size(), *id,
             *merge);
  return kDone;
}

int FarmCommand::status() {
  Queue queue;
  if (const auto refusal = read_queue(queue)) return refuse(*refusal);
  // Rows that came between the two looks are no failures.
  std::erase_if(missing_, [&](std::size_t task) {
    std::error_code code;
    return fs::exists(record_file(dir_, plan_.tasks[task].id), code);
  });
  const Progress now = progress_of(missing_, submitted_, queue);
  fmt::print("{} tasks: {} have rows, {} in running jobs, {} wait, {} failed, {} not submitted\n",
             plan_.tasks.size(), plan_.tasks.size() - missing_.size(), now.running.size(),
             now.waiting.size(), now.failed.size(), now.idle.size());
  for (std::size_t i = 0; i < std::min(kNamedAtMost, now.failed.size()); ++i)
    fmt::print(
        "failed: {}: see {}\n", one_line(plan_.tasks[now.failed[i]].name),
        one_line(
            job_log(dir_, submitted_.array, job_of(now.failed[i], submitted_.count)).string()));
  if (now.failed.size() > kNamedAtMost)
    fmt::print("and {} more\n", now.failed.size() - kNamedAtMost);
  if (!now.failed.empty()) fmt::print("skerry farm submit runs what has no row again\n");
  return now.failed.empty() ? kDone : kFailed;
}

int FarmCommand::fetch() {
  std::error_code code;
  const fs::path to = to_ ? fs::absolute(*to_, code) : dir_;
  if (to_ && !fs::equivalent(to, dir_, code)) {
    if (const Result<void> written = write_plan(to, plan_); !written)
      return fail(kFailed, written.error());
    // Rows first: a row is written after its pictures, so that those of all copied rows are there.
    for (const char* folder : {"rows", "pictures"})
      if (const Result<void> copied = copy_files(dir_ / folder, to / folder); !copied)
        return fail(kFailed, copied.error());
  }
  const Result<fs::path> program = own_program();
  if (!program) return fail(kFailed, program.error());
  std::vector<std::string> words{program->string()};
  for (std::string& word : merge_words(plan_.command, to)) words.push_back(std::move(word));
  return fail(kFailed, become_program(std::move(words)));
}

}  // namespace skerry::tools
