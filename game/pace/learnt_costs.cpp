#include "game/pace/learnt_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/pace/quality_front.h"
#include "game/scene_file/json_text.h"

namespace skerry::game {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostBytes = 1 << 16;
constexpr int kVersion = 1;
constexpr double kMostMs = 1e6;

std::optional<std::size_t> find_point(std::string_view label) {
  const auto front = quality_front();
  for (std::size_t i = 0; i < front.size(); ++i)
    if (label_of(front[i]) == label) return i;
  return std::nullopt;
}

/// One machine's entry. None: it is not as save_learnt_costs writes it.
std::optional<LearntCosts> read_entry(const Json& entry) {
  if (!entry.contains("point") || !entry["point"].is_string() || !entry.contains("costs_ms") ||
      !entry["costs_ms"].is_object())
    return std::nullopt;
  LearntCosts learnt;
  learnt.costs_ms.resize(quality_front().size());
  for (const auto& [label, value] : entry["costs_ms"].items()) {
    if (!value.is_number()) return std::nullopt;
    const double ms = value.get<double>();
    if (!(ms > 0.0 && ms < kMostMs)) return std::nullopt;
    if (const auto point = find_point(label)) learnt.costs_ms[*point] = ms;
  }
  const std::optional<std::size_t> point = find_point(entry["point"].get<std::string>());
  const bool some = std::any_of(learnt.costs_ms.begin(), learnt.costs_ms.end(),
                                [](const auto& cost) { return cost.has_value(); });
  if (!point || !some) return std::nullopt;  // of a front that has changed since
  learnt.point = *point;
  return learnt;
}

/// The machines of a file, oldest first. Errors: see load_learnt_costs.
Result<Json> read_machines(const std::filesystem::path& path) {
  const Result<std::string> text = platform::read_text(path, kMostBytes);
  if (!text) return text.error();
  const Result<Json> parsed = parse_ordered_json(*text);
  const Json root = parsed ? *parsed : Json();
  const bool known = root.is_object() && root.contains("version") && root["version"] == kVersion &&
                     root.contains("machines") && root["machines"].is_array();
  if (known && std::all_of(root["machines"].begin(), root["machines"].end(), [](const Json& m) {
        return m.is_object() && m.contains("machine") && m["machine"].is_string();
      }))
    return root["machines"];
  return Error{
      fmt::format("cannot use what was learnt of this machine: {} is damaged or of another "
                  "version; it is measured anew",
                  path.string())};
}

}  // namespace

std::string machine_name(std::string_view device, std::string_view driver, std::uint32_t width,
                         std::uint32_t height) {
  return fmt::format("{}, {}, {}x{}", device, driver, width, height);
}

std::filesystem::path learnt_costs_path() {
  const std::filesystem::path folder = platform::cache_dir();
  return folder.empty() ? folder : folder / "quality.json";
}

Result<std::optional<LearntCosts>> load_learnt_costs(const std::filesystem::path& path,
                                                     std::string_view machine) {
  std::error_code code;
  if (path.empty() || !std::filesystem::exists(path, code)) return std::optional<LearntCosts>{};
  const Result<Json> machines = read_machines(path);
  if (!machines) return machines.error();
  for (const Json& entry : *machines)
    if (entry["machine"] == machine) return read_entry(entry);
  return std::optional<LearntCosts>{};
}

Result<void> save_learnt_costs(const std::filesystem::path& path, std::string_view machine,
                               const LearntCosts& learnt) {
  if (path.empty())
    return Error{
        "cannot keep what was learnt of this machine: there is no folder for caches; set HOME or "
        "XDG_CACHE_HOME"};
  if (const Result<void> made = platform::make_dirs(path.parent_path()); !made) return made;
  Json machines = Json::array();
  std::error_code code;
  if (std::filesystem::exists(path, code))
    if (Result<Json> before = read_machines(path)) machines = *std::move(before);
  Json kept = Json::array();
  for (Json& entry : machines)
    if (entry["machine"] != machine) kept.push_back(std::move(entry));
  while (kept.size() >= kMostMachines) kept.erase(kept.begin());
  Json costs = Json::object();
  for (std::size_t i = 0; i < learnt.costs_ms.size(); ++i)
    if (learnt.costs_ms[i]) costs[label_of(quality_front()[i])] = *learnt.costs_ms[i];
  Json entry;
  entry["machine"] = machine;
  entry["point"] = label_of(quality_front()[learnt.point]);
  entry["costs_ms"] = std::move(costs);
  kept.push_back(std::move(entry));
  Json root;
  root["version"] = kVersion;
  root["machines"] = std::move(kept);
  // Names of devices come from drivers, in whatever bytes.
  const auto print = [&root] { return root.dump(2, ' ', false, Json::error_handler_t::replace); };
  std::string text = print();
  // Entries keep what another version put there; a file that is too large to be read has nothing.
  for (Json& list = root["machines"]; text.size() >= kMostBytes && list.size() > 1; text = print())
    list.erase(list.begin());
  return write_text(path, text + "\n");
}

}  // namespace skerry::game
