// The errors that quality auto chooses by, drawn again.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "game/pace/quality_front.h"
#include "tests/gpu/test_device.h"
#include "tools/measure/flip.h"
#include "tools/measure/metrics.h"
#include "tools/skerry/report/report_session.h"
#include "tools/skerry/report/topics.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

class QualityErrors : public gpu::GpuTest {
 protected:
  QualityErrors() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  /// A point of a topic in a scene that is loaded.
  measure::Picture draw(SceneDrawer& drawer, const game::Settings& scene, std::string_view point,
                        std::optional<double>& exposure_ev) {
    game::Settings settings = scene;
    EXPECT_TRUE(apply_point(point, settings));
    if (exposure_ev) settings.exposure_ev = exposure_ev;
    drawer.view().settings() = settings;
    Result<Drawn> drawn = drawer.draw(true);  // by the way that a report draws
    if (!drawn) {
      ADD_FAILURE() << drawn.error().message;
      return {};
    }
    exposure_ev = drawn->report.exposure_ev;
    return measure::picture_from(
        measure::Image{drawn->size.width, drawn->size.height, std::move(drawn->rgba)});
  }

  /// Mean FLIP of each point against the topic's last, over the topic's scenes.
  std::map<std::string, double> errors_of(const Topic& topic) {
    std::map<std::string, double> errors;
    for (const std::string_view name : topic.scenes) {
      const auto text = game::parse_scene(find_report_scene(name)->json);
      game::SceneText size;
      size.size = "320x180";
      auto scene = game::make_scene(*text, size);
      EXPECT_TRUE(scene);
      auto drawer = SceneDrawer::create(device(), *scene);
      if (!drawer) {
        ADD_FAILURE() << drawer.error().message;
        return {};
      }
      std::optional<double> exposure_ev;
      const measure::Picture last =
          draw(**drawer, scene->settings, topic.points.back().settings, exposure_ev);
      for (const TopicPoint& point : topic.points) {
        const measure::Picture shown = draw(**drawer, scene->settings, point.settings, exposure_ev);
        errors[std::string(point.label)] += measure::mean_of(measure::flip_ldr(last, shown)) /
                                            static_cast<double>(topic.scenes.size());
      }
    }
    return errors;
  }
};

// Those of the view's distance and detail load nine worlds of up to 4,000 blocks: by the command
// alone. Those of render_scale, where less is shaded than shading_rate shades, in long runs.
TEST_F(QualityErrors, OfPixelsAreWhatAReportMeasures) {
  for (const char* topic : {"render_scale", "shading_rate"}) {
    if (topic == std::string_view("render_scale") && !long_tests()) continue;
    const std::map<std::string, double> errors = errors_of(*find_topic(topic));
    for (const game::MeasuredError& kept : game::measured_errors()) {
      if (kept.topic != topic) continue;
      EXPECT_NEAR(errors.at(std::string(kept.point)), kept.flip, game::kErrorTolerance)
          << topic << " " << kept.point;
    }
  }
}

}  // namespace
}  // namespace skerry::tools
