#include "tools/skerry/test/history.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"
#include "tools/skerry/test/page.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

class HistoryTest : public testing::Test {
 protected:
  static PastRun run(const std::string& date, Verdict verdict = Verdict::kPass,
                     const std::string& picture = "a") {
    return {date, "day", "mesa", verdict, 1, verdict == Verdict::kFail ? 1 : 0, 1, picture, {}};
  }
  /// Adds runs as a command of its own does.
  void append(const std::vector<PastRun>& runs) {
    Result<History> history = History::open(file());
    ASSERT_TRUE(history) << history.error().message;
    for (const PastRun& one : runs) history->add(one);
    ASSERT_TRUE(history->append());
  }
  std::vector<PastRun> stored(const std::string& scene = "day") {
    Result<History> history = History::open(file());
    EXPECT_TRUE(history);
    const auto runs = history->of(scene, "mesa");
    return {runs.begin(), runs.end()};
  }
  std::string text() { return *platform::read_text(file(), 1 << 20); }
  void write(const std::string& text) { std::ofstream(file(), std::ios::binary) << text; }
  fs::path file() const { return folder_.path() / "history.jsonl"; }

  Folder folder_;
};

TEST_F(HistoryTest, KeepsTheRunsOfAllCommandsInTheirOrder) {
  const PastRun first = run("1"), second = run("2", Verdict::kFail, "b");
  PastRun third{"3", "night \"\n\xc3\xa4", "mesa", Verdict::kApproved, 5, 2, 3, "", 1.5};
  append({first});
  const std::string before = text();
  append({second, third});
  EXPECT_EQ(text().rfind(before, 0), 0u);  // it only grows
  EXPECT_EQ(stored(), (std::vector<PastRun>{first, second}));
  EXPECT_EQ(stored(third.scene), std::vector<PastRun>{third});
  EXPECT_TRUE(stored("noon").empty());
}

TEST_F(HistoryTest, DamagedLinesArePassedOverAndStay) {
  append({run("1"), run("2")});
  const std::string whole = text();
  const std::string line = whole.substr(0, whole.find('\n') + 1);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string out = line;
    const std::size_t at = out.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return out.replace(at, from.size(), to);
  };
  const std::string deep(100000, '[');
  for (const std::string& bad :
       {std::string("no json\n"), std::string("{}\n"), std::string("[]\n"), std::string("null\n"),
        deep + "\n", std::string("\xff\xfe\n"), std::string("\0\n", 2),
        changed("\"pass\"", "\"maybe\""), changed("\"runs\":1", "\"runs\":0"),
        changed("\"runs\":1", "\"runs\":1e99"), changed("\"runs\":1", "\"runs\":\"1\""),
        changed("\"failed_runs\":0", "\"failed_runs\":-1"),
        changed("\"failed_runs\":0", "\"failed_runs\":2"),
        changed("\"pictures\":1", "\"pictures\":2"),
        changed("\"date\":\"1\"", "\"date\":\"" + std::string(41, '1') + "\""),
        changed("\"pictures\":1", "\"seconds\":-1,\"pictures\":1"),
        changed("\"scene\":\"day\"", "\"scene\":null")}) {
    write(line + bad + whole);
    EXPECT_EQ(stored(), (std::vector<PastRun>{run("1"), run("1"), run("2")})) << bad.substr(0, 80);
    append({run("3")});
    EXPECT_EQ(text().rfind(line + bad + whole, 0), 0u);
  }
}

TEST_F(HistoryTest, ALineThatAKillCutShortEndsBeforeTheNext) {
  append({run("1"), run("2")});
  const std::string whole = text();
  for (std::size_t cut = whole.find('\n') + 1; cut < whole.size(); cut += 9) {
    write(whole.substr(0, cut));
    append({run("3")});
    EXPECT_EQ(stored(), (std::vector<PastRun>{run("1"), run("3")})) << cut;
  }
}

TEST_F(HistoryTest, OfALongFileTheEndIsRead) {
  append({run("1")});
  const std::string line = text();
  std::string many;
  while (many.size() <= kMaxHistoryBytes) many += line;
  append({});
  write(many);
  const std::size_t read = stored().size();
  EXPECT_LT(read, many.size() / line.size());
  EXPECT_GE(read, kMaxHistoryBytes / line.size() - 1);
}

TEST_F(HistoryTest, AMergedRunIsTakenInOnce) {
  append({run("1")});
  Result<History> history = History::open(file());
  ASSERT_TRUE(history);
  history->add_new(run("1"));
  history->add_new(run("2"));
  history->add_new(run("2"));
  ASSERT_TRUE(history->append());
  EXPECT_EQ(stored(), (std::vector<PastRun>{run("1"), run("2")}));
}

TEST_F(HistoryTest, KnowsWhatASceneTookAtLast) {
  PastRun slow = run("2"), quick = run("3"), unknown = run("4");
  slow.seconds = 9.0;
  quick.seconds = 2.5;
  quick.driver = "other";
  append({quick, slow, unknown});
  Result<History> history = History::open(file());
  ASSERT_TRUE(history);
  EXPECT_EQ(history->seconds_of("day"), 2.5);
  EXPECT_EQ(history->seconds_of("night"), std::nullopt);
  // Lines that an earlier version wrote are the same run as one that a merge brings with its time.
  PastRun again = unknown;
  again.seconds = 1.0;
  history->add_new(again);
  EXPECT_EQ(history->of("day", "mesa").size(), 2u);
}

TEST_F(HistoryTest, WhatIsNoRegularFileIsRefused) {
  EXPECT_FALSE(History::open(folder_.path()));
  EXPECT_FALSE(History::open("/dev/null"));
  EXPECT_FALSE(History::open(folder_.path() / "none" / "history"));
}

TEST_F(HistoryTest, ThePageShowsTheRunsAsAStrip) {
  append({run("<1>"), run("2", Verdict::kFail, "b"), run("3", Verdict::kPass, "b")});
  Result<History> history = History::open(file());
  ASSERT_TRUE(history);
  Row row;
  row.scene = "day";
  row.driver = "mesa";
  row.verdict = Verdict::kPass;
  const std::string page = test_page({{}, 1, {row}, {}}, folder_.path(), &*history);
  EXPECT_NE(page.find("3 runs: 2 passed, 1 failed; 2 different pictures"), std::string::npos);
  EXPECT_NE(page.find("class=\"bad changed\" title=\"2: fail, 1 of 1 failed, 1 picture, another"),
            std::string::npos);
  EXPECT_NE(page.find("title=\"&lt;1&gt;: pass"), std::string::npos);
  EXPECT_EQ(test_page({{}, 1, {row}, {}}, folder_.path()).find("class=\"strip\""),
            std::string::npos);
}

}  // namespace
}  // namespace skerry::tools
