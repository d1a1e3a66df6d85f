#include "tools/skerry/test/records.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/skerry/test/hashes.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// "DRIVER HASH" for each driver that has approved a picture of a scene.
using ApprovedBy = std::map<std::string, std::vector<std::string>>;

Result<ApprovedBy> approved_in(const fs::path& scenes) {
  ApprovedBy approved;
  std::error_code code;
  for (fs::directory_iterator at(hash_file(scenes, "any").parent_path(), code), end;
       !code && at != end; at.increment(code)) {
    if (at->path().extension() != ".json") continue;
    const Result<Hashes> hashes = read_hashes(at->path());
    if (!hashes) return hashes.error();
    for (const auto& [scene, hash] : *hashes)
      approved[scene].push_back(at->path().stem().string() + " " + hash);
  }
  for (auto& [scene, lines] : approved) std::ranges::sort(lines);
  return approved;
}

std::vector<fs::path> files_of(const TestScene& scene) {
  std::vector<fs::path> files{scene.file, scene.reference()};
  if (scene.scene.world) files.emplace_back(*scene.scene.world);
  for (const game::CloudFile& cloud : scene.scene.clouds) files.emplace_back(cloud.path);
  return files;
}

}  // namespace

Result<std::vector<Task>> tasks_of(std::span<const TestScene> scenes, const PoolOptions& options) {
  std::vector<Task> tasks;
  std::map<fs::path, ApprovedBy> approved;  // by folder
  for (const TestScene& scene : scenes) {
    const fs::path folder = scene.file.parent_path();
    if (!approved.contains(folder)) {
      Result<ApprovedBy> found = approved_in(folder);
      if (!found) return found.error();
      approved[folder] = *std::move(found);
    }
    std::vector<std::string> inputs{
        fmt::format("{} runs{}", options.runs, options.validate ? ", validated" : "")};
    for (const fs::path& file : files_of(scene)) {
      Result<std::string> hash = file_hash(file);
      if (!hash) return hash.error();
      inputs.push_back(*std::move(hash));
    }
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
