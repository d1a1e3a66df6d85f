#include "tools/skerry/farm/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/core/output.h"
#include "engine/core/output_place.h"
#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::uint64_t kMaxRecordBytes = 16u << 20;

ordered_json record_json(const Record& record) {
  return {{"task", record.task},
          {"device", record.device},
          {"driver", record.driver},
          {"result", record.result},
          {"measured", record.measured}};
}

std::string text_of(const ordered_json& value) {
  return value.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

constexpr int kMissingKey = 403;  // nlohmann's, "... key 'NAME' not found"

std::string fault_of_json(const ordered_json::exception& why) {
  const std::string_view text = why.what();
  if (why.id != kMissingKey) return game::quote_text(text);
  const std::size_t first = text.find('\''), last = text.rfind('\'');
  return fmt::format("it has no {}", game::quote_text(text.substr(first + 1, last - first - 1)));
}

/// @pre the file exists.
Result<Record> read_record(const fs::path& file, const std::string& id) {
  const Result<std::string> text = platform::read_text(file, kMaxRecordBytes);
  if (!text) return text.error();
  const auto wrong = [&file](std::string_view why) {
    return Error{fmt::format("cannot use the row {}: {}; delete the file and run its task again",
                             quoted_path(file), why)};
  };
  const Result<ordered_json> parsed = game::parse_ordered_json(*text);
  if (!parsed) return wrong("it " + parsed.error().message);
  try {
    const ordered_json& from = *parsed;
    Record record{from.at("task").get<std::string>(), from.at("device").get<std::string>(),
                  from.at("driver").get<std::string>(), from.at("result"), from.at("measured")};
    if (record.task != id) return wrong("it is of another task");
    return record;
  } catch (const ordered_json::exception& why) {
    return wrong("it is damaged: " + fault_of_json(why));
  }
}

/// A row and where it was.
struct Found {
  Record record;
  fs::path folder;
  std::string text;  ///< of the record
};

/// Picks a task's row and notes what is wrong with it.
void settle(std::vector<Found> found, Collected& out) {
  out.faults.emplace_back();
  if (found.empty()) {
    out.faults.back() = "it has no row; run its task";
    out.records.emplace_back();
    out.folders.emplace_back();
    return;
  }
  std::ranges::stable_sort(found, {}, &Found::text);
  const auto other = std::ranges::find_if(
      found, [&](const Found& one) { return one.record.result != found.front().record.result; });
  if (other != found.end()) {
    std::vector<std::string> folders{found.front().folder.string(), other->folder.string()};
    std::ranges::sort(folders);
    out.faults.back() = fmt::format("it ran twice with different results, in {} and {}",
                                    game::quote_text(folders[0]), game::quote_text(folders[1]));
  }
  out.records.emplace_back(std::move(found.front().record));
  out.folders.push_back(std::move(found.front().folder));
}

/// @param counts of rows, by the device that they ran on.
Result<void> check_devices(const std::map<std::string, std::size_t>& counts) {
  if (counts.size() < 2) return {};
  std::string list;
  for (const auto& [device, count] : counts)
    list += fmt::format("{}{} of {}", list.empty() ? "" : ", ", count, game::quote_text(device));
  return Error{
      fmt::format("cannot merge rows of different devices: {}; merge the folders of each "
                  "device on their own",
                  list)};
}

}  // namespace

fs::path record_file(const fs::path& dir, std::string_view id) {
  return dir / "rows" / (std::string(id) + ".json");
}

fs::path pictures_dir(const fs::path& dir) {
  return dir / "pictures";
}

Result<void> write_record(const fs::path& dir, const Record& record) {
  const fs::path file = record_file(dir, record.task);
  if (Result<void> made = platform::make_dirs(file.parent_path()); !made) return made;
  return write_text(file, text_of(record_json(record)));
}

Result<Collected> collect(const Plan& plan, std::span<const fs::path> folders) {
  Collected out;
  std::map<std::string, std::size_t> devices;
  for (const Task& task : plan.tasks) {
    std::vector<Found> found;
    for (const fs::path& folder : folders) {
      const fs::path file = record_file(folder, task.id);
      std::error_code code;
      if (!fs::exists(file, code)) {
        if (!code) continue;
        return Error{fmt::format("cannot look into {}: {}; check the folder", quoted_path(folder),
                                 code.message())};
      }
      Result<Record> record = read_record(file, task.id);
      if (!record) return record.error();
      if (!record->device.empty()) ++devices[record->device + " " + record->driver];
      std::string text = text_of(record_json(*record));
      found.push_back({*std::move(record), folder, std::move(text)});
    }
    settle(std::move(found), out);
  }
  if (Result<void> same = check_devices(devices); !same) return same.error();
  return out;
}

std::string fault_of_row(const ordered_json::exception& why) {
  const bool lacks = why.id == kMissingKey;
  return (lacks ? "it is damaged, or another version of skerry wrote it: " : "it is damaged: ") +
         fault_of_json(why);
}

double measured_number(const Record& record, const char* name) {
  if (!record.measured.is_object()) return 0.0;
  const auto found = record.measured.find(name);
  return found != record.measured.end() && found->is_number() ? found->get<double>() : 0.0;
}

ordered_json any_number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return value;
}

double any_number_from(const ordered_json& value) {
  if (!value.is_string()) return value.get<double>();
  const auto& word = value.get_ref<const std::string&>();
  if (word == "inf") return std::numeric_limits<double>::infinity();
  if (word == "-inf") return -std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace skerry::tools
