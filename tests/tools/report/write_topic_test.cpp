#include "tools/skerry/report/write_topic.h"

#include <gtest/gtest.h>

#include <charconv>
#include <filesystem>
#include <limits>
#include <random>

#include "engine/platform/files.h"
#include "tests/folder.h"
#include "tests/measure/xml.h"
#include "tools/measure/html.h"

namespace skerry::tools {
namespace {

constexpr TopicPoint kPoints[] = {{"plain", "shadow.size=256"},
                                  {"a,\"b\" <c> & 'd'", "world.offset=1,2,3 shadow.size=512"},
                                  {"last", "shadow.size=1024"}};
constexpr std::string_view kScenes[] = {"one", "two"};
constexpr Topic kTopic{"some_topic", "what it <means> & more", kPoints, kScenes};

measure::Image picture(std::uint8_t grey) {
  return {4, 2, std::vector<std::uint8_t>(32, grey)};
}

/// Numbers of all magnitudes, and infinity.
TopicResult result_of_noise() {
  std::mt19937_64 random(5);
  const auto number = [&] {
    return std::exp2(static_cast<double>(random() % 80) - 40.0) *
           (1.0 + static_cast<double>(random()) * 0x1p-64);
  };
  const auto row = [&](const TopicPoint& point) {
    PointRow made;
    made.point = &point;
    made.ms = {1.0, 1.0 + number(), 1e13, 1e13};
    made.errors = {number(), number(), number(), number(), std::numeric_limits<double>::infinity()};
    made.change = number();
    made.from_reference = number();
    return made;
  };
  TopicResult result{&kTopic, {}, {}};
  for (const std::string_view name : kScenes) {
    SceneRows scene{std::string(name), "skerry shot --seed '<&>'", 9, {}, {}, {}, 0.0, {}};
    for (const TopicPoint& point : kPoints) {
      scene.rows.push_back(row(point));
      scene.pictures.push_back({picture(10), picture(0), picture(40)});
    }
    scene.reference = picture(20);
    result.scenes.push_back(std::move(scene));
  }
  for (const TopicPoint& point : kPoints) result.rows.push_back(row(point));
  result.rows[1].defaults = {"low", "medium"};
  judge_standing(result.rows);
  return result;
}

/// Fields of one CSV text, line by line (RFC 4180).
std::vector<std::vector<std::string>> parse_csv(std::string_view text) {
  std::vector<std::vector<std::string>> lines(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      lines.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      lines.back().emplace_back();
    } else if (!quoted && c == '\n') {
      lines.push_back({""});
    } else {
      lines.back().back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

double number_of(const std::string& text) {
  double value = -1.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc() && end == text.data() + text.size()) << text;
  return value;
}

TEST(ReportFiles, CsvReadsBackAsTheSameNumbers) {
  const TopicResult result = result_of_noise();
  const auto lines = parse_csv(topic_csv(result));
  ASSERT_EQ(lines.size(), 1u + 3u * 3u);
  for (const auto& line : lines) ASSERT_EQ(line.size(), lines[0].size());
  for (std::size_t i = 0; i < 9; ++i) {
    const bool all = i >= 6;
    const PointRow& row = all ? result.rows[i - 6] : result.scenes[i / 3].rows[i % 3];
    const auto& line = lines[i + 1];
    EXPECT_EQ(line[0], all ? "all" : result.scenes[i / 3].scene);
    EXPECT_EQ(line[1], row.point->label);
    EXPECT_EQ(line[2], row.point->settings);
    const PictureErrors& e = row.errors;
    const double expected[] = {row.ms.median, row.ms.p10, row.ms.p90,         all ? 18.0 : 9.0,
                               e.flip_mean,   e.flip_p99, e.hdr_flip_mean,    e.rel_mse,
                               e.psnr_db,     row.change, *row.from_reference};
    for (std::size_t c = 0; c < std::size(expected); ++c)
      EXPECT_EQ(number_of(line[3 + c]), expected[c]) << lines[0][3 + c];
  }
  EXPECT_EQ(lines[8][15], "low medium");
}

TEST(ReportFiles, JsonHoldsEveryRow) {
  const TopicResult result = result_of_noise();
  const auto j = nlohmann::ordered_json::parse(topic_json(result).dump());
  EXPECT_EQ(j["rows"].size(), 3u);
  EXPECT_EQ(j["scenes"].size(), 2u);
  EXPECT_EQ(j["rows"][1]["point"], kPoints[1].label);
  EXPECT_EQ(j["rows"][1]["ms_median"], result.rows[1].ms.median);
  EXPECT_TRUE(j["rows"][1]["psnr_db"].is_null());
  EXPECT_EQ(j["scenes"][1]["rows"][2]["rel_mse"], result.scenes[1].rows[2].errors.rel_mse);
}

TEST(ReportFiles, MarkupIsWellFormedWithHostileLabels) {
  TopicResult result = result_of_noise();
  EXPECT_EQ(measure::xml_fault(topic_svg(result)), "");
  const Folder own;
  const std::filesystem::path& dir = own.path();
  for (SceneRows& scene : result.scenes) {
    const Result<void> written = write_pictures(kTopic, scene, dir);
    ASSERT_TRUE(written) << written.error().message;
    for (const std::string& file : picture_files(kTopic, scene))
      EXPECT_TRUE(std::filesystem::exists(dir / file)) << file;
  }
  const Result<std::string> part = write_topic(result, dir);
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_EQ(measure::xml_fault(measure::page("title", *part)), "");
  // Every picture and file that the page names is there.
  for (std::size_t at = part->find("=\"some_topic"); at != std::string::npos;
       at = part->find("=\"some_topic", at + 1)) {
    const std::string name = part->substr(at + 2, part->find('"', at + 2) - at - 2);
    if (name.find('.') == std::string::npos) continue;
    EXPECT_TRUE(std::filesystem::exists(dir / name)) << name;
  }
}

PointRow point_row(double p10, double median, double p90, double error) {
  PointRow row;
  row.point = &kPoints[0];
  row.ms = {p10, median, p90, p90};
  row.errors.flip_mean = error;
  return row;
}

TEST(ReportFiles, StandingAsksWhetherTheTimesOverlap) {
  std::vector<PointRow> rows{point_row(1, 2, 3, 0.2), point_row(4, 5, 6, 0.3),
                             point_row(2.5, 2.7, 2.9, 0.2), point_row(8, 9, 10, 0.1)};
  judge_standing(rows);
  EXPECT_EQ(rows[0].standing, Standing::kOnFront);
  EXPECT_EQ(rows[1].standing, Standing::kOffFront);     // p90 3 of a better one < p10 4
  EXPECT_EQ(rows[2].standing, Standing::kWithinNoise);  // as good, slower within the spread
  EXPECT_EQ(rows[3].standing, Standing::kOnFront);      // the most exact
}

TEST(ReportFiles, DefaultOffItsFrontIsADefect) {
  TopicResult result{&kTopic, {}, {point_row(1, 2, 3, 0.2), point_row(4, 5, 6, 0.3)}};
  judge_standing(result.rows);
  EXPECT_TRUE(defects_of(result).empty());
  result.rows[0].defaults = {"medium"};
  EXPECT_TRUE(defects_of(result).empty());
  result.rows[1].defaults = {"high"};
  ASSERT_EQ(defects_of(result).size(), 1u);
  EXPECT_TRUE(defects_of(result)[0].certain);
  EXPECT_NE(defects_of(result)[0].text.find("high"), std::string::npos);
}

TEST(ReportFiles, PicturesThatMustBeEqualAndAreNotAreADefect) {
  constexpr Topic equal{"equal", "m", kPoints, kScenes, Judge::kEqual};
  TopicResult result{&equal, {}, {point_row(1, 1, 1, 0.0), point_row(1, 1, 1, 0.0)}};
  result.rows[0].same_bytes = result.rows[1].same_bytes = true;
  EXPECT_TRUE(defects_of(result).empty());
  result.rows[0].same_bytes = false;
  EXPECT_EQ(defects_of(result).size(), 1u);
}

}  // namespace
}  // namespace skerry::tools
