#include "tools/skerry/farm/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "engine/core/output.h"
#include "engine/core/output_place.h"
#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kMaxSubmittedBytes = 4u << 20;
constexpr std::size_t kMostJobs = 1'000'000;

bool has_control(std::string_view text) {
  return std::ranges::any_of(text, [](unsigned char c) { return std::iscntrl(c) != 0; });
}

/// One word for a shell.
std::string shell_word(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// A line of options; sbatch reads quotes and backslashes as a shell does.
std::string option(std::string_view name, std::string_view value) {
  std::string quoted;
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return fmt::format("#SBATCH --{}=\"{}\"\n", name, quoted);
}

/// A path in which sbatch replaces nothing.
std::string log_pattern(const fs::path& folder, std::string_view name) {
  std::string out;
  for (const char c : folder.string()) out += c == '%' ? std::string("%%") : std::string(1, c);
  return fmt::format("{}/{}", out, name);
}

std::string common_options(const JobArray& array, std::string_view log) {
  std::string out = "#!/bin/sh\n#SBATCH --job-name=skerry\n#SBATCH --requeue\n";
  out +=
      "#SBATCH --ntasks=1\n#SBATCH --open-mode=append\n";  // a job that runs again adds to its log
  out += option("chdir", array.working_dir.string());
  out += option("output", log_pattern(jobs_dir(array.dir), log));
  if (!array.request.time.empty()) out += option("time", array.request.time);
  if (!array.request.partition.empty()) out += option("partition", array.request.partition);
  return out;
}

/// GPUs that a --gres asks for: "gpu", "gpu:2" or "gpu:h100:2".
std::int64_t gpus_of(const std::string& gres) {
  std::int64_t gpus = 0;
  for (const std::string& one : game::split(gres, ',')) {
    const std::vector<std::string> parts = game::split(one, ':');
    if (parts.front() != "gpu") continue;
    const auto count = game::parse_integer(parts.back(), "GPUs", 0, 1024);
    gpus += count ? *count : 1;
  }
  return gpus;
}

/// What `run` is told about the job's share of a node.
std::string run_options(const JobArray& array) {
  const std::int64_t gpus = gpus_of(array.request.gres);
  if (gpus > 1 && array.command != "stability") return " --devices all";
  if (gpus == 0 && array.command == "test") return fmt::format(" --jobs {}", array.request.cpus);
  return "";
}

std::string joined(std::span<const std::string> words) {
  std::string out;
  for (const std::string& word : words) out += " " + shell_word(word);
  return out;
}

/// Throws nlohmann's errors.
Submitted submitted_or_throw(const json& from) {
  Submitted out{from.at("array").get<std::string>(), from.at("merge").get<std::string>(),
                from.at("count").get<std::size_t>(),
                from.at("jobs").get<std::vector<std::size_t>>()};
  return out;
}

}  // namespace

std::string job_ranges(std::span<const std::size_t> jobs) {
  std::string out;
  for (std::size_t i = 0; i < jobs.size();) {
    std::size_t last = i;
    while (last + 1 < jobs.size() && jobs[last + 1] == jobs[last] + 1) ++last;
    out += fmt::format("{}{}", out.empty() ? "" : ",", jobs[i]);
    if (last > i) out += fmt::format("-{}", jobs[last]);
    i = last + 1;
  }
  return out;
}

std::string fault_of(const JobRequest& request, std::string_view command) {
  const std::pair<const char*, const std::string&> texts[] = {{"--time", request.time},
                                                              {"--gres", request.gres},
                                                              {"--partition", request.partition},
                                                              {"--constraint", request.constraint}};
  for (const auto& [name, text] : texts)
    if (has_control(text)) return fmt::format("{} has a control character: leave it out", name);
  if (command == "report" && request.constraint.empty() && request.partition.empty())
    return "a report is timed, so its jobs need nodes of one kind: give --constraint FEATURE or "
           "--partition NAME; sinfo --Node --format '%N %P %f' lists them";
  if (command == "stability" && gpus_of(request.gres) > 1)
    return "a job of skerry stability uses one GPU: give --gres gpu:1";
  return {};
}

std::string array_script(const JobArray& array) {
  std::string out = common_options(array, "%A_%a.log");
  out += option("array", job_ranges(array.jobs));
  if (!array.request.gres.empty()) out += option("gres", array.request.gres);
  if (!array.request.constraint.empty()) out += option("constraint", array.request.constraint);
  out += fmt::format("#SBATCH --cpus-per-task={}\n", array.request.cpus);
  if (array.command == "report") out += "#SBATCH --exclusive\n";  // its rows are times
  out += fmt::format("exec {} {} run \"$SLURM_ARRAY_TASK_ID/{}\" --dir {}{}\n",
                     shell_word(array.program.string()), array.command, array.count,
                     shell_word(array.dir.string()), run_options(array));
  return out;
}

std::string merge_script(const JobArray& array) {
  std::vector<std::string> words{array.program.string()};
  for (std::string& word : merge_words(array.command, array.dir)) words.push_back(std::move(word));
  return common_options(array, "merge_%j.log") + "exec" + joined(words) + "\n";
}

std::vector<std::string> merge_words(std::string_view command, const fs::path& dir) {
  std::vector<std::string> words{std::string(command), "merge", "--dir", dir.string()};
  const auto add = [&](const char* name, const char* file) {
    words.insert(words.end(), {name, (dir / file).string()});
  };
  if (command == "report") {
    add("--out", "page");
    return words;
  }
  add("--json", "rows.json");
  if (command != "test") return words;
  add("--html", "page");
  add("--junit", "rows.xml");
  return words;
}

fs::path jobs_dir(const fs::path& dir) {
  return dir / "jobs";
}

fs::path job_log(const fs::path& dir, std::string_view array, std::size_t job) {
  return jobs_dir(dir) / fmt::format("{}_{}.log", array, job);
}

Result<void> write_submitted(const fs::path& dir, const Submitted& submitted) {
  const nlohmann::ordered_json out{{"array", submitted.array},
                                   {"merge", submitted.merge},
                                   {"count", submitted.count},
                                   {"jobs", submitted.jobs}};
  return write_text(jobs_dir(dir) / "submitted.json", out.dump() + "\n");
}

Result<Submitted> read_submitted(const fs::path& dir) {
  const fs::path file = jobs_dir(dir) / "submitted.json";
  std::error_code code;
  if (!fs::exists(file, code) && !code) return Submitted{};
  const Result<std::string> text = platform::read_text(file, kMaxSubmittedBytes);
  if (!text) return text.error();
  const auto wrong = [&](std::string_view why) {
    return Error{fmt::format("cannot use {}: {}; delete the file once no job of it is in squeue",
                             quoted_path(file), why)};
  };
  const Result<json> from = game::parse_json(*text);
  if (!from) return wrong("it " + from.error().message);
  try {
    Submitted out = submitted_or_throw(*from);
    if (out.array.empty() || out.count == 0 || out.count > kMostJobs)
      return wrong("it names no jobs");
    return out;
  } catch (const json::exception& why) {
    return wrong(game::quote_text(why.what()));
  }
}

Queue queue_from(const std::string& listing, const Submitted& submitted) {
  // Of the states in which squeue shows a job, these have it on a node.
  static const std::set<std::string> on_node{"R", "CG", "S", "ST", "SI", "SO", "RS"};
  Queue queue;
  std::istringstream lines(listing);
  for (std::string id, index, state; lines >> id >> index >> state;) {
    if (!submitted.merge.empty() && id == submitted.merge) queue.merge = true;
    if (id != submitted.array) continue;
    const auto job = game::parse_integer(index, "a job", 1, std::int64_t{kMostJobs});
    if (job)
      (on_node.contains(state) ? queue.running : queue.waiting)
          .push_back(static_cast<std::size_t>(*job));
  }
  return queue;
}

}  // namespace skerry::tools
