#include "tools/skerry/test/scene_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <test_paths.h>
#include "engine/core/output.h"
#include "tests/folder.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

std::vector<TestScene> named(int count) {
  std::vector<TestScene> scenes(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) scenes[static_cast<std::size_t>(i)].name = std::to_string(i);
  return scenes;
}

TEST(SceneSet, ShardsHoldEachSceneExactlyOnceWhateverTheirNumber) {
  for (const int scenes : {1, 2, 7, 24, 42}) {
    for (std::size_t count = 1; count <= 50; ++count) {
      std::multiset<std::string> seen;
      std::size_t least = 1000, most = 0;
      for (std::size_t index = 1; index <= count; ++index) {
        const auto part = shard_of(named(scenes), {index, count});
        for (const TestScene& scene : part) seen.insert(scene.name);
        least = std::min(least, part.size());
        most = std::max(most, part.size());
      }
      EXPECT_EQ(seen.size(), static_cast<std::size_t>(scenes));
      EXPECT_EQ(std::set<std::string>(seen.begin(), seen.end()).size(), seen.size());
      EXPECT_LE(most - least, 1u);
    }
  }
}

TEST(SceneSet, AShardIsReadOrRefused) {
  EXPECT_EQ(*parse_shard("1/1"), (Shard{1, 1}));
  EXPECT_EQ(*parse_shard("3/10000"), (Shard{3, 10000}));
  for (const char* text : {"", "1", "/", "1/", "/2", "0/2", "3/2", "-1/2", "1/0", "1/2/3", "a/b",
                           "1/10001", "1/99999999999999999999", "1 /2"})
    EXPECT_FALSE(parse_shard(text)) << text;
}

TEST(SceneSet, FilesAndFoldersAreFoundOnceAndSorted) {
  const Folder folder;
  for (const char* name : {"b.json", "a.json", "c.txt", "a.png"})
    ASSERT_TRUE(write_text(folder / name, "{}"));
  fs::create_directories(folder / "hashes");
  ASSERT_TRUE(write_text(folder / "hashes/d.json", "{}"));
  fs::create_directories(folder / "e.json");
  const std::vector<std::string> paths{(folder / "b.json").string(), folder.path().string(),
                                       folder.path().string() + "/./a.json"};
  const auto found = find_scenes(paths);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ((*found)[0].stem(), "a");
  EXPECT_EQ((*found)[1].stem(), "b");
}

TEST(SceneSet, WhatCannotBeASetIsAnError) {
  const Folder folder;
  EXPECT_FALSE(find_scenes(std::vector<std::string>{folder.path().string()}));
  EXPECT_FALSE(find_scenes(std::vector<std::string>{(folder / "no.json").string()}));
  fs::create_directories(folder / "one");
  fs::create_directories(folder / "two");
  ASSERT_TRUE(write_text(folder / "one/a.json", "{}"));
  ASSERT_TRUE(write_text(folder / "two/a.json", "{}"));
  const auto twins =
      find_scenes(std::vector<std::string>{(folder / "one").string(), (folder / "two").string()});
  ASSERT_FALSE(twins);
  EXPECT_NE(twins.error().message.find("'a'"), std::string::npos);
}

TEST(SceneSet, ASceneNamesItsFileWhenItIsWrong) {
  const Folder folder;
  for (const char* text : {"", "[]", R"({"sede": 1})", R"({"size": "0x1"})",
                           R"({"size": "10x10", "masks": [[5, 5, 6, 5]]})",
                           R"({"size": "10x10", "masks": [[0, 0, 10, 10]]})"}) {
    ASSERT_TRUE(write_text(folder / "wrong.json", text));
    const auto scene = read_scene(folder / "wrong.json");
    ASSERT_FALSE(scene) << text;
    EXPECT_NE(scene.error().message.find("wrong.json"), std::string::npos);
    EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
  }
  ASSERT_TRUE(write_text(folder / "right.json", R"({"size": "10x10", "masks": [[5, 5, 5, 5]]})"));
  const auto scene = read_scene(folder / "right.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->name, "right");
  EXPECT_EQ(scene->reference("any"), folder / "right.png");
}

TEST(SceneSet, TheScenesOfTheRepositoryAreRightAndComplete) {
  const fs::path folder = SKERRY_SOURCE_DIR "/tests/scenes";
  const auto files = find_scenes(std::vector<std::string>{folder.string()});
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_GE(files->size(), 24u);
  for (const fs::path& file : *files) {
    const auto scene = read_scene(file);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_TRUE(fs::exists(scene->reference("any"))) << file;
    EXPECT_FALSE(scene->expected.description.empty()) << file;
  }
}

}  // namespace
}  // namespace skerry::tools
