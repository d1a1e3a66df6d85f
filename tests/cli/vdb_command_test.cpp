#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/world/vdb/sample_files.h"

namespace skerry {
namespace {

std::string sample(const std::string& name) {
  return (world::sample_files() / name).string();
}

TEST(VdbCommand, InfoTellsWhatEachGridIsForAsTextAndAsJson) {
  SKIP_WITHOUT_OPENVDB();
  const Outcome text = run({"vdb", "info", sample("types.vdb")});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const char* part : {"points have no surface", "colours the surface", "block ids", "[2]"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part;
  const Outcome json = run({"vdb", "info", sample("ball.vdb"), "--json"});
  const nlohmann::json grid = nlohmann::json::parse(json.out).at("grids").at(0);
  EXPECT_EQ(grid.at("name"), "ball");
  EXPECT_EQ(grid.at("kind"), "level set");
  EXPECT_EQ(grid.at("class"), "level set");
  EXPECT_EQ(grid.at("index_min"), nlohmann::json({-20, -25, -17}));
}

TEST(VdbCommand, ImportsAWorldThatExportsToTheSameBlocks) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string world = (folder / "ball.skerry").string();
  const Outcome imported = run({"vdb", "import", sample("ball.vdb"), "--out", world, "--json"});
  ASSERT_EQ(imported.status, 0) << imported.err;
  const auto blocks = nlohmann::json::parse(imported.out).at("islands").at(0).at("blocks");
  const std::string back = (folder / "back.vdb").string();
  const Outcome exported = run({"vdb", "export", "--world", world, "--out", back});
  ASSERT_EQ(exported.status, 0) << exported.err;
  const Outcome info = run({"vdb", "info", back, "--json"});
  const nlohmann::json grids = nlohmann::json::parse(info.out).at("grids");
  ASSERT_EQ(grids.size(), 2u);
  EXPECT_EQ(grids.at(0).at("active_voxels"), blocks);
  // A world is not written over.
  expect_refusal(run({"vdb", "import", sample("ball.vdb"), "--out", world}), 1, {"--out"}, "again");
}

TEST(VdbCommand, RefusesInOneLineAndLeavesNothingBehind) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string out = (folder / "w.skerry").string();
  const auto import = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"vdb", "import"});
    more.insert(more.end(), {"--out", out});
    return run(more);
  };
  std::ofstream(folder / "text.vdb") << "no volume";
  expect_refusal(import({(folder / "text.vdb").string()}), 1, {"text.vdb"}, "no volume");
  expect_refusal(import({sample("huge.vdb")}), 1, {"huge.vdb", "--size"}, "huge");
  expect_refusal(import({sample("empty.vdb")}), 1, {"empty.vdb"}, "empty");
  expect_refusal(import({sample("vectors.vdb")}), 1, {"vectors.vdb"}, "vectors");
  expect_refusal(import({sample("ball.vdb"), "--grid", "bull"}), 1, {"'ball'"}, "grid");
  expect_refusal(import({sample("ball.vdb"), "--scale", "0"}), 2, {"--scale"}, "scale");
  expect_refusal(import({sample("ball.vdb"), "--scale", "1", "--size", "9"}), 2, {"--size"},
                 "both");
  expect_refusal(import({sample("ball.vdb"), "--up", "x"}), 2, {"y or z"}, "up");
  std::filesystem::remove(folder / "text.vdb");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(VdbCommand, ExportNeedsASourceAndAnEnd) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string out = (folder / "f.vdb").string();
  expect_refusal(run({"vdb", "export", "--out", out}), 2, {"--seed"}, "no source");
  expect_refusal(run({"vdb", "export", "--seed", "1", "--out", out}), 2, {"--box"}, "no end");
  expect_refusal(run({"vdb", "export", "--seed", "1", "--box", "0,0,0,0,9,9", "--out", out}), 2,
                 {"--box"}, "empty box");
  expect_refusal(
      run({"vdb", "export", "--seed", "1", "--box", "0,900000,0,9,900009,9", "--out", out}), 1,
      {"no block"}, "air");
  expect_refusal(run({"vdb", "imprt"}), 2, {"import"}, "typing error");
}

TEST(VdbCommand, AFileIsAWorldToShot) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string picture = (folder / "p.png").string();
  const Outcome drawn = run({"shot", "--world", sample("ball.vdb"), "--camera", "40,30,40,225,-25",
                             "--size", "64x36", "--out", picture});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  expect_refusal(
      run({"shot", "--world", sample("ball.vdb"), "--import", "grid=bull", "--out", picture}), 1,
      {"'ball'"}, "no such grid");
  expect_refusal(run({"shot", "--world", sample("vectors.vdb"), "--out", picture}), 1,
                 {"vectors.vdb"}, "nothing to stand on");
}

}  // namespace
}  // namespace skerry
