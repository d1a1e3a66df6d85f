#include "tools/skerry/farm/plan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"
#include "tests/tools/farm/one_line.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

std::string id(int number) {
  return fmt::format("t{:024x}", number);
}

Plan plan_of(int tasks) {
  Plan plan{"test", {"scenes", "--repeat", "2"}, "a date", {}, {"a note"}};
  for (int i = 0; i < tasks; ++i) plan.tasks.push_back({id(i), fmt::format("scene {}", i)});
  return plan;
}

std::string id_of(const std::string& command, const std::string& name, const Words& inputs) {
  const Result<std::string> made = task_id(command, name, inputs);
  return made ? *made : made.error().message;
}

TEST(TaskId, IsTheSameForTheSameAndAnotherForEachChange) {
  const std::string first = id_of("test", "day", {"a", "b"});
  EXPECT_EQ(first, id_of("test", "day", {"a", "b"}));
  EXPECT_EQ(first.size(), 25u);
  EXPECT_EQ(first.find_first_not_of("0123456789abcdef", 1), std::string::npos);
  const std::set<std::string> ids{first,
                                  id_of("report", "day", {"a", "b"}),
                                  id_of("test", "night", {"a", "b"}),
                                  id_of("test", "day", {"b", "a"}),
                                  id_of("test", "day", {"a"}),
                                  id_of("test", "day", {"a", "b", ""}),
                                  id_of("test", "day", {"ab", ""}),
                                  id_of("test", "day", {"", "ab"}),
                                  id_of("test", "day", {"a1:b"}),
                                  id_of("test", "daya", {"b"}),
                                  id_of("testday", "", {"a", "b"}),
                                  id_of("test", "day", {std::string("a\0", 2), "b"})};
  EXPECT_EQ(ids.size(), 12u) << "two lists of parts have one id";
}

// The values are those of FIPS 180-4's examples.
TEST(FileHash, IsSha256OfTheBytesAlone) {
  const Folder folder;
  const std::pair<std::string, std::string> examples[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {std::string(1000000, 'a'),  // longer than a block of reading
       "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"}};
  for (const auto& [text, hash] : examples) {
    for (const char* name : {"one", "another"}) {
      ASSERT_TRUE(write_text(folder / name, text));
      const Result<std::string> found = file_hash(folder / name);
      ASSERT_TRUE(found);
      EXPECT_EQ(*found, hash);
    }
  }
}

TEST(FileHash, SaysWhatIsNotThereAndWhatCannotBeRead) {
  const Folder folder;
  EXPECT_EQ(*file_hash(folder / "missing"), "none");
  expect_one_line(file_hash(folder.path()), {"cannot read", folder.path().filename().string()});
}

TEST(PlanFile, ComesBackAsItWas) {
  const Folder folder;
  Plan plan = plan_of(3);
  plan.arguments = {"two words", "--set", "a=\"b\"\n", "", "\xc3\xa4"};
  plan.tasks[1].name = "quote \" and \\ and\ttab";
  ASSERT_TRUE(write_plan(folder / "new folder", plan));
  const Result<Plan> read = read_plan(folder / "new folder", "test");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->command, plan.command);
  EXPECT_EQ(read->arguments, plan.arguments);
  EXPECT_EQ(read->date, plan.date);
  EXPECT_EQ(read->notes, plan.notes);
  EXPECT_EQ(read->tasks, plan.tasks);
}

TEST(PlanFile, IsRefusedIfItEndsTooEarly) {
  const Folder folder;
  ASSERT_TRUE(write_plan(folder.path(), plan_of(2)));
  const fs::path file = folder / "plan.json";
  const std::string whole = *platform::read_text(file, 1 << 20);
  for (std::size_t bytes = 0; bytes + 1 < whole.size(); ++bytes) {  // the last is a line's end
    ASSERT_TRUE(write_text(file, whole.substr(0, bytes)));
    expect_one_line(read_plan(folder.path(), "test"), {"plan.json", "skerry test plan"});
  }
  fs::remove(file);
  expect_one_line(read_plan(folder.path(), "test"), {"plan.json"});
}

TEST(PlanFile, IsRefusedIfAPartIsMissingOrWrong) {
  const Folder folder;
  ASSERT_TRUE(write_plan(folder.path(), plan_of(2)));
  const fs::path file = folder / "plan.json";
  const json whole = json::parse(*platform::read_text(file, 1 << 20));
  const auto expect_refused = [&](const std::function<void(json&)>& damage,
                                  const std::string& why) {
    json damaged = whole;
    damage(damaged);
    ASSERT_TRUE(write_text(file, damaged.dump()));
    expect_one_line(read_plan(folder.path(), "test"), {"plan.json", why});
  };
  for (const auto& [key, value] : whole.items()) {
    expect_refused([&](json& plan) { plan.erase(key); }, key);
    expect_refused([&](json& plan) { plan[key] = 7; }, "");
  }
  const char* bad_ids[] = {"",
                           "t",
                           "t00000000000000000000000",
                           "t0000000000000000000000000",
                           "x000000000000000000000000",
                           "t00000000000000000000000g",
                           "../../../../../../../../e",
                           "t0000000000000000000000/0",
                           "t00000000000000000000000A"};
  for (const char* bad : bad_ids)
    expect_refused([&](json& plan) { plan["tasks"][1]["id"] = bad; }, "is no id");
  expect_refused([](json& plan) { plan["tasks"][1]["id"] = plan["tasks"][0]["id"]; }, "twice");
  expect_refused([](json& plan) { plan["tasks"][1]["name"] = plan["tasks"][0]["name"]; }, "twice");
  expect_refused([](json& plan) { plan["tasks"] = json::array(); }, "no task");
  expect_refused([](json& plan) { plan["command"] = "report"; }, "one of skerry 'report'");
  expect_refused([](json& plan) { plan = json::array({plan}); }, "");
}

TEST(Tasks, ThatAreOthersNowAreNamed) {
  const Plan plan = plan_of(3);
  EXPECT_TRUE(check_same_tasks(plan, plan.tasks));
  std::vector<Task> again = plan.tasks;
  again[1].id = id(99);
  expect_one_line(check_same_tasks(plan, again), {"'scene 1'", "plan again"});
  again = plan.tasks;
  again.pop_back();
  expect_one_line(check_same_tasks(plan, again), {"'scene 2'"});
  again = plan.tasks;
  again.push_back({id(3), "scene 3"});
  expect_one_line(check_same_tasks(plan, again), {"'scene 3'"});
  std::swap(again[0], again[1]);
  expect_one_line(check_same_tasks(plan, again), {"'scene 0'"});
}

TEST(ChosenTasks, AreThoseOfNamesIdsAndShares) {
  const Plan plan = plan_of(10);
  const auto chosen = [&](const Words& wanted) {
    const auto found = chosen_tasks(plan, wanted);
    return found ? *found : std::vector<std::size_t>{999};
  };
  EXPECT_EQ(chosen({}).size(), 10u);
  EXPECT_EQ(chosen({"scene 7", id(2), "scene 2"}), (std::vector<std::size_t>{2, 7}));
  EXPECT_EQ(chosen({"2/4"}), (std::vector<std::size_t>{1, 5, 9}));
  EXPECT_EQ(chosen({"11/12"}), std::vector<std::size_t>{});
  expect_one_line(chosen_tasks(plan, Words{"scene 77"}), {"'scene 77'", "did you mean 'scene 7'"});
  for (const char* bad : {"", "0/3", "4/3", "1/0", "-1/3", "1/", "1/2/3", "a/b", "1/99999999999"})
    expect_one_line(chosen_tasks(plan, Words{bad}), {"the plan has no task"});
}

TEST(ChosenTasks, OfAllSharesAreEachTaskOnce) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const int tasks = 1 + static_cast<int>(random() % 50),
              shares = 1 + static_cast<int>(random() % 60);
    const Plan plan = plan_of(tasks);
    std::vector<int> times(static_cast<std::size_t>(tasks));
    for (int i = 1; i <= shares; ++i) {
      const auto share = chosen_tasks(plan, Words{fmt::format("{}/{}", i, shares)});
      ASSERT_TRUE(share);
      for (const std::size_t task : *share) ++times.at(task);
    }
    EXPECT_EQ(times, std::vector<int>(times.size(), 1)) << tasks << " tasks, " << shares;
  }
}

}  // namespace
}  // namespace skerry::tools
