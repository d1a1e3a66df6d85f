#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

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

TEST(VdbCommand, TakesTheSmokeNotItsObstaclesAndSaysSoInOneLine) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  for (const char* name : {"obstacles.vdb", "no_obstacles.vdb"}) {
    const std::string world = (folder / (std::string(name) + ".skerry")).string();
    const Outcome imported =
        run({"vdb", "import", sample(name), "--out", world, "--size", "64", "--json"});
    ASSERT_EQ(imported.status, 0) << imported.err;
    const nlohmann::json islands = nlohmann::json::parse(imported.out).at("islands");
    ASSERT_EQ(islands.size(), 1u);
    EXPECT_EQ(islands.at(0).at("grid"), "density");
    EXPECT_GT(islands.at(0).at("blocks"), 1000);
    EXPECT_EQ(std::count(imported.err.begin(), imported.err.end(), '\n'), 1) << imported.err;
    EXPECT_NE(imported.err.find("leaves 'obstacles'"), std::string::npos) << imported.err;
  }
  const std::string world = (folder / "named.skerry").string();
  const Outcome named = run(
      {"vdb", "import", sample("obstacles.vdb"), "--out", world, "--grid", "obstacles", "--json"});
  ASSERT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(nlohmann::json::parse(named.out).at("islands").at(0).at("blocks"), 2);
  EXPECT_EQ(named.err, "");
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

/// A world of the ball in a folder. @return its path.
std::string make_ball(const Folder& folder) {
  const std::string world = (folder / "ball.skerry").string();
  EXPECT_EQ(run({"vdb", "import", sample("ball.vdb"), "--out", world}).status, 0);
  return world;
}

TEST(VdbCommand, ExportsIntoWhatIsNoFileWithoutReplacingIt) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string world = make_ball(folder), pipe = (folder / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string seen;
  std::thread reader([&] { seen = text_of(pipe); });
  const Outcome exported = run({"vdb", "export", "--world", world, "--out", pipe});
  reader.join();
  EXPECT_EQ(exported.status, 0) << exported.err;
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  std::ofstream(folder / "seen.vdb", std::ios::binary) << seen;
  EXPECT_EQ(run({"vdb", "info", (folder / "seen.vdb").string()}).status, 0);
  std::ofstream(folder / "target.vdb") << "old";
  std::filesystem::create_symlink("target.vdb", folder / "link.vdb");
  const std::string link = (folder / "link.vdb").string();
  EXPECT_EQ(run({"vdb", "export", "--world", world, "--out", link}).status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(run({"vdb", "info", (folder / "target.vdb").string()}).status, 0);
  // A node of our own that is full, where root may make one.
  const std::string full = (folder / "full").string();
  if (::mknod(full.c_str(), S_IFCHR | 0600, makedev(1, 7)) != 0) return;
  expect_refusal(run({"vdb", "export", "--world", world, "--out", full}), 1, {full, "No space"},
                 "full device");
  EXPECT_TRUE(std::filesystem::is_character_file(full));
}

TEST(VdbCommand, ExportsOfADamagedWorldAreAskedFor) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string world = make_ball(folder), out = (folder / "out.vdb").string();
  // Chunks are compressed by zstd: the middle of one is spoiled.
  std::string bytes = text_of(world);
  const std::string frame = "\x28\xb5\x2f\xfd";
  const std::size_t at = bytes.find(frame);
  ASSERT_NE(at, std::string::npos);
  bytes[at + 30] = static_cast<char>(bytes[at + 30] ^ 1);
  std::ofstream(world, std::ios::binary) << bytes;
  expect_refusal(run({"vdb", "export", "--world", world, "--out", out}), 1, {"--partial"},
                 "damage");
  EXPECT_FALSE(std::filesystem::exists(out));
  const Outcome partial = run({"vdb", "export", "--world", world, "--out", out, "--partial"});
  EXPECT_NE(partial.err.find("skerry: warning: "), std::string::npos) << partial.err;
  EXPECT_NE(partial.err.find("has lost"), std::string::npos) << partial.err;
  EXPECT_EQ(partial.status, 0) << partial.err;
}

TEST(VdbCommand, WarnsWhenMetadataDisagreesWithWhatWasRead) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string path = (folder / "odd.vdb").string(), out = (folder / "w").string();
  std::string bytes = text_of(sample("ball.vdb"));
  const std::size_t name = bytes.find("file_mem_bytes");
  ASSERT_NE(name, std::string::npos);
  // Behind the name come the type's name, with its length in front, and the number with its own.
  const std::size_t type = bytes.find("int64", name);
  ASSERT_EQ(type, name + 14 + 4);
  bytes[type + 5 + 4 + 3] ^= '\1';  // 16 MiB more
  std::ofstream(path, std::ios::binary) << bytes;
  for (const Outcome& outcome :
       {run({"vdb", "info", path}), run({"vdb", "import", path, "--out", out})}) {
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find("may be damaged"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run({"vdb", "info", sample("types.vdb")}).err, "");
}

/// A grid that states other active voxels than it holds, or another box of them, has lost some or
/// gained what was never there.
TEST(VdbCommand, RefusesAGridThatIsNotWhatItsMetadataState) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string path = (folder / "odd.vdb").string(), out = (folder / "w").string();
  const std::string good = text_of(sample("ball.vdb"));
  struct Stated {
    std::string name, type, refusal;
  };
  for (const Stated& stated : {Stated{"file_voxel_count", "int64", "active voxels and holds"},
                               Stated{"file_bbox_min", "vec3i", "not where it states"},
                               Stated{"file_bbox_max", "vec3i", "not where it states"}}) {
    std::string bytes = good;
    // As above: the name, the type and the numbers, each behind its length.
    const std::size_t type = bytes.find(stated.type, bytes.find(stated.name));
    ASSERT_EQ(type, bytes.find(stated.name) + stated.name.size() + 4);
    bytes[type + 5 + 4] ^= '\1';  // the lowest bit of the first number
    std::ofstream(path, std::ios::binary) << bytes;
    expect_refusal(run({"vdb", "info", path}), 1, {stated.refusal}, stated.name);
    expect_refusal(run({"vdb", "import", path, "--out", out}), 1, {stated.refusal}, stated.name);
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

/// As coreutils have it.
std::string sha256_of(const std::string& path) {
  const Folder folder;
  const std::string out = (folder / "sum").string();
  EXPECT_EQ(std::system(("sha256sum " + path + " > " + out).c_str()), 0);
  return text_of(out).substr(0, 64);
}

TEST(VdbCommand, ReadsOnlyTheFileThatIsExpected) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  const std::string ball = sample("ball.vdb"), out = (folder / "w").string();
  const std::string sum = sha256_of(ball), other = sha256_of(sample("cloud.vdb"));
  std::string upper = sum;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(run({"vdb", "info", ball, "--expect", upper}).status, 0);
  expect_refusal(run({"vdb", "info", ball, "--expect", other}), 1, {"ball.vdb", sum}, "info");
  expect_refusal(run({"vdb", "import", ball, "--out", out, "--expect", other}), 1, {sum}, "import");
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(run({"vdb", "import", ball, "--out", out, "--expect", sum}).status, 0);
  const std::string picture = (folder / "p.png").string();
  expect_refusal(run({"shot", "--world", ball, "--import", "expect=" + other, "--out", picture}), 1,
                 {sum}, "shot");
  for (const std::string& wrong : {sum.substr(1), sum + "0", std::string(64, 'g'), std::string()})
    expect_refusal(run({"vdb", "info", ball, "--expect", wrong}), 2, {"sha256sum"}, wrong);
  expect_refusal(run({"vdb", "info", (folder / "none.vdb").string(), "--expect", sum}), 1,
                 {"none.vdb"}, "missing");
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
