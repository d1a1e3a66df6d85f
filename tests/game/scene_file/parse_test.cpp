#include "game/scene_file/parse.h"

#include <gtest/gtest.h>

#include <random>

namespace skerry::game {
namespace {

constexpr std::int64_t kEdge = world::kMaxBlock * world::kUnitsPerBlock;

std::int64_t blocks(std::string_view text) {
  const auto units = parse_blocks(text, "X");
  EXPECT_TRUE(units) << text;
  return units ? *units : 0;
}

TEST(ParseBlocks, KeepsEveryUnitAtTheEdgeOfTheWorld) {
  // 2^40 blocks and 1/65536 need 57 bits: a double would drop the last four.
  EXPECT_EQ(blocks("1099511627775.9999847412109375"), kEdge - 1);
  EXPECT_EQ(blocks("-1099511627775.9999847412109375"), -kEdge + 1);
  EXPECT_EQ(blocks("1099511627775.0000152587890625"), kEdge - 65535);
  EXPECT_EQ(blocks("1099511627776"), kEdge);
  EXPECT_EQ(blocks("-1099511627776.0"), -kEdge);
}

TEST(ParseBlocks, RoundsToTheNearestUnitWithTiesAwayFromZero) {
  EXPECT_EQ(blocks("0.00000762939453125"), 1);  // half a unit
  EXPECT_EQ(blocks("-0.00000762939453125"), -1);
  EXPECT_EQ(blocks("0.000007629394531249999999999999999999999999"), 0);
  EXPECT_EQ(blocks("0.99999999999"), 65536);
  EXPECT_EQ(blocks("0.5"), 32768);
  EXPECT_EQ(blocks(".25"), 16384);
  EXPECT_EQ(blocks("3."), 3 * 65536);
  EXPECT_EQ(blocks("+0007.5"), 7 * 65536 + 32768);
}

TEST(ParseBlocks, RefusesWhatIsNoPlainDecimalInRange) {
  for (const char* text : {"",
                           "-",
                           ".",
                           "+.",
                           "nan",
                           "NaN",
                           "inf",
                           "-inf",
                           "1e300",
                           "1e3",
                           "0x10",
                           "1,5",
                           " 1",
                           "1 ",
                           "--1",
                           "1.2.3",
                           "1099511627776.00001",
                           "1099511627777",
                           "-1099511627777",
                           "99999999999999999999999"}) {
    EXPECT_FALSE(parse_blocks(text, "X")) << text;
  }
  EXPECT_FALSE(parse_blocks(std::string(100000, '1'), "X"));
  EXPECT_FALSE(parse_blocks("0." + std::string(100000, '1'), "X"));
  EXPECT_FALSE(parse_blocks(std::string("1\0", 2), "X"));
}

TEST(ParseBlocks, ReadsBackWhatFormatWrites) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> any(-kEdge, kEdge);
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t units = i < 10000 ? any(random) : any(random) % 131072;
    ASSERT_EQ(blocks(format_blocks(units)), units) << format_blocks(units);
  }
  EXPECT_EQ(format_blocks(32768), "0.5");
  EXPECT_EQ(format_blocks(-65536 * 3), "-3");
}

TEST(ParseCamera, ReadsFivePartsAndReadsBackItsOwnText) {
  const auto camera = parse_camera("-1.5,80,1099511627776,-90.25,12");
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->position, (world::WorldPos{-98304, 80 * 65536, kEdge}));
  EXPECT_EQ(camera->yaw_deg, -90.25);
  EXPECT_EQ(camera->pitch_deg, 12.0);
  const CameraPlace odd{{1, -7, kEdge - 1}, 0.1 + 0.2, -1.0 / 3.0};
  const auto back = parse_camera(format_camera(odd));
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, odd);
}

TEST(ParseCamera, RefusesTooFewPartsAndAnglesThatAreNone) {
  for (const char* text :
       {"", "1,2,3", "1,2,3,4", "1,2,3,4,5,6", "1,2,3,nan,0", "1,2,3,0,inf", "1,2,3,0,90.1",
        "1,2,3,0,-91", "1,2,3,1e300,0", "1,2,nan,0,0", "1,1e300,3,0,0", "a,b,c,d,e", "1,2,3,4,"}) {
    const auto camera = parse_camera(text);
    ASSERT_FALSE(camera) << text;
    EXPECT_EQ(camera.error().message.find('\n'), std::string::npos);
  }
}

TEST(ParseTime, ReadsHoursMinutesAndSeconds) {
  EXPECT_EQ(*parse_time_of_day("00:00"), 0);
  EXPECT_EQ(*parse_time_of_day("7:05"), 7 * 3600 + 300);
  EXPECT_EQ(*parse_time_of_day("23:59:59"), 86399);
  for (const char* text : {"", "12", "24:00", "12:60", "12:00:60", "-1:00", "12:", ":30", "1:2:3:4",
                           "012:00", "a:b"}) {
    EXPECT_FALSE(parse_time_of_day(text)) << text;
  }
  for (const int second : {0, 1, 3599, 43200, 86399}) {
    EXPECT_EQ(*parse_time_of_day(format_time_of_day(second)), second);
  }
}

TEST(ParseSize, AcceptsPicturesAndNothingElse) {
  EXPECT_EQ(*parse_size("1x1"), (PictureSize{1, 1}));
  EXPECT_EQ(*parse_size("3840x2160"), (PictureSize{3840, 2160}));
  for (const char* text : {"", "x", "0x10", "10x0", "-1x5", "5x-1", "10", "10x", "x10", "1.5x2",
                           "ax3", "10x10x10", "10X10", "99999999999999999999x1", "65536x1"}) {
    EXPECT_FALSE(parse_size(text)) << text;
  }
}

TEST(NearestName, IsTheOneWithTheFewestEdits) {
  constexpr std::string_view names[] = {"view.distance", "view.detail", "shadow.size"};
  EXPECT_EQ(nearest_name("veiw.detail", names), "view.detail");
  EXPECT_EQ(nearest_name("view.dist", names), "view.distance");
  EXPECT_EQ(nearest_name("shadowsize", names), "shadow.size");
  EXPECT_EQ(nearest_name(std::string(1000000, 'x'), names).empty(), false);
}

TEST(Quote, KeepsAnErrorOnOneLine) {
  EXPECT_EQ(quote_text("a\nb"), "'a\\x0ab'");
  EXPECT_LT(quote_text(std::string(5000, 'x')).size(), 80u);
}

}  // namespace
}  // namespace skerry::game
