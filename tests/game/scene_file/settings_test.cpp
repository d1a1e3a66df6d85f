#include "game/scene_file/setting_keys.h"

#include <gtest/gtest.h>

#include <test_paths.h>
#include <algorithm>
#include <fstream>
#include <regex>

namespace skerry::game {
namespace {

std::string error_of(std::string_view assignment) {
  Settings settings;
  const auto done = apply_setting(assignment, settings);
  EXPECT_FALSE(done) << assignment;
  EXPECT_EQ(settings, Settings()) << assignment << " changed something though it is wrong";
  return done ? "" : done.error().message;
}

TEST(Settings, AnUnknownKeyNamesTheNearest) {
  EXPECT_NE(error_of("view.distanse=100").find("'view.distance'"), std::string::npos);
  EXPECT_NE(error_of("shadows.size=100").find("'shadow.size'"), std::string::npos);
  EXPECT_NE(error_of("=1").find("did you mean"), std::string::npos);
}

TEST(Settings, AnUnknownValueNamesTheNearestAndAllThereAre) {
  EXPECT_NE(error_of("debug.view=nromal").find("did you mean 'normal'"), std::string::npos);
  EXPECT_NE(error_of("shading=flatt").find("'flat'"), std::string::npos);
  EXPECT_NE(error_of("upload.path=mapp").find("'mapped'"), std::string::npos);
}

TEST(Settings, RenderersOfOtherBuildsAreNamedAsMissing) {
  EXPECT_NE(error_of("renderer=forward").find("not in this build"), std::string::npos);
  Settings settings;
  EXPECT_TRUE(apply_setting("renderer=deferred", settings));
  EXPECT_TRUE(apply_setting("renderer=auto", settings));
}

TEST(Settings, ValuesOutOfRangeAreRefused) {
  for (const char* assignment : {"view.distance=31",
                                 "view.distance=16385",
                                 "view.distance=1.5",
                                 "view.distance=",
                                 "view.detail=0",
                                 "shadow.size=300",
                                 "shadow.size=16384",
                                 "shadow.enabled=2",
                                 "shadow.enabled=true",
                                 "exposure=nan",
                                 "exposure=21",
                                 "sky.moon_phase=1.01",
                                 "sky.moon_phase=-0.1",
                                 "world.offset=1,2",
                                 "world.offset=1,2,3.5",
                                 "world.offset=1,2,1099511627777",
                                 "world.islands=-1",
                                 "world.time=inf",
                                 "world.time=1e300",
                                 "upload.budget=1",
                                 "jobs.threads=257",
                                 "memory.budget=7",
                                 "memory.budget=1048577",
                                 "shadow.cascades=0",
                                 "shadow.cascades=5",
                                 "shadow.taps=2",
                                 "shadow.taps=08",
                                 "texture.taps=0",
                                 "texture.taps=17",
                                 "gbuffer.normal=oct12",
                                 "leave.out=",
                                 "leave.out=sun,moon",
                                 "leave.out=sun+none",
                                 "leave.out=sun+",
                                 "gbuffer.position=rgb32f",
                                 "gbuffer.depth=24",
                                 "water.layers=0",
                                 "water.layers=5",
                                 "view.distance",
                                 ""}) {
    EXPECT_FALSE(error_of(assignment).empty()) << assignment;
  }
}

TEST(Settings, EveryKeyReadsBackWhatItPrints) {
  Settings odd;
  for (const char* assignment : {"world.offset=1099511627776,-1099511627776,7",
                                 "world.islands=0",
                                 "world.time=123456.789",
                                 "sky.moon_phase=0.1",
                                 "view.distance=32",
                                 "view.detail=4096",
                                 "shadow.enabled=0",
                                 "shadow.size=256",
                                 "shadow.cascades=3",
                                 "shadow.taps=32",
                                 "shadow.split=0.5",
                                 "shadow.samples=7",
                                 "aa=edge",
                                 "aa.samples=4",
                                 "shadow.blur=0.25",
                                 "texture.taps=16",
                                 "gbuffer.normal=rgb8",
                                 "gbuffer.position=rgba32f",
                                 "gbuffer.depth=d16",
                                 "leave.out=moon+haze",
                                 "exposure=-1.5",
                                 "exposure.key=0.18",
                                 "exposure.min=-6.25",
                                 "exposure.max=2",
                                 "exposure.stride=3",
                                 "bloom.intensity=0.25",
                                 "bloom.threshold=2.5",
                                 "bloom.levels=4",
                                 "tone=agx",
                                 "display.peak=0.75",
                                 "display.black=0.03",
                                 "shading=flat",
                                 "debug.view=emissive",
                                 "upload.path=mapped",
                                 "renderer=reference",
                                 "reference.samples=9",
                                 "reference.filter=centre",
                                 "upload.budget=65536",
                                 "jobs.threads=8",
                                 "memory.budget=32",
                                 "water.layers=4"}) {
    const auto done = apply_setting(assignment, odd);
    ASSERT_TRUE(done) << done.error().message;
  }
  Settings back;
  for (const SettingKey& key : setting_keys()) {
    const auto done = apply_setting(key.key, key.print(odd), back);
    ASSERT_TRUE(done) << key.key << ": " << done.error().message;
  }
  EXPECT_EQ(back, odd);
}

TEST(Settings, AssignmentsRebuildTheSettingsFromTheirLevel) {
  for (const Quality quality : {Quality::kLow, Quality::kMedium, Quality::kHigh, Quality::kUltra}) {
    EXPECT_TRUE(assignments_from(quality, settings_of(quality)).empty());
    Settings wanted = settings_of(quality);
    wanted.view_distance = 777;
    wanted.exposure_ev = 0.25;
    const auto assignments = assignments_from(quality, wanted);
    EXPECT_EQ(assignments.size(), 2u);
    Settings got = settings_of(quality);
    for (const auto& assignment : assignments) ASSERT_TRUE(apply_setting(assignment, got));
    EXPECT_EQ(got, wanted);
  }
}

TEST(Settings, TheDefaultsAreQualityMedium) {
  EXPECT_EQ(settings_of(Quality::kMedium), Settings());
  EXPECT_FALSE(parse_quality("med"));
  EXPECT_EQ(*parse_quality("ultra"), Quality::kUltra);
}

TEST(Settings, TheDocumentListsExactlyTheKeys) {
  std::ifstream file(SKERRY_SOURCE_DIR "/docs/settings.md");
  ASSERT_TRUE(file);
  std::vector<std::string> documented;
  // Rows without a key go on with the row before them.
  const std::regex row("\\| `([a-z_.]+)` \\| ([^|]*) \\|.*"),
      more("\\| \\| (?:([^|]+) )?\\| [^|]*\\| \\|");
  std::smatch part;
  for (std::string line; std::getline(file, line);) {
    if (std::regex_match(line, part, row))
      documented.push_back(part[1].str() + ": " + part[2].str());
    else if (std::regex_match(line, part, more) && part[1].matched)
      documented.back().append(1, ' ').append(part[1].str());
  }
  std::vector<std::string> keys;
  for (const SettingKey& key : setting_keys())
    keys.push_back(std::string(key.key) + ": " + std::string(key.values));
  EXPECT_EQ(documented, keys);
}

}  // namespace
}  // namespace skerry::game
