#include "game/scene_file/scene_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/folder.h"

namespace skerry::game {
namespace {

/// SKERRY_FILES, as long as this lives.
class FilesVariable {
 public:
  explicit FilesVariable(const std::string& value) {
    if (const char* before = std::getenv(kFilesVariable)) before_ = before;
    ::setenv(kFilesVariable, value.c_str(), 1);
  }
  ~FilesVariable() {
    before_.empty() ? ::unsetenv(kFilesVariable) : ::setenv(kFilesVariable, before_.c_str(), 1);
  }

 private:
  std::string before_;
};

TEST(SceneFiles, LieBesideTheSceneElseInTheFolderOfTheVariable) {
  const Folder scenes, files;
  const std::string scene = (scenes / "one.json").string();
  const FilesVariable variable(files.path().string());
  EXPECT_EQ(file_of_scene(scene, "a.vdb"), (scenes / "a.vdb").string());  // what an error names
  std::ofstream(files / "a.vdb") << "far";
  EXPECT_EQ(file_of_scene(scene, "a.vdb"), (files / "a.vdb").string());
  std::ofstream(scenes / "a.vdb") << "near";
  EXPECT_EQ(file_of_scene(scene, "a.vdb"), (scenes / "a.vdb").string());
  EXPECT_EQ(file_of_scene(scene, "/b.vdb"), "/b.vdb");
}

}  // namespace
}  // namespace skerry::game
