#include "tools/skerry/farm/plan.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/output.h"
#include "engine/core/output_place.h"
#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::uint64_t kMaxPlanBytes = 64u << 20;
constexpr const char* kPlanFile = "plan.json";
constexpr std::size_t kIdDigits = 24;

/// SHA-256 of parts, each behind its length, so that no two lists of parts are alike.
class Hash {
 public:
  Hash() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void add_bytes(const void* bytes, std::size_t count) {
    EVP_DigestUpdate(context_.get(), bytes, count);
  }
  void add(std::string_view part) {
    const std::string length = fmt::format("{}:", part.size());
    add_bytes(length.data(), length.size());
    add_bytes(part.data(), part.size());
  }
  std::string hex() {
    std::array<unsigned char, 32> digest{};
    EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
    return fmt::format("{:02x}", fmt::join(digest, ""));
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

/// Of the file this process runs; it stays what it was when it was started.
Result<std::string> program_hash() {
  static const Result<std::string> hash = file_hash("/proc/self/exe");
  return hash;
}

/// Throws nlohmann's errors.
Plan plan_or_throw(const json& from) {
  Plan plan;
  plan.command = from.at("command").get<std::string>();
  plan.arguments = from.at("arguments").get<std::vector<std::string>>();
  plan.date = from.at("date").get<std::string>();
  plan.notes = from.at("notes").get<std::vector<std::string>>();
  for (const json& task : from.at("tasks"))
    plan.tasks.push_back({task.at("id").get<std::string>(), task.at("name").get<std::string>()});
  return plan;
}

bool is_id(std::string_view id) {
  return id.size() == kIdDigits + 1 && id.front() == 't' &&
         id.find_first_not_of("0123456789abcdef", 1) == std::string_view::npos;
}

/// What keeps a plan from being used; empty if nothing does. Ids name files.
std::string fault_of(const Plan& plan) {
  std::set<std::string_view> ids, names;
  for (const Task& task : plan.tasks) {
    if (!is_id(task.id)) return fmt::format("{} is no id", game::quote_text(task.id));
    if (!ids.insert(task.id).second || !names.insert(task.name).second)
      return fmt::format("it has the task {} twice", game::quote_text(task.name));
  }
  return plan.tasks.empty() ? "it has no task" : "";
}

/// Adds what one word chooses. @return whether it is a name, an id or a share.
bool choose(const Plan& plan, const std::string& word, std::set<std::size_t>& chosen) {
  bool found = false;
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    if (plan.tasks[i].id != word && plan.tasks[i].name != word) continue;
    chosen.insert(i);
    found = true;
  }
  const std::vector<std::string> parts = game::split(word, '/');
  if (found || parts.size() != 2) return found;
  const auto count = game::parse_integer(parts[1], "the number of shares", 1, 1000000);
  if (!count) return false;
  const auto index = game::parse_integer(parts[0], "the share", 1, *count);
  if (!index) return false;
  for (auto i = static_cast<std::size_t>(*index - 1); i < plan.tasks.size();
       i += static_cast<std::size_t>(*count))
    chosen.insert(i);
  return true;
}

}  // namespace

Result<std::string> file_hash(const fs::path& file) {
  std::error_code code;
  if (!fs::exists(file, code) && !code) return std::string("none");
  std::ifstream in(file, std::ios::binary);
  Hash hash;
  std::vector<char> block(1 << 18);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.add_bytes(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.eof()) return hash.hex();
  return Error{
      fmt::format("cannot read {}: check that it is a file you may read", quoted_path(file))};
}

Result<std::string> task_id(std::string_view command, std::string_view name,
                            std::span<const std::string> inputs) {
  const Result<std::string> program = program_hash();
  if (!program) return program.error();
  Hash hash;
  for (const std::string_view part : {command, name, std::string_view(*program)}) hash.add(part);
  for (const std::string& input : inputs) hash.add(input);
  return fmt::format("t{:.{}}", hash.hex(), kIdDigits);
}

Result<void> write_plan(const fs::path& dir, const Plan& plan) {
  if (Result<void> made = platform::make_dirs(dir); !made) return made;
  ordered_json tasks = ordered_json::array();
  for (const Task& task : plan.tasks) tasks.push_back({{"id", task.id}, {"name", task.name}});
  const ordered_json out{{"command", plan.command},
                         {"arguments", plan.arguments},
                         {"date", plan.date},
                         {"notes", plan.notes},
                         {"tasks", std::move(tasks)}};
  return write_text(dir / kPlanFile,
                    out.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

Result<Plan> read_plan(const fs::path& dir, std::string_view command) {
  const fs::path file = dir / kPlanFile;
  const Result<std::string> text = platform::read_text(file, kMaxPlanBytes);
  if (!text) return text.error();
  const auto wrong = [&](std::string_view why) {
    return Error{fmt::format("cannot use the plan {}: {}; make it with skerry {} plan",
                             quoted_path(file), why,
                             command.empty() ? "test, report or stability" : command)};
  };
  const Result<json> from = game::parse_json(*text);
  if (!from) return wrong("it " + from.error().message);
  Plan plan;
  try {
    plan = plan_or_throw(*from);
  } catch (const json::exception& why) {
    return wrong(game::quote_text(why.what()));
  }
  if (!command.empty() && plan.command != command)
    return wrong(fmt::format("it is one of skerry {}", game::quote_text(plan.command)));
  if (plan.command != "test" && plan.command != "report" && plan.command != "stability")
    return wrong(fmt::format("it is one of skerry {}", game::quote_text(plan.command)));
  if (const std::string fault = fault_of(plan); !fault.empty()) return wrong(fault);
  return plan;
}

Result<void> check_same_tasks(const Plan& plan, std::span<const Task> again) {
  const std::size_t count = std::min(plan.tasks.size(), again.size());
  const auto changed = [&](const Task& task) {
    return Error{
        fmt::format("the task {} is not what was planned: the program, a scene, a reference or a "
                    "setting has changed; run the planned program on the planned files, or plan "
                    "again",
                    game::quote_text(task.name))};
  };
  for (std::size_t i = 0; i < count; ++i)
    if (plan.tasks[i] != again[i]) return changed(plan.tasks[i]);
  if (plan.tasks.size() > count) return changed(plan.tasks[count]);
  if (again.size() > count) return changed(again[count]);
  return {};
}

Result<std::vector<std::size_t>> chosen_tasks(const Plan& plan,
                                              std::span<const std::string> wanted) {
  std::set<std::size_t> chosen;
  for (std::size_t i = 0; wanted.empty() && i < plan.tasks.size(); ++i) chosen.insert(i);
  for (const std::string& word : wanted) {
    if (choose(plan, word, chosen)) continue;
    std::vector<std::string_view> names;
    for (const Task& task : plan.tasks) names.push_back(task.name);
    return Error{
        fmt::format("the plan has no task {}: did you mean '{}'? Give names, ids or I/N of {} "
                    "tasks",
                    game::quote_text(word), game::nearest_name(word, names), plan.tasks.size())};
  }
  return std::vector<std::size_t>(chosen.begin(), chosen.end());
}

}  // namespace skerry::tools
