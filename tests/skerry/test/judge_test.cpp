#include "tools/skerry/test/judge.h"

#include <gtest/gtest.h>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

platform::PngImage picture(std::uint32_t width, std::uint32_t height, std::uint8_t value) {
  platform::PngImage image{width, height, {}, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    for (const std::uint8_t channel : {value, static_cast<std::uint8_t>(i % 7), value})
      image.pixels.push_back(channel);
    image.pixels.push_back(255);
  }
  return image;
}

/// The same with one channel of one pixel off by one.
platform::PngImage nearly(platform::PngImage image) {
  image.pixels[4 * 100 + 1] ^= 1;
  return image;
}

class Judge : public testing::Test {
 protected:
  Judge() {
    scene_.name = "day";
    scene_.file = folder_ / "day.json";
    shown_.picture = picture(32, 18, 100);
    shown_.driver = "mine";
  }
  fs::path reference() const { return scene_.reference(shown_.driver); }
  void write_reference(const platform::PngImage& image, const std::string& driver = "mine") {
    const std::vector<platform::PngText> text{{"Driver", driver}};
    ASSERT_TRUE(
        platform::write_png(reference(), {image.width, image.height, 4, image.pixels}, text));
  }
  Row row(const Hashes& approved = {}) { return judge(scene_, shown_, approved, {}).row; }
  Outcome approve(const Hashes& approved = {}) {
    JudgeOptions options;
    options.approve = true;
    return judge(scene_, shown_, approved, options);
  }
  void expect_failure(const Row& row, const std::string& why) {
    EXPECT_TRUE(row.failed());
    EXPECT_EQ(row.failed_runs, 1);
    EXPECT_NE(row.message.find(why), std::string::npos) << row.message;
    EXPECT_EQ(row.message.find('\n'), std::string::npos) << row.message;
  }

  Folder folder_;
  TestScene scene_;
  Shown shown_;
};

TEST_F(Judge, TheReferencesOwnPicturePasses) {
  write_reference(shown_.picture);
  const Row found = row();
  EXPECT_EQ(found.verdict, Verdict::kPass);
  EXPECT_TRUE(found.message.empty());
  EXPECT_FALSE(found.hash_equal.has_value());
  EXPECT_TRUE(found.found->equal());
}

TEST_F(Judge, ApprovedHashesAreComparedFirst) {
  write_reference(picture(32, 18, 200));  // far off
  const std::string hash = sha256_hex(shown_.picture.pixels);
  const Row same = row({{"day", hash}});
  EXPECT_EQ(same.verdict, Verdict::kPass);
  EXPECT_EQ(same.hash_equal, true);
  EXPECT_GT(same.found->flip_mean, 0.1);  // the numbers are told all the same
  const Row other = row({{"day", std::string(64, '0')}, {"night", hash}});
  EXPECT_EQ(other.hash_equal, false);
  expect_failure(other, "FLIP mean");
}

TEST_F(Judge, WithoutItsHashAPictureMustBeWithinTheTolerance) {
  write_reference(nearly(shown_.picture));
  const Row near = row({{"day", std::string(64, '0')}});
  EXPECT_EQ(near.verdict, Verdict::kPass);
  EXPECT_EQ(near.hash_equal, false);
  scene_.expected.tolerance.pixels_over = 0.0;
  scene_.expected.tolerance.channel_threshold = 0;
  expect_failure(row(), "share of pixels");
}

TEST_F(Judge, AReferenceThatIsMissingOrWrongIsAFailure) {
  expect_failure(row(), "no reference yet");
  write_reference(picture(33, 18, 100));
  expect_failure(row(), "33x18");
  write_reference(shown_.picture);
  const auto text = platform::read_text(reference(), 1 << 20);
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{7}, text->size() / 2}) {
    ASSERT_TRUE(write_text(reference(), text->substr(0, bytes)));
    expect_failure(row(), "day.png");
  }
  const std::string hash = sha256_hex(shown_.picture.pixels);
  expect_failure(row({{"day", hash}}), "day.png");  // an approved hash does not make up for it
}

TEST_F(Judge, ABlackPictureMustBeExpected) {
  shown_.picture = picture(32, 18, 0);
  write_reference(shown_.picture);
  expect_failure(row(), "black");
  expect_failure(approve().row, "black");
  scene_.expected.expects_dark = true;
  EXPECT_EQ(row().verdict, Verdict::kPass);
}

TEST_F(Judge, APictureThatIsNotFiniteIsAFailure) {
  write_reference(shown_.picture);
  shown_.non_finite = 3;
  expect_failure(row(), "3 pixels were not finite");
  expect_failure(approve().row, "not finite");
}

TEST_F(Judge, WhatIsApprovedPassesAfterwards) {
  const Outcome first = approve();
  EXPECT_EQ(first.row.verdict, Verdict::kApproved);
  EXPECT_TRUE(first.replaced);
  const Hashes hashes{{"day", first.hash}};
  const Row passed = row(hashes);
  EXPECT_EQ(passed.verdict, Verdict::kPass);
  EXPECT_EQ(passed.hash_equal, true);
  EXPECT_EQ(approve(hashes).row.verdict, Verdict::kPass);  // nothing left to approve
  shown_.picture = picture(32, 18, 160);
  const Outcome second = approve(hashes);
  EXPECT_TRUE(second.replaced);
  EXPECT_TRUE(row({{"day", second.hash}}).found->equal());
}

TEST_F(Judge, ApprovingReplacesADamagedReference) {
  ASSERT_TRUE(write_text(reference(), "no picture"));
  EXPECT_TRUE(approve().replaced);
  EXPECT_EQ(row().verdict, Verdict::kPass);
}

TEST_F(Judge, AnotherDriversReferenceStaysWhenThePictureIsWithinTheTolerance) {
  write_reference(nearly(shown_.picture), "theirs");
  const Outcome near = approve();
  EXPECT_EQ(near.row.verdict, Verdict::kApproved);
  EXPECT_FALSE(near.replaced);
  EXPECT_EQ(platform::read_png(reference())->pixels, nearly(shown_.picture).pixels);
  shown_.picture = picture(32, 18, 160);
  EXPECT_TRUE(approve().replaced);
}

TEST_F(Judge, ABaselineHasAFolderADriver) {
  const fs::path beside = reference();
  write_reference(picture(32, 18, 200));  // beside the scene, and not looked at
  scene_.baseline = folder_ / "baseline";
  EXPECT_EQ(reference(), folder_ / "baseline/mine/day.png");
  EXPECT_EQ(scene_.reference("theirs"), folder_ / "baseline/theirs/day.png");
  expect_failure(row(), "no reference yet");
  EXPECT_TRUE(approve().replaced);
  EXPECT_EQ(row().verdict, Verdict::kPass);
  EXPECT_EQ(platform::read_png(reference())->pixels, shown_.picture.pixels);
  EXPECT_EQ(platform::read_png(beside)->pixels, picture(32, 18, 200).pixels);
  shown_.driver = "theirs";
  expect_failure(row(), "no reference yet");
}

TEST_F(Judge, AReportShowsWhatThereIs) {
  JudgeOptions options;
  options.html = folder_.path();
  const auto there = [&](ReportPicture kind) {
    return fs::exists(folder_ / report_picture_name("day", kind));
  };
  write_reference(picture(32, 18, 160));
  judge(scene_, shown_, {}, options);
  for (const ReportPicture kind : kReportPictures) EXPECT_TRUE(there(kind));
  const auto actual =
      platform::read_png(folder_ / report_picture_name("day", ReportPicture::kActual));
  EXPECT_EQ(actual->pixels, shown_.picture.pixels);
  fs::remove(reference());
  judge(scene_, shown_, {}, options);  // and takes away what no longer is
  EXPECT_TRUE(there(ReportPicture::kActual));
  EXPECT_FALSE(there(ReportPicture::kReference) || there(ReportPicture::kDifference) ||
               there(ReportPicture::kFlip));
}

TEST_F(Judge, AReportThatCannotBeWrittenIsAFailure) {
  write_reference(shown_.picture);
  JudgeOptions options;
  options.html = folder_ / "no/such/folder";
  expect_failure(judge(scene_, shown_, {}, options).row, "no/such/folder");
}

TEST(Hashes, SurviveTheirFileAndAreForgottenByOthers) {
  const Folder folder;
  const Hashes mine{{"a", std::string(64, 'a')}, {"b", std::string(64, '0')}};
  for (const char* driver : {"mine", "theirs", "older"})
    ASSERT_TRUE(write_hashes(hash_file(folder.path(), driver), mine));
  EXPECT_EQ(*read_hashes(hash_file(folder.path(), "mine")), mine);
  ASSERT_TRUE(remove_others(folder.path(), "mine", "a"));
  EXPECT_EQ(*read_hashes(hash_file(folder.path(), "mine")), mine);
  const Hashes left{{"b", std::string(64, '0')}};
  EXPECT_EQ(*read_hashes(hash_file(folder.path(), "theirs")), left);
  EXPECT_EQ(*read_hashes(hash_file(folder.path(), "older")), left);
  EXPECT_TRUE(read_hashes(folder / "none.json")->empty());
}

TEST(Hashes, AFileOfAnythingElseIsRefused) {
  const Folder folder;
  for (const char* text :
       {"", "[]", "{\"a\": 1}", "{\"a\": \"123\"}", "{\"a\"", "null", "[\"a\", \"b\"]"}) {
    ASSERT_TRUE(write_text(folder / "h.json", text));
    EXPECT_FALSE(read_hashes(folder / "h.json")) << text;
  }
}

TEST(Hashes, TheKeyNamesDriverVersionAndProcessor) {
  gpu::DeviceInfo info;
  info.name = "NVIDIA H200";
  info.driver = "NVIDIA 580.95.05";
  info.type = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  EXPECT_EQ(driver_key(info), "nvidia_580.95.05");
  info.name = "llvmpipe (LLVM 15.0.6, 256 bits)";
  info.driver = "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)";
  info.type = VK_PHYSICAL_DEVICE_TYPE_CPU;
  const std::string key = driver_key(info);
  EXPECT_TRUE(key.starts_with("llvmpipe_mesa_22.3.6_llvm_15.0.6_256_bits_")) << key;
  info.driver = "../..//\n";  // names come from drivers; keys are file names
  info.name = "";
  EXPECT_EQ(driver_key(info).find_first_of("/\n"), std::string::npos);
  EXPECT_FALSE(driver_key(info).starts_with("."));
}

}  // namespace
}  // namespace skerry::tools
