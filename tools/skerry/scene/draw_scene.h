#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "game/view/scene_view.h"
#include "tools/measure/picture.h"

namespace skerry::tools {

/// One drawn picture and its numbers.
struct Drawn {
  VkExtent2D size{};
  std::vector<std::uint8_t> rgba;  ///< sRGB-encoded, rows from the top
  render::FrameReport report;
  std::optional<measure::Picture> radiance;  ///< before exposure, of `size`, if asked for
};

/// Lower-case hexadecimal SHA-256.
std::string sha256_hex(std::span<const std::uint8_t> bytes);

/// A scene with its world loaded completely, to be drawn as often as wanted.
class SceneDrawer {
 public:
  /// Loads the world. @param cache see SceneView::create. Errors: no memory on the device; the
  /// picture is too large for it.
  static Result<std::unique_ptr<SceneDrawer>> create(gpu::Device& device,
                                                     const game::SceneOptions& scene,
                                                     game::SceneCache* cache = nullptr);

  /// Draws and waits. With aa=temporal it is the last of 9 frames, of which the first is metered
  /// and the others are mixed: the picture that play comes to at rest. @param with_radiance also
  /// copies out the scene's radiance (RGBA16F rounded), which makes the frame take the way over a
  /// radiance image.
  Result<Drawn> draw(bool with_radiance = false);
  /// Draws `count` frames and waits for each; every shadow map and table is drawn afresh in each,
  /// as in a screenshot. @param keep_shadows as in play: maps that still hold are kept.
  Result<std::vector<render::FrameReport>> time(int count, bool keep_shadows = false);
  game::SceneView& view() { return *view_; }

 private:
  SceneDrawer(gpu::Device& device, const game::SceneOptions& scene);
  Result<std::uint64_t> draw_frame(bool with_radiance);
  Result<void> settle();

  gpu::Device& device_;
  game::SceneOptions scene_;
  std::unique_ptr<game::SceneView> view_;
  std::optional<double> exposure_ev_;  // of frames that are mixed; none: as metered
};

/// Draws what a view has loaded and waits. @return RGBA8, sRGB-encoded, rows from the top.
Result<std::vector<std::uint8_t>> drawn_picture(gpu::Device& device, game::SceneView& view,
                                                const game::SceneView::Moment& moment,
                                                VkExtent2D size);

}  // namespace skerry::tools
