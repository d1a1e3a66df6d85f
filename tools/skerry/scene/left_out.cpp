#include "tools/skerry/scene/left_out.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "game/scene_file/setting_keys.h"

namespace skerry::tools {
namespace {

struct Listed {
  const char* feature;
  const char* setting;
  game::SceneText text;
};

/// Small pictures of little land: what is counted does not grow with either.
game::SceneText scene(const char* seed, const char* time, const char* moon_phase,
                      const char* camera = nullptr, const char* fov = nullptr) {
  game::SceneText text;
  text.seed = seed;
  text.time = time;
  text.size = "320x180";
  if (camera) text.camera = camera;
  if (fov) text.fov = fov;
  text.settings = {std::string("sky.moon_phase=") + moon_phase, "view.distance=200"};
  return text;
}

game::SceneText with(const char* setting, game::SceneText text) {
  text.settings.emplace_back(setting);
  return text;
}

/// A renderer that has drawn its scene once.
struct Side {
  std::unique_ptr<game::SceneCache> cache;  // none: all was made from nothing
  std::unique_ptr<SceneDrawer> drawer;
  Drawn first;
  std::vector<double> ms, start_ms;
  LeftOutSide numbers() const;
};

constexpr int kMostStarts = 3;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

LeftOutSide Side::numbers() const {
  return {first.report.counts, first.report.pipelines_created, first.report.memory_bytes,
          median(ms), median(start_ms)};
}

using Light = std::shared_ptr<world::LightCache>;

/// @param light handed on from renderer to renderer, each of which makes its own programs; null:
/// not.
Result<Side> draw_once(gpu::Device& device, const game::SceneOptions& scene, const Light& light) {
  // What other renderers have retired must not count.
  device.run_now([](VkCommandBuffer) {});
  device.collect();
  const std::uint64_t others = device.memory_total();
  Side side;
  if (light) side.cache = std::make_unique<game::SceneCache>(device, light);
  Result<std::unique_ptr<SceneDrawer>> drawer =
      SceneDrawer::create(device, scene, side.cache.get());
  if (!drawer) return drawer.error();
  side.drawer = *std::move(drawer);
  Result<Drawn> first = side.drawer->draw();
  if (!first) return first.error();
  side.first = *std::move(first);
  side.first.report.memory_bytes -= others;
  return side;
}

Result<void> time_once(Side& side) {
  Result<std::vector<render::FrameReport>> reports = side.drawer->time(1);
  if (!reports) return reports.error();
  side.ms.push_back(reports->front().gpu_ms);
  return {};
}

Result<void> start_once(gpu::Device& device, const game::SceneOptions& scene, Side& side) {
  const auto begin = std::chrono::steady_clock::now();
  if (Result<Side> started = draw_once(device, scene, nullptr); !started) return started.error();
  side.start_ms.push_back(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  return {};
}

/// What the last frame says.
std::string reason(SceneDrawer& drawer, const std::string& feature) {
  const std::string name = feature == "shadows" ? "draw_shadow_sun" : feature;
  for (const gpu::LeftOut& one : drawer.view().renderer().graph().left_out())
    if (one.name == name) return one.why;
  return {};
}

}  // namespace

Result<std::vector<LackingScene>> lacking_scenes() {
  const std::vector<Listed> listed{
      {"sun", "leave.out=sun", scene("4", "00:30", "0.5")},
      {"moon", "leave.out=moon", scene("1", "12:00", "0.5")},
      {"shadows", "shadow.enabled=0", scene("1", "00:00", "0")},
      {"water", "leave.out=water", scene("2", "12:00", "0", "-540,100,140,180,-15", "20")},
      {"cutouts", "leave.out=cutouts", scene("1", "00:00", "0", "0,-160,0,0,26", "4")},
      {"stars", "leave.out=stars", scene("1", "12:00", "0")},
      {"discs", "leave.out=discs", scene("1", "10:30", "0")},
      {"haze", "leave.out=haze", with("indirect=off", scene("1", "00:00", "0"))},
      {"lights", "leave.out=lights", scene("1", "00:00", "0", "0,-160,0,0,26", "4")},
      {"clouds", "leave.out=clouds", scene("1", "12:00", "0")},
      {"indirect", "indirect=off", with("world.islands=0", scene("1", "12:00", "0"))},
      {"ao", "ao.strength=0", with("shading=flat", scene("1", "12:00", "0"))},
  };
  std::vector<LackingScene> out;
  for (const Listed& one : listed) {
    Result<game::SceneOptions> made = game::make_scene(one.text, {});
    if (!made) return made.error();
    out.push_back({one.feature, one.setting, *std::move(made)});
  }
  return out;
}

bool LeftOutRow::same_counts() const {
  return as_is.counts == without.counts && as_is.pipelines_created == without.pipelines_created &&
         as_is.memory_bytes == without.memory_bytes;
}

Result<LeftOutRow> measure_left_out(gpu::Device& device, const LackingScene& lacking, int frames,
                                    const std::shared_ptr<world::LightCache>& light) {
  game::SceneOptions without = lacking.scene;
  if (Result<void> ok = game::apply_setting(lacking.setting, without.settings); !ok)
    return ok.error();
  Result<Side> a = draw_once(device, lacking.scene, light);
  if (!a) return a.error();
  Result<Side> b = draw_once(device, without, light);
  if (!b) return b.error();
  for (int i = 0; i < frames; ++i) {
    for (Side* side : {&*a, &*b})
      if (Result<void> ok = time_once(*side); !ok) return ok.error();
  }
  for (int i = 0; i < std::min(frames, kMostStarts); ++i) {
    if (Result<void> ok = start_once(device, lacking.scene, *a); !ok) return ok.error();
    if (Result<void> ok = start_once(device, without, *b); !ok) return ok.error();
  }
  return LeftOutRow{lacking.feature, reason(*a->drawer, lacking.feature),
                    a->first.rgba == b->first.rgba, a->numbers(), b->numbers()};
}

}  // namespace skerry::tools
