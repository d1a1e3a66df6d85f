#include "game/scene_file/json_text.h"

#include <gtest/gtest.h>

#include <string>

namespace skerry::game {
namespace {

std::string refusal_of(std::string_view text) {
  const auto parsed = parse_json(text);
  return parsed ? "" : parsed.error().message;
}

TEST(JsonText, AKeyThatAnObjectHasTwiceIsNamed) {
  for (const char* text :
       {R"({"fov": 40, "seed": 1, "fov": 50})", R"([{"fov": 1, "fov": 1}])",
        R"({"a": {"b": {}, "fov": 1, "fov": null}})", R"({"f\u006fv": 1, "fov": 1})"}) {
    EXPECT_NE(refusal_of(text).find("'fov' twice"), std::string::npos) << text;
  }
}

TEST(JsonText, TheSameKeyInTwoObjectsIsFine) {
  for (const char* text : {R"([{"fov": 1}, {"fov": 2}])", R"({"fov": {"fov": {"fov": 1}}})",
                           R"({"a": {"x": 1}, "b": {"x": 1}, "x": 1})", "3", "[]", "{}"})
    EXPECT_EQ(refusal_of(text), "") << text;
}

TEST(JsonText, OtherTextIsNoJson) {
  for (const char* text : {"", "{", "{\"a\": 1,}", "{} {}", "nul", "{\"a\": 1, \"a\": }"})
    EXPECT_NE(refusal_of(text).find("is not JSON"), std::string::npos) << text;
}

TEST(JsonText, DeepNestingIsRefused) {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  EXPECT_EQ(refusal_of(nested(kMostJsonDepth)), "");
  for (const std::size_t depth : {std::size_t{kMostJsonDepth + 1}, std::size_t{200'000}}) {
    EXPECT_NE(refusal_of(nested(depth)).find("nested"), std::string::npos) << depth;
    EXPECT_NE(refusal_of(R"({"a": )" + nested(depth)).find("nested"), std::string::npos) << depth;
    EXPECT_FALSE(parse_ordered_json(nested(depth))) << depth;
  }
  EXPECT_NE(refusal_of(std::string(200'000, '[')), "");
}

}  // namespace
}  // namespace skerry::game
