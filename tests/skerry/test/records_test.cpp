#include "tools/skerry/test/records.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/core/output.h"
#include "tests/folder.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

class TasksOfATest : public testing::Test {
 protected:
  TasksOfATest() {
    write("day.json", R"({"size": "48x27"})");
    write("day.png", "a reference");
    write("night.json", R"({"size": "48x27", "time": "00:00"})");
    write("hashes/mine.json", hashes("0", "1"));
    before_ = ids();
  }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(write_text(folder_ / name, text));
  }
  /// Approved hashes of both scenes: a digit, 64 times.
  static std::string hashes(const std::string& day, const std::string& night) {
    const auto hash = [](const std::string& digit) { return std::string(64, digit.front()); };
    return R"({"day": ")" + hash(day) + R"(", "night": ")" + hash(night) + R"("})";
  }
  std::map<std::string, std::string> ids() {
    std::vector<TestScene> scenes;
    for (const char* name : {"day", "night"}) {
      TestScene scene;
      scene.name = name;
      scene.file = folder_ / (std::string(name) + ".json");
      scene.baseline = baseline_;
      if (scene.name == "day") scene.scene.world = (folder_ / "world").string();
      if (scene.name == "day") scene.scene.clouds.push_back({(folder_ / "cloud").string()});
      scenes.push_back(scene);
    }
    const Result<std::vector<Task>> tasks = tasks_of(scenes, options_);
    std::map<std::string, std::string> found;
    if (!tasks) ADD_FAILURE() << tasks.error().message;
    if (tasks)
      for (const Task& task : *tasks) found[task.name] = task.id;
    return found;
  }
  /// @param what must change, of the two tasks.
  void expect_changed(const std::string& after, bool day, bool night) {
    const auto now = ids();
    EXPECT_EQ(now.at("day") != before_.at("day"), day) << after;
    EXPECT_EQ(now.at("night") != before_.at("night"), night) << after;
    before_ = now;
  }

  Folder folder_;
  PoolOptions options_;
  std::optional<fs::path> baseline_;
  std::map<std::string, std::string> before_;
};

TEST_F(TasksOfATest, DependOnTheirFilesAndOnNoOthers) {
  write("day.json", R"({"size": "48x28"})");
  expect_changed("the scene", true, false);
  write("day.png", "another reference");
  expect_changed("the reference", true, false);
  write("night.png", "its first reference");
  expect_changed("a first reference", false, true);
  write("world", "a world");
  expect_changed("the world", true, false);
  write("cloud", "a cloud");
  expect_changed("the cloud", true, false);
  write("hashes/mine.json", hashes("0", "2"));
  expect_changed("an approved hash", false, true);
  write("hashes/another.json", hashes("3", "4"));
  expect_changed("hashes of another driver", true, true);
  write("hashes/notes.txt", "other files");
  write("dusk.json", "{}");
  expect_changed("files that are not theirs", false, false);
}

TEST_F(TasksOfATest, DependOnHowTheyAreDrawnButNotWhereOrBySoMany) {
  options_.runs = 2;
  expect_changed("--repeat", true, true);
  options_.validate = true;
  expect_changed("--validate", true, true);
  options_.devices = {1, 2};
  options_.processes = 3;
  options_.judge.html = folder_ / "page";
  expect_changed("device, processes and pages", false, false);
}

TEST_F(TasksOfATest, WithABaselineDependOnAllOfItsDrivers) {
  baseline_ = folder_ / "baseline";
  write("baseline/mine/day.png", "a reference");
  before_ = ids();
  write("day.png", "another reference");
  write("hashes/mine.json", hashes("5", "6"));
  expect_changed("what lies beside the scenes", false, false);
  write("baseline/mine/day.png", "another reference");
  expect_changed("the reference", true, false);
  write("baseline/theirs/night.png", "another driver's");
  expect_changed("another driver's reference", true, true);
  write("baseline/mine/hashes/mine.json", R"({"night": ")" + std::string(64, '7') + "\"}");
  expect_changed("an approved hash", false, true);
}

TEST(RecordOfARow, ComesBackAsItWas) {
  Row row;
  row.scene = "day";
  row.message = "a message";
  row.found = Difference{0.1, 0.2, 0.3, 40.0, 0.5, 6};
  row.seconds = 1.25;
  row.driver = "mine";
  row.runs = 3;
  const Record record = record_of(row, "t");
  EXPECT_EQ(record.device, "mine");
  EXPECT_FALSE(record.result.contains("seconds")) << "times are no result";
  const Result<Row> again = row_of(record);
  ASSERT_TRUE(again);
  EXPECT_EQ(row_json(*again), row_json(row));
}

}  // namespace
}  // namespace skerry::tools
