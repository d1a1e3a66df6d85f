#include "game/scene_file/expectations.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <regex>

#include <test_paths.h>
#include "game/scene_file/options.h"

namespace skerry::game {
namespace {

Result<Expectations> expectations_of(const std::string& fields) {
  const auto scene = parse_scene("{" + fields + "}");
  if (!scene) return scene.error();
  return scene->expectations;
}

std::string error_of(const std::string& fields) {
  const auto found = expectations_of(fields);
  EXPECT_FALSE(found) << fields;
  return found ? "" : found.error().message;
}

bool fits(const std::vector<Mask>& masks, const PictureSize& size) {
  Expectations expected;
  expected.masks = masks;
  return static_cast<bool>(check_expectations(expected, size));
}

TEST(Expectations, EveryFieldOfAFileArrives) {
  const auto found = expectations_of(
      R"("tolerance": {"flip_mean": 0.25, "flip_p99": 0.5, "flip_max": 1, "pixels_over": 0,
          "channel_threshold": 3, "code_values": 2, "pixels_rounded": 0.125, "bias": 0.75},
         "expects_dark": true, "masks": [[1, 2, 3, 4], [0, 0, 65535, 1]],
         "description": "A cave")");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->tolerance, (Tolerance{0.25, 0.5, 1.0, 0.0, 3, 2, 0.125, 0.75}));
  EXPECT_TRUE(found->expects_dark);
  EXPECT_EQ(found->masks, (std::vector<Mask>{{1, 2, 3, 4}, {0, 0, 65535, 1}}));
  EXPECT_EQ(found->description, "A cave");
}

TEST(Expectations, AFieldThatIsLeftOutKeepsItsDefault) {
  const auto found = expectations_of(R"("tolerance": {"flip_p99": 0.5})");
  ASSERT_TRUE(found);
  Tolerance expected;
  expected.flip_p99 = 0.5;
  EXPECT_EQ(found->tolerance, expected);
  EXPECT_FALSE(found->expects_dark);
}

TEST(Expectations, MistakesAreNamedInOneLine) {
  EXPECT_NE(error_of(R"("tolerence": {})").find("'tolerance'"), std::string::npos);
  EXPECT_NE(error_of(R"("expect_dark": true)").find("'expects_dark'"), std::string::npos);
  EXPECT_NE(error_of(R"("tolerance": {"flip_maen": 0})").find("'flip_mean'"), std::string::npos);
  for (const char* fields : {R"("tolerance": 1)",
                             R"("tolerance": {"flip_mean": -0.1})",
                             R"("tolerance": {"flip_mean": 1.1})",
                             R"("tolerance": {"flip_mean": "0.1"})",
                             R"("tolerance": {"flip_mean": null})",
                             R"("tolerance": {"flip_mean": NaN})",
                             R"("tolerance": {"flip_mean": 1e999})",
                             R"("tolerance": {"channel_threshold": 256})",
                             R"("tolerance": {"channel_threshold": 1.5})",
                             R"("tolerance": {"channel_threshold": -1})",
                             R"("expects_dark": 1)",
                             R"("expects_dark": "yes")",
                             R"("masks": {})",
                             R"("masks": [1])",
                             R"("masks": [[1, 2, 3]])",
                             R"("masks": [[1, 2, 3, 4, 5]])",
                             R"("masks": [[-1, 0, 3, 4]])",
                             R"("masks": [[0, 0, 0, 4]])",
                             R"("masks": [[0, 0, 4, 0]])",
                             R"("masks": [[0, 0, 1e9, 4]])",
                             R"("masks": [[0.5, 0, 1, 4]])",
                             R"("masks": [["0", 0, 1, 4]])",
                             R"("description": 5)",
                             R"("description": "")",
                             R"("description": "two\nlines")"}) {
    EXPECT_EQ(error_of(fields).find('\n'), std::string::npos) << fields;
  }
}

TEST(Expectations, TheDocumentTellsTheDefaults) {
  std::ifstream file(SKERRY_SOURCE_DIR "/docs/settings.md");
  ASSERT_TRUE(file);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::regex entry("\\n- `([a-z_.0-9]+)` \\([^\\n]*?(?:, default ([a-z0-9.]+))?\\)");
  std::map<std::string, std::string> documented;
  for (std::sregex_iterator it(text.begin(), text.end(), entry), end; it != end; ++it)
    documented[(*it)[1]] = (*it)[2];
  const Tolerance t;
  const std::map<std::string, std::string> expected{
      {"description", ""},
      {"expects_dark", "false"},
      {"masks", ""},
      {"tolerance.flip_mean", fmt::format("{}", t.flip_mean)},
      {"tolerance.flip_p99", fmt::format("{}", t.flip_p99)},
      {"tolerance.flip_max", fmt::format("{}", t.flip_max)},
      {"tolerance.pixels_over", fmt::format("{}", t.pixels_over)},
      {"tolerance.channel_threshold", fmt::format("{}", t.channel_threshold)},
      {"tolerance.code_values", fmt::format("{}", t.code_values)},
      {"tolerance.pixels_rounded", fmt::format("{}", t.pixels_rounded)},
      {"tolerance.bias", fmt::format("{}", t.bias)},
      {"tolerance.shift", "0"},
      {"tolerance.regions", ""}};
  EXPECT_EQ(documented, expected);
}

TEST(Expectations, HugeListsAreRefused) {
  std::string masks = "[0,0,1,1]";
  for (std::size_t i = 0; i < kMaxMasks; ++i) masks += ",[0,0,1,1]";
  EXPECT_NE(error_of("\"masks\": [" + masks + "]").find("at most 64"), std::string::npos);
  EXPECT_FALSE(expectations_of("\"description\": \"" + std::string(100000, 'x') + "\""));
  std::string nested = "\"masks\": ";
  for (int i = 0; i < 50000; ++i) nested += '[';
  EXPECT_FALSE(expectations_of(nested + std::string(50000, ']')));
}

TEST(Expectations, MasksStayInsideThePicture) {
  const PictureSize size{320, 180};
  EXPECT_TRUE(fits({}, size));
  EXPECT_TRUE(fits({{319, 179, 1, 1}}, size));
  EXPECT_FALSE(fits({{319, 179, 2, 1}}, size));
  EXPECT_FALSE(fits({{319, 179, 1, 2}}, size));
  EXPECT_FALSE(fits({{65535, 65535, 65535, 65535}}, size));
}

TEST(Expectations, RegionsBeginWithTheScenesTolerance) {
  // The file's order does not matter: what a region leaves out is the scene's.
  const auto found = expectations_of(
      R"("tolerance": {"shift": 2, "regions": [
          {"name": "leaves", "rectangle": [1, 2, 30, 40], "pixels_over": 0.5},
          {"flip_max": 0.25, "channel_threshold": 0, "rectangle": [0, 0, 1, 1], "name": "x"}],
         "flip_mean": 0.125})");
  ASSERT_TRUE(found) << found.error().message;
  Tolerance scene;
  scene.flip_mean = 0.125;
  Tolerance leaves = scene, other = scene;
  leaves.pixels_over = 0.5;
  other.flip_max = 0.25;
  other.channel_threshold = 0;
  EXPECT_EQ(found->tolerance, scene);
  EXPECT_EQ(found->shift, 2u);
  EXPECT_EQ(found->regions,
            (std::vector<Region>{{"leaves", {1, 2, 30, 40}, leaves}, {"x", {0, 0, 1, 1}, other}}));
}

TEST(Expectations, MistakesInRegionsAreNamedInOneLine) {
  const auto region = [](const std::string& fields) {
    return error_of(R"("tolerance": {"regions": [{"name": "a", "rectangle": [0, 0, 9, 9]}, {)" +
                    fields + "}]}");
  };
  const std::string place = R"("rectangle": [0, 0, 9, 9])";
  EXPECT_NE(region(R"("name": "b", "flip_maen": 0, )" + place).find("'flip_mean'"),
            std::string::npos);
  EXPECT_NE(region(R"("name": "b", "regions": [], )" + place).find("region has an unknown"),
            std::string::npos);
  EXPECT_NE(region(R"("name": "a", )" + place).find("another name"), std::string::npos);
  EXPECT_NE(region(R"("name": "elsewhere", )" + place).find("another name"), std::string::npos);
  for (const std::string& fields :
       {std::string(), place, std::string(R"("name": "b")"), R"("name": 5, )" + place,
        R"("name": "", )" + place, R"("name": "two\nlines", )" + place,
        "\"name\": \"" + std::string(41, 'x') + "\", " + place,
        std::string(R"("name": "b", "rectangle": [0, 0, 0, 1])"),
        std::string(R"("name": "b", "rectangle": [0, 0, 1])"),
        std::string(R"("name": "b", "rectangle": [0, 0, 1e9, 1])"),
        std::string(R"("name": "b", "rectangle": "all")"),
        R"("name": "b", "flip_mean": 2, )" + place,
        R"("name": "b", "channel_threshold": 256, )" + place})
    EXPECT_EQ(region(fields).find('\n'), std::string::npos) << fields;
  for (const char* fields : {R"("tolerance": {"shift": 17})", R"("tolerance": {"shift": -1})",
                             R"("tolerance": {"shift": 0.5})", R"("tolerance": {"shift": "1"})",
                             R"("tolerance": {"regions": {}})", R"("tolerance": {"regions": [1]})"})
    EXPECT_EQ(error_of(fields).find('\n'), std::string::npos) << fields;
  std::string many;
  for (std::size_t i = 0; i <= kMaxRegions; ++i)
    many += fmt::format(R"({}{{"name": "{}", {}}})", i == 0 ? "" : ",", i, place);
  EXPECT_NE(error_of(R"("tolerance": {"regions": [)" + many + "]}").find("at most 64"),
            std::string::npos);
}

TEST(Expectations, RegionsStayInsideThePicture) {
  Expectations expected;
  expected.regions = {{"a", {319, 179, 1, 1}, {}}};
  EXPECT_TRUE(check_expectations(expected, {320, 180}));
  EXPECT_FALSE(check_expectations(expected, {319, 180}));
  EXPECT_FALSE(check_expectations(expected, {320, 179}));
}

TEST(Expectations, AShiftLeavesSomethingToCompare) {
  Expectations expected;
  expected.shift = 4;
  EXPECT_TRUE(check_expectations(expected, {9, 9}));
  EXPECT_FALSE(check_expectations(expected, {8, 90}));
  EXPECT_FALSE(check_expectations(expected, {90, 8}));
  expected.masks = {{4, 4, 1, 1}};  // the one pixel that has a partner wherever the picture lies
  EXPECT_FALSE(check_expectations(expected, {9, 9}));
  EXPECT_TRUE(check_expectations(expected, {10, 9}));
}

TEST(Expectations, MasksLeaveSomethingToCompare) {
  std::mt19937 random(3);
  int covered = 0;
  for (int round = 0; round < 3000; ++round) {
    const PictureSize size{1 + static_cast<std::uint32_t>(random() % 5),
                           1 + static_cast<std::uint32_t>(random() % 5)};
    std::vector<Mask> masks;
    for (std::size_t i = random() % 6; i > 0; --i) {
      const auto x = static_cast<std::uint32_t>(random() % size.width);
      const auto y = static_cast<std::uint32_t>(random() % size.height);
      masks.push_back({x, y, 1 + static_cast<std::uint32_t>(random() % (size.width - x)),
                       1 + static_cast<std::uint32_t>(random() % (size.height - y))});
    }
    bool something = false;  // pixel by pixel
    for (std::uint32_t pixel = 0; pixel < size.width * size.height; ++pixel)
      something = something || !is_masked(masks, pixel % size.width, pixel / size.width);
    EXPECT_EQ(fits(masks, size), something);
    covered += something ? 0 : 1;
  }
  EXPECT_GT(covered, 50);
}

}  // namespace
}  // namespace skerry::game
