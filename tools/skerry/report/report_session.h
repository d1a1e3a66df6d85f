#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "game/scene_file/options.h"
#include "game/view/scene_cache.h"
#include "tools/measure/image.h"
#include "tools/measure/picture.h"
#include "tools/skerry/report/reference_store.h"
#include "tools/skerry/report/topics.h"

namespace skerry::tools {

/// What a report was asked to do.
struct ReportRequest {
  std::vector<const Topic*> topics;
  bool left_out = false;     ///< kLeftOutTopic, too
  game::SceneText typed;     ///< scene options of the command line
  game::SceneOptions scene;  ///< as they resolve
  bool own_scene = false;    ///< judge every topic in `scene` instead of the topic's own
  bool own_size = false;     ///< a size was given
  std::optional<std::filesystem::path> references;  ///< folder that keeps references
  std::uint32_t reference_parts = 1;                ///< that each is drawn in, by any process
};

/// Names of the scenes a topic is judged in.
std::vector<std::string> scenes_of(const ReportRequest& request, const Topic& topic);
/// A scene by such a name, with the settings of a request; its size is the request's if that has
/// one.
Result<game::SceneOptions> requested_scene(const ReportRequest& request, const std::string& name);
/// Why a topic cannot be measured here: a file of its scenes is not there, or this build cannot
/// read it.
std::optional<std::string> why_not(const ReportRequest& request, const Topic& topic);

/// A picture by the CPU reference.
struct Judged {
  measure::Picture radiance;  ///< before exposure
  measure::Image shown;
  double ev = 0.0;                   ///< that it is shown at [stops]
  double mean_standard_error = 0.0;  ///< of radiance; 0 when unknown
};

/// What the tasks of a run share: the device, and the references, each made once, or taken from the
/// request's folder.
class ReportSession {
 public:
  ReportSession(gpu::Device& device, const ReportRequest& request);

  gpu::Device& device() { return device_; }
  game::SceneCache& cache() { return cache_; }
  const ReportRequest& request() const { return request_; }
  /// A scene by such a name, with the size and the settings of this run on this device.
  Result<game::SceneOptions> scene(const std::string& name) const;
  /// @param progress receives 0..1. Errors: those of reference::render_reference and reference_id.
  Result<const Judged*> reference(const game::SceneOptions& scene,
                                  const std::function<void(double)>& progress);

 private:
  Result<KeptReference> radiance_of(const game::SceneOptions& scene,
                                    const std::function<void(double)>& progress) const;

  gpu::Device& device_;
  game::SceneCache cache_;
  const ReportRequest& request_;
  std::map<std::string, std::unique_ptr<Judged>> references_;  // by the command that draws it
};

/// Applies "KEY=VALUE KEY=VALUE" of a topic.
Result<void> apply_point(std::string_view settings, game::Settings& into);

/// The quality levels whose own settings a point does not change.
std::vector<std::string> levels_with_default(const TopicPoint& point);

}  // namespace skerry::tools
