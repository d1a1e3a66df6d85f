#include "game/panorama/radiance_hdr.h"

#include <gtest/gtest.h>

#include <test_paths.h>
#include <initializer_list>
#include <string>

#include "game/panorama/load_panorama.h"

namespace skerry::game {
namespace {

constexpr const char* kHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) out.push_back(static_cast<char>(value));
  return out;
}

std::string two_texels() {
  return std::string(kHead) + "\n-Y 1 +X 2\n" + bytes({128, 64, 0, 129, 0, 0, 0, 0});
}

std::string why(const std::string& file) {
  const Result<render::Panorama> read = read_radiance_hdr(file);
  return read ? "" : read.error().message;
}

TEST(RadianceHdr, ATexelIsTheMiddleOfWhatItStandsFor) {
  const Result<render::Panorama> read = read_radiance_hdr(two_texels());
  ASSERT_TRUE(read) << read.error().message;
  // (mantissa + 1/2) / 256 * 2^(exponent - 128)
  EXPECT_EQ(read->at(0, 0), glm::vec3(128.5f / 128.0f, 64.5f / 128.0f, 0.5f / 128.0f));
  EXPECT_EQ(read->at(1, 0), glm::vec3(0.0f));
}

TEST(RadianceHdr, ExposuresAreTakenOff) {
  const Result<render::Panorama> read =
      read_radiance_hdr(std::string(kHead) + "EXPOSURE=2\nEXPOSURE= 4.0\n\n-Y 1 +X 2\n" +
                        bytes({128, 64, 0, 132, 0, 0, 0, 0}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->at(0, 0).x, 128.5f / 128.0f);
}

TEST(RadianceHdr, RunsAreReadInBothWays) {
  std::string parts = std::string(kHead) + "\n-Y 4 +X 8\n", repeats = parts;
  for (int row = 0; row < 4; ++row) {
    parts += bytes({2, 2, 0, 8, 136, 10, 8, 1, 2, 3, 4, 5, 6, 7, 8, 132, 9, 132, 8, 136, 128});
    for (int i = 0; i < 8; ++i) repeats += bytes({10, i + 1, i < 4 ? 9 : 8, 128});
  }
  const Result<render::Panorama> one = read_radiance_hdr(parts), other = read_radiance_hdr(repeats);
  ASSERT_TRUE(one) << one.error().message;
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(one->texels, other->texels);
  // A texel, and itself three times more; 1 + 256 * 0 is one repetition by two bytes.
  const std::string old = std::string(kHead) + "\n-Y 2 +X 4\n" +
                          bytes({10, 20, 30, 128, 1, 1, 1, 3, 7, 7, 7, 128, 1, 1, 1, 3});
  const Result<render::Panorama> third = read_radiance_hdr(old);
  ASSERT_TRUE(third) << third.error().message;
  EXPECT_EQ(third->at(3, 0), third->at(0, 0));
  EXPECT_NE(third->at(0, 1), third->at(0, 0));
}

TEST(RadianceHdr, DamageIsAnErrorOfOneLine) {
  const std::string whole = two_texels();
  EXPECT_EQ(why(whole), "");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(why(whole.substr(0, length)), "") << length;
  const auto sized = [](const char* size) { return std::string(kHead) + "\n" + size + "\n"; };
  EXPECT_NE(why(sized("-Y 1 +X 1")).find("twice as wide"), std::string::npos);
  EXPECT_NE(why(sized("-Y 4 +X 10")).find("twice as wide"), std::string::npos);
  EXPECT_NE(why(sized("+Y 1 +X 2")).find("top left"), std::string::npos);
  EXPECT_NE(why(sized("-Y 8193 +X 16386")), "");
  EXPECT_NE(why(sized("-Y 8192 +X 16384")).find("cut short"), std::string::npos);
  EXPECT_NE(why(sized("-Y -1 +X -2")), "");
  EXPECT_NE(why("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n").find("xyze"),
            std::string::npos);
  for (const char* exposure : {"nan", "inf", "0", "-1", "1e300", ""})
    EXPECT_NE(why(std::string(kHead) + "EXPOSURE=" + exposure + "\n\n-Y 1 +X 2\n"), "") << exposure;
  // A run beyond the row; a run of nothing; a repetition of nothing.
  EXPECT_NE(why(std::string(kHead) + "\n-Y 4 +X 8\n" + bytes({2, 2, 0, 8, 255, 1})), "");
  EXPECT_NE(why(std::string(kHead) + "\n-Y 4 +X 8\n" + bytes({2, 2, 0, 8, 0, 1})), "");
  EXPECT_NE(why(std::string(kHead) + "\n-Y 1 +X 2\n" + bytes({1, 1, 1, 1, 1, 1, 1, 1})), "");
}

TEST(LoadPanorama, TheSkyIsNoFile) {
  SceneOptions scene;
  ASSERT_TRUE(load_panorama(scene));
  EXPECT_EQ(*load_panorama(scene), nullptr);
  scene.ambient = "sky";
  EXPECT_EQ(*load_panorama(scene), nullptr);
}

TEST(LoadPanorama, ErrorsNameTheFile) {
  SceneOptions scene;
  for (const char* path : {"/nowhere/there.hdr", SKERRY_SOURCE_DIR "/tests"}) {
    scene.ambient = path;
    const auto loaded = load_panorama(scene);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find(path), std::string::npos) << loaded.error().message;
  }
}

TEST(LoadPanorama, TheScenesPanoramaIsReadAndPlaced) {
  SceneOptions scene;
  scene.ambient = SKERRY_SOURCE_DIR "/tests/scenes/evening.hdr";
  scene.settings.ambient.yaw_deg = 90.0;
  const auto loaded = load_panorama(scene);
  ASSERT_TRUE(loaded) << loaded.error().message;
  // Its green post is on the right: of a camera that looks east, south.
  const glm::dvec3 post = (*loaded)->radiance({0.0, 0.0, 1.0});
  EXPECT_GT(post.y, 4.0 * post.x);
  EXPECT_GT(post.y, 4.0 * post.z);
}

TEST(Ambient, OnlyPanoramasAndTheSkyAreTaken) {
  const auto made = [](const char* text) {
    SceneText typed;
    typed.ambient = text;
    return make_scene({}, typed);
  };
  for (const char* good : {"sky", "a.hdr", "b/C.HDR", "a.exr", "b/C.EXR"})
    EXPECT_TRUE(made(good)) << good;
  for (const char* bad : {"", ".hdr", "a.png", "sky.", "hdr", ".exr"})
    EXPECT_FALSE(made(bad)) << bad;
}

TEST(Ambient, TheCommandLineWinsAndIsPrinted) {
  SceneText under, over;
  under.ambient = "a.hdr";
  find_ambient_beside("/scenes/one.json", under);
  EXPECT_EQ(*make_scene(under, over)->ambient, "/scenes/a.hdr");
  over.ambient = "sky";
  EXPECT_NE(shot_command(*make_scene(under, over)).find("--ambient sky"), std::string::npos);
  EXPECT_EQ(shot_command(*make_scene({}, {})).find("--ambient"), std::string::npos);
}

}  // namespace
}  // namespace skerry::game
