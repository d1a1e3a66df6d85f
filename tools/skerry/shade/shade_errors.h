#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "tools/measure/image.h"
#include "tools/skerry/shade/stored_light.h"

namespace skerry::tools {

/// A view in which stored light is judged.
struct ShadeScene {
  std::string_view name;  ///< lower-case words joined by _
  std::string_view json;  ///< as a scene file (docs/settings.md), without size and quality
};
std::span<const ShadeScene> shade_scenes();

/// How far stored light is from the reference's, over the surfaces that a picture's pixels show:
/// irradiance but for direct light of sun, moon and strong lamps, linear RGB.
struct ShadeErrors {
  std::size_t places = 0;   ///< pixels that show a surface, farther than a block from weak lamps,
                            ///< which count as points
  std::size_t without = 0;  ///< of them those whose face is not there at the level of detail
  double mean = 0.0;        ///< of the reference's irradiance
  double rmse = 0.0;        ///< over `mean`; the reference's own variance is taken off
  double bias = 0.0;        ///< mean difference over `mean`
  double worst = 0.0;       ///< 99th percentile of the difference in luminance, over `mean`
  double standard_error = 0.0;  ///< root mean square of the reference's own, over `mean`
  double work_seconds = 0.0;    ///< of threads that found the light of all islands in view
  std::size_t bytes = 0;        ///< that the renderer stores of it
};

/// Errors: those of reference::scene_from.
Result<ShadeErrors> measure_shade(const game::SceneOptions& options);

/// The same light as pictures of irradiance; black where there is no surface, or no face at the
/// level of detail.
struct ShadePictures {
  measure::Picture reference;
  std::vector<measure::Picture> stored;  ///< one a detail
  double standard_error = 0.0;           ///< root mean square of the reference's, over its mean
};
/// @pre `details` is not empty. Errors: those of measure_shade().
Result<ShadePictures> draw_shade(const game::SceneOptions& options,
                                 std::span<const LightDetail> details);
/// What finding that light takes, of all threads [ms]. Errors: those of StoredLight::find.
Result<double> shade_work_ms(const game::SceneOptions& options, const LightDetail& detail);

}  // namespace skerry::tools
