// Water and glass behind the layers that are peeled: what is added up must be what looking through
// surface by surface shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

using world::block::kAirBlock;
using world::block::kBricks;
using world::block::kGlass;
using world::block::kLamp;
using world::block::kWater;

constexpr VkExtent2D kSize{96, 64};

class Tail : public RendererOnGpu {
 protected:
  std::vector<glm::vec4> seen(int layers, double pitch_deg = 0.0) {
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(50.0, 200.0);
    in.camera = camera_at({0.5, 6.5, -6.0}, 0.0, pitch_deg);
    RenderSettings settings;
    settings.water_layers = layers;
    settings.leave_out.add(Feature::kHaze);
    return radiance(in, settings, kSize);
  }
  /// Mean difference over the mean of `exact`.
  static double difference(const std::vector<glm::vec4>& picture,
                           const std::vector<glm::vec4>& exact) {
    double off = 0.0, all = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        off += std::abs(double{picture[i][c]} - double{exact[i][c]});
        all += double{exact[i][c]};
      }
    return off / all;
  }
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
};

/// @param n slabs of a block, each two blocks behind the other, before a wall with lamps in it.
BlockAt slabs(int n) {
  return [n](int x, int y, int z) -> world::BlockId {
    if (y < 0) return kBricks;
    if (z == 30) return (x + y) % 3 == 0 ? kLamp : kBricks;
    return z >= 0 && z < 2 * n && z % 2 == 0 && y < 24 ? kGlass : kAirBlock;
  };
}

/// A basin of glass with water in it.
world::BlockId basin(int x, int y, int z) {
  if (y < 0 || z == 30) return kBricks;
  const auto within = [&](int rim) {
    return x >= -8 + rim && x < 8 - rim && z >= 2 + rim && z < 14 - rim && y >= rim;
  };
  if (within(1)) return y < 9 ? kWater : kAirBlock;
  return within(0) && y < 12 ? kGlass : kAirBlock;
}

TEST_F(Tail, TwoSurfacesAddedUpAreAsThoseThatArePeeled) {
  add(slabs(1), {-1, -1, 0}, {1, 1, 1});
  // Entering is peeled and leaving added up; behind it nothing is hidden from anything else.
  EXPECT_LT(difference(seen(1), seen(4)), 0.005);
}

TEST_F(Tail, SlabsBehindTheLayersAreSeen) {
  add(slabs(2), {-1, -1, 0}, {1, 1, 1});
  const std::vector<glm::vec4> exact = seen(4);
  const double one = difference(seen(1), exact), two = difference(seen(2), exact),
               three = difference(seen(3), exact);
  EXPECT_LT(one, 0.03);
  EXPECT_LT(two, 0.02);
  EXPECT_LT(three, 0.005);
}

TEST_F(Tail, WaterBehindGlassIsOneSurface) {
  add(basin, {-1, -1, 0}, {1, 1, 1});
  // Glass, water, glass and air: four surfaces, as water touches the glass. A fifth layer is not
  // needed, so that three and four differ by the last of them alone.
  EXPECT_LT(difference(seen(3), seen(4)), 0.01);
  EXPECT_LT(difference(seen(1), seen(4)), 0.11);  // 0.096: the rim's far side shows through
}

TEST_F(Tail, ABedThatIsSeenThroughAPaneIsAsDarkAsWaterIs) {
  // Its light does not leave the water before surfaces are added up.
  add([](int x, int y, int z) { return y < 1 ? world::BlockId{kBricks} : basin(x, y, z); },
      {-1, -1, 0}, {1, 1, 1});
  EXPECT_LT(difference(seen(1, -20.0), seen(4, -20.0)), 0.07);  // 0.063; 0.081 without
}

TEST_F(Tail, TheOrderOfDrawsIsNotSeen) {
  const std::vector<world::IVec3> chunks{{-1, -1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 0}};
  const auto with = [&](bool backwards) {
    restart();
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      const world::IVec3 c = chunks[backwards ? chunks.size() - 1 - i : i];
      add(basin, c, {c.x + 1, c.y + 1, c.z + 1});
    }
    return seen(1, -20.0);
  };
  const std::vector<glm::vec4> forwards = with(false), backwards = with(true);
  EXPECT_LT(difference(backwards, forwards), 1e-5);
}

TEST_F(Tail, IsThereOnlyWithWaterOrGlass) {
  add(slabs(0), {-1, -1, 0}, {1, 1, 1});
  seen(2);
  EXPECT_FALSE(has_pass("tail"));
  restart();
  add(slabs(1), {-1, -1, 0}, {1, 1, 1});
  seen(2);
  EXPECT_TRUE(has_pass("sum_tail"));
}

}  // namespace
}  // namespace skerry::render
