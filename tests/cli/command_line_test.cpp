// Runs the program itself, as scripts do: exit statuses and the one line on stderr are its
// contract.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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
                                                    {"shot", "-h"},
                                                    {"test", "--help"},
                                                    {"bench", "--help"},
                                                    {"bench", "mesh", "--help"},
                                                    {"bench", "generate", "--help"},
                                                    {"bench", "upload", "--help"},
                                                    {"bench", "cull", "--help"},
                                                    {"bench", "frame", "--help"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << joined(arguments) << outcome.err;
    EXPECT_NE(outcome.out.find("Usage: skerry"), std::string::npos) << joined(arguments);
    EXPECT_TRUE(outcome.err.empty());
  }
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
      {{"bench"}, {"mesh, generate, upload, cull or frame"}},
      {{"bench", "mehs"}, {"'mesh'"}},
      {{"bench", "mesh", "--inptu", "x"}, {"'--input'"}},
      {{"bench", "cull", "--device", "-1"}, {"--device"}},
      {{"bench", "frame"}, {"--seed"}},
      {{"shot", "--seed", "1", "--set", std::string(100000, 'x')}, {"'xxx"}},
  };
  for (const auto& [arguments, parts] : cases)
    expect_refusal(run(arguments), 2, parts, joined(arguments));
}

TEST(CommandLine, WhatIsNotInThisBuildIsNotListed) {
  const Outcome help = run({"--help"});
  for (const char* command : {"report", "stability", "vdb"}) {
    EXPECT_EQ(help.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
    EXPECT_EQ(run({command}).status, 2) << command;
  }
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
  expect_refusal(run({"--world", "/"}), 1, {"cannot load saved worlds"}, "play world");
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

TEST(CommandLine, ADeviceThatDoesNotExistIsStatusFour) {
  const Folder folder;
  expect_refusal(
      run({"shot", "--seed", "1", "--device", "999", "--out", (folder / "a.png").string()}), 4,
      {"999"}, "device");
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

}  // namespace
}  // namespace skerry
