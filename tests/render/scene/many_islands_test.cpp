// More islands than a uniform buffer held (1,365), and than twelve bits of a surface's word named.
#include <cstring>
#include <set>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{1024, 768};  // two pixels a block

using tools::stability::mesh_chunk_of;
using tools::stability::MeshedChunk;

class ManyIslands : public RendererOnGpu {
 protected:
  /// Islands of one block each until there are so many, side by side far below the camera.
  void add_up_to(std::uint32_t count) {
    MeshedChunk block = mesh_chunk_of(
        [](int x, int y, int z) -> world::BlockId {
          return x == 0 && y == 0 && z == 0 ? world::block::kStone : world::block::kAirBlock;
        },
        {0, 0, 0});
    while (islands_.size() < count) {
      const auto i = static_cast<std::uint32_t>(islands_.size());
      islands_.push_back({fixed_at({4.0 * (i % 80), 0.0, 4.0 * static_cast<int>(i / 80)}),
                          glm::angleAxis(0.01 * i, glm::dvec3(0.0, 1.0, 0.0)), 2.0});
      block.section.island = i;
      ASSERT_TRUE(
          renderer().geometry().add(renderer().mesh_uploader(), block.section, block.quads));
    }
  }
  FrameInput input() {
    FrameInput input;
    input.islands = islands_;
    input.sky = sun_at(50.0, 30.0);
    input.camera = camera_at({160.0, 220.0, 130.0}, 0.0, -89.0, 90.0);
    input.capture = true;
    return input;
  }
  std::set<std::uint32_t> shown() {
    const Captured got = renderer().captured(Capture::kSurfaces);
    std::set<std::uint32_t> out;
    for (std::size_t at = 0; at < got.texels.size(); at += 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, got.texels.data() + at, 4);
      if (word != 0) out.insert(shared::surface_island(word));
    }
    return out;
  }
  std::vector<IslandPlacement> islands_;
};

// The device is not waited for between frames, so that tables grow while the ones before are read.
TEST_F(ManyIslands, ComeWhileFramesAreInFlight) {
  RenderSettings settings;
  settings.shadow_size = 512;
  settings.aa = Antialiasing::kTemporal;
  for (const std::uint32_t count : {3u, 1'200u, 1'500u, 3'000u, 4'700u, 5'200u}) {
    add_up_to(count);
    for (int frame = 0; frame < 2; ++frame) {
      const Result<std::uint64_t> drawn = renderer().draw(input(), settings, kSize);
      ASSERT_TRUE(drawn) << drawn.error().message;
    }
  }
  renderer().finish();
  EXPECT_GT(shown().size(), 5'000u);
}

// A word names each island, up to the last one.
TEST_F(ManyIslands, AreToldApart) {
  islands_.resize(shared::kMaxIslands);
  const std::set<std::uint32_t> wanted{0, 1, 1'365, 4'095, 4'096, 32'768, shared::kMaxIslands - 1};
  MeshedChunk block = mesh_chunk_of(
      [](int x, int y, int z) -> world::BlockId {
        const bool there = std::max({x, y, z}) < 60 && std::min({x, y, z}) >= 0;
        return there ? world::block::kStone : world::block::kAirBlock;
      },
      {0, 0, 0});
  double x = -3.0 * 80.0;
  for (const std::uint32_t island : wanted) {
    block.section.island = island;
    islands_[island] = {fixed_at({x, 0.0, 0.0}), {1.0, 0.0, 0.0, 0.0}, 120.0};
    x += 80.0;
    ASSERT_TRUE(renderer().geometry().add(renderer().mesh_uploader(), block.section, block.quads));
  }
  FrameInput in = input();
  in.camera = camera_at({32.0, 300.0, 32.0}, 0.0, -89.0, 100.0);
  drawn(in, {}, kSize);
  EXPECT_EQ(shown(), wanted);
}

}  // namespace
}  // namespace skerry::render
