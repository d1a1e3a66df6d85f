// Edges smoothed by what covers a pixel (aa=edge), against closed forms and many samples.
// docs/decisions/0043.
#include "engine/render/post/edge_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/render/renderer_on_gpu.h"
#include "tests/render/smooth_pictures.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{96, 64};

world::BlockId corner(int x, int, int z) {
  return x >= 0 && z >= 0 ? world::block::kStone : world::block::kAirBlock;
}
world::BlockId leaves(int x, int y, int z) {
  if (y < 0) return world::block::kStone;
  return x % 4 == 0 && z % 4 == 0 && y < 3 ? world::block::kOakLeaves : world::block::kAirBlock;
}

class Edges : public RendererOnGpu {
 protected:
  /// @param turned of the island, about the vertical [degrees].
  void place(double turned) {
    islands_ = {{{}, glm::angleAxis(turned * M_PI / 180.0, glm::dvec3(0, 1, 0)), 300.0}};
  }
  FrameInput view(glm::dvec3 eye, double yaw_deg, double pitch_deg) const {
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(50.0, 160.0);
    in.camera = camera_at(eye, yaw_deg, pitch_deg);
    in.reach_blocks = 200.0;
    return in;
  }
  Bytes shown(const FrameInput& input, Antialiasing aa, int samples = 1) {
    RenderSettings settings;
    settings.aa = aa;
    settings.aa_samples = samples;
    settings.shadow_enabled = false;
    drawn(input, settings, kSize);
    return picture();
  }

 private:
  std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
};

/// The edge of a block, upright in the middle of the picture: where it cuts a row, and so what
/// share of which pixel lies on either side, follows from the camera alone.
class UprightEdge : public Edges {
 protected:
  /// @param across by how many blocks the camera stands beside the edge, 5 blocks before it.
  void expect_shares(double across) {
    const FrameInput input = view({across, 1.5, -5.0}, 0.0, 0.0);
    const Bytes hard = shown(input, Antialiasing::kOff), soft = shown(input, Antialiasing::kEdge);
    const double tan_x = std::tan(35.0 * M_PI / 180.0) * kSize.width / kSize.height;
    const double edge = (1.0 + across / 5.0 / tan_x) * kSize.width / 2.0;
    const int column = static_cast<int>(std::floor(edge));
    const double left = edge - column;  // of the pixel's width
    for (int row = 24; row < 40; ++row)
      for (int x = 8; x < static_cast<int>(kSize.width) - 8; ++x)
        for (int channel = 0; channel < 3; ++channel) {
          const auto at = [&](const Bytes& from, int place) {
            return from[4 * (static_cast<std::size_t>(row) * kSize.width + place) + channel];
          };
          if (x != column) {
            ASSERT_EQ(at(hard, x), at(soft, x)) << "beside the edge, " << x << " " << row;
            continue;
          }
          // The pixel shows what is at its centre; the other side is beside it.
          const bool centre_right = left < 0.5;
          const double sides[2] = {light_of(at(hard, centre_right ? x - 1 : x)),
                                   light_of(at(hard, centre_right ? x : x + 1))};
          const double expected = 255.0 * std::sqrt(left * sides[0] + (1.0 - left) * sides[1]);
          ASSERT_NEAR(at(soft, x), expected, 1.6) << left << " " << row << " " << channel;
        }
  }
};

TEST_F(UprightEdge, AFaceThatEndsBeforeTheSkyCoversItsShare) {
  add(corner, {0, -1, 0}, {1, 1, 1});
  for (int i = 0; i < 12; ++i) expect_shares(0.013 * i - 0.07);
}

TEST_F(UprightEdge, IsFoundInEachColumnOfATile) {
  add(corner, {0, -1, 0}, {1, 1, 1});
  const double column = 10.0 * std::tan(35.0 * M_PI / 180.0) / kSize.height;  // blocks
  for (int i = 0; i < 8; ++i) expect_shares((0.3 + i) * column);
}

TEST_F(UprightEdge, TwoFacesThatMeetCoverTheirShares) {
  place(35.0);
  add(corner, {0, -1, 0}, {1, 1, 1});
  for (int i = 0; i < 12; ++i) expect_shares(0.013 * i - 0.07);
}

class EdgesOfAWorld : public Edges {
 protected:
  struct Found {
    double hard = 0.0, soft = 0.0;       // errors
    int hard_jumps = 0, soft_jumps = 0;  // in a turn
  };
  Found look(glm::dvec3 eye, double yaw_deg, double pitch_deg) {
    Found out;
    const double eighth = 2.0 * std::tan(35.0 * M_PI / 180.0) / kSize.height / 8.0 * 180.0 / M_PI;
    Bytes hard_before, soft_before;
    for (int i = 0; i < 8; ++i) {
      const FrameInput input = view(eye, yaw_deg + i * eighth, pitch_deg);
      const Bytes hard = shown(input, Antialiasing::kOff), soft = shown(input, Antialiasing::kEdge);
      if (i == 0) {
        const Bytes exact = shown(input, Antialiasing::kOff, 16);
        out.hard = error_of(hard, exact);
        out.soft = error_of(soft, exact);
      } else {
        out.hard_jumps += far_off(hard, hard_before);
        out.soft_jumps += far_off(soft, soft_before);
      }
      hard_before = hard;
      soft_before = soft;
    }
    return out;
  }
};

TEST_F(EdgesOfAWorld, OfWholeBlocksAreNearManySamplesAndDoNotJump) {
  place(17.0);
  add(rough, {-1, 0, -1}, {1, 1, 1});
  for (const auto& [eye, yaw, pitch] : {std::tuple(glm::dvec3(2.0, 8.0, -12.0), 10.0, -20.0),
                                        std::tuple(glm::dvec3(-7.0, 14.0, 9.0), 130.0, -35.0)}) {
    const Found found = look(eye, yaw, pitch);
    EXPECT_LT(found.soft, 0.75 * found.hard) << found.soft << " " << found.hard;
    EXPECT_LT(found.soft_jumps, found.hard_jumps / 2)
        << found.soft_jumps << " " << found.hard_jumps;
  }
}

TEST_F(EdgesOfAWorld, OfLeavesAreNearerToManySamples) {
  add(leaves, {-1, -1, -1}, {1, 1, 1});
  const Found found = look({3.0, 2.5, -6.0}, 20.0, -10.0);
  EXPECT_LT(found.soft, 0.9 * found.hard) << found.soft << " " << found.hard;
  EXPECT_LT(found.soft_jumps, found.hard_jumps) << found.soft_jumps << " " << found.hard_jumps;
}

TEST_F(Edges, ASecondFrameHasTheSameBytes) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  const FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  const Bytes first = shown(input, Antialiasing::kEdge);
  EXPECT_EQ(first, shown(input, Antialiasing::kEdge));
  EXPECT_NE(first, shown(input, Antialiasing::kOff));
}

TEST_F(Edges, CostNothingWhereTheyAreNotSmoothed) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  const FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  shown(input, Antialiasing::kEdge);
  EXPECT_TRUE(has_pass("smooth_edges"));
  shown(input, Antialiasing::kOff);
  EXPECT_FALSE(has_pass("edges"));
  // Many samples have smooth edges by themselves.
  const Bytes samples = shown(input, Antialiasing::kOff, 4);
  EXPECT_EQ(samples, shown(input, Antialiasing::kEdge, 4));
  EXPECT_FALSE(has_pass("edges"));
}

// A picture that is enlarged is smoothed before; one of many parts behind the last.
TEST_F(Edges, AreSmoothInEveryKindOfFrame) {
  add(rough, {-1, 0, -1}, {1, 1, 1});
  FrameInput input = view({2.0, 8.0, -12.0}, 10.0, -20.0);
  RenderSettings settings;
  settings.aa = Antialiasing::kEdge;
  for (const bool metered : {false, true})
    for (const float scale : {0.5f, 1.0f})
      for (const std::uint32_t parts : {1u, 2u}) {
        input.exposure_ev = metered ? std::nullopt : std::optional(0.0f);
        input.parts = parts;
        settings.render_scale = scale;
        for (input.part = 0; input.part < parts; ++input.part) {
          drawn(input, settings, kSize);
          EXPECT_EQ(has_pass("smooth_edges"), input.part + 1 == parts);
        }
      }
}

}  // namespace
}  // namespace skerry::render
