#pragma once
#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/transfer/readback.h"
#include "engine/render/renderer/renderer.h"
#include "engine/render/scene/occupancy_store.h"
#include "game/view/materials.h"
#include "tests/gpu/test_device.h"
#include "tests/render/random_scenes.h"
#include "tests/render/voxel_chunks.h"
#include "world/mesh/occupancy.h"

namespace skerry::render {

/// A sun alone in the sky, wherever a test wants it.
inline Celestial sun_at(double altitude_deg, double azimuth_deg) {
  const double altitude = altitude_deg * M_PI / 180.0, azimuth = azimuth_deg * M_PI / 180.0;
  Celestial sky = celestial_at(12.0 * 3600.0, 0.0);  // new moon: no second light
  sky.to_sun = {std::sin(azimuth) * std::cos(altitude), std::sin(altitude),
                std::cos(azimuth) * std::cos(altitude)};
  return sky;
}

/// The whole renderer under validation, with scenes made of few blocks.
class RendererOnGpu : public gpu::GpuTest {
 protected:
  RendererOnGpu() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  void SetUp() override {
    GpuTest::SetUp();
    if (!HasFatalFailure()) restart();
  }
  void TearDown() override {
    renderer_.reset();
    GpuTest::TearDown();
  }

  /// A renderer without geometry.
  void restart() {
    renderer_.reset();
    const std::vector<shared::Material> materials = game::material_table();
    RendererDesc desc;
    desc.materials = materials;
    desc.upload_budget_bytes = UINT64_MAX;
    desc.arena_quads = 1u << 12;
    Result<std::unique_ptr<Renderer>> made = Renderer::create(device(), desc);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = *std::move(made);
  }
  Renderer& renderer() { return *renderer_; }
  void add(const BlockAt& block_at, world::IVec3 low, world::IVec3 high, std::uint32_t island = 0,
           std::uint32_t voxel_size_log2 = 0) {
    add_chunks(renderer_->geometry(), renderer_->mesh_uploader(), block_at, low, high, island,
               voxel_size_log2);
  }

  /// Which voxels of the same chunks, at full detail, are opaque.
  void add_occupancy(const BlockAt& block_at, world::IVec3 low, world::IVec3 high,
                     std::uint32_t island = 0) {
    Result<OccupancyStore*> store = renderer_->occupancy();
    ASSERT_TRUE(store) << store.error().message;
    const glm::ivec3 first(low.x, low.y, low.z), size = glm::ivec3(high.x, high.y, high.z) - first;
    ASSERT_TRUE((*store)->begin_island(renderer_->mesh_uploader(), island, {first, size}));
    for (int c = 0; c < size.x * size.y * size.z; ++c) {
      const glm::ivec3 chunk =
          first + glm::ivec3(c % size.x, c / size.x % size.y, c / (size.x * size.y));
      std::vector<world::BlockId> voxels;
      for (int y = -1; y < 65; ++y)
        for (int x = -1; x < 65; ++x)
          for (int z = -1; z < 65; ++z)
            voxels.push_back(block_at(chunk.x * 64 + x, chunk.y * 64 + y, chunk.z * 64 + z));
      const world::ChunkOccupancy made = world::occupancy_of(voxels);
      if (made.fill == world::ChunkOccupancy::Fill::kEmpty) continue;
      const bool full = made.fill == world::ChunkOccupancy::Fill::kFull;
      ASSERT_TRUE(
          (*store)->add(renderer_->mesh_uploader(), island, chunk, {full, made.table, made.words}));
    }
  }

  /// Draws and waits. @return the frame's numbers.
  FrameReport drawn(const FrameInput& input, const RenderSettings& settings, VkExtent2D size) {
    const Result<std::uint64_t> value = renderer_->draw(input, settings, size);
    EXPECT_TRUE(value) << (value ? "" : value.error().message);
    renderer_->finish();
    return renderer_->report().value_or(FrameReport{});
  }
  /// Draws, all parts of it, and waits. @return radiance, rows from the top.
  std::vector<glm::vec4> radiance(FrameInput input, const RenderSettings& settings,
                                  VkExtent2D size) {
    input.capture = true;
    for (input.part = 0; input.part < input.parts; ++input.part) drawn(input, settings, size);
    const Captured captured = renderer().captured(Capture::kRadiance);
    EXPECT_EQ(captured.size.width, size.width);
    std::vector<glm::vec4> out;
    for (std::size_t i = 0; i < captured.texels.size(); i += 8) {
      std::uint64_t texel = 0;
      std::memcpy(&texel, captured.texels.data() + i, 8);
      out.push_back(glm::unpackHalf4x16(texel));
    }
    return out;
  }
  /// RGBA8 of the last frame, rows from the top.
  std::vector<std::uint8_t> picture() {
    const Result<std::vector<std::byte>> bytes = gpu::read_back(device(), renderer_->picture(), 4);
    EXPECT_TRUE(bytes);
    std::vector<std::uint8_t> out(bytes->size());
    std::transform(bytes->begin(), bytes->end(), out.begin(),
                   [](std::byte b) { return static_cast<std::uint8_t>(b); });
    return out;
  }
  bool has_pass(const std::string& part) const {
    const std::vector<std::string> names = renderer_->graph().pass_names();
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return name.find(part) != std::string::npos;
    });
  }

 private:
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace skerry::render
