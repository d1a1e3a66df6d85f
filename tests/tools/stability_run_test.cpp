#include "tools/skerry/stability/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools::stability {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Result<Rows> two_good_rows() {
  return Rows{{"error", 0.5, 0.25}, {"count", 0.0, 0.0}};
}
Result<Rows> a_false_bound() {
  return Rows{{"error", 0.5, 0.25}, {"error", 0.2, 0.25}};
}
Result<Rows> not_measurable() {
  return Rows{{"error", 1e9, kNan}};
}
Result<Rows> impossible() {
  return Error{"no memory"};
}

constexpr Case kGood{"one.good", two_good_rows}, kFalse{"one.false", a_false_bound},
    kNone{"two.nan", not_measurable}, kError{"two.error", impossible};

std::vector<Outcome> outcomes_of(const Case& one) {
  return run_cases({&one, 1}, nullptr, {});
}

TEST(StabilityRun, RowsWithinTheirBoundsPass) {
  const std::vector<Outcome> outcomes = outcomes_of(kGood);
  EXPECT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(status_of(outcomes), kDone);
}

TEST(StabilityRun, OneRowBeyondItsBoundFails) {
  const std::vector<Outcome> outcomes = outcomes_of(kFalse);
  EXPECT_TRUE(outcomes[0].row.pass());
  EXPECT_FALSE(outcomes[1].row.pass());
  EXPECT_EQ(status_of(outcomes), kFailed);
}

TEST(StabilityRun, WhatCannotBeMeasuredFails) {
  EXPECT_EQ(status_of(outcomes_of(kNone)), kFailed);
}

TEST(StabilityRun, ACaseThatCannotRunIsARowThatFailsAndSaysWhy) {
  const std::vector<Outcome> outcomes = outcomes_of(kError);
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_NE(outcomes[0].row.quantity.find("no memory"), std::string::npos);
  EXPECT_EQ(status_of(outcomes), kFailed);
}

TEST(StabilityRun, NoRowsAtAllFail) {
  EXPECT_EQ(status_of({}), kFailed);
}

TEST(StabilityRun, CasesAreChosenByNameOrGroupInTheOrderOfTheTable) {
  const std::vector<Case> all{kGood, kFalse, kNone, kError};
  const auto names = [&](const std::vector<std::string>& wanted) {
    std::vector<std::string_view> out;
    const Result<std::vector<Case>> chosen = chosen_cases(all, wanted);
    for (const Case& one : *chosen) out.push_back(one.name);
    return out;
  };
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(names({}).size(), 4u);
  EXPECT_EQ(names({"two.error", "one"}), (Names{"one.good", "one.false", "two.error"}));
  const auto unknown = chosen_cases(all, std::vector<std::string>{"two.eror"});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("'two.error'"), std::string::npos);
}

TEST(StabilityRun, RowsAreWrittenWithTheFieldsOfTheContract) {
  std::vector<Outcome> outcomes = outcomes_of(kFalse);
  outcomes.push_back(outcomes_of(kNone).front());
  const nlohmann::ordered_json rows = nlohmann::ordered_json::parse(rows_of(outcomes).dump());
  ASSERT_EQ(rows.size(), 3u);
  for (const nlohmann::ordered_json& row : rows) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : row.items()) keys.push_back(key);
    EXPECT_EQ(keys, (std::vector<std::string>{"case", "quantity", "bound", "observed", "pass"}));
  }
  EXPECT_EQ(rows[1]["case"], "one.false");
  EXPECT_EQ(rows[1]["observed"], 0.25);
  EXPECT_EQ(rows[1]["pass"], false);
  EXPECT_TRUE(rows[2]["observed"].is_null());
  EXPECT_EQ(rows[2]["pass"], false);
}

TEST(StabilityRun, TheTableMarksWhatFailed) {
  const std::string table = table_of(outcomes_of(kFalse));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_NE(table.find("| one.false | error | 0.5 | 0.25 |\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("FAILED"), table.rfind("FAILED"));
  EXPECT_NE(table.find("FAILED"), std::string::npos);
}

TEST(StabilityCases, NamesAreUniqueAndHaveAGroup) {
  std::set<std::string_view> names;
  for (const Case& one : all_cases()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_NE(one.name.find('.'), std::string_view::npos) << one.name;
  }
}

}  // namespace
}  // namespace skerry::tools::stability
