// What a build without OpenVDB says where a .vdb file is wanted.
#include <gtest/gtest.h>

#include <test_paths.h>
#include "tests/cli/run_program.h"

namespace skerry {
namespace {

constexpr const char* kScenes = SKERRY_SOURCE_DIR "/tests/scenes/";

Outcome run_without(const std::vector<std::string>& arguments) {
  const std::string program = "skerry_without_openvdb";
  const bool beside = std::filesystem::exists(SKERRY_BINARY_DIR "/" + program);
  return run(arguments, {}, beside ? program : "skerry");
}

TEST(WithoutOpenVdb, EveryCommandThatWantsAFileSaysInALineWhatIsMissing) {
  const Folder folder;
  const std::string islet = std::string(kScenes) + "islet.vdb";
  const std::string puff = std::string(kScenes) + "puff.vdb";
  const std::string picture = (folder / "p.png").string();
  const std::vector<std::vector<std::string>> wanted = {
      {"vdb", "info", islet},
      {"vdb", "info", islet, "--json"},
      {"vdb", "import", islet, "--out", (folder / "w.skerry").string()},
      {"vdb", "export", "--seed", "1", "--box", "-8,-8,-8,8,64,8", "--out",
       (folder / "f.vdb").string()},
      {"shot", "--world", islet, "--out", picture},
      {"shot", "--seed", "1", "--cloud", puff, "--out", picture},
      {"shot", "--scene", std::string(kScenes) + "cloud_of_a_file.json", "--out", picture},
      {"bench", "frame", "--world", islet},
  };
  for (const std::vector<std::string>& arguments : wanted)
    expect_refusal(run_without(arguments), 1, {"this build has no OpenVDB", "-DSKERRY_OPENVDB=ON"},
                   arguments[0] + " " + arguments[1]);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WithoutOpenVdb, ReportsLeaveOutTheirTopics) {
  const Folder folder;
  const Outcome done =
      run_without({"report", "clouds_precision", "--out", (folder / "report").string()});
  expect_refusal(done, 1, {"no topic is left"}, "nothing but clouds of files");
  EXPECT_NE(done.out.find("this build has no OpenVDB"), std::string::npos) << done.out;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WithoutOpenVdb, ScenesOfVdbFilesAreSkippedAndNamed) {
  const Outcome some = run_without({"test", std::string(kScenes) + "vdb_islet.json",
                                    std::string(kScenes) + "cloud_of_a_file.json",
                                    std::string(kScenes) + "sealed_dark.json"});
  EXPECT_EQ(some.status, 0) << some.out << some.err;
  for (const char* part : {"skipped: vdb_islet: this build has no OpenVDB",
                           "skipped: cloud_of_a_file:", "1 of 1 scenes passed"})
    EXPECT_NE(some.out.find(part), std::string::npos) << some.out;
  expect_refusal(run_without({"test", std::string(kScenes) + "vdb_islet.json"}), 1,
                 {"no scene is left"}, "nothing but skipped scenes");
}

TEST(WithoutOpenVdb, WhatNeedsNoFileWorks) {
  const Folder folder;
  const Outcome drawn = run_without({"shot", "--seed", "1", "--size", "32x18", "--set",
                                     "clouds.coverage=0.5", "--out", (folder / "p.png").string()});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
}

}  // namespace
}  // namespace skerry
