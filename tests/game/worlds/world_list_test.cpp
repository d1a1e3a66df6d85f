#include "game/worlds/world_list.h"

#include <gtest/gtest.h>

#include "engine/core/output.h"
#include "tests/folder.h"
#include "world/store/world_file.h"

namespace skerry::game {
namespace {

world::WorldInfo named(const std::string& name) {
  world::WorldInfo info;
  info.name = name;
  info.seed_text = "seed of " + name;
  return info;
}

TEST(WorldList, NamesWhatIsThereAndSaysWhatCannotBePlayed) {
  const Folder folder;
  ASSERT_TRUE(world::WorldFile::create(folder / "one.skerry", named("One")));
  ASSERT_TRUE(write_text(folder / "junk.skerry", "no world at all"));
  ASSERT_TRUE(write_text(folder / "notes.txt", "nor this"));
  const std::vector<WorldEntry> worlds = list_worlds(folder.path());
  ASSERT_EQ(worlds.size(), 2u);
  for (const WorldEntry& world : worlds) {
    if (world.name == "One") {
      EXPECT_EQ(world.seed_text, "seed of One");
      EXPECT_TRUE(world.problem.empty());
      EXPECT_GT(world.bytes, 0u);
    } else {
      EXPECT_EQ(world.name, "junk");
      EXPECT_EQ(world.problem, "It is no saved world of Skerry; name another file");
      EXPECT_EQ(world.problem.find('\n'), std::string::npos);
    }
  }
  EXPECT_TRUE(list_worlds(folder / "nowhere").empty());
}

TEST(WorldList, DeletesAWorldWithItsPicture) {
  const Folder folder;
  const auto path = folder / "one.skerry";
  ASSERT_TRUE(world::WorldFile::create(path, named("One")));
  ASSERT_TRUE(write_text(picture_of_world(path), "png"));
  ASSERT_TRUE(remove_world(path));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(remove_world(path));
}

TEST(WorldList, DoesNotDeleteAWorldThatIsBeingPlayed) {
  const Folder folder;
  const auto path = folder / "one.skerry";
  const auto played = world::WorldFile::create(path, named("One"));
  ASSERT_TRUE(played);
  EXPECT_FALSE(remove_world(path));
  EXPECT_EQ(list_worlds(folder.path()).size(), 1u);
}

}  // namespace
}  // namespace skerry::game
