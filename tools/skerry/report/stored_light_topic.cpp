#include "tools/skerry/report/stored_light_topic.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "tools/reference/reference.h"
#include "tools/skerry/shade/shade_errors.h"

namespace skerry::tools {
namespace {

constexpr int kLooks = 3;

}  // namespace

Result<SceneRows> measure_stored_light(
    const Topic& topic, const std::string& name, const game::SceneOptions& scene,
    const std::function<void(double, std::string_view)>& progress) {
  SceneRows out{name, game::shot_command(scene), kLooks, {}, {}, {}, 0.0, {}};
  const std::string what = fmt::format("{} in {}", topic.name, name);
  std::vector<LightDetail> details;
  for (const TopicPoint& point : topic.points)
    details.push_back(point.light.value_or(LightDetail{}));
  progress(0.0, what + ": reference");
  Result<ShadePictures> pictures = draw_shade(scene, details);
  if (!pictures) return pictures.error();
  Judged reference{pictures->reference, {}, 0.0, pictures->standard_error};
  reference.ev = reference::metered_ev(pictures->reference, {}).value_or(0.0);
  const auto develop = [&](const measure::Picture& light) {
    return measure::Image{light.width, light.height, reference::develop(light, reference.ev)};
  };
  reference.shown = develop(pictures->reference);
  out.reference = reference.shown;
  out.reference_standard_error = pictures->standard_error;
  std::vector<Shot> shots;
  for (measure::Picture& light : pictures->stored) {
    measure::Image shown = develop(light);
    shots.push_back({std::move(shown), std::move(light), reference.ev});
  }
  std::vector<std::vector<double>> ms(details.size());
  for (int round = 0; round < kLooks; ++round)
    for (std::size_t p = 0; p < details.size(); ++p) {
      progress(0.6 + 0.4 * round / kLooks, what + ": times");
      const Result<double> found = shade_work_ms(scene, details[p]);
      if (!found) return found.error();
      ms[p].push_back(*found);
    }
  finish_rows(topic, shots, ms, &reference, out);
  return out;
}

}  // namespace skerry::tools
