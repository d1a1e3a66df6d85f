// A plan as jobs of the scheduler Slurm (docs/farm.md): the scripts, and what the queue says.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/farm/plan.h"

namespace skerry::tools {

/// What is asked of Slurm for each job, as sbatch takes it; empty: nothing.
struct JobRequest {
  std::string time, gres, partition, constraint;
  int cpus = 1;
};

/// The jobs of a plan. Job i of `count`, from 1 on, runs the tasks i, i + count, i + 2 count ...
struct JobArray {
  std::string command;  ///< of the plan
  std::filesystem::path program, dir,
      working_dir;  ///< absolute; working_dir: scene paths start here
  std::size_t count = 0;
  std::vector<std::size_t> jobs;  ///< those that have something to run, ascending
  JobRequest request;
};

/// The job of a task, by the task's place in the plan.
constexpr std::size_t job_of(std::size_t task, std::size_t count) {
  return task % count + 1;
}

/// "1-3,7" of 1, 2, 3, 7. @param jobs ascending.
std::string job_ranges(std::span<const std::size_t> jobs);

/// What keeps a request from being submitted; empty if nothing does. A report's jobs have to say on
/// which nodes they run, since they are timed.
std::string fault_of(const JobRequest& request, std::string_view command);

/// The script of the array: each job runs its share, again if its node is lost.
std::string array_script(const JobArray& array);
/// The script of the job that merges; it runs when all jobs of the array have ended.
std::string merge_script(const JobArray& array);
/// What a merge of a command takes: its outputs are in `dir`.
std::vector<std::string> merge_words(std::string_view command, const std::filesystem::path& dir);

/// Scripts and logs of a plan's jobs.
std::filesystem::path jobs_dir(const std::filesystem::path& dir);
/// The log of a job.
std::filesystem::path job_log(const std::filesystem::path& dir, std::string_view array,
                              std::size_t job);

/// What was submitted last.
struct Submitted {
  std::string array, merge;       ///< ids; merge empty: that job could not be submitted
  std::size_t count = 0;          ///< as in JobArray
  std::vector<std::size_t> jobs;  ///< alike
};
Result<void> write_submitted(const std::filesystem::path& dir, const Submitted& submitted);
/// An empty `array` if nothing was submitted. Errors: the file is damaged.
Result<Submitted> read_submitted(const std::filesystem::path& dir);

/// Jobs of an array that have not ended.
struct Queue {
  std::vector<std::size_t> running, waiting;
  bool merge = false;  ///< the merge job has not ended
};
/// Reads what `squeue --noheader --array --format "%F %K %t"` prints; other jobs are ignored.
Queue queue_from(const std::string& listing, const Submitted& submitted);

}  // namespace skerry::tools
