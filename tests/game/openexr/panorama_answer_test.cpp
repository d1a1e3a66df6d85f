#include "game/openexr/panorama_answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace skerry::game {
namespace {

using Bytes = std::vector<std::byte>;

world::ByteSink into(Bytes& out) {
  return [&out](std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  };
}

render::Panorama small() {
  render::Panorama out;
  out.columns = 4;
  out.rows = 2;
  for (int i = 0; i < 8; ++i)
    out.texels.push_back(glm::vec3(static_cast<float>(i), 0.5f, render::kMostPanoramaRadiance));
  out.mended = 3;
  return out;
}

Bytes answer_of(const render::Panorama& panorama) {
  Bytes out;
  EXPECT_TRUE(encode_panorama(panorama, into(out)));
  return out;
}

TEST(PanoramaAnswer, GivesBackWhatWasPutIn) {
  const Result<render::Panorama> back = decode_panorama(answer_of(small()));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->columns, 4u);
  EXPECT_EQ(back->rows, 2u);
  EXPECT_EQ(back->mended, 3u);
  EXPECT_EQ(back->texels, small().texels);
}

TEST(PanoramaAnswer, ARefusalIsOneLine) {
  Bytes out;
  ASSERT_TRUE(encode_refusal("it is\nno\x7fpicture", into(out)));
  EXPECT_EQ(decode_panorama(out).error().message, "it is?no?picture");
  out.clear();
  ASSERT_TRUE(encode_refusal(std::string(5000, 'x'), into(out)));
  EXPECT_EQ(decode_panorama(out).error().message.size(), world::kMostAnswerText);
}

TEST(PanoramaAnswer, NoCutOrLongOneIsTaken) {
  const Bytes whole = answer_of(small());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_panorama(std::span(whole).first(size))) << size;
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(decode_panorama(longer));
}

TEST(PanoramaAnswer, NothingOfAChildOutOfControlIsTaken) {
  const auto refused = [](auto&& change) {
    render::Panorama panorama = small();
    change(panorama);
    return !decode_panorama(answer_of(panorama));
  };
  const float bad[] = {-1.0f, std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       std::nextafter(render::kMostPanoramaRadiance, 1e9f)};
  for (const float value : bad)
    EXPECT_TRUE(refused([&](render::Panorama& p) { p.texels[5].y = value; })) << value;
  EXPECT_TRUE(refused([](render::Panorama& p) { p.rows = 3; }));
  EXPECT_TRUE(refused([](render::Panorama& p) { p.columns = 8; }));
  // Twice the rows, and a product that is right where 32 bits overflow.
  EXPECT_TRUE(refused([](render::Panorama& p) {
    p.columns = 0x80000000u;
    p.rows = 0x40000000u;
  }));
}

}  // namespace
}  // namespace skerry::game
