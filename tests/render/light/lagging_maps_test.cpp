// Coarse maps that may lag: how far they are off at most, and that what they lack is drawn.
#include <algorithm>
#include <functional>
#include <map>

#include "engine/render/light/shadow_maps.h"
#include "tests/render/passes_on_gpu.h"

namespace skerry::render {
namespace {

world::BlockId hills(int x, int y, int z) {
  const int height = (x * x / 31 + z * 3 / 7 + x * z / 53) & 15;
  return y < height ? world::block::kStone : world::block::kAirBlock;
}

constexpr std::size_t kFine = 2;  // maps that never lag

class LaggingShadowMaps : public PassesOnGpu {
 protected:
  FrameInput input_;
  RenderSettings settings_;
  std::vector<IslandPlacement> islands_;
  GeometryChanges geometry_;

  void SetUp() override {
    PassesOnGpu::SetUp();
    input_.sky = celestial_at(15.0 * 3600.0, 0.0);
    input_.reach_blocks = 500.0;
    input_.may_lag = true;
    settings_.shadow_size = 512;
  }
  SectionId add(world::IVec3 chunk, std::uint32_t island) {
    tools::stability::MeshedChunk meshed = tools::stability::mesh_chunk_of(hills, chunk, 0);
    meshed.section.island = island;
    return *store().add(uploader(), meshed.section, meshed.quads);
  }
  /// Enough for several parts.
  void add_land() {
    for (int x = -3; x < 3; ++x)
      for (int z = -3; z < 3; ++z) add({x, 0, z}, 0);
    add({0, 0, 0}, 1);
    islands_ = {{fixed_at({0.0, -40.0, 0.0}), glm::angleAxis(0.4, glm::dvec3(0, 1, 0)), 300.0},
                {fixed_at({5.0, 30.0, 9.0}), glm::angleAxis(1.0, glm::dvec3(1, 0, 0)), 100.0}};
  }
  DrawnMaps draw() {
    input_.islands = islands_;
    return shadow_maps(input_, settings_);
  }
  /// All maps as they should be now.
  std::vector<float> fresh() {
    invalidate_shadows();
    input_.may_lag = false;
    std::vector<float> texels = draw().texels;
    input_.may_lag = true;
    invalidate_shadows();
    return texels;
  }
  /// Draws until nothing is left to draw. @return frames that drew parts.
  int settle(DrawnMaps& maps) {
    int frames = 0;
    for (int i = 0; i < 64; ++i) {
      maps = draw();
      if (maps.parts == 0) return frames;
      ++frames;
    }
    ADD_FAILURE() << "it never settles";
    return frames;
  }
};

TEST_F(LaggingShadowMaps, ShowWhatFreshOnesDoOnceTheirPartsAreDrawn) {
  add_land();
  const DrawnMaps first = draw();
  EXPECT_EQ(first.redrawn, std::vector<bool>(4, true)) << "there was nothing to show instead";
  EXPECT_EQ(draw().parts, 0u);
  const std::function<void()> changes[]{
      [&] { input_.sky = celestial_at(15.0 * 3600.0 + 60.0, 0.0); },
      [&] {
        input_.camera.position = fixed_at({70.0, 3.0, -20.0});
      },
      [&] { input_.reach_blocks = 620.0; },
      [&] {
        islands_[0].origin = sum(islands_[0].origin, fixed_at({0.2, -0.3, 0.1}));
      },
      [&] {
        add({1, 0, 0}, 1);
      },
  };
  int parts = 0;
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    changes[i]();
    DrawnMaps maps;
    parts += settle(maps);
    EXPECT_EQ(maps.texels, fresh()) << "change " << i;
    draw();
  }
  EXPECT_GT(parts, 8);
}

TEST_F(LaggingShadowMaps, NoFrameDrawsManyMoreSectionsThanItsShare) {
  add_land();
  draw();
  std::uint64_t all = 0;
  for (const shared::Section& section : store().records())
    all += section.range_end[shared::kRangeTranslucent - 1];
  input_.reach_blocks = 620.0;  // of which they cover 500
  input_.islands = islands_;
  std::map<std::uint32_t, std::uint32_t> next;  // section, by layer
  int parts = 0;
  for (int i = 0; i < 20; ++i)
    for (const PartAhead& part : next_shadows(input_, settings_, store().changes()).ahead) {
      EXPECT_EQ(part.sections.first, next[part.layer]) << "each section once, in one order";
      EXPECT_EQ(part.clear, part.sections.first == 0);
      next[part.layer] = part.sections.end;
      std::uint64_t quads = 0, last = 0;
      for (std::uint32_t s = part.sections.first; s < part.sections.end; ++s)
        quads += last = store().records()[s].range_end[shared::kRangeTranslucent - 1];
      EXPECT_LE(quads - last, std::max<std::uint64_t>(2 * 8192, all / 3)) << "frame " << i;
      ++parts;
    }
  EXPECT_EQ(next.size(), 2u) << "the two coarse maps";
  for (const auto& [layer, end] : next) EXPECT_EQ(end, store().records().size());
  EXPECT_GT(parts, 4);
}

TEST_F(LaggingShadowMaps, AFrameThatMayNotLagShowsWhatAFreshOneDoes) {
  add_land();
  draw();
  for (int i = 0; i < 5; ++i) {
    input_.sky = celestial_at(15.0 * 3600.0 + 40.0 * (i + 1), 0.0);
    islands_[0].origin = sum(islands_[0].origin, fixed_at({0.1, -0.1, 0.0}));
    for (int frame = 0; frame < i % 3; ++frame) draw();
    // From here on no map can be kept.
    islands_[0].origin = sum(islands_[0].origin, fixed_at({4.0, 0.0, 0.0}));
    input_.sky = celestial_at(15.0 * 3600.0 + 2000.0 * (1 + i % 2), 0.0);
    input_.may_lag = false;
    const DrawnMaps exact = draw();
    EXPECT_EQ(exact.parts, 0u);
    EXPECT_EQ(exact.texels, fresh()) << "step " << i;
    draw();
  }
}

TEST_F(LaggingShadowMaps, WhatIsNotUploadedYetIsDrawnLater) {
  islands_ = {{fixed_at({0.0, -40.0, 0.0}), {1.0, 0.0, 0.0, 0.0}, 300.0}};
  shared::Section section{};
  section.bounds_max = 64u | 64u << 7 | 64u << 14;
  input_.islands = islands_;
  next_shadows(input_, settings_, geometry_);
  const std::uint64_t before = geometry_.version();
  geometry_.note(section);
  EXPECT_TRUE(next_shadows(input_, settings_, geometry_).cascades[3].redraw);
  shadow_history().only_shows(before);
  EXPECT_TRUE(next_shadows(input_, settings_, geometry_).cascades[3].redraw) << "once more";
  EXPECT_FALSE(next_shadows(input_, settings_, geometry_).cascades[3].redraw);
}

/// Where points of islands were when a layer was drawn, from the anchor.
using Shown = std::vector<glm::dvec3>;

// By brute force, from the draws alone: how far what a map shows is from where it is.
TEST_F(LaggingShadowMaps, AreNeverFurtherOffThanAllowed) {
  RandomPlaces random(5);
  for (int i = 0; i < 6; ++i)
    islands_.push_back(
        {fixed_at(random.in_box(300.0)), random.turn(), random.uniform(40.0, 200.0)});
  std::vector<glm::dvec3> places, drifts, axes;
  std::vector<std::pair<std::size_t, glm::dvec3>> points;  // of an island's ball
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    places.push_back(blocks_at(islands_[i].origin));
    drifts.push_back(random.direction() * random.uniform(0.0, 3.0));  // blocks/s
    axes.push_back(random.direction());
    for (int k = 0; k < 40; ++k)
      points.emplace_back(i, random.direction() * islands_[i].bounding_radius);
  }
  std::vector<shared::Section> sections(48);  // too many quads to draw them at once
  for (std::uint32_t i = 0; i < sections.size(); ++i) {
    sections[i].island = i % 6;
    sections[i].bounds_max = 64u | 64u << 7 | 64u << 14;
    std::ranges::fill(sections[i].range_end, 8000u);
  }
  std::map<std::uint32_t, Shown> shown;  // by layer
  double most_off = 0.0;
  int parts = 0;
  for (int frame = 0; frame < 600; ++frame) {
    constexpr double kFrameS = 1.0 / 30.0;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      islands_[i].origin = fixed_at(places[i] += drifts[i] * kFrameS);
      islands_[i].rotation =
          glm::normalize(glm::angleAxis(0.01 * kFrameS, axes[i]) * islands_[i].rotation);
    }
    input_.camera.position = fixed_at({48.0 * kFrameS * frame, 0.0, 0.0});
    input_.sky = celestial_at(15.0 * 3600.0 + std::floor(24.0 * kFrameS * frame), 0.0);
    input_.islands = islands_;
    const ShadowPlan plan = next_shadows(input_, settings_, geometry_, sections);
    Shown now;
    for (const auto& [island, point] : points)
      now.push_back(blocks_at(islands_[island].origin) + islands_[island].rotation * point);
    for (const PartAhead& part : plan.ahead) {
      if (part.clear) shown[part.layer] = now;
      ++parts;
    }
    for (const ActiveCascade& c : plan.cascades) {
      Shown& drawn = shown[c.layer];
      if (drawn.empty()) drawn = now;
      const auto shows = [&](const ActiveCascade& in, const glm::dvec3& place) {
        const glm::vec3 from_camera(place - blocks_at(input_.camera.position));
        const glm::vec4 clip = in.cascade.clip_from_world * glm::vec4(from_camera, 1.0f);
        return std::abs(clip.x) < 1.0f && std::abs(clip.y) < 1.0f && clip.z > 0.0f;
      };
      const auto texel_of = [&](const glm::dvec3& place) {
        const glm::vec3 from_camera(place - blocks_at(input_.camera.position));
        const glm::vec4 clip = c.cascade.clip_from_world * glm::vec4(from_camera, 1.0f);
        return 0.5f * (glm::vec2(clip) + 1.0f) * static_cast<float>(settings_.shadow_size);
      };
      const auto inside = [&](const glm::dvec3& place, const VkRect2D& area) {
        const glm::vec2 at = texel_of(place) - glm::vec2(area.offset.x, area.offset.y);
        return at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(area.extent.width) &&
               at.y < static_cast<float>(area.extent.height);
      };
      for (std::size_t i = 0; i < now.size(); ++i) {
        if (c.redraw && inside(now[i], c.area)) drawn[i] = now[i];
        if (!shows(c, now[i])) {
          drawn[i] = now[i];  // nothing is there to be late
          continue;
        }
        const double off =
            glm::length(drawn[i] - now[i]) / static_cast<double>(c.cascade.texel_blocks);
        EXPECT_LE(off, 0.4501) << "map " << c.slot << ", frame " << frame;
        if (c.slot >= kFine) most_off = std::max(most_off, off);
      }
      // The pole's tip as in KeptShadowMaps, and twice what is allowed there.
      const double turned = kShadowBlocks * glm::length(glm::cross(c.to_light, input_.sky.to_sun));
      const double times = c.slot < kFine ? 1.01 : 2.02;
      EXPECT_LE(turned, times * std::max(0.25 * static_cast<double>(c.cascade.texel_blocks),
                                         kShadowStepBlocks));
      // What the shader takes to be covered is.
      for (int k = 0; k < 20; ++k) {
        const glm::dvec3 way = random.direction() * static_cast<double>(c.cascade.radius);
        EXPECT_TRUE(inside(blocks_at(input_.camera.position) + way, {{0, 0}, {512, 512}}));
      }
    }
    const float last = plan.cascades.back().cascade.radius;
    EXPECT_GE(last, 0.8f * 500.0f);
  }
  EXPECT_GT(most_off, 0.15) << "nothing lagged";
  EXPECT_GT(parts, 100);
}

}  // namespace
}  // namespace skerry::render
