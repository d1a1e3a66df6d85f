#include "game/pace/learnt_costs.h"

#include <gtest/gtest.h>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/pace/quality_front.h"
#include "tests/folder.h"

namespace skerry::game {
namespace {

LearntCosts some(double ms) {
  LearntCosts learnt{3, std::vector<std::optional<double>>(quality_front().size())};
  learnt.costs_ms[1] = ms;
  learnt.costs_ms[3] = 2.5 * ms;
  return learnt;
}

TEST(LearntCosts, ComeBackFromAFileByMachine) {
  const Folder folder;
  const auto path = folder / "quality.json";
  ASSERT_TRUE(save_learnt_costs(path, "a", some(11.0)));
  ASSERT_TRUE(save_learnt_costs(path, "b", some(22.0)));
  ASSERT_TRUE(save_learnt_costs(path, "a", some(33.0)));
  const auto a = load_learnt_costs(path, "a"), b = load_learnt_costs(path, "b");
  ASSERT_TRUE(a && *a && b && *b);
  EXPECT_EQ((*a)->costs_ms, some(33.0).costs_ms);
  EXPECT_EQ((*a)->point, 3u);
  EXPECT_EQ((*b)->costs_ms, some(22.0).costs_ms);
  const auto none = load_learnt_costs(path, "c");
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
}

TEST(LearntCosts, AFileThatIsNotThereSaysNothing) {
  const Folder folder;
  for (const std::filesystem::path& path : {folder / "quality.json", std::filesystem::path()}) {
    const auto read = load_learnt_costs(path, "a");
    ASSERT_TRUE(read);
    EXPECT_FALSE(*read);
  }
}

TEST(LearntCosts, ADamagedFileIsToldInOneLineAndReplaced) {
  const Folder folder;
  const auto path = folder / "quality.json";
  const std::string deep = R"({"version": 1, "machines": [{"machine": "a", "x": )" +
                           std::string(30'000, '[') + std::string(30'000, ']') + "}]}";
  for (const char* text :
       {"", "{", "[]", R"({"version": 2, "machines": []})", R"({"version": 1, "machines": {}})",
        R"({"version": 1, "machines": [7]})", R"({"version": 1, "machines": [{"machine": 7}]})",
        deep.c_str()}) {
    ASSERT_TRUE(write_text(path, text));
    const auto read = load_learnt_costs(path, "a");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    ASSERT_TRUE(save_learnt_costs(path, "a", some(5.0)));
    EXPECT_TRUE(load_learnt_costs(path, "a"));
  }
}

TEST(LearntCosts, AnEntryThatCannotBeIsMeasuredAnew) {
  const Folder folder;
  const auto path = folder / "quality.json";
  for (const char* entry :
       {R"("point": "medium 0.50", "costs_ms": {"medium 0.50": -1})",
        R"("point": "medium 0.50", "costs_ms": {"medium 0.50": 1e300})",
        R"("point": "medium 0.50", "costs_ms": {"medium 0.50": "5"})",
        R"("point": "medium 0.50", "costs_ms": {})", R"("point": "best", "costs_ms": {"best": 5})",
        R"("point": 3, "costs_ms": {"medium 0.50": 5})", R"("costs_ms": {"medium 0.50": 5})"}) {
    ASSERT_TRUE(write_text(
        path, std::string(R"({"version": 1, "machines": [{"machine": "a", )") + entry + "}]}"));
    const auto read = load_learnt_costs(path, "a");
    ASSERT_TRUE(read) << entry;
    EXPECT_FALSE(*read) << entry;
  }
}

TEST(LearntCosts, WhatWouldNotBeReadAgainGoes) {
  const Folder folder;
  const auto path = folder / "quality.json";
  // Two bytes a number here; a line of more than 120 blanks as it is printed.
  std::string nested = "0";
  for (int i = 0; i < 2000; ++i) nested += ",0";
  nested = std::string(60, '[') + nested + std::string(60, ']');
  ASSERT_TRUE(
      write_text(path, R"({"version": 1, "machines": [{"machine": "b", "x": )" + nested + "}]}"));
  ASSERT_TRUE(save_learnt_costs(path, "a", some(5.0)));
  const auto read = load_learnt_costs(path, "a");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(*read);
}

TEST(LearntCosts, TheOldestOfTooManyMachinesGoes) {
  const Folder folder;
  const auto path = folder / "quality.json";
  for (std::size_t i = 0; i <= kMostMachines; ++i)
    ASSERT_TRUE(save_learnt_costs(path, std::to_string(i), some(1.0)));
  EXPECT_FALSE(*load_learnt_costs(path, "0"));
  EXPECT_TRUE(*load_learnt_costs(path, "1"));
  EXPECT_TRUE(*load_learnt_costs(path, std::to_string(kMostMachines)));
}

}  // namespace
}  // namespace skerry::game
