#include "tools/skerry/farm/record.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/cli/run_program.h"
#include "tests/tools/farm/one_line.h"
#include "tools/skerry/test/records.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string id(int number) {
  return fmt::format("t{:024x}", number);
}

Plan plan_of(int tasks) {
  Plan plan{"test", {"scenes"}, "a date", {}, {}};
  for (int i = 0; i < tasks; ++i) plan.tasks.push_back({id(i), fmt::format("scene_{:03}", i)});
  return plan;
}

Record record(int task, int result = 1, double seconds = 0.5) {
  return {id(task), "a device", "a driver", {{"value", result}}, {{"seconds", seconds}}};
}

std::string text_of_record(const Record& of) {
  return ordered_json{of.task, of.device, of.driver, of.result, of.measured}.dump();
}

std::vector<fs::path> paths(std::initializer_list<fs::path> list) {
  return list;
}

TEST(RecordFile, ComesBackAsItWas) {
  const Folder folder;
  Record odd = record(0);
  odd.result = {{"z", 1},
                {"a", any_number(std::numeric_limits<double>::quiet_NaN())},
                {"tiny", 5e-324},
                {"third", 1.0 / 3.0},
                {"text", "\"\n\xc3\xa4"}};
  ASSERT_TRUE(write_record(folder.path(), odd));
  const auto found = collect(plan_of(1), paths({folder.path()}));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(found->records[0]);
  EXPECT_EQ(text_of_record(*found->records[0]), text_of_record(odd));
  EXPECT_EQ(found->folders[0], folder.path());
  EXPECT_EQ(found->faults[0], "");
}

TEST(RecordFile, IsRefusedIfItEndsTooEarly) {
  const Folder folder;
  ASSERT_TRUE(write_record(folder.path(), record(0)));
  const fs::path file = record_file(folder.path(), id(0));
  const std::string whole = *platform::read_text(file, 1 << 20);
  for (std::size_t bytes = 0; bytes + 1 < whole.size(); ++bytes) {
    ASSERT_TRUE(write_text(file, whole.substr(0, bytes)));
    expect_one_line(collect(plan_of(1), paths({folder.path()})),
                    {id(0) + ".json", "delete the file and run its task again"});
  }
}

TEST(RecordFile, IsRefusedIfAPartIsMissingOrWrong) {
  const Folder folder;
  ASSERT_TRUE(write_record(folder.path(), record(0)));
  const fs::path file = record_file(folder.path(), id(0));
  const ordered_json whole = ordered_json::parse(*platform::read_text(file, 1 << 20));
  const auto expect_refused = [&](const ordered_json& damaged, const std::string& why) {
    ASSERT_TRUE(write_text(file, damaged.dump()));
    expect_one_line(collect(plan_of(1), paths({folder.path()})), {id(0) + ".json", why});
  };
  const std::string damage = "it is damaged: ";
  for (const auto& [key, value] : whole.items()) {
    ordered_json damaged = whole;
    damaged.erase(key);
    expect_refused(damaged, damage + "it has no '" + key + "'");
  }
  for (const char* key : {"task", "device", "driver"}) {
    ordered_json damaged = whole;
    damaged[key] = 7;
    expect_refused(damaged, damage);
  }
  ordered_json other = whole;
  other["task"] = id(1);
  expect_refused(other, "it is of another task");
  expect_refused(ordered_json::array({whole}), damage);
}

TEST(Collect, IgnoresRowsOfOtherPlansAndOtherFiles) {
  const Folder folder;
  for (const int task : {0, 1, 7}) ASSERT_TRUE(write_record(folder.path(), record(task)));
  ASSERT_TRUE(write_text(folder / "rows/notes.json", "{"));
  ASSERT_TRUE(write_text(record_file(folder.path(), id(8)), "damaged"));
  const auto found = collect(plan_of(3), paths({folder.path()}));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->records.size(), 3u);
  EXPECT_TRUE(found->records[0] && found->records[1]);
  EXPECT_FALSE(found->records[2]);
  EXPECT_EQ(found->faults[0] + found->faults[1], "");
  EXPECT_EQ(found->faults[2], "it has no row; run its task");
}

TEST(Collect, NamesTasksThatRanTwiceWithUnlikeResults) {
  const Folder a, b, c;
  ASSERT_TRUE(write_record(a.path(), record(0, 1, 0.5)));
  ASSERT_TRUE(write_record(b.path(), record(0, 1, 0.7)));
  const auto alike = collect(plan_of(1), paths({a.path(), b.path()}));
  ASSERT_TRUE(alike);
  EXPECT_EQ(alike->faults[0], "") << "times are no result";
  ASSERT_TRUE(write_record(c.path(), record(0, 2)));
  std::vector<fs::path> folders{a.path(), b.path(), c.path()};
  std::ranges::sort(folders);
  do {
    const auto found = collect(plan_of(1), folders);
    ASSERT_TRUE(found);
    EXPECT_NE(found->faults[0].find("ran twice with different results"), std::string::npos);
    EXPECT_NE(found->faults[0].find(c.path().string()), std::string::npos);
  } while (std::ranges::next_permutation(folders).found);
}

TEST(Collect, RefusesRowsOfTwoDevices) {
  for (const bool driver : {false, true}) {
    const Folder folder;
    Record other = record(1);
    (driver ? other.driver : other.device) = "another";
    ASSERT_TRUE(write_record(folder.path(), record(0)));
    ASSERT_TRUE(write_record(folder.path(), other));
    expect_one_line(collect(plan_of(2), paths({folder.path()})),
                    {"different devices", "1 of 'a device a driver'", "another"});
    other.device.clear();  // it ran on none
    ASSERT_TRUE(write_record(folder.path(), other));
    EXPECT_TRUE(collect(plan_of(2), paths({folder.path()})));
  }
}

/// Rows of a plan over folders: each in one or more, measured anew in each.
class Scattered {
 public:
  Scattered(std::mt19937& random, int tasks) {
    for (std::size_t i = 0; i < 1 + random() % 5; ++i)
      folders_.push_back(folder_ / fmt::format("part {}", i));
    for (int task = 0; task < tasks; ++task) {
      for (std::size_t copies = random() % 3; copies < 3; ++copies) {
        const Record one = record(task, task, static_cast<double>(random() % 100) / 8);
        const fs::path& place = folders_[random() % folders_.size()];
        rows_[task][place] = one;  // a folder has a task's last row
        EXPECT_TRUE(write_record(place, one));
      }
    }
    std::ranges::shuffle(folders_, random);
  }
  const std::vector<fs::path>& folders() const { return folders_; }
  const std::map<fs::path, Record>& of(int task) const { return rows_.at(task); }

 private:
  Folder folder_;
  std::vector<fs::path> folders_;
  std::map<int, std::map<fs::path, Record>> rows_;
};

TEST(Collect, TakesOneRowOfEachTaskWhereverItIs) {
  std::mt19937 random(2);
  for (int round = 0; round < 30; ++round) {
    const int tasks = 1 + static_cast<int>(random() % 12);
    const Scattered rows(random, tasks);
    const auto found = collect(plan_of(tasks), rows.folders());
    ASSERT_TRUE(found) << found.error().message;
    std::vector<fs::path> reversed(rows.folders().rbegin(), rows.folders().rend());
    const auto again = collect(plan_of(tasks), reversed);
    ASSERT_TRUE(again);
    for (int task = 0; task < tasks; ++task) {
      const auto at = static_cast<std::size_t>(task);
      ASSERT_TRUE(found->records[at]);
      EXPECT_EQ(found->faults[at], "");
      EXPECT_EQ(text_of_record(*found->records[at]),
                text_of_record(rows.of(task).at(found->folders[at])));
      EXPECT_EQ(text_of_record(*found->records[at]), text_of_record(*again->records[at]));
    }
  }
}

Row row(int scene) {
  Row row;
  row.scene = fmt::format("scene_{:03}", scene);
  row.verdict = scene % 3 == 0 ? Verdict::kFail : Verdict::kPass;
  row.message = row.failed() ? "a <reason> & \"more\"" : "";
  row.found = Difference{scene / 7.0, 0.25, 0.5, 30.0 + scene, 0.0625, scene};
  row.seconds = scene / 3.0;
  row.driver = "a_driver";
  row.command = "skerry shot";
  row.failed_runs = row.failed() ? 1 : 0;
  row.pictures = 1;
  return row;
}

TEST(Merge, OfAnyPartitionHasTheSameBytes) {
  constexpr int kTasks = 17;
  std::mt19937 random(3);
  std::string page, rows, junit;
  for (int round = 0; round < 12; ++round) {
    const Folder folder;
    const int parts = round == 0 ? 1 : 1 + static_cast<int>(random() % 6);
    std::vector<std::string> folders;
    for (int i = 0; i < parts; ++i) {
      folders.push_back((folder / fmt::format("part{}", i)).string());
      ASSERT_TRUE(platform::make_dirs(folders.back()));
    }
    for (int task = 0; task < kTasks; ++task)
      ASSERT_TRUE(write_record(folders[random() % folders.size()], record_of(row(task), id(task))));
    std::ranges::shuffle(folders, random);
    ASSERT_TRUE(write_plan(folders.front(), plan_of(kTasks)));
    std::vector<std::string> words{"test", "merge"};
    words.insert(words.end(), folders.begin() + 1, folders.end());
    for (const auto& [option, name] : std::map<std::string, std::string>{
             {"--html", "page"}, {"--json", "rows.json"}, {"--junit", "rows.xml"}}) {
      words.push_back(option);
      words.push_back((folder / name).string());
    }
    words.insert(words.end(), {"--dir", folders.front()});
    const skerry::Outcome done = run(words);
    EXPECT_EQ(done.status, 1) << done.err;  // scenes failed
    if (round == 0) {
      page = skerry::text_of(folder / "page/index.html");
      rows = skerry::text_of(folder / "rows.json");
      junit = skerry::text_of(folder / "rows.xml");
      const ordered_json merged = ordered_json::parse(rows)["rows"];
      ASSERT_EQ(merged.size(), kTasks);
      for (int task = 0; task < kTasks; ++task)
        EXPECT_EQ(merged[static_cast<std::size_t>(task)], row_json(row(task)));
    }
    EXPECT_EQ(skerry::text_of(folder / "page/index.html"), page) << "round " << round;
    EXPECT_EQ(skerry::text_of(folder / "rows.json"), rows) << "round " << round;
    EXPECT_EQ(skerry::text_of(folder / "rows.xml"), junit) << "round " << round;
  }
}

TEST(AnyNumber, ComesBackAsItWas) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -1.5, 1e300, infinity, -infinity})
    EXPECT_EQ(any_number_from(ordered_json::parse(any_number(value).dump())), value);
  EXPECT_TRUE(std::isnan(any_number_from(any_number(std::nan("")))));
}

}  // namespace
}  // namespace skerry::tools
