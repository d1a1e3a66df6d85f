#include "engine/platform/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/folder.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

TEST(Files, ReadingStopsAtTheLimitEvenForEndlessFiles) {
  const auto endless = read_text("/dev/zero", 1000);
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().message.find("larger than 1000"), std::string::npos);
  EXPECT_FALSE(read_text("/", 1000));
  EXPECT_FALSE(read_text("/no/such/file", 1000));
}

TEST(Files, APipeIsReadToItsEndAndNotWaitedForWithoutEnd) {
  const Folder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::string text(200'000, 'x');  // more than a pipe holds
  std::thread writer([&] {
    const int descriptor = ::open((folder / "pipe").c_str(), O_WRONLY | O_CLOEXEC);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(::write(descriptor, text.data(), text.size()), std::ssize(text));
    ::close(descriptor);
  });
  const auto whole = read_text(folder / "pipe", 1 << 20);
  writer.join();
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(*whole, text);
  const auto nothing = read_text(folder / "pipe", 1 << 20);
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("within 10 s"), std::string::npos);
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
