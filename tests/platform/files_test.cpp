#include "engine/platform/files.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

TEST(Files, WritingReplacesTheOldFileAndLeavesNoOther) {
  const fs::path dir = fs::path(testing::TempDir()) / "skerry_files";
  ASSERT_TRUE(make_dirs(dir));
  ASSERT_TRUE(write_text(dir / "a", "old and long"));
  ASSERT_TRUE(write_text(dir / "a", "new"));
  EXPECT_EQ(*read_text(dir / "a", 100), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir), fs::directory_iterator()), 1);
  fs::remove_all(dir);
}

TEST(Files, CheckingAPathTouchesNothing) {
  const fs::path dir = fs::path(testing::TempDir()) / "skerry_check";
  ASSERT_TRUE(make_dirs(dir));
  EXPECT_TRUE(check_writable(dir / "a"));
  EXPECT_TRUE(fs::is_empty(dir));
  ASSERT_TRUE(write_text(dir / "a", "kept"));
  EXPECT_TRUE(check_writable(dir / "a"));
  EXPECT_EQ(*read_text(dir / "a", 100), "kept");
  EXPECT_FALSE(check_writable(dir));
  EXPECT_FALSE(check_writable(dir / "none" / "a"));
  EXPECT_FALSE(check_writable(""));
  fs::remove_all(dir);
}

TEST(Files, ReadingStopsAtTheLimitEvenForEndlessFiles) {
  const auto endless = read_text("/dev/zero", 1000);
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().message.find("larger than 1000"), std::string::npos);
  EXPECT_FALSE(read_text("/", 1000));
  EXPECT_FALSE(read_text("/no/such/file", 1000));
}

TEST(Files, TheProgramsOwnFolderHoldsTheProgram) {
  EXPECT_TRUE(fs::exists(executable_dir() / "skerry_tests"));
}

TEST(Files, XdgVariablesWinOverHomeUnlessRelative) {
  ::setenv("HOME", "/someone", 1);
  ::setenv("XDG_CACHE_HOME", "/cache", 1);
  EXPECT_EQ(cache_dir(), "/cache/skerry");
  ::setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(cache_dir(), "/someone/.cache/skerry");
  ::unsetenv("XDG_CACHE_HOME");
  ::unsetenv("XDG_CONFIG_HOME");
  ::unsetenv("XDG_DATA_HOME");
  EXPECT_EQ(config_dir(), "/someone/.config/skerry");
  EXPECT_EQ(data_dir(), "/someone/.local/share/skerry");
}

}  // namespace
}  // namespace skerry::platform
