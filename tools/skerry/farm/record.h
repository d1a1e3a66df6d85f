// A task's row as a file, and the rows of any number of folders together.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/farm/plan.h"

namespace skerry::tools {

/// What running a task gave.
// NOLINTNEXTLINE(bugprone-exception-escape): by nlohmann's move, which is noexcept
struct Record {
  std::string task;                 ///< its id
  std::string device, driver;       ///< that it ran on; empty: on none
  nlohmann::ordered_json result;    ///< equal whenever the task runs on the same device
  nlohmann::ordered_json measured;  ///< times and what follows from them: differ from run to run
};

/// The file of a task's row in a folder, and the folder of its pictures.
std::filesystem::path record_file(const std::filesystem::path& dir, std::string_view id);
std::filesystem::path pictures_dir(const std::filesystem::path& dir);

/// Writes a row, whole, in the place of one that was there.
Result<void> write_record(const std::filesystem::path& dir, const Record& record);

/// Rows of a plan, each task's once.
struct Collected {
  std::vector<std::optional<Record>> records;  ///< by task of the plan; none: missing
  std::vector<std::filesystem::path> folders;  ///< alike: where the row was
  std::vector<std::string> faults;  ///< alike: it is missing, or ran twice with unlike results;
                                    ///< empty: neither
};

/// Reads the rows that folders hold of a plan's tasks; rows of other tasks are ignored. Of several
/// rows of a task the choice does not depend on the folders or their order.
/// Errors: a row's file is damaged; rows are of different devices, which do not belong on one page.
Result<Collected> collect(const Plan& plan, std::span<const std::filesystem::path> folders);

/// What keeps a row from being used that lacks something, or has it otherwise: it is damaged, or,
/// if it lacks a key, another version may have written it. What is around a row, such as its task,
/// is the same in all versions.
std::string fault_of_row(const nlohmann::ordered_json::exception& why);

/// A number among a record's measurements; 0 if there is none of that name.
double measured_number(const Record& record, const char* name);

/// A number that JSON has, or the words "nan", "inf" and "-inf"; and back. The second throws
/// nlohmann's errors.
nlohmann::ordered_json any_number(double value);
double any_number_from(const nlohmann::ordered_json& value);

}  // namespace skerry::tools
