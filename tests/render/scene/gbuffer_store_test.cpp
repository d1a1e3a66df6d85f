// What the G-buffer keeps for measuring, against the exact normals and positions of what is drawn.
#include "tests/render/passes_on_gpu.h"

#include <algorithm>

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{160, 96};

/// Blocks all over, of many turned islands: normals in every direction.
class GBufferStoreOnGpu : public PassesOnGpu {
 protected:
  void SetUp() override {
    PassesOnGpu::SetUp();
    if (HasFatalFailure()) return;
    RandomPlaces random(4);
    for (std::uint32_t island = 0; island < 40; ++island) {
      islands_.push_back({fixed_at(random.in_box(30.0)), random.turn(), 20.0});
      add_chunks(
          store(), uploader(),
          [](int x, int y, int z) -> world::BlockId {
            const int most = std::max({x, y, z}), least = std::min({x, y, z});
            return least >= 0 && most < 8 ? world::block::kStone : world::block::kAirBlock;
          },
          {0, 0, 0}, {1, 1, 1}, island);
    }
    input_.islands = islands_;
    input_.camera = camera_at({0.0, 0.0, -60.0}, 0.0, 4.0);
  }
  /// Normal of the word's face, exactly.
  glm::dvec3 normal_of(std::uint32_t word) const {
    const std::uint32_t face = shared::surface_face(word), island = shared::surface_island(word);
    glm::dvec3 n(0.0);
    n[static_cast<int>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
    return islands_[island].rotation * n;
  }
  std::vector<IslandPlacement> islands_;
  FrameInput input_;
};

TEST_F(GBufferStoreOnGpu, NormalsAreAsExactAsTheirEncoding) {
  const Drawn drawn_now = drawn(input_, kSize);
  const struct {
    NormalStore store;
    double most_deg;
  } kBounds[] = {
      // Octahedral: largest errors as Cigolle et al. (2014) give them in table 1 for plain rounding
      // with 2x8 and 2x16 bits.
      {NormalStore::kOct8, 0.95},
      {NormalStore::kOct16, 0.0038},
      // Three channels rounded by half a step each: at most sqrt(3) / 2 steps across.
      {NormalStore::kRgb8, std::sqrt(0.75) / 127.0 * 180.0 / M_PI},
      {NormalStore::kRgb10a2, std::sqrt(0.75) * 2.0 / 1023.0 * 180.0 / M_PI},
      // Eleven bits; devices may round to nearest or towards zero.
      {NormalStore::kRgba16f, std::sqrt(3.0) / 2048.0 * 180.0 / M_PI},
  };
  for (const auto& [store, most_deg] : kBounds) {
    const std::vector<glm::vec3> normals =
        drawn_stored(input_, kSize, {store, PositionStore::kRgba32f, DepthStore::kD32}).normals;
    double worst = 0.0;
    int surfaces = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (drawn_now.words[i] == 0) continue;
      ++surfaces;
      const glm::dvec3 expected = normal_of(drawn_now.words[i]), got(normals[i]);
      worst = std::max(worst, std::asin(glm::length(glm::cross(expected, got))) * 180.0 / M_PI);
      ASSERT_GT(glm::dot(expected, got), 0.9);
    }
    ASSERT_GT(surfaces, 2000);
    EXPECT_LE(worst, most_deg * 1.01) << static_cast<int>(store);
    EXPECT_GT(worst, most_deg / 20.0) << "as good as exact: was it stored at all?";
  }
}

TEST_F(GBufferStoreOnGpu, PositionsAreAsExactAsTheirFormat) {
  const Drawn drawn_now = drawn(input_, kSize);
  for (const auto& [store, most] :
       {std::pair(PositionStore::kRgba16f, std::ldexp(1.0, -10)),  // rounded towards zero at worst
        std::pair(PositionStore::kRgba32f, std::ldexp(1.0, -19))}) {
    const std::vector<glm::vec3> positions =
        drawn_stored(input_, kSize, {NormalStore::kOct16, store, DepthStore::kD32}).positions;
    double worst = 0.0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (drawn_now.words[i] == 0) continue;
      const auto x = static_cast<double>(i % kSize.width), y = static_cast<double>(i / kSize.width);
      const glm::dvec3 ray = ray_of(input_.camera, x, y, kSize.width, kSize.height);
      const glm::dvec3 forward = axes_of(input_.camera).forward;
      const double along = static_cast<double>(kNearPlane) / drawn_now.depth[i];
      const glm::dvec3 expected = ray / glm::dot(ray, forward) * along;
      const double error = glm::length(glm::dvec3(positions[i]) - expected);
      worst = std::max(worst, error / glm::length(expected));
    }
    EXPECT_LE(worst, most) << static_cast<int>(store);
    EXPECT_GT(worst, most / 100.0);
  }
}

}  // namespace
}  // namespace skerry::render
