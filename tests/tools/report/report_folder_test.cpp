#include "tools/skerry/report/report_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// A scratch folder that goes with the test.
class ReportFolderTest : public testing::Test {
 protected:
  ReportFolderTest() {
    std::string name = (fs::path(testing::TempDir()) / "skerry_folder_XXXXXX").string();
    parent_ = ::mkdtemp(name.data());
  }
  ~ReportFolderTest() override { fs::remove_all(parent_); }

  static void write(const fs::path& file) { std::ofstream(file) << "x"; }
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(parent_), fs::directory_iterator()));
  }
  fs::path parent_;
};

TEST_F(ReportFolderTest, AppearsWhenPublishedAndNotBefore) {
  Result<ReportFolder> folder = ReportFolder::create(parent_ / "report/", "--out");
  ASSERT_TRUE(folder) << folder.error().message;
  write(folder->path() / kReportFile);
  EXPECT_FALSE(fs::exists(parent_ / "report"));
  ASSERT_TRUE(folder->publish());
  EXPECT_TRUE(fs::exists(parent_ / "report" / kReportFile));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ReportFolderTest, LeavesNothingWhenNotPublished) {
  {
    Result<ReportFolder> folder = ReportFolder::create(parent_ / "report", "--out");
    ASSERT_TRUE(folder);
    write(folder->path() / "picture.png");
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(ReportFolderTest, TakesThePlaceOfAReport) {
  fs::create_directories(parent_ / "report");
  write(parent_ / "report" / kReportFile);
  write(parent_ / "report" / "old.png");
  Result<ReportFolder> folder = ReportFolder::create(parent_ / "report", "--out");
  ASSERT_TRUE(folder) << folder.error().message;
  write(folder->path() / kReportFile);
  EXPECT_TRUE(fs::exists(parent_ / "report" / "old.png"));
  ASSERT_TRUE(folder->publish());
  EXPECT_FALSE(fs::exists(parent_ / "report" / "old.png"));
  EXPECT_TRUE(fs::exists(parent_ / "report" / kReportFile));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ReportFolderTest, TakesTheirPlaceFromNoOtherFiles) {
  fs::create_directories(parent_ / "mine");
  write(parent_ / "mine" / "thesis.txt");
  write(parent_ / "file");
  fs::create_directory_symlink(parent_ / "mine", parent_ / "link");
  for (const char* name : {"mine", "file", "link"}) {
    const Result<ReportFolder> folder = ReportFolder::create(parent_ / name, "--out");
    ASSERT_FALSE(folder) << name;
    EXPECT_NE(folder.error().message.find("--out"), std::string::npos);
  }
  EXPECT_FALSE(ReportFolder::create(parent_ / "missing" / "report", "--out"));
  EXPECT_FALSE(ReportFolder::create("/", "--out"));
  EXPECT_EQ(entries(), 3u);
}

TEST_F(ReportFolderTest, LooksAgainBeforeItTakesAPlace) {
  Result<ReportFolder> folder = ReportFolder::create(parent_ / "report", "--out");
  ASSERT_TRUE(folder);
  fs::create_directories(parent_ / "report");
  write(parent_ / "report" / "thesis.txt");
  EXPECT_FALSE(folder->publish());
  EXPECT_TRUE(fs::exists(parent_ / "report" / "thesis.txt"));
}

}  // namespace
}  // namespace skerry::tools
