// skerry test as scripts call it, on scenes small enough to be drawn in a moment.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <test_paths.h>
#include "engine/core/output.h"
#include "engine/platform/image_file.h"
#include "engine/platform/tar.h"
#include "tests/cli/run_program.h"
#include "tools/measure/html.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Whether a page shows a picture whose file lies beside it too.
bool holds(const std::string& page, const fs::path& picture) {
  const std::string bytes = text_of(picture);
  return !bytes.empty() &&
         page.find(measure::data_address("image/png", bytes)) != std::string::npos;
}

class TestCommandLine : public testing::Test {
 protected:
  /// A picture of the sky alone.
  void write_scene(const std::string& name, const std::string& more = "") {
    const std::string text =
        R"({"size": "48x27", "time": "16:00", "settings": {"world.islands": 0})" + more + "}";
    ASSERT_TRUE(write_text(scenes() / (name + ".json"), text));
  }
  fs::path scenes() const { return folder_.path(); }
  fs::path out(const std::string& name) const { return out_ / name; }
  Outcome test(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "test");
    return run(std::move(arguments));
  }
  Outcome approve() { return test({scenes().string(), "--approve"}); }
  json rows(const std::string& file) {
    json rows = json::parse(text_of(out(file)))["rows"];
    for (json& row : rows) row.erase("seconds");
    return rows;
  }

  Folder folder_, out_;
};

TEST_F(TestCommandLine, WhatIsApprovedPassesAndWhatChangesFails) {
  write_scene("sky");
  const Outcome first = test({scenes().string()});
  EXPECT_EQ(first.status, 1);
  EXPECT_NE(first.out.find("no reference yet"), std::string::npos) << first.out;
  EXPECT_EQ(approve().status, 0);
  const Outcome second = test({scenes().string(), "--json", out("rows.json").string()});
  EXPECT_EQ(second.status, 0) << second.out << second.err;
  const json row = rows("rows.json")[0];
  EXPECT_EQ(row["scene"], "sky");
  EXPECT_EQ(row["verdict"], "pass");
  EXPECT_EQ(row["hash_equal"], true);
  EXPECT_TRUE(row["psnr"].is_null());
  write_scene("sky", R"(, "fov": 30)");
  const Outcome third = test({scenes().string(), "--json", out("rows.json").string()});
  EXPECT_EQ(third.status, 1);
  EXPECT_EQ(rows("rows.json")[0]["verdict"], "fail");
  EXPECT_EQ(rows("rows.json")[0]["hash_equal"], false);
  EXPECT_GT(rows("rows.json")[0]["flip_mean"], 0.0);
}

TEST_F(TestCommandLine, TheCommandOfARowDrawsItsPictureAgain) {
  write_scene("sky");
  ASSERT_EQ(approve().status, 0);
  ASSERT_EQ(test({scenes().string(), "--json", out("rows.json").string()}).status, 0);
  const std::string command = rows("rows.json")[0]["command"];
  ASSERT_TRUE(command.starts_with("skerry shot "));
  const std::string shell = SKERRY_BINARY_DIR "/" + command + " --out " + out("again.png").string();
  ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
  EXPECT_EQ(platform::read_png(out("again.png"))->pixels,
            platform::read_png(scenes() / "sky.png")->pixels);
}

TEST_F(TestCommandLine, ShardsMergeIntoTheWholeWithItsPictures) {
  for (const char* name : {"a", "b", "c", "d", "e"})
    write_scene(name, std::string(", \"fov\": ") + std::to_string(40 + name[0] % 8));
  ASSERT_EQ(approve().status, 0);
  const std::string all = scenes().string();
  ASSERT_EQ(test({all, "--json", out("whole.json").string()}).status, 0);
  std::vector<std::string> merge{"--merge"};
  for (const char* index : {"1", "2", "3"}) {
    const std::string file = out(index + std::string(".json")).string();
    ASSERT_EQ(test({all, "--shard", index + std::string("/3"), "--json", file, "--html",
                    out(std::string("html") + index).string()})
                  .status,
              0);
    merge.push_back(file);
  }
  merge.insert(merge.end(), {"--json", out("merged.json").string(), "--html", out("html").string(),
                             "--junit", out("junit.xml").string()});
  const Outcome merged = test(merge);
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(rows("merged.json"), rows("whole.json"));
  const std::string page = text_of(out("html/index.html"));
  for (const char* name : {"a", "b", "c", "d", "e"})
    EXPECT_TRUE(holds(page, out(std::string("html/") + name + ".actual.png"))) << name;
  EXPECT_NE(text_of(out("junit.xml")).find("tests=\"5\""), std::string::npos);
}

TEST_F(TestCommandLine, RepeatedRunsGiveOnePicture) {
  write_scene("sky");
  write_scene("wide", R"(, "fov": 120)");
  ASSERT_EQ(approve().status, 0);
  const Outcome outcome = test(
      {scenes().string(), "--repeat", "3", "--jobs", "2", "--json", out("rows.json").string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const json& row : rows("rows.json")) {
    EXPECT_EQ(row["runs"], 3);
    EXPECT_EQ(row["failed_runs"], 0);
    EXPECT_EQ(row["pictures"], 1);
  }
}

/// Folders of pictures that some other program drew.
class CompareCommandLine : public TestCommandLine {
 protected:
  /// A grey ramp. @param brighter of a square in its middle [of 255].
  void write_picture(const fs::path& folder, const std::string& name, int brighter = 0,
                     std::uint32_t width = 48) {
    constexpr std::uint32_t kHeight = 32;
    std::vector<std::uint8_t> pixels;
    for (std::uint32_t y = 0; y < kHeight; ++y)
      for (std::uint32_t x = 0; x < width; ++x) {
        const bool square = x >= 20 && x < 28 && y >= 12 && y < 20;
        const auto grey = static_cast<std::uint8_t>(60 + 2 * x + (square ? brighter : 0));
        pixels.insert(pixels.end(), {grey, grey, grey, 255});
      }
    fs::create_directories(folder);
    ASSERT_TRUE(platform::write_png(folder / (name + ".png"), {width, kHeight, 4, pixels}));
  }
  void write_both(const std::string& name, int brighter) {
    write_picture(before(), name);
    write_picture(after(), name, brighter);
  }
  Outcome compare(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"--compare", before().string(), after().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test(std::move(arguments));
  }
  fs::path before() const { return out("before"); }
  fs::path after() const { return out("after"); }
};

TEST_F(CompareCommandLine, PicturesOfTwoFoldersAreJudgedByName) {
  write_both("equal", 0);
  write_both("hardly", 2);
  write_both("other", 90);
  write_picture(before(), "gone");
  write_picture(after(), "new");
  write_picture(before(), "wider");
  write_picture(after(), "wider", 0, 50);
  write_both("damaged", 0);
  ASSERT_TRUE(write_text(after() / "damaged.png", "no picture"));
  ASSERT_TRUE(write_text(after() / "notes.txt", "passed over"));
  const Outcome outcome =
      compare({"--json", out("rows.json").string(), "--html", out("html").string()});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("2 of 7 scenes passed"), std::string::npos) << outcome.out;
  const json found = rows("rows.json");
  ASSERT_EQ(found.size(), 7u);
  const auto row = [&](const std::string& name) {
    return *std::find_if(found.begin(), found.end(),
                         [&](const json& one) { return one["scene"] == name; });
  };
  EXPECT_EQ(row("equal")["verdict"], "pass");
  EXPECT_EQ(row("equal")["flip_max"], 0.0);
  EXPECT_EQ(row("hardly")["verdict"], "pass");
  EXPECT_EQ(row("hardly")["largest"], 2);
  EXPECT_EQ(row("other")["verdict"], "fail");
  EXPECT_EQ(row("other")["largest"], 90);
  EXPECT_DOUBLE_EQ(row("other")["pixels_over"].get<double>(), 64.0 / (48 * 32));
  const auto says = [&](const std::string& name, const std::string& what) {
    EXPECT_EQ(row(name)["verdict"], "fail") << name;
    EXPECT_NE(row(name)["message"].get<std::string>().find(what), std::string::npos)
        << row(name)["message"];
  };
  says("gone", "a reference alone");
  says("new", "no reference");
  says("wider", "48x32 pixels, the picture 50x32");
  says("damaged", "damaged.png");
  const std::string page = text_of(out("html/index.html"));
  for (const char* shown :
       {"other.flip.png", "other.reference.png", "gone.reference.png", "new.actual.png"}) {
    EXPECT_TRUE(holds(page, out("html") / shown)) << shown;
  }
}

TEST_F(CompareCommandLine, TheToleranceCanBeStated) {
  write_both("hardly", 2);
  EXPECT_EQ(compare().status, 0);
  EXPECT_EQ(compare({"--tolerance", R"({"flip_max": 0.001})"}).status, 1);
  write_both("hardly", 90);
  EXPECT_EQ(compare().status, 1);
  EXPECT_EQ(compare({"--tolerance", R"({"flip_mean": 1, "flip_p99": 1, "pixels_over": 1})"}).status,
            0);
  expect_refusal(compare({"--tolerance", R"({"flip_man": 1})"}), 2, {"flip_mean"},
                 "a typing error");
  expect_refusal(compare({"--tolerance", "tight"}), 2, {"--tolerance"}, "no JSON");
}

TEST_F(CompareCommandLine, RegionsAndShiftsAreInTheRow) {
  write_both("square", 90);
  const std::string square =
      R"({"shift": 1, "regions": [{"name": "square", "rectangle": [20, 12, 8, 8], "flip_mean": 1,
          "flip_p99": 1, "pixels_over": PART}]})";
  const auto with_share = [&](const std::string& share) {
    std::string text = square;
    return text.replace(text.find("PART"), 4, share);
  };
  // FLIP's filters reach over the region's border.
  const std::string around = R"({"flip_mean": 1, "flip_p99": 1, )";
  const auto both = [&](const std::string& share) { return around + with_share(share).substr(1); };
  EXPECT_EQ(compare({"--tolerance", both("1"), "--json", out("rows.json").string(), "--html",
                     out("html").string()})
                .status,
            0);
  const json row = rows("rows.json").at(0);
  EXPECT_EQ(row["shift"], json({0, 0}));
  ASSERT_EQ(row["regions"].size(), 2u);
  EXPECT_EQ(row["regions"][0]["name"], "square");
  EXPECT_EQ(row["regions"][0]["pixels_over"], 1.0);
  EXPECT_EQ(row["regions"][1]["name"], "elsewhere");
  EXPECT_EQ(row["regions"][1]["pixels_over"], 0.0);
  EXPECT_NE(text_of(out("html/index.html")).find("elsewhere"), std::string::npos);
  const Outcome tight = compare({"--tolerance", both("0.5")});
  EXPECT_EQ(tight.status, 1);
  EXPECT_NE(tight.out.find("square: share of pixels"), std::string::npos) << tight.out;
  const Outcome outside =
      compare({"--tolerance", R"({"regions": [{"name": "far", "rectangle": [40, 0, 9, 1]}]})"});
  EXPECT_EQ(outside.status, 1);
  EXPECT_NE(outside.out.find("leaves the picture of 48x32"), std::string::npos) << outside.out;
}

TEST_F(CompareCommandLine, WhatCannotBeComparedIsRefused) {
  write_picture(before(), "one");
  expect_refusal(compare(), 1, {"after", "no folder"}, "one folder");
  fs::create_directory(after());
  expect_refusal(test({"--compare", after().string(), after().string()}), 1, {"nothing to compare"},
                 "no pictures");
  expect_refusal(test({"--compare", before().string()}), 2, {"two folders"}, "one path");
  expect_refusal(compare({"--approve"}), 2, {"--compare draws nothing"}, "approve");
  expect_refusal(compare({"--merge"}), 2, {"exclude each other"}, "merge");
  write_scene("sky");
  expect_refusal(test({scenes().string(), "--tolerance", "{}"}), 2, {"--compare"}, "drawing");
}

TEST_F(TestCommandLine, NothingToTestIsAFailure) {
  expect_refusal(test({}), 1, {"nothing to test"}, "no scenes");
  expect_refusal(test({scenes().string()}), 1, {"no scene"}, "empty folder");
  expect_refusal(test({"no/such.json"}), 1, {"no/such.json"}, "no file");
  write_scene("sky");
  expect_refusal(test({scenes().string(), "--shard", "2/2"}), 1, {"shard 2/2"}, "empty shard");
}

TEST_F(TestCommandLine, AMistakeInASceneIsAUsageErrorBeforeAnythingIsDrawn) {
  write_scene("sky");
  ASSERT_TRUE(write_text(scenes() / "wrong.json", R"({"tolerence": {}})"));
  expect_refusal(test({scenes().string(), "--approve"}), 2, {"wrong.json", "'tolerance'"}, "scene");
  EXPECT_FALSE(fs::exists(scenes() / "sky.png"));
}

TEST_F(TestCommandLine, AFolderForReportsThatCannotBeWrittenIsAUsageError) {
  write_scene("sky");
  ASSERT_TRUE(write_text(out("file"), "in the way"));
  for (const std::string& html :
       {out("file").string(), out("file/below").string(), std::string("/proc/skerry")}) {
    expect_refusal(test({scenes().string(), "--approve", "--html", html}), 2, {}, html);
    EXPECT_FALSE(fs::exists(scenes() / "sky.png"));
  }
  for (const char* option : {"--json", "--junit"})
    expect_refusal(test({scenes().string(), option, "/no/such/folder/x"}), 1, {"x"}, option);
}

TEST_F(TestCommandLine, AReportTakesThePlaceOfAReportAndOfNothingElse) {
  write_scene("sky");
  ASSERT_EQ(approve().status, 0);
  fs::create_directory(out("mine"));
  ASSERT_TRUE(write_text(out("mine") / "index.html", "my page"));
  expect_refusal(test({scenes().string(), "--html", out("mine").string()}), 2,
                 {"no report", "--html"}, "foreign page");
  EXPECT_EQ(text_of(out("mine") / "index.html"), "my page");
  EXPECT_EQ(std::distance(fs::directory_iterator(out("mine")), {}), 1);
  fs::create_directory(out("far"));
  fs::create_directory_symlink("far", out("link"));
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(test({scenes().string(), "--html", out("link").string()}).status, 0) << round;
    EXPECT_TRUE(fs::is_symlink(out("link")));
    EXPECT_TRUE(fs::exists(out("far") / "index.html"));
    EXPECT_TRUE(fs::exists(out("far") / "sky.actual.png"));
    EXPECT_EQ(json::parse(text_of(out("far") / "report.json"))["rows"][0]["scene"], "sky");
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(out("")), {}), 3);  // no draft
}

TEST_F(TestCommandLine, ASceneWhoseNameHasANewlineStaysOnItsLine) {
  write_scene("a\nb");
  const Outcome outcome = test({scenes().string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("a\\x0ab: "), std::string::npos) << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
  ASSERT_TRUE(write_text(scenes() / "a\nb.json", "{"));
  expect_refusal(test({scenes().string()}), 2, {"a\\x0ab.json"}, "newline");
  expect_refusal(run({"shot", "--scene", (scenes() / "no\nfile").string()}), 1, {"no\\x0afile"},
                 "shot");
}

TEST_F(TestCommandLine, APictureTooLargeForTheDeviceFailsItsScene) {
  write_scene("sky");
  ASSERT_EQ(approve().status, 0);
  ASSERT_TRUE(write_text(scenes() / "huge.json", R"({"size": "65535x65535"})"));
  const Outcome outcome = test({scenes().string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("fail: huge: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("1 of 2 scenes passed"), std::string::npos) << outcome.out;
}

TEST_F(TestCommandLine, WithoutADeviceTheStatusIsFour) {
  write_scene("sky");
  expect_refusal(run({"test", scenes().string()}, {"VK_ICD_FILENAMES=/no/such/driver.json",
                                                   "VK_DRIVER_FILES=/no/such/driver.json"}),
                 4, {}, "no driver");
  expect_refusal(test({scenes().string(), "--device", "999"}), 4, {"999"}, "device");
}

TEST_F(TestCommandLine, MergingWhatIsNoShardFails) {
  expect_refusal(test({"--merge"}), 2, {"nothing to test"}, "nothing");
  expect_refusal(test({"--merge", "no/such.json"}), 1, {"no/such.json"}, "no file");
  ASSERT_TRUE(write_text(out("x.json"), "{}"));
  expect_refusal(test({"--merge", out("x.json").string()}), 1, {"x.json"}, "no rows");
}

TEST_F(TestCommandLine, ABaselineKeepsReferencesOutsideTheScenes) {
  write_scene("sky");
  const std::string baseline = out("baseline").string();
  const auto judge = [&] { return test({scenes().string(), "--baseline", baseline}); };
  expect_refusal(judge(), 2, {"there is no folder", "--approve"}, "no baseline");
  EXPECT_EQ(test({scenes().string(), "--baseline", baseline, "--approve"}).status, 0);
  EXPECT_EQ(judge().status, 0);
  EXPECT_FALSE(fs::exists(scenes() / "sky.png") || fs::exists(scenes() / "hashes"));
  const fs::path driver = fs::directory_iterator(baseline)->path();
  EXPECT_TRUE(fs::exists(driver / "sky.png"));
  EXPECT_TRUE(fs::exists(driver / "hashes" / (driver.filename().string() + ".json")));

  const std::string dir = out("work").string();
  EXPECT_EQ(test({"plan", scenes().string(), "--baseline", baseline, "--dir", dir}).status, 0);
  EXPECT_EQ(test({"run", "--dir", dir}).status, 0);
  EXPECT_EQ(test({"merge", "--dir", dir}).status, 0);
  fs::rename(driver, out("baseline") / "another_driver");
  const Outcome other = judge();
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.out.find("no reference yet"), std::string::npos) << other.out;
  expect_refusal(test({"run", "sky", "--dir", dir}), 1, {"'sky' is not what was planned"}, "run");
}

TEST_F(TestCommandLine, AnArchiveKeepsWhatWasApprovedBeforeAnotherApprovalFailed) {
  write_scene("a");
  write_scene("b");
  const std::string archive = out("baseline.tar").string();
  ASSERT_EQ(test({scenes().string(), "--baseline", archive, "--approve"}).status, 0);
  // Damage in the hashes of a driver that shares the references is noticed once one is replaced.
  const fs::path folder = out("unpacked");
  fs::create_directories(folder);
  ASSERT_TRUE(platform::unpack_tar(archive, folder));
  const std::string driver = fs::directory_iterator(folder)->path().filename();
  const fs::path hashes = folder / driver / "hashes";
  ASSERT_TRUE(write_text(hashes / "other.json", "{"));
  for (const auto& file : fs::directory_iterator(hashes))
    if (file.path().filename() != "other.json") {
      ASSERT_TRUE(write_text(file.path(), "{}"));
    }
  ASSERT_TRUE(platform::pack_tar(folder, archive));
  write_scene("b", R"(, "fov": 30)");

  expect_refusal(test({scenes().string(), "--baseline", archive, "--approve"}), 1,
                 {"cannot use the approved hashes in '" + driver + "/hashes/other.json'",
                  "in the archive '" + archive + "'", "tar --delete"},
                 "damaged");
  const auto row = [&](const std::string& scene) {
    test({(scenes() / (scene + ".json")).string(), "--baseline", archive, "--json",
          out("rows.json").string()});
    return rows("rows.json").at(0);
  };
  EXPECT_EQ(row("a")["hash_equal"], true) << "approved before";
  EXPECT_EQ(row("b")["verdict"], "pass") << "its reference and its hash, as in a folder";

  ASSERT_TRUE(write_text(folder / driver / "a.png", "no picture"));
  ASSERT_TRUE(platform::pack_tar(folder, archive));
  const std::string why = row("a")["message"].get<std::string>();
  EXPECT_NE(why.find("'" + driver + "/a.png' in the archive '" + archive), std::string::npos)
      << why;
}

TEST_F(TestCommandLine, AFailureNamesTheChannelInWhichItBegins) {
  const auto write = [&](const std::string& time, const std::string& settings) {
    ASSERT_TRUE(write_text(scenes() / "isle.json",
                           R"({"seed": 7, "size": "64x36", "tolerance": {"flip_mean": 0, )"
                           R"("flip_p99": 0, "flip_max": 0, "pixels_over": 0}, "time": ")" +
                               time +
                               R"(", "settings": {"world.islands": 1, "view.distance": 100, )" +
                               R"("indirect": "off", "shadow.enabled": 0)" + settings + "}}"));
  };
  const std::string baseline = out("baseline").string();
  const auto cause = [&] {
    EXPECT_EQ(test({scenes().string(), "--baseline", baseline, "--json", out("rows.json").string(),
                    "--history", out("history").string()})
                  .status,
              1);
    return rows("rows.json").at(0)["cause"];
  };
  write("12:00", "");
  ASSERT_EQ(test({scenes().string(), "--baseline", baseline, "--approve"}).status, 0);
  write("12:00", R"(, "gbuffer.depth": "d16")");
  const json depth = cause();
  EXPECT_EQ(depth["channel"], "depth");
  EXPECT_EQ(depth["pass"], "draw_geometry");
  write("15:00", "");
  EXPECT_NE(cause()["pass"], "draw_geometry");  // the surfaces are the same
  write("12:00", "");
  EXPECT_EQ(test({scenes().string(), "--baseline", baseline, "--history", out("history").string(),
                  "--html", out("html").string()})
                .status,
            0);
  EXPECT_NE(text_of(out("html/index.html")).find("3 runs: 1 passed, 2 failed; 3 different"),
            std::string::npos);
}

}  // namespace
}  // namespace skerry
