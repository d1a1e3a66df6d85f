// Runs the program itself, as scripts do: exit statuses and the one line on stderr are its
// contract.
#include <gtest/gtest.h>
#include <skerry_version.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "engine/platform/files.h"
#include "tests/cli/run_program.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& arguments) {
  std::string text;
  for (const std::string& argument : arguments) text += " [" + argument.substr(0, 60) + "]";
  return text;
}

TEST(CommandLine, HelpIsThereOnEveryLevel) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"play", "--help"},
                                                    {"shot", "--help"},
                                                    {"devices", "--help"},
                                                    {"report", "--help"},
                                                    {"shot", "-h"},
                                                    {"test", "--help"},
                                                    {"bench", "--help"},
                                                    {"bench", "mesh", "--help"},
                                                    {"bench", "generate", "--help"},
                                                    {"bench", "upload", "--help"},
                                                    {"bench", "cull", "--help"},
                                                    {"bench", "device", "--help"},
                                                    {"bench", "flicker", "--help"},
                                                    {"bench", "pops", "--help"},
                                                    {"bench", "frame", "--help"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << joined(arguments) << outcome.err;
    EXPECT_NE(outcome.out.find("Usage: skerry"), std::string::npos) << joined(arguments);
    EXPECT_TRUE(outcome.err.empty());
  }
}

TEST(CommandLine, SaysItsVersionInOneLine) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, std::string("skerry ") + kSkerryVersion + "\n");
  EXPECT_TRUE(outcome.err.empty());
}

TEST(CommandLine, UsageErrorsExitWithTwoAndNameWhatWasMeant) {
  const std::string with_newline = "a\nb";
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> cases{
      {{"shto"}, {"'shot'"}},
      {{"shot"}, {"--seed"}},
      {{"shot", "--sede", "1"}, {"'--sede'", "'--seed'"}},
      {{"shot", "--seed"}, {"--seed"}},
      {{"shot", "--seed", "1", "--seed", "2"}, {"--seed"}},
      {{"shot", "--seed", "1", "more"}, {"'more'"}},
      {{"shot", "--seed", "1", "--size", "0x100"}, {"'0'"}},
      {{"shot", "--seed", "1", "--size", "-1x100"}, {"'-1'"}},
      {{"shot", "--seed", "1", "--size", "axb"}, {"'a'"}},
      {{"shot", "--seed", "1", "--size", with_newline}, {"\\x0a"}},
      {{"shot", "--seed", "1", "--camera", "nan,0,0,0,0"}, {"camera X", "'nan'"}},
      {{"shot", "--seed", "1", "--camera", "0,1e300,0,0,0"}, {"camera Y", "'1e300'"}},
      {{"shot", "--seed", "1", "--camera", "0,0,inf,0,0"}, {"camera Z"}},
      {{"shot", "--seed", "1", "--camera", "0,0,0,0,91"}, {"PITCH"}},
      {{"shot", "--seed", "1", "--camera", "1,2"}, {"X,Y,Z,YAW,PITCH"}},
      {{"shot", "--seed", "1", "--fov", "0"}, {"0.1", "175"}},
      {{"shot", "--seed", "1", "--time", "25:00"}, {"HH:MM"}},
      {{"shot", "--seed", "1", "--quality", "hihg"}, {"'high'"}},
      {{"shot", "--seed", "1", "--device", "x"}, {"--device"}},
      {{"shot", "--seed", "1", "--set", "view.distence=5"}, {"'view.distance'"}},
      {{"shot", "--seed", "1", "--set", "nothing"}, {"KEY=VALUE"}},
      {{"shot", "--seed", "1", "--renderer", "forward"}, {"not in this build", "deferred"}},
      {{"shot", "--seed", "1", "--renderer", "referense"}, {"'reference'"}},
      {{"shot", "--seed", "1", "--set", "reference.samples=0"}, {"1", "65536"}},
      {{"shot", "--seed", "1", "--renderer", "reference", "--set", "debug.view=depth"},
       {"debug.view"}},
      {{"shot", "--seed", "1", "--renderer", "reference", "--size", "65535x65535"},
       {"--size", "pixels"}},
      {{"play", "--renderer", "reference"}, {"skerry shot"}},
      {{"bench", "frame", "--seed", "1", "--renderer", "reference"}, {"skerry shot"}},
      {{"shot", "--seed", "1", "--shading", "pbrr"}, {"'pbr'"}},
      {{"--no-such"}, {"'--no-such'"}},
      {{"devices", "--jsno"}, {"'--json'"}},
      {{"test", "x.json", "--aprove"}, {"'--approve'"}},
      {{"test", "x.json", "--shard", "3/2"}, {"the shard", "'3'"}},
      {{"test", "x.json", "--shard", "half"}, {"I/N"}},
      {{"test", "x.json", "--jobs", "0"}, {"--jobs"}},
      {{"test", "x.json", "--repeat", "-1"}, {"--repeat"}},
      {{"test", "x.json", "--approve", "--repeat", "2"}, {"--repeat"}},
      {{"test", "x.json", "--merge", "--validate"}, {"--merge"}},
      {{"bench"},
       {"mesh, generate, world, upload, cull, device, lights, shade, frame, flicker, pops, edit, "
        "fly or start"}},
      {{"bench", "mehs"}, {"'mesh'"}},
      {{"bench", "mesh", "--inptu", "x"}, {"'--input'"}},
      {{"bench", "cull", "--device", "-1"}, {"--device"}},
      {{"bench", "frame"}, {"--seed"}},
      {{"bench", "flicker"}, {"--seed"}},
      {{"bench", "pops", "--seed", "1", "--speed", "0"}, {"--speed", "1"}},
      {{"bench", "fliker"}, {"'flicker'"}},
      {{"bench", "flicker", "--seed", "1", "--frames", "1"}, {"--frames", "2"}},
      {{"report", "shadow_sise", "--out", "x"}, {"'shadow_sise'", "'shadow_size'"}},
      {{"report", "leftout", "--out", "x"}, {"'left_out'"}},
      {{"report", "shadow_size"}, {"--out DIR"}},
      {{"report", "--uot", "x"}, {"'--out'"}},
      {{"shot", "--seed", "1", "--set", std::string(100000, 'x')}, {"'xxx"}},
  };
  for (const auto& [arguments, parts] : cases)
    expect_refusal(run(arguments), 2, parts, joined(arguments));
}

TEST(CommandLine, FilesThatCannotBeUsedExitWithOne) {
  expect_refusal(run({"shot", "--seed", "1", "--out", "/no/such/folder/a.png"}), 1,
                 {"/no/such/folder/a.png", "No such file"}, "out");
  expect_refusal(run({"shot", "--seed", "1", "--out", "/"}), 1, {"directory"}, "folder");
  expect_refusal(run({"shot", "--seed", "1", "--stats", "/no/such/folder/a.json"}), 1, {"a.json"},
                 "stats");
  expect_refusal(run({"shot", "--scene", "/no/such.json"}), 1, {"/no/such.json"}, "scene");
  expect_refusal(run({"shot", "--world", "/no/such/world"}), 1, {"does not exist"}, "world");
  expect_refusal(run({"bench", "mesh", "--input", "/no/such"}), 1, {"/no/such"}, "bench input");
  expect_refusal(run({"bench", "cull", "--json", "/no/such/a.json"}), 1, {"a.json"}, "bench json");
  expect_refusal(run({"report", "--out", "/no/such/report"}), 1, {"/no/such/report", "--out"},
                 "report");
  expect_refusal(run({"--world", "/"}), 1, {"is a folder"}, "play world");
}

/// Everything in a folder: names, types, contents and what links lead to.
std::map<std::string, std::string> snapshot(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::file_status status = entry.symlink_status();
    std::string& what = all[entry.path().filename().string()];
    what = std::to_string(static_cast<int>(status.type()));
    if (entry.is_symlink()) what += fs::read_symlink(entry.path()).string();
    if (entry.is_regular_file() && !entry.is_symlink()) what += text_of(entry.path());
  }
  return all;
}

/// A reference picture: small, and drawn without a device.
std::vector<std::string> small_shot(const fs::path& out, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"shot",
                                     "--seed",
                                     "1",
                                     "--renderer",
                                     "reference",
                                     "--set",
                                     "reference.samples=1",
                                     "--set",
                                     "view.distance=64",
                                     "--size",
                                     "8x4",
                                     "--out",
                                     out.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(CommandLine, StatsThatCannotBeWrittenLeaveNoPictureBehind) {
  const auto refused = [](bool stats_are_the_pipe) {
    const Folder folder;
    const fs::path pipe = folder / "pipe";
    std::ofstream(folder / "a.png") << "old";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto before = snapshot(folder.path());
    const Outcome outcome =
        stats_are_the_pipe ? run(small_shot(folder / "a.png", {"--stats", pipe.string()}))
                           : run(small_shot(pipe, {"--stats", (folder / "new.json").string()}));
    expect_refusal(outcome, 1, {pipe.string(), "nobody reads the pipe"},
                   stats_are_the_pipe ? "stats" : "out");
    EXPECT_EQ(snapshot(folder.path()), before);
  };
  // Both wait ten seconds for a reader: at once.
  const std::jthread stats(refused, true), out(refused, false);
}

TEST(CommandLine, APipeThatNobodyWritesIsNoScene) {
  const Folder folder;
  const std::string pipe = (folder / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  // Those that wait ten seconds for a writer, at once.
  auto scene = std::async(std::launch::async, [&] { return run({"shot", "--scene", pipe}); });
  auto test = std::async(std::launch::async, [&] { return run({"test", pipe}); });
  expect_refusal(run({"shot", "--world", pipe}), 1, {pipe, "no file"}, "world");
  expect_refusal(scene.get(), 1, {pipe, "within 10 s"}, "scene");
  expect_refusal(test.get(), 2, {pipe, "within 10 s"}, "test");
}

// Mesa's own cache stays, so that the driver need not compile all anew.
TEST(CommandLine, ACacheFolderThatIsAFileIsToldInOneWarning) {
  const Folder folder;
  std::ofstream(folder / "skerry") << "in the way";
  const Outcome outcome =
      run({"shot", "--seed", "1", "--set", "view.distance=64", "--size", "8x4", "--out",
           (folder / "a.png").string()},
          {"XDG_CACHE_HOME=" + folder.path().string(),
           "MESA_SHADER_CACHE_DIR=" + platform::cache_dir().parent_path().string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("skerry: warning: compiled shaders are not kept"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(text_of(folder / "skerry"), "in the way");
}

TEST(CommandLine, MistakesInASceneFileAreUsageErrors) {
  const Folder folder;
  const auto scene = [&](const std::string& json) {
    std::ofstream(folder / "scene.json") << json;
    return run({"shot", "--scene", (folder / "scene.json").string()});
  };
  expect_refusal(scene("{"), 2, {"not JSON"}, "broken");
  expect_refusal(scene(R"({"sead": 1})"), 2, {"'seed'"}, "field");
  expect_refusal(scene(R"({"settings": {"shadow.siz": 1}})"), 2, {"'shadow.size'"}, "setting");
  expect_refusal(scene(R"({"camera": [0, 1e300, 0, 0, 0]})"), 2, {"camera Y"}, "camera");
  expect_refusal(scene(R"({"seed": 1, "seed": 2})"), 2, {"'seed' twice"}, "twice");
  expect_refusal(scene(R"({"world": 3})"), 2, {"'world'", "quotation marks"}, "world");
}

TEST(CommandLine, WithoutADriverTheStatusIsFour) {
  const std::vector<std::string> no_driver{"VK_ICD_FILENAMES=/no/such/driver.json",
                                           "VK_DRIVER_FILES=/no/such/driver.json"};
  expect_refusal(run({"devices"}, no_driver), 4, {}, "devices");
  const Folder folder;
  expect_refusal(run({"shot", "--seed", "1", "--out", (folder / "a.png").string()}, no_driver), 4,
                 {}, "shot");
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

TEST(CommandLine, AReferencePictureNeedsNoDriverAndIsTheSameOnAnyNumberOfThreads) {
  const Folder folder;
  const auto hash_with = [&](const char* threads) {
    const Outcome outcome =
        run({"shot", "--seed", "1", "--renderer", "reference", "--set", "reference.samples=2",
             "--set", "view.distance=64", "--set", threads, "--size", "24x16", "--out",
             (folder / "a.png").string(), "--stats", (folder / "a.json").string()},
            {"VK_ICD_FILENAMES=/no/such/driver.json", "VK_DRIVER_FILES=/no/such/driver.json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "a.png"));
    const auto stats = nlohmann::json::parse(text_of(folder / "a.json"));
    EXPECT_EQ(stats["non_finite_pixels"], 0);
    EXPECT_GT(stats["error"]["mean_standard_error"].get<double>(), 0.0);
    return stats["image_sha256"].get<std::string>();
  };
  EXPECT_EQ(hash_with("jobs.threads=1"), hash_with("jobs.threads=3"));
}

TEST(CommandLine, ADeviceThatDoesNotExistIsStatusFour) {
  const Folder folder;
  expect_refusal(
      run({"shot", "--seed", "1", "--device", "999", "--out", (folder / "a.png").string()}), 4,
      {"999"}, "device");
  // Though these rows are worked out on the CPU.
  expect_refusal(run({"stability", "--device", "99", "time.clock"}), 4, {"99"}, "stability");
}

TEST(CommandLine, DevicesListsWhatCanBeUsed) {
  const Outcome outcome = run({"devices", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_FALSE(json["devices"].empty());
  for (const auto& device : json["devices"]) {
    EXPECT_TRUE(device["name"].is_string() && device["driver"].is_string());
    EXPECT_EQ(device["usable"].get<bool>(), device["missing"].empty());
  }
}

TEST(CommandLine, PlayWithoutADisplaySaysSoAndNamesShot) {
  expect_refusal(run({"play", "--seed", "1"}, {"DISPLAY", "WAYLAND_DISPLAY"}), 1,
                 {"display", "skerry shot"}, "no display");
  expect_refusal(run({}, {"DISPLAY=:987", "WAYLAND_DISPLAY"}), 1, {"display", "skerry shot"},
                 "wrong display");
}

TEST(CommandLine, AReportIsWholeOrNotThere) {
  const Folder folder;
  const fs::path dir = folder / "report";
  const Outcome outcome =
      run({"report", "water_layers", "--size", "24x16", "--out", dir.string(), "--set",
           "reference.samples=1", "--set", "view.distance=128", "--set", "indirect=off"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("index.html"), std::string::npos);
  for (const char* name :
       {"index.html", "report.json", "water_layers.csv", "water_layers.json", "water_layers.svg",
        "water_layers-water-reference.png", "water_layers-water-3.png",
        "water_layers-water-3-flip.png", "water_layers-water-3-difference.png"})
    EXPECT_TRUE(fs::is_regular_file(dir / name)) << name;
  const auto json = nlohmann::json::parse(text_of(dir / "report.json"));
  EXPECT_EQ(json["topics"].size(), 1u);
  EXPECT_EQ(json["topics"][0]["rows"].size(), 4u);
  EXPECT_TRUE(json["command"].get<std::string>().starts_with("skerry report water_layers --size"));
  for (const auto& row : json["topics"][0]["scenes"][0]["rows"]) {
    EXPECT_GT(row["ms_median"], 0.0);
    EXPECT_GT(row["flip_mean"], 0.0);  // no GPU picture is the reference, to the last bit
    EXPECT_LT(row["flip_mean"], 0.3);  // and none is another scene
  }
  const auto& last = json["topics"][0]["rows"].back();
  EXPECT_EQ(last["change_flip_mean"], 0.0);
  EXPECT_EQ(last["same_bytes_as_last"], true);
}

TEST(CommandLine, AReportThatFailsLeavesNothing) {
  const Folder folder;
  std::ofstream(folder / "thesis.txt") << "years";
  expect_refusal(run({"report", "--out", folder.path().string()}), 1, {"no report", "--out"},
                 "foreign folder");
  const std::vector<std::string> no_driver{"VK_ICD_FILENAMES=/no/such/driver.json",
                                           "VK_DRIVER_FILES=/no/such/driver.json"};
  expect_refusal(run({"report", "--out", (folder / "report").string()}, no_driver), 4, {},
                 "no driver");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
  EXPECT_EQ(text_of(folder / "thesis.txt"), "years");
}

}  // namespace
}  // namespace skerry
