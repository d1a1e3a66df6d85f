#include <fmt/format.h>

#include <algorithm>

#include "game/panorama/load_panorama.h"
#include "game/scene_file/setting_keys.h"
#include "game/scene_file/vdb_options.h"
#include "tools/skerry/farm/plan.h"
#include "tools/skerry/report/reference_store.h"

namespace skerry::tools {
namespace {

/// Keys of settings that the radiance of a reference does not depend on. One that is missing here
/// costs time; one that should not be here gives wrong references, so that a new key counts.
constexpr std::string_view kUnread[] = {"view.detail",       "aa.samples",
                                        "render.scale",      "shadow.size",
                                        "shadow.cascades",   "shadow.taps",
                                        "shadow.samples",    "shadow.split",
                                        "shadow.blur",       "texture.taps",
                                        "gbuffer.normal",    "gbuffer.position",
                                        "gbuffer.depth",     "exposure.stride",
                                        "bloom.intensity",   "bloom.threshold",
                                        "bloom.levels",      "clouds.steps",
                                        "clouds.resolution", "clouds.shadow_steps",
                                        "clouds.precision",  "tone",
                                        "display.peak",      "display.black",
                                        "renderer",          "shading.rate",
                                        "shading.tolerance", "lights.shadows",
                                        "lights.softness",   "lights.tile",
                                        "lights.oracle",     "upload.path",
                                        "upload.budget",     "memory.budget",
                                        "jobs.threads",      "frames.wanted",
                                        "frames.cap",        "frames.unfocused",
                                        "frames.sync",       "water.layers",
                                        "water.mirror",      "view.error"};

std::string text_of(const game::WorldLight& placed) {
  const shared::Light& light = placed.light;
  const auto vector = [](const auto& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
  return fmt::format("{} {} {} {} {} {} {} {}", vector(placed.position), light.range,
                     vector(light.intensity), light.kind, vector(light.axis), light.size,
                     light.cos_inner, light.cos_outer);
}

/// The scene without names of files, which are not the same on every machine.
std::vector<std::string> inputs_of(const game::SceneOptions& scene) {
  std::vector<std::string> inputs{scene.world ? "a world" : "seed " + scene.seed_text,
                                  scene.camera ? game::format_camera(*scene.camera) : "spawn",
                                  fmt::format("{} {} {}x{}", scene.fov_deg, scene.time_of_day_s,
                                              scene.size.width, scene.size.height)};
  for (const std::string& assignment :
       game::assignments_from(game::Quality::kMedium, scene.settings))
    if (std::ranges::find(kUnread, assignment.substr(0, assignment.find('='))) == std::end(kUnread))
      inputs.push_back(assignment);
  if (scene.world && game::is_vdb(*scene.world))
    for (const std::string& assignment : game::import_assignments(scene.import))
      inputs.push_back("import " + assignment);
  for (const game::WorldLight& light : scene.lights) inputs.push_back("light " + text_of(light));
  for (game::CloudFile cloud : scene.clouds) {
    cloud.path = "cloud";
    inputs.push_back(game::format_cloud(cloud));
  }
  return inputs;
}

}  // namespace

Result<std::string> reference_id(const game::SceneOptions& scene) {
  std::vector<std::string> inputs = inputs_of(scene);
  std::vector<std::string> files;
  if (scene.world) files = {*scene.world, *scene.world + "-wal"};
  for (const game::CloudFile& cloud : scene.clouds) files.push_back(cloud.path);
  if (const auto panorama = game::panorama_file(scene)) files.push_back(*panorama);
  for (const std::string& file : files) {
    Result<std::string> hash = file_hash(file);
    if (!hash) return hash;
    inputs.push_back(*std::move(hash));
  }
  return task_id("reference", "", inputs);
}

}  // namespace skerry::tools
