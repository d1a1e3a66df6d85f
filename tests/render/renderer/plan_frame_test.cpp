// What a frame decides before anything is made: a function of values.
#include "engine/render/renderer/plan_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <latch>
#include <string>
#include <vector>

#include "engine/core/shared_work.h"
#include "engine/render/plan/in_view.h"
#include "engine/render/renderer/frame_steps.h"
#include "engine/render/sky/sky_irradiance.h"
#include "tests/render/random_scenes.h"
#include "tests/same_bits.h"

namespace skerry::render {
namespace {

/// A scene of one stone section before the camera.
struct Planned {
  std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 120.0}};
  std::vector<shared::Section> sections;
  GeometryChanges changes;
  FrameInput input;
  RenderSettings settings;
  FrameHistory history;
  bool indirect = false;  // faces are known to see the sky

  Planned() {
    shared::Section section{};
    section.bounds_max = 64u | 64u << 7 | 64u << 14;
    for (std::uint32_t range = 0; range < shared::kRangeCount; ++range)
      section.range_end[range] = range < shared::kRangeCutout ? range + 1 : shared::kRangeCutout;
    sections = {section};
    input.islands = islands;
    input.sky = celestial_at(12.0 * 3600.0, 0.0);
    input.camera.position = {32 * 65536, 80 * 65536, -40 * 65536};
  }
  SceneFacts facts() const {
    SceneFacts out;
    out.sections = sections;
    out.sections_resident = static_cast<std::uint32_t>(sections.size());
    out.quads_resident = 6;
    out.changes = &changes;
    out.shadow_generation = history.shadows.generation;
    out.indirect = indirect;
    return out;
  }
  FramePlan plan() const { return plan_frame({input, settings, {64, 48}}, facts(), history); }
};

const char* why_not(const FramePlan& plan, const std::string& pass) {
  const auto found = std::find_if(plan.left_out.begin(), plan.left_out.end(),
                                  [&](const gpu::LeftOut& l) { return l.name == pass; });
  return found == plan.left_out.end() ? nullptr : found->why.c_str();
}

std::size_t redrawn(const FramePlan& plan) {
  return static_cast<std::size_t>(std::count_if(plan.shadows.cascades.begin(),
                                                plan.shadows.cascades.end(),
                                                [](const ActiveCascade& c) { return c.redraw; }));
}

TEST(PlanFrame, IsAFunctionOfItsArgumentsAlone) {
  const Planned scene;
  const FramePlan a = scene.plan(), b = scene.plan();
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.left_out.size(), b.left_out.size());
  EXPECT_TRUE(same_bits(a.tables.constants, b.tables.constants));
  EXPECT_EQ(redrawn(a), redrawn(b));
}

/// Of a world of many islands, most of them far, of which some move from frame to frame.
struct ManyPlanned : Planned {
  ManyPlanned() {
    RandomPlaces random(5);
    islands.clear();
    sections.resize(kIslands, sections.front());
    for (std::size_t i = 0; i < kIslands; ++i) {
      const double half = i < 100 ? 300.0 : 8000.0;
      sections[i].island = static_cast<std::uint32_t>(i);
      islands.push_back({fixed_at(random.in_box(half)),
                         glm::angleAxis(random.uniform(0.0, 6.28), glm::dvec3(0.0, 1.0, 0.0)),
                         120.0});
      islands.back().far = i >= 100;
      islands.back().land = {glm::vec3(0.0f), glm::vec3(60.0f, 40.0f, 60.0f)};
    }
    input.reach_blocks = 8000.0;
    indirect = true;
    input.islands = islands;
  }
  void move(double blocks) {
    for (std::size_t i = 0; i < kIslands; i += 3)
      islands[i].origin[0] += static_cast<std::int64_t>(65536.0 * blocks);
  }
  static constexpr std::size_t kIslands = 2000;
};

bool same_islands(const std::vector<DrawnIsland>& a, const std::vector<DrawnIsland>& b) {
  return std::ranges::equal(a, b, [](const DrawnIsland& x, const DrawnIsland& y) {
    return x.index == y.index && x.origin == y.origin && x.rotation == y.rotation;
  });
}

void expect_same(const FramePlan& a, const FramePlan& b) {
  EXPECT_EQ(a.sky_light, b.sky_light);
  EXPECT_TRUE(
      std::ranges::equal(a.tables.islands, b.tables.islands, same_bits<shared::IslandTransform>));
  ASSERT_EQ(a.shadows.cascades.size(), b.shadows.cascades.size());
  for (std::size_t i = 0; i < a.shadows.cascades.size(); ++i) {
    const ActiveCascade &x = a.shadows.cascades[i], &y = b.shadows.cascades[i];
    EXPECT_EQ(x.cascade.key, y.cascade.key);
    EXPECT_EQ(x.slot, y.slot);
    EXPECT_EQ(x.redraw, y.redraw);
    EXPECT_TRUE(same_bits(x.area, y.area)) << i;
    EXPECT_TRUE(
        same_islands(*a.next.shadows.kept[i].map->islands, *b.next.shadows.kept[i].map->islands))
        << i;
  }
}

TEST(PlanFrame, IsTheSameWhoeverDoesIt) {
  ManyPlanned scene;
  bool some_sky = false, some_redrawn = false;
  for (int frame = 0; frame < 12; ++frame) {
    const FramePlan shared = scene.plan();
    // While all helpers are busy, this thread plans alone.
    Helpers* const helpers = Helpers::of_frames();
    std::latch busy(helpers->threads()), release(1);
    SharedWork block(helpers, helpers->threads(), [&](int) {
      busy.count_down();
      release.wait();
    });
    busy.wait();
    const FramePlan alone = scene.plan();
    release.count_down();
    block.join();
    expect_same(shared, alone);
    EXPECT_EQ(shared.sky_light,
              sky_irradiance(shared.sky, shared.input.sky, scene.islands,
                             islands_in_view(scene.facts(), scene.islands, shared.tables.views[0],
                                             scene.input.camera.position),
                             scene.input.camera.position));
    some_sky = some_sky || shared.sky_light.size() > 3 * ManyPlanned::kIslands / 4;
    some_redrawn = some_redrawn || (frame > 0 && redrawn(shared) > 0);
    scene.history = shared.next;
    scene.move(0.2 * frame);
    scene.input.camera.yaw_deg += 30.0;
  }
  EXPECT_TRUE(some_sky);
  EXPECT_TRUE(some_redrawn);
}

// A list of a map's islands that nothing changes is one object, and what a frame changes in its own
// is not seen in that of the frame before.
TEST(PlanFrame, ChangesNoListOfAnEarlierFrame) {
  ManyPlanned scene;
  const FramePlan first = scene.plan();
  scene.history = first.next;
  const FramePlan still = scene.plan();
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(still.next.shadows.kept[i].map->islands, first.next.shadows.kept[i].map->islands);
  const auto origins = [&](const FramePlan& plan) {
    std::vector<FixedPos> out;
    for (const DrawnIsland& island : *plan.next.shadows.kept[0].map->islands)
      out.push_back(island.origin);
    return out;
  };
  const std::vector<FixedPos> before = origins(first);
  scene.history = still.next;
  scene.move(10.0);
  const FramePlan moved = scene.plan();
  EXPECT_EQ(origins(first), before);
  ASSERT_EQ(moved.next.previous->islands->size(), ManyPlanned::kIslands);
  EXPECT_NE((*moved.next.previous->islands)[0].origin, (*still.next.previous->islands)[0].origin);
  for (const DrawnIsland& island : *moved.next.shadows.kept[0].map->islands)
    EXPECT_EQ(island.origin, scene.islands[island.index].origin) << "moved by many texels";
}

TEST(PlanFrame, DrawsEveryMapOfAFirstFrameAndNoneOfTheNext) {
  Planned scene;
  const FramePlan first = scene.plan();
  EXPECT_EQ(redrawn(first), 4u);
  EXPECT_TRUE(first.bake_sky);
  scene.history = first.next;
  const FramePlan second = scene.plan();
  EXPECT_EQ(redrawn(second), 0u);
  EXPECT_FALSE(second.bake_sky);
  EXPECT_NE(why_not(second, "bake_sky"), nullptr);
  EXPECT_NE(why_not(second, "draw_shadow_sun_0"), nullptr);
}

TEST(PlanFrame, OfAFrameThatFailedIsMadeAgainAsIfItHadNotBeen) {
  Planned scene;
  (void)scene.plan();  // and never submitted: its history is dropped
  EXPECT_EQ(redrawn(scene.plan()), 4u);
}

TEST(PlanFrame, KeepsNoMapOfAnArrayThatWasMadeAnew) {
  Planned scene;
  scene.history = scene.plan().next;
  SceneFacts facts;
  facts.sections = scene.sections;
  facts.sections_resident = 1;
  facts.changes = &scene.changes;
  facts.shadow_generation = scene.history.shadows.generation + 1;
  const FramePlan plan = plan_frame({scene.input, scene.settings, {64, 48}}, facts, scene.history);
  EXPECT_EQ(redrawn(plan), 4u);
}

TEST(PlanFrame, RemembersWhereCameraAndIslandsWere) {
  Planned scene;
  const FrameHistory next = scene.plan().next;
  ASSERT_TRUE(next.previous);
  EXPECT_EQ(next.previous->camera.position, scene.input.camera.position);
  ASSERT_EQ(next.previous->islands->size(), 1u);
}

TEST(PlanFrame, EachStepIsTakenOrSaysWhyNot) {
  for (const bool debug : {false, true})
    for (const bool geometry : {false, true}) {
      Planned scene;
      if (!geometry) scene.sections.clear();
      if (debug) scene.settings.debug_view = DebugView::kNormal;
      const FramePlan plan = scene.plan();
      for (std::size_t i = 0; i < frame_steps().size(); ++i) {
        const bool taken = std::find(plan.steps.begin(), plan.steps.end(), i) != plan.steps.end();
        for (const StepPasses& passes : frame_steps()[i].passes)
          for (const std::string_view name : passes.names) {
            const char* why = why_not(plan, std::string(name));
            EXPECT_TRUE(taken || (why && *why != 0)) << name;
          }
      }
      EXPECT_EQ(why_not(plan, "draw_geometry") == nullptr, geometry);
      EXPECT_TRUE(std::is_sorted(plan.steps.begin(), plan.steps.end()));
    }
}

TEST(PlanFrame, LeavesShadowsOutWithTheirSetting) {
  Planned scene;
  scene.settings.shadow_enabled = false;
  const FramePlan plan = scene.plan();
  EXPECT_TRUE(plan.shadows.cascades.empty());
  EXPECT_EQ(plan.shadows.layout.layers, 0u);
  EXPECT_STREQ(why_not(plan, "draw_shadow_sun"), "shadow.enabled=0");
}

TEST(PlanFrame, SaysWhyEdgesAreNotSmoothed) {
  Planned scene;
  EXPECT_STREQ(why_not(scene.plan(), "smooth_edges"), "aa=off");
  scene.settings.aa = Antialiasing::kEdge;
  EXPECT_EQ(why_not(scene.plan(), "smooth_edges"), nullptr);
  scene.settings.gbuffer.depth = DepthStore::kD16;
  EXPECT_STREQ(why_not(scene.plan(), "smooth_edges"), "gbuffer.depth=d16");
  scene.settings.aa_samples = 4;
  EXPECT_STREQ(why_not(scene.plan(), "smooth_edges"), "aa.samples smooths the edges");
  scene.settings.debug_view = DebugView::kNormal;
  EXPECT_STREQ(why_not(scene.plan(), "smooth_edges"), "a debug view is shown");
}

TEST(PlanFrame, SaysWhyPicturesAreNotMixed) {
  Planned scene;
  EXPECT_STREQ(why_not(scene.plan(), "mix_edges"), "aa is not temporal");
  scene.settings.aa = Antialiasing::kTemporal;
  scene.input.exposure_ev = 0.0f;
  EXPECT_EQ(why_not(scene.plan(), "mix_at_rest"), nullptr);
  EXPECT_STREQ(why_not(scene.plan(), "mix_edges"), "nothing has moved");
  EXPECT_TRUE(scene.plan().next.temporal);
  scene.input.exposure_ev.reset();
  EXPECT_STREQ(why_not(scene.plan(), "mix_edges"), "the frame chooses its own exposure");
  EXPECT_FALSE(scene.plan().next.temporal);
}

TEST(PlanFrame, LeavesCloudsOutThatAreNotInView) {
  Planned scene;
  scene.settings.clouds.coverage = 0.5f;
  scene.input.camera.pitch_deg = 10.0;
  const FramePlan up = scene.plan();
  ASSERT_TRUE(up.clouds);
  EXPECT_TRUE(up.clouds->in_view);
  EXPECT_EQ(why_not(up, "march_clouds"), nullptr);
  scene.input.camera.pitch_deg = -80.0;
  const FramePlan down = scene.plan();
  ASSERT_TRUE(down.clouds) << "they still shade what is seen";
  EXPECT_STREQ(why_not(down, "march_clouds"), "no cloud is in view");
  EXPECT_LT(down.steps.size(), up.steps.size());
}

TEST(PlanFrame, FreezesTheViewOfTheFrameInWhichCullingIsFrozen) {
  Planned scene;
  scene.input.freeze_culling = true;
  scene.history = scene.plan().next;
  ASSERT_TRUE(scene.history.frozen);
  scene.input.camera.yaw_deg = 90.0;
  EXPECT_EQ(scene.plan().next.frozen->view.planes[0], scene.history.frozen->view.planes[0]);
  scene.input.freeze_culling = false;
  EXPECT_FALSE(scene.plan().next.frozen);
}

}  // namespace
}  // namespace skerry::render
