#include "tools/skerry/test/history.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ranges>
#include <set>
#include <utility>

#include "engine/core/log.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A file that is open as long as this lives.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

Error history_error(const fs::path& file, const std::string& why) {
  return {fmt::format("cannot keep the history in {}: {}; give a regular file that may be written",
                      game::quote_text(file.string()), why)};
}

/// Bytes of an open file from `first` on. Errors: errno.
Result<std::string> read_from(int descriptor, off_t first, off_t end, const fs::path& file) {
  std::string text(static_cast<std::size_t>(end - first), '\0');
  std::size_t have = 0;
  while (have < text.size()) {
    const ssize_t got = ::pread(descriptor, text.data() + have, text.size() - have,
                                first + static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return history_error(file, std::strerror(errno));
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  text.resize(have);
  return text;
}

std::string line_of(const PastRun& run) {
  nlohmann::ordered_json line{{"date", run.date},         {"scene", run.scene},
                              {"driver", run.driver},     {"verdict", verdict_name(run.verdict)},
                              {"runs", run.runs},         {"failed_runs", run.failed_runs},
                              {"pictures", run.pictures}, {"picture", run.picture}};
  if (run.seconds) line["seconds"] = *run.seconds;
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// None: the line is damaged.
std::optional<PastRun> run_of(const std::string& line) {
  const Result<json> from = game::parse_json(line);
  if (!from) return std::nullopt;
  try {
    const std::optional<Verdict> verdict = verdict_of_name(from->at("verdict").get<std::string>());
    PastRun run{from->at("date").get<std::string>(),
                from->at("scene").get<std::string>(),
                from->at("driver").get<std::string>(),
                verdict.value_or(Verdict::kFail),
                from->at("runs").get<int>(),
                from->at("failed_runs").get<int>(),
                from->at("pictures").get<int>(),
                from->at("picture").get<std::string>(),
                {}};
    if (from->contains("seconds")) run.seconds = from->at("seconds").get<double>();
    const bool counts = run.runs >= 1 && run.failed_runs >= 0 && run.failed_runs <= run.runs &&
                        run.pictures >= 0 && run.pictures <= run.runs &&
                        run.seconds.value_or(0.0) >= 0.0;
    if (!verdict || !counts || run.date.size() > 40) return std::nullopt;
    return run;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

/// The runs of whole lines. @param damaged counts the others.
std::vector<PastRun> runs_of(const std::string& text, std::size_t& damaged) {
  std::vector<PastRun> runs;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, end - from);
    from = end + 1;
    if (line.empty()) continue;
    if (std::optional<PastRun> run = run_of(line)) {
      runs.push_back(*std::move(run));
    } else {
      ++damaged;
    }
  }
  return runs;
}

Result<void> write_all(int descriptor, std::string_view text, const fs::path& file) {
  while (!text.empty()) {
    const ssize_t done = ::write(descriptor, text.data(), text.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return history_error(file, std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(done));
  }
  return {};
}

}  // namespace

PastRun past_run(const Row& row, const std::string& date) {
  return {date,         row.scene,   row.driver,
          row.verdict,  row.runs,    row.failed_runs,
          row.pictures, row.picture, row.seconds / row.runs};
}

std::string summary_of(std::span<const PastRun> runs) {
  std::size_t passed = 0, failed = 0;
  std::set<std::string_view> pictures;
  bool differed = false;
  for (const PastRun& run : runs) {
    (run.verdict == Verdict::kFail ? failed : passed) += 1;
    if (!run.picture.empty()) pictures.insert(run.picture);
    differed = differed || run.pictures > 1;
  }
  std::string text = fmt::format("{} {}: {} passed, {} failed", runs.size(),
                                 runs.size() == 1 ? "run" : "runs", passed, failed);
  if (!pictures.empty())
    text += fmt::format("; {} different {}", pictures.size(),
                        pictures.size() == 1 ? "picture" : "pictures");
  if (differed) text += ", some within a run";
  return text;
}

Result<History> History::open(fs::path file) {
  const Descriptor opened(::open(file.c_str(), O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666));
  if (opened.number() < 0) return history_error(file, std::strerror(errno));
  struct stat status {};
  if (::fstat(opened.number(), &status) != 0) return history_error(file, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return history_error(file, "it is no regular file");
  const off_t first = std::max<off_t>(0, status.st_size - static_cast<off_t>(kMaxHistoryBytes));
  Result<std::string> text = read_from(opened.number(), first, status.st_size, file);
  if (!text) return text.error();
  if (first > 0) text->erase(0, text->find('\n'));  // of a line that began before
  History history;
  std::size_t damaged = 0;
  for (PastRun& run : runs_of(*text, damaged))
    history.runs_[{run.scene, run.driver}].push_back(std::move(run));
  if (damaged > 0)
    log_warning(fmt::format("{} damaged lines of the history {} are passed over", damaged,
                            game::quote_text(file.string())));
  history.file_ = std::move(file);
  return history;
}

std::span<const PastRun> History::of(const std::string& scene, const std::string& driver) const {
  const auto found = runs_.find({scene, driver});
  if (found == runs_.end()) return {};
  return found->second;
}

std::optional<double> History::seconds_of(const std::string& scene) const {
  const PastRun* last = nullptr;
  const auto of_scene = [&](const auto& runs) { return runs.first.first == scene; };
  for (const auto& [name, runs] : runs_ | std::views::filter(of_scene))
    for (const PastRun& run : runs)
      if (run.seconds && (!last || run.date > last->date)) last = &run;
  return last ? last->seconds : std::nullopt;
}

void History::add(PastRun run) {
  unwritten_ += line_of(run);
  runs_[{run.scene, run.driver}].push_back(std::move(run));
}

void History::add_new(PastRun run) {
  const auto same = [&](PastRun known) {
    known.seconds = run.seconds;  // an earlier version did not note it
    return known == run;
  };
  if (std::ranges::none_of(of(run.scene, run.driver), same)) add(std::move(run));
}

Result<void> History::append() {
  if (unwritten_.empty()) return {};
  const Descriptor opened(::open(file_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
  if (opened.number() < 0) return history_error(file_, std::strerror(errno));
  // Where there are no locks, an append of one call is still whole on a local file system.
  while (::flock(opened.number(), LOCK_EX) != 0 && errno == EINTR) {
  }
  const off_t end = ::lseek(opened.number(), 0, SEEK_END);
  char last = '\n';
  if (end > 0 && ::pread(opened.number(), &last, 1, end - 1) != 1)
    return history_error(file_, std::strerror(errno));
  if (last != '\n') unwritten_.insert(0, 1, '\n');
  if (Result<void> done = write_all(opened.number(), unwritten_, file_); !done) return done;
  unwritten_.clear();
  return {};
}

}  // namespace skerry::tools
