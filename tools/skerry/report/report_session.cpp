#include "tools/skerry/report/report_session.h"

#include <fmt/format.h>

#include <filesystem>

#include "engine/core/check.h"
#include "engine/render/air/light_moments.h"
#include "game/scene_file/setting_keys.h"
#include "tools/reference/reference.h"
#include "tools/skerry/report/reference_parts.h"
#include "world/vdb/worker.h"

namespace skerry::tools {
namespace {

constexpr game::PictureSize kCpuSize{160, 90}, kGpuSize{1920, 1080};
constexpr const char* kOwnScene = "given";

KeptReference kept_of(reference::ReferencePicture made) {
  return {std::move(made.radiance), made.ev, made.mean_error, made.seconds};
}

}  // namespace

ReportSession::ReportSession(gpu::Device& device, const ReportRequest& request)
    : device_(device), cache_(device), request_(request) {}

std::vector<std::string> scenes_of(const ReportRequest& request, const Topic& topic) {
  if (request.own_scene) return {kOwnScene};
  return {topic.scenes.begin(), topic.scenes.end()};
}

Result<game::SceneOptions> requested_scene(const ReportRequest& request, const std::string& name) {
  if (request.own_scene) return request.scene;
  const ReportScene* known = find_report_scene(name);
  SKERRY_ASSERT(known != nullptr);
  const Result<game::SceneText> text = game::parse_scene(known->json);
  if (!text) return text.error();
  Result<game::SceneOptions> made = game::make_scene(*text, request.typed);
  if (!made) return made.error();
  made->device = request.scene.device;
  made->validate = request.scene.validate;
  return made;
}

std::optional<std::string> why_not(const ReportRequest& request, const Topic& topic) {
  for (const std::string& name : scenes_of(request, topic)) {
    const Result<game::SceneOptions> made = requested_scene(request, name);
    if (!made) return made.error().message;
    if (!made->clouds.empty() && !world::has_openvdb()) return "this build has no OpenVDB";
    for (const game::CloudFile& cloud : made->clouds)
      if (std::error_code none; !std::filesystem::exists(cloud.path, none))
        return fmt::format("there is no '{}' here; run it from the folder of the sources",
                           cloud.path);
  }
  return std::nullopt;
}

Result<game::SceneOptions> ReportSession::scene(const std::string& name) const {
  Result<game::SceneOptions> scene = requested_scene(request_, name);
  if (scene && !request_.own_size)
    scene->size = device_.info().type == VK_PHYSICAL_DEVICE_TYPE_CPU ? kCpuSize : kGpuSize;
  return scene;
}

Result<const Judged*> ReportSession::reference(const game::SceneOptions& scene,
                                               const std::function<void(double)>& progress) {
  std::unique_ptr<Judged>& kept = references_[game::shot_command(scene)];
  if (kept) return kept.get();
  Result<KeptReference> made = radiance_of(scene, progress);
  if (!made) return made.error();
  kept = std::make_unique<Judged>();
  kept->shown = {
      made->radiance.width, made->radiance.height,
      reference::develop(made->radiance, made->ev, reference::darkroom_from(scene.settings))};
  kept->ev = made->ev;
  kept->radiance = std::move(made->radiance);
  kept->mean_standard_error = made->mean_error.value_or(0.0);
  return kept.get();
}

Result<KeptReference> ReportSession::radiance_of(
    const game::SceneOptions& scene, const std::function<void(double)>& progress) const {
  const auto render = [&]() -> Result<KeptReference> {
    Result<reference::ReferencePicture> made =
        reference::render_reference(scene, reference::settings_from(scene), progress);
    if (!made) return made.error();
    return kept_of(*std::move(made));
  };
  if (!request_.references) return render();
  const Result<std::string> id = reference_id(scene);
  if (!id) return id.error();
  const ReferenceStore store(*request_.references);
  if (request_.reference_parts < 2) return store.get(*id, render);
  const reference::ReferenceSettings settings = reference::settings_from(scene);
  const std::vector<BatchRange> parts =
      split_batches(reference::batches_of(settings), request_.reference_parts);
  return get_in_parts(
      store, *id, parts,
      [&](const BatchRange& range) {
        return reference::render_reference_batches(scene, settings, range.first, range.count,
                                                   progress);
      },
      [&](std::span<const reference::ReferenceBatches> all) {
        return kept_of(merge_reference(scene, all));
      });
}

Result<void> apply_point(std::string_view settings, game::Settings& into) {
  if (settings.empty()) return {};
  for (const std::string& assignment : game::split(settings, ' '))
    if (Result<void> done = game::apply_setting(assignment, into); !done) return done;
  return {};
}

std::vector<std::string> levels_with_default(const TopicPoint& point) {
  std::vector<std::string> levels;
  for (const game::Quality quality :
       {game::Quality::kLow, game::Quality::kMedium, game::Quality::kHigh, game::Quality::kUltra}) {
    game::Settings settings = game::settings_of(quality);
    const Result<void> applied = apply_point(point.settings, settings);
    SKERRY_ASSERT(applied);
    if (point.sky_degree.value_or(render::kLightDegree) != render::kLightDegree) continue;
    if (point.light.value_or(LightDetail{}) != LightDetail{}) continue;
    if (settings == game::settings_of(quality))
      levels.emplace_back(game::quality_level(quality).name);
  }
  return levels;
}

}  // namespace skerry::tools
