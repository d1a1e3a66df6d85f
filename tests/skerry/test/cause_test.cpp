#include "tools/skerry/test/cause.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/core/output.h"
#include "tests/folder.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using render::DebugView;

class CauseTest : public testing::Test {
 protected:
  CauseTest() {
    scene_.name = "day";
    scene_.file = folder_ / "day.json";
    scene_.baseline = folder_ / "baseline";
  }
  /// A renderer whose channels are plain, but for what `changed` says of a pixel.
  DrawChannel renderer() {
    return [this](DebugView view) -> Result<platform::PngImage> {
      drawn_.push_back(view);
      platform::PngImage image{width_, 18, {}, {}};
      image.pixels.assign(std::size_t{image.width} * image.height * 4, 100);
      if (changed_.contains(view))
        for (const std::size_t pixel : changed_[view]) image.pixels[4 * pixel + 1] = 110;
      return image;
    };
  }
  std::optional<Cause> cause(const std::string& approved = "hash") {
    drawn_.clear();
    const auto found = find_cause(scene_, "mesa", approved, renderer());
    EXPECT_TRUE(found);
    return *found;
  }
  void keep() { ASSERT_TRUE(keep_channels(scene_, "mesa", "hash", renderer())); }

  Folder folder_;
  TestScene scene_;
  std::uint32_t width_ = 32;
  std::map<DebugView, std::vector<std::size_t>> changed_;
  std::vector<DebugView> drawn_;
};

TEST_F(CauseTest, NamesTheFirstChannelThatDiffersAndWhere) {
  keep();
  changed_[DebugView::kShadow] = {0};
  changed_[DebugView::kNormal] = {3 * 32 + 5, 9 * 32 + 4};
  EXPECT_EQ(cause(), (Cause{"normal", "draw_geometry", 2, {4, 3, 2, 7}, 10}));
  EXPECT_EQ(text_of(*cause()),
            "normal (draw_geometry) is the first to differ: 2 pixels in [4, 3, 2, 7], by up to 10 "
            "of 255");
  EXPECT_EQ(drawn_, (std::vector{DebugView::kDepth, DebugView::kPosition, DebugView::kNormal}));
  changed_.erase(DebugView::kNormal);
  EXPECT_EQ(cause()->channel, "shadow");
  EXPECT_EQ(cause()->pass, "draw_shadow");
}

TEST_F(CauseTest, EqualChannelsSayThatALaterPassDiffers) {
  keep();
  ASSERT_TRUE(cause());
  EXPECT_EQ(*cause(), Cause());
  EXPECT_NE(text_of(Cause()).find("shading or a later pass"), std::string::npos);
}

TEST_F(CauseTest, MaskedPixelsAreNoCause) {
  keep();
  changed_[DebugView::kDepth] = {5 * 32 + 5};
  scene_.expected.masks = {{4, 4, 3, 3}};
  EXPECT_EQ(cause()->channel, "");
  changed_[DebugView::kDepth].push_back(7 * 32 + 5);
  EXPECT_EQ(cause()->around, (game::Mask{5, 7, 1, 1}));
}

TEST_F(CauseTest, ChannelsOfAnotherPictureAreNotAsked) {
  EXPECT_EQ(cause(), std::nullopt);  // none are kept
  keep();
  EXPECT_TRUE(has_channels(scene_, "mesa", "hash"));
  EXPECT_FALSE(has_channels(scene_, "other", "hash"));
  EXPECT_FALSE(has_channels(scene_, "mesa", "newer"));
  EXPECT_EQ(cause("newer"), std::nullopt);
  EXPECT_TRUE(drawn_.empty());
  width_ = 31;
  EXPECT_EQ(cause(), std::nullopt);
  width_ = 32;
  for (const fs::path& file : channel_files(scene_, "mesa")) {
    ASSERT_TRUE(write_text(file, "no picture"));
    EXPECT_EQ(cause(), std::nullopt) << file;
    keep();
  }
  scene_.baseline.reset();
  EXPECT_EQ(cause(), std::nullopt);
}

TEST_F(CauseTest, AnErrorOfDrawingIsPassedOn) {
  const DrawChannel fails = [](DebugView) -> Result<platform::PngImage> { return Error{"lost"}; };
  EXPECT_FALSE(keep_channels(scene_, "mesa", "hash", fails));
  keep();
  EXPECT_FALSE(find_cause(scene_, "mesa", "hash", fails));
}

TEST_F(CauseTest, IsInTheRowTheJsonAndTheJUnit) {
  Row row;
  row.scene = "day";
  row.message = "FLIP mean over";
  EXPECT_EQ(row.explanation(), row.message);
  row.cause = Cause{"depth", "draw_geometry", 3, {1, 2, 3, 4}, 5};
  const Result<Row> again = row_from_json(row_json(row));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->cause, row.cause);
  const std::string xml = junit_xml({{}, 1, {row}, {}});
  EXPECT_NE(xml.find("FLIP mean over; depth (draw_geometry) is the first"), std::string::npos);
}

}  // namespace
}  // namespace skerry::tools
