#include "tools/skerry/test/records.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/skerry/test/cause.h"
#include "tools/skerry/test/hashes.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// "DRIVER HASH" for each driver that has approved a picture of a scene.
using ApprovedBy = std::map<std::string, std::vector<std::string>>;

/// Adds the hashes that lie in a folder of scenes, or in one of a baseline.
Result<void> add_approved(const fs::path& folder, const std::optional<Unpacked>& from,
                          ApprovedBy& approved) {
  std::error_code code;
  for (fs::directory_iterator at(hash_file(folder, "any").parent_path(), code), end;
       !code && at != end; at.increment(code)) {
    if (at->path().extension() != ".json") continue;
    const Result<Hashes> hashes = read_hashes(at->path(), from);
    if (!hashes) return hashes.error();
    for (const auto& [scene, hash] : *hashes)
      approved[scene].push_back(at->path().stem().string() + " " + hash);
  }
  return {};
}

/// The drivers of a baseline, sorted; without one a single name that stands for all.
std::vector<std::string> drivers_of(const TestScene& scene) {
  if (!scene.baseline) return {"any"};
  std::vector<std::string> drivers;
  std::error_code code;
  for (fs::directory_iterator at(*scene.baseline, code), end; !code && at != end;
       at.increment(code))
    if (at->is_directory(code)) drivers.push_back(at->path().filename().string());
  std::ranges::sort(drivers);
  return drivers;
}

Result<ApprovedBy> approved_for(const TestScene& scene) {
  ApprovedBy approved;
  for (const std::string& driver : drivers_of(scene))
    if (auto added = add_approved(scene.approved(driver), scene.unpacked, approved); !added)
      return added.error();
  for (auto& [name, lines] : approved) std::ranges::sort(lines);
  return approved;
}

/// Adds hashes of the files that decide a scene's row.
Result<void> add_files(const TestScene& scene, std::vector<std::string>& inputs) {
  std::vector<fs::path> files{scene.file};
  for (const std::string& driver : drivers_of(scene)) {
    if (scene.baseline) inputs.push_back(driver);
    files.push_back(scene.reference(driver));
    for (fs::path& channel : channel_files(scene, driver)) files.push_back(std::move(channel));
  }
  if (scene.scene.world) files.emplace_back(*scene.scene.world);
  for (const game::CloudFile& cloud : scene.scene.clouds) files.emplace_back(cloud.path);
  for (const fs::path& file : files) {
    Result<std::string> hash = file_hash(file);
    if (!hash) return hash.error();
    inputs.push_back(*std::move(hash));
  }
  return {};
}

}  // namespace

Result<std::vector<Task>> tasks_of(std::span<const TestScene> scenes, const PoolOptions& options) {
  std::vector<Task> tasks;
  std::map<fs::path, ApprovedBy> approved;  // by folder
  for (const TestScene& scene : scenes) {
    const fs::path folder = scene.baseline.value_or(scene.file.parent_path());
    if (!approved.contains(folder)) {
      Result<ApprovedBy> found = approved_for(scene);
      if (!found) return found.error();
      approved[folder] = *std::move(found);
    }
    std::vector<std::string> inputs{
        fmt::format("{} runs{}", options.runs, options.validate ? ", validated" : "")};
    if (auto added = add_files(scene, inputs); !added) return added.error();
    const std::vector<std::string>& lines = approved[folder][scene.name];
    inputs.insert(inputs.end(), lines.begin(), lines.end());
    Result<std::string> id = task_id("test", scene.name, inputs);
    if (!id) return id.error();
    tasks.push_back({*std::move(id), scene.name});
  }
  return tasks;
}

Record record_of(const Row& row, const std::string& task) {
  Record record{task, row.driver, {}, row_json(row), {}};
  // Where and how fast it was drawn is no result.
  for (const char* key : {"seconds", "device"}) {
    record.measured[key] = record.result[key];
    record.result.erase(key);
  }
  return record;
}

Result<Row> row_of(const Record& record) {
  nlohmann::json row = record.result;
  if (row.is_object()) {
    row["seconds"] = measured_number(record, "seconds");
    row["device"] = record.measured.is_object() ? record.measured.value("device", nlohmann::json())
                                                : nlohmann::json();
  }
  return row_from_json(row);
}

}  // namespace skerry::tools
