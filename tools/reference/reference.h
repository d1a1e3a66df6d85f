// The picture that the renderer's approximations are judged by: double precision, exact visibility,
// written from the formulas and not from the shaders. docs/reference.md.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/jobs.h"
#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "tools/measure/picture.h"
#include "tools/reference/scene.h"
#include "world/islands/world.h"

namespace skerry::reference {

/// The real radius of sun and moon in the sky [rad].
inline constexpr double kBodyRadius = 0.00465;

struct ReferenceSettings {
  std::uint32_t samples = 64;  ///< a pixel, 1 .. 65536
  game::ReferenceFilter filter = game::ReferenceFilter::kPixel;
  double body_radius = kBodyRadius;  ///< of sun and moon [rad]; 0: hard shadows
  int threads = 0;                   ///< 0: one a core. The picture does not depend on it.
};

/// Settings as the options' keys reference.* and jobs.threads give them.
ReferenceSettings settings_from(const game::SceneOptions& options);

/// A scene that options name.
struct NamedScene {
  std::shared_ptr<world::World> world;  ///< its voxels are made when they are asked for
  Scene scene;
  std::vector<std::uint64_t> ids;  ///< of its islands, in their order
};
/// What render_reference() draws. Errors: alike.
Result<NamedScene> scene_from(const game::SceneOptions& options, const ReferenceSettings& settings);

/// Radiance before exposure, and how far from its limit it is expected to be.
struct ReferencePicture {
  measure::Picture radiance;
  /// Standard error of the mean of each pixel and channel, from independent batches of samples.
  /// Empty with one sample, which says nothing about its error.
  std::vector<glm::vec3> standard_error;
  std::optional<double> mean_error;  ///< of all pixels and channels of standard_error
  double ev = 0.0;                   ///< stops to be developed at
  std::uint32_t non_finite_pixels = 0;
  std::size_t islands = 0, chunks = 0;  ///< looked at
  double seconds = 0.0;
};

/// A picture is the mean of so many independent estimates, or of fewer if it has fewer samples.
inline constexpr std::uint32_t kBatches = 8;
std::uint32_t batches_of(const ReferenceSettings& settings);

/// Batches [first, first + count) of a picture: what some machine has drawn of it.
struct ReferenceBatches {
  std::uint32_t width = 0, height = 0;
  std::uint32_t first = 0, count = 0;
  std::vector<glm::dvec3> means;  ///< of each batch's samples, a pixel; batch after batch
  double seconds = 0.0;
};

/// Told the share done, 0..1, now and then, from one thread at a time.
using Progress = std::function<void(double share)>;

/// Draws a scene made by hand. @pre the scene's numbers are finite; 1 <= samples <= 65536.
ReferencePicture render(const Scene& scene, const ReferenceSettings& settings,
                        const Progress& progress = {});

/// Draws some batches of it. @pre first + count <= batches_of(settings), count >= 1.
ReferenceBatches render_batches(const Scene& scene, const ReferenceSettings& settings,
                                std::uint32_t first, std::uint32_t count,
                                const Progress& progress = {});
/// The picture that `render` draws, to the last bit, whoever drew the batches: they are added in
/// their order. Its islands and chunks are not known; its
/// seconds are those of all batches together.
/// @pre the parts are of one size and are all batches, each once; in any order.
ReferencePicture merge_batches(std::span<const ReferenceBatches> parts);

/// Draws what `skerry shot` draws. The camera's place is exact; islands are at full detail.
/// Errors: a debug view is asked for, or a feature left out; more than 2^26 pixels.
Result<ReferencePicture> render_reference(const game::SceneOptions& options,
                                          const ReferenceSettings& settings,
                                          const Progress& progress = {});

/// The same, of some batches; and the picture of all of them, which is that of render_reference.
Result<ReferenceBatches> render_reference_batches(const game::SceneOptions& options,
                                                  const ReferenceSettings& settings,
                                                  std::uint32_t first, std::uint32_t count,
                                                  const Progress& progress = {});
ReferencePicture merge_reference(const game::SceneOptions& options,
                                 std::span<const ReferenceBatches> parts);

/// The exposure that a picture asks for [stops]: docs/exposure.md, from every pixel's luminance, in
/// order, without a histogram. None: all pixels are as good as black.
std::optional<double> metered_ev(const measure::Picture& radiance,
                                 const render::MeterSettings& settings);

/// How a picture is developed.
struct Darkroom {
  render::ToneCurve tone = render::ToneCurve::kAces;
  render::DisplaySettings display;
  render::BloomSettings bloom;
};
Darkroom darkroom_from(const game::Settings& settings);

/// What of an exposed pixel glows: docs/exposure.md.
glm::dvec3 too_bright(glm::dvec3 exposed, double threshold);
/// Exposed light that bloom adds.
measure::Picture glow(const measure::Picture& radiance, double ev,
                      const render::BloomSettings& settings);

/// Linear, 0..1.
glm::dvec3 tone_mapped(glm::dvec3 exposed, render::ToneCurve curve);

/// Exposure of `ev` stops, bloom, tone curve, display and sRGB to 8 bits, RGBA, rows from the top,
/// without dither.
std::vector<std::uint8_t> develop(const measure::Picture& radiance, double ev,
                                  const Darkroom& darkroom = {});

}  // namespace skerry::reference
