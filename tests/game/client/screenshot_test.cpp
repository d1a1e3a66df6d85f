#include "game/client/screenshot.h"

#include <gtest/gtest.h>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"

namespace skerry::game {
namespace {

TEST(Screenshot, NamesAreDatesAndNeverTaken) {
  const Folder own;
  const std::filesystem::path folder = own / "shots";
  ASSERT_TRUE(platform::make_dirs(folder));
  constexpr std::int64_t kMoment = 1738367999;  // 2025-01-31 23:59:59 UTC
  for (const char* name : {"skerry-20250131-235959.png", "skerry-20250131-235959-2.png",
                           "skerry-20250131-235959-3.png"}) {
    const auto path = free_screenshot_path(folder, kMoment);
    EXPECT_EQ(path, folder / name);
    ASSERT_TRUE(write_text(path, "taken"));
  }
}

}  // namespace
}  // namespace skerry::game
