#include "tools/skerry/test/decisions.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"
#include "tests/tools/farm/one_line.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/farm/plan.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/test/judge.h"
#include "tools/skerry/test/page.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

platform::PngImage picture(std::uint8_t value) {
  platform::PngImage image{16, 9, {}, {}};
  for (int i = 0; i < 16 * 9; ++i)
    for (const int channel : {int{value}, i, int{value}, 255})
      image.pixels.push_back(static_cast<std::uint8_t>(channel));
  return image;
}

/// A report of two scenes that failed, and decisions about it.
class Decisions : public testing::Test {
 protected:
  Decisions() {
    for (const char* name : {"day", "night"}) {
      TestScene scene;
      scene.name = name;
      scene.file = folder_ / (std::string(name) + ".json");
      scenes_.push_back(scene);
    }
    write_reference("day", "Skerry");
    write_report();
  }
  fs::path report() const { return folder_ / "report"; }
  fs::path reference(const std::string& scene) const { return folder_ / (scene + ".png"); }
  void write_reference(const std::string& scene, const std::string& software) {
    const platform::PngImage image = picture(10);
    const std::vector<platform::PngText> text{{"Software", software}, {"Driver", "mine"}};
    ASSERT_TRUE(platform::write_png(reference(scene), {16, 9, 4, image.pixels}, text));
  }
  void write_report(const std::function<void(Results&)>& change = {}) {
    Results results;
    JudgeOptions options;
    options.html = report();
    ASSERT_TRUE(platform::make_dirs(report()));
    for (const TestScene& scene : scenes_)
      results.rows.push_back(judge(scene, {picture(200), 0, "mine"}, {}, options).row);
    if (change) change(results);
    ASSERT_TRUE(write_text(report() / "report.json", results_json(results).dump()));
    page_ = test_page(results, report());
  }
  Decision decision(const std::string& scene) const {
    return {scene, "mine", *file_hash(report() / (scene + ".actual.png")), true, std::nullopt};
  }
  /// With the picture, as the page saves it.
  Decision whole_decision(const std::string& scene) const {
    Decision one = decision(scene);
    one.png = *platform::read_text(report() / (scene + ".actual.png"), 1 << 20);
    return one;
  }
  Result<std::vector<Approval>> check(const std::vector<Decision>& decisions) const {
    return check_decisions(decisions, report(), scenes_);
  }
  /// What is refused replaces nothing.
  void expect_refused(const std::vector<Decision>& decisions, const std::string& why) {
    const auto before = platform::read_text(reference("day"), 1 << 20);
    expect_one_line(check(decisions), {why});
    const auto after = platform::read_text(reference("day"), 1 << 20);
    if (before && after) {
      EXPECT_EQ(*after, *before);
    }
    EXPECT_FALSE(fs::exists(folder_ / "hashes"));
  }

  Folder folder_;
  std::vector<TestScene> scenes_;
  std::string page_;
};

TEST_F(Decisions, ApprovedPicturesBecomeReferencesWithTheirHashes) {
  const auto approvals = check({decision("day"), decision("night")});
  ASSERT_TRUE(approvals) << approvals.error().message;
  ASSERT_EQ(approvals->size(), 2u);
  for (const Approval& approval : *approvals) ASSERT_TRUE(apply(approval));
  const Hashes hashes = *read_hashes(hash_file(folder_.path(), "mine"));
  for (const char* scene : {"day", "night"}) {
    EXPECT_EQ(platform::read_png(reference(scene))->pixels, picture(200).pixels);
    EXPECT_EQ(hashes.at(scene), sha256_hex(picture(200).pixels));
  }
  // And once more, as after a run that was ended.
  const auto again = check({decision("day")});
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_TRUE(apply(again->front()));
}

TEST_F(Decisions, WithTheirPicturesNeedNoReport) {
  const std::vector<Decision> decisions{whole_decision("day"), whole_decision("night")};
  fs::remove_all(report());
  const auto approvals = check_decisions(decisions, std::nullopt, scenes_);
  ASSERT_TRUE(approvals) << approvals.error().message;
  ASSERT_EQ(approvals->size(), 2u);
  ASSERT_TRUE(apply(approvals->front()));
  EXPECT_EQ(platform::read_png(reference("day"))->pixels, picture(200).pixels);
}

TEST_F(Decisions, WithAnotherPictureOrNoneAreRefused) {
  Decision one = whole_decision("day");
  const std::string png = *one.png;
  const auto expect_refused_alone = [&](const std::string& why) {
    expect_one_line(check_decisions(std::vector{one}, std::nullopt, scenes_), {why});
  };
  one.png.reset();
  expect_refused_alone("give --report");
  one.png = *platform::read_text(reference("day"), 1 << 20);
  expect_refused_alone("not the one that was judged");
  one.png = "no picture";
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(one.png->data());
  one.picture = sha256_hex({bytes, one.png->size()});
  expect_refused_alone("not a PNG");
  one = whole_decision("day");
  one.driver = "../mine";
  expect_refused_alone("names no driver");
}

TEST_F(Decisions, RejectedPicturesStayFailures) {
  Decision reject = decision("day");
  reject.approve = false;
  const auto approvals = check({reject});
  ASSERT_TRUE(approvals);
  EXPECT_TRUE(approvals->empty());
}

TEST_F(Decisions, AboutWhatIsAnotherThingNowAreRefused) {
  Decision other = decision("day");
  other.scene = "dusk";
  expect_refused({decision("night"), other}, "no such scene");
  other = decision("day");
  other.driver = "theirs";
  expect_refused({other}, "another driver");
  other = decision("day");
  other.picture.back() = other.picture.back() == '0' ? '1' : '0';
  expect_refused({decision("night"), other}, "not the one that was judged");
  fs::remove(report() / "day.actual.png");
  expect_refused({other}, "day.actual.png");
  scenes_.pop_back();
  expect_refused({decision("night")}, "not among SCENES");
  fs::remove(report() / "report.json");
  expect_refused({decision("night")}, "report.json");
}

TEST_F(Decisions, ApproveNothingThatPassedOrIsNotSound) {
  write_report([](Results& results) { results.rows[0].sound = false; });
  expect_refused({decision("day")}, "black or not finite");
  write_report([](Results& results) { results.rows[0].verdict = Verdict::kPass; });
  expect_refused({decision("day")}, "did not fail");
}

TEST_F(Decisions, LeaveFilesThatAreNotOurs) {
  write_reference("day", "A painter");
  expect_refused({decision("day")}, "no picture of Skerry");
  ASSERT_TRUE(write_text(reference("day"), "a letter"));
  expect_refused({decision("day")}, "day.png");
  fs::rename(reference("day"), folder_ / "elsewhere");
  fs::create_symlink(folder_ / "elsewhere", reference("day"));
  expect_refused({decision("day")}, "no regular file");
  fs::remove(reference("day"));
  fs::create_directory(reference("day"));
  expect_refused({decision("day")}, "no regular file");
  fs::remove(reference("day"));
  fs::create_directories(folder_ / "baseline/mine/hashes/mine.json");
  for (TestScene& scene : scenes_) scene.baseline = folder_ / "baseline";
  expect_refused({decision("day")}, "no regular file");
}

TEST_F(Decisions, DriversThatAreNoNamesOfFilesAreRefused) {
  for (const char* bad : {"", "../mine", "a/b", "..", "UPPER"}) {
    write_report([&](Results& results) { results.rows[0].driver = bad; });
    Decision one = decision("day");
    one.driver = bad;
    expect_refused({one}, "names no driver");
  }
}

TEST_F(Decisions, AreReadFromTheirFileAndNoOther) {
  const fs::path file = folder_ / "decisions.json";
  const json one{{"scene", "day"}, {"driver", "mine"}, {"picture", "0"}, {"decision", "approve"}};
  const std::string whole = json{{"decisions", {one}}}.dump();
  ASSERT_TRUE(write_text(file, whole));
  const auto read = read_decisions(file);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 1u);
  EXPECT_TRUE(read->front().scene == "day" && read->front().approve);
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    ASSERT_TRUE(write_text(file, whole.substr(0, bytes)));
    expect_one_line(read_decisions(file), {"decisions.json"});
  }
  const auto expect_wrong = [&](const json& text, const std::string& why) {
    ASSERT_TRUE(write_text(file, text.dump()));
    expect_one_line(read_decisions(file), {"decisions.json", why});
  };
  for (const auto& [key, value] : one.items()) {
    json damaged = one;
    damaged.erase(key);
    expect_wrong({{"decisions", {damaged}}}, key);
    damaged[key] = 1;
    expect_wrong({{"decisions", {damaged}}}, "");
  }
  json with_picture = one;
  with_picture["png"] = "U2tlcnJ5IQ==";
  ASSERT_TRUE(write_text(file, json{{"decisions", {with_picture}}}.dump()));
  EXPECT_EQ(read_decisions(file)->front().png, "Skerry!");
  for (const char* damaged : {"", "U2t", "U2t!", "=U2t"}) {
    with_picture["png"] = damaged;
    expect_wrong({{"decisions", {with_picture}}}, "base64");
  }
  json maybe = one;
  maybe["decision"] = "maybe";
  expect_wrong({{"decisions", {maybe}}}, "neither approve nor reject");
  expect_wrong({{"decisions", {one, one}}}, "'day' twice");
  expect_wrong(json::array({one}), "");
}

TEST_F(Decisions, HaveButtonsForWhatCanBeApproved) {
  const auto count = [this](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = page_.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("data-decision=\"approve\""), 2u);
  EXPECT_EQ(count("data-decision=\"reject\""), 2u);
  EXPECT_EQ(count("data-picture=\"" + decision("day").picture + "\""), 2u) << "they are equal";
  EXPECT_EQ(count("class=\"decisions\""), 1u);
  EXPECT_EQ(count("http"), 0u) << "the page needs no network";
  write_report([](Results& results) {
    results.rows[0].sound = false;
    results.rows[1].verdict = Verdict::kPass;
  });
  EXPECT_EQ(count("data-decision"), 0u);
  EXPECT_EQ(count("class=\"decisions\""), 0u);
}

}  // namespace
}  // namespace skerry::tools
