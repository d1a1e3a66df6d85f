#include "tools/skerry/test/rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <test_paths.h>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"
#include "tests/tools/farm/one_line.h"
#include "tools/skerry/test/page.h"

namespace skerry::tools {
namespace {

constexpr const char* kHostile = "<script>alert('&\"')</script>\x01\xff\n%2e";

Row row_of(const std::string& scene, Verdict verdict = Verdict::kPass) {
  Row row;
  row.scene = scene;
  row.verdict = verdict;
  row.hash_equal = false;
  row.found = Difference{0.125, 0.25, 0.5, 33.5, 0.0625, 17, 0.625, -0.0625};
  row.seconds = 1.5;
  row.message = "a message";
  row.driver = "a_driver";
  row.command = "skerry shot";
  row.failed_runs = row.failed() ? 1 : 0;
  row.pictures = 1;
  return row;
}

Results shard(std::size_t index, std::size_t count, std::size_t in_set,
              const std::vector<std::string>& scenes) {
  Results results{{index, count}, in_set, {}, {}};
  for (const std::string& scene : scenes) results.rows.push_back(row_of(scene));
  return results;
}

void expect_equal(const Row& a, const Row& b) {
  EXPECT_EQ(row_json(a).dump(), row_json(b).dump());
}

TEST(Rows, ARowSurvivesItsJson) {
  Row row = row_of("day", Verdict::kApproved);
  expect_equal(*row_from_json(row_json(row)), row);
  row.hash_equal = std::nullopt;
  row.found = std::nullopt;
  const Result<Row> bare = row_from_json(row_json(row));
  ASSERT_TRUE(bare);
  EXPECT_FALSE(bare->found || bare->hash_equal);
  row.found = Difference{0.0, 0.0, 0.0, std::numeric_limits<double>::infinity(), 0.0, 0};
  const Result<Row> equal = row_from_json(row_json(row));
  ASSERT_TRUE(equal);
  EXPECT_TRUE(std::isinf(equal->found->psnr_db));
}

TEST(Rows, TheContractsFieldsAreThere) {
  const auto json = row_json(row_of("day", Verdict::kFail));
  EXPECT_EQ(json["scene"], "day");
  EXPECT_EQ(json["verdict"], "fail");
  EXPECT_EQ(json["hash_equal"], false);
  EXPECT_EQ(json["flip_mean"], 0.125);
  EXPECT_EQ(json["flip_p99"], 0.25);
  EXPECT_EQ(json["flip_max"], 0.5);
  EXPECT_EQ(json["psnr"], 33.5);
  EXPECT_EQ(json["pixels_rounded"], 0.625);
  EXPECT_EQ(json["bias"], -0.0625);
}

TEST(Rows, WhatIsNoRowIsAnError) {
  const nlohmann::json json = row_json(row_of("day"));
  for (const auto& [key, value] : json.items()) {
    nlohmann::json without = json;
    without.erase(key);
    EXPECT_FALSE(row_from_json(without)) << key;
    nlohmann::json other = json;
    // Regions are an array, which may be empty.
    other[key] = key == "regions" ? nlohmann::json::object() : nlohmann::json::array();
    EXPECT_FALSE(row_from_json(other)) << key;
  }
  EXPECT_FALSE(row_from_json(nlohmann::json::array()));
}

TEST(Rows, MergedShardsAreTheWhole) {
  const std::vector<std::string> names{"a", "b", "c", "d", "e", "f", "g"};
  const Results whole = shard(1, 1, names.size(), names);
  for (std::size_t count = 1; count <= names.size(); ++count) {
    std::vector<Results> parts;
    for (std::size_t index = count; index >= 1; --index) {  // in any order
      std::vector<std::string> part;
      for (std::size_t i = index - 1; i < names.size(); i += count) part.push_back(names[i]);
      parts.push_back(shard(index, count, names.size(), part));
    }
    const Result<Results> merged = merge(parts);
    ASSERT_TRUE(merged) << merged.error().message;
    EXPECT_EQ(results_json(*merged).dump(), results_json(whole).dump());
  }
}

TEST(Rows, ShardsThatAreNoWholeAreRefused) {
  const auto error = [](const std::vector<Results>& parts) {
    const Result<Results> merged = merge(parts);
    EXPECT_FALSE(merged);
    return merged ? std::string() : merged.error().message;
  };
  const Results one = shard(1, 2, 3, {"a", "c"}), two = shard(2, 2, 3, {"b"});
  EXPECT_NE(error({one}).find("2/2 is missing"), std::string::npos);
  EXPECT_NE(error({one, one}).find("itself"), std::string::npos);
  EXPECT_NE(error({one, shard(2, 3, 3, {"b"})}).find("one run"), std::string::npos);
  EXPECT_NE(error({one, shard(2, 2, 4, {"b", "d"})}).find("one run"), std::string::npos);
  EXPECT_NE(error({one, shard(2, 2, 3, {"a"})}).find("'a'"), std::string::npos);
  EXPECT_NE(error({one, shard(2, 2, 3, {})}).find("2 of 3"), std::string::npos);
  EXPECT_TRUE(merge(std::vector<Results>{one, two}));
}

TEST(Rows, FilesThatHoldNoResultsAreRefused) {
  const Folder folder;
  const Results results = shard(1, 1, 1, {"a"});
  const std::string good = results_json(results).dump();
  ASSERT_TRUE(write_text(folder / "good.json", good));
  EXPECT_TRUE(read_results(folder / "good.json"));
  for (const std::string& text :
       {std::string(), std::string("{}"), std::string("[]"), std::string("{\"rows\": 1}"),
        good.substr(0, good.size() / 2), std::string(100000, '['),
        R"({"shard": "2/1", "scenes_in_set": 1, "html": "", "rows": []})" + std::string()}) {
    ASSERT_TRUE(write_text(folder / "bad.json", text));
    const auto read = read_results(folder / "bad.json");
    ASSERT_FALSE(read) << text.substr(0, 50);
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
  EXPECT_FALSE(read_results(folder / "none.json"));
}

TEST(Rows, ThatLackAKeyAreSaidToBeDamagedOrOfAnotherVersion) {
  const Folder folder;
  nlohmann::json results = results_json(shard(1, 1, 1, {"a"}));
  results["rows"][0].erase("regions");  // as rows of versions without regions are
  ASSERT_TRUE(write_text(folder / "old.json", results.dump()));
  expect_one_line(read_results(folder / "old.json"),
                  {"old.json", "damaged, or another version", "'regions'"});
  expect_one_line(row_from_json(results["rows"][0]), {"damaged, or another version", "'regions'"});
  results["rows"][0]["regions"] = 1;
  expect_one_line(row_from_json(results["rows"][0]), {"it is damaged: "});
}

/// Whether Python's parsers take the text; they are other people's code.
bool parses(const char* script, const std::string& text) {
  const Folder folder;
  EXPECT_TRUE(write_text(folder / "text", text));
  const std::string command =
      std::string("python3 -c '") + script + "' " + (folder / "text").string();
  return std::system(command.c_str()) == 0;
}

TEST(Rows, JunitIsXmlThatTellsEveryCase) {
  Results results = shard(1, 1, 3, {"a", kHostile});
  results.rows.push_back(row_of("failed", Verdict::kFail));
  results.rows.back().message = kHostile;
  EXPECT_TRUE(
      parses("import sys, xml.etree.ElementTree as e; r = e.parse(sys.argv[1]).getroot(); "
             "s = r.find(\"testsuite\"); assert s.get(\"tests\") == \"3\" and s.get(\"failures\") "
             "== \"1\"; "
             "c = s.findall(\"testcase\"); assert len(c) == 3; "
             "assert [len(x) for x in c] == [0, 0, 1] and c[0].get(\"name\") == \"a\"",
             junit_xml(results)));
}

TEST(Rows, HostileNamesStayTextInThePage) {
  Results results = shard(1, 1, 1, {kHostile});
  results.rows[0].message = results.rows[0].command = results.rows[0].driver = kHostile;
  const std::string page = test_page(results, "no/such/folder");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find('\x01'), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
}

TEST(Rows, EveryLinkOfThePageHasItsTarget) {
  // The first fits into a string without memory of its own.
  const Results results = shard(
      1, 1, 5, {"a", "a_name_that_is_longer", "two words", "100%", std::string(300, 'x') + "#?&"});
  const Folder folder;
  const auto page = folder / "index.html";
  ASSERT_TRUE(write_text(page, test_page(results, folder.path())));
  const std::string command = SKERRY_SOURCE_DIR "/tests/tools/page_links.py " + page.string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Rows, ThePageHoldsPicturesUntilItIsFull) {
  Results results = shard(1, 1, 2, {"alpha", "beta"});
  results.rows.push_back(row_of("omega", Verdict::kFail));
  const Folder folder;
  const auto write = [&](const std::string& name, std::size_t bytes) {
    ASSERT_TRUE(write_text(folder / (name + ".png"), std::string(bytes, name.front())));
  };
  write("omega.actual", 47 << 20);
  write("alpha.actual", 2 << 20);
  write("beta.reference", 1000);
  write("beta.actual", 1000);
  const std::string page = test_page(results, folder.path());
  EXPECT_LT(page.size(), std::size_t{64} << 20);
  const auto count = [&](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = page.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("src=\"data:image/png;base64,"), 2u) << "omega, and beta's two, which are equal";
  EXPECT_EQ(count("src=\"alpha.actual.png\""), 1u);
  EXPECT_EQ(count("pictures of 2 scenes are in this file; those of 1 lie beside it"), 1u);
}

TEST(Rows, ThePageShowsFailuresFirst) {
  Results results = shard(1, 1, 2, {"alpha"});
  results.rows.push_back(row_of("omega", Verdict::kFail));
  const std::string page = test_page(results, "no/such/folder");
  EXPECT_LT(page.find("omega"), page.find("alpha"));
  EXPECT_NE(page.find("1 of 2 scenes failed"), std::string::npos);
}

}  // namespace
}  // namespace skerry::tools
