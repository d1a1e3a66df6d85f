#include "tools/skerry/scene/draw_scene.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "engine/gpu/transfer/readback.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/temporal.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

// Before a still with aa=temporal: one that is metered and not kept, then all that are mixed with
// the still.
constexpr int kSettlingFrames = shared::kMixedFrames;

measure::Picture picture_of(const render::Captured& radiance) {
  SKERRY_ASSERT(radiance.layers == 1);
  measure::Picture out{radiance.size.width, radiance.size.height, {}};
  out.pixels.resize(std::size_t{out.width} * out.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    std::uint64_t halves;
    std::memcpy(&halves, radiance.texels.data() + i * sizeof(halves), sizeof(halves));
    out.pixels[i] = glm::vec3(glm::unpackHalf4x16(halves));
  }
  return out;
}

/// Radiance of a picture that is drawn smaller, as enlarge_picture.comp enlarges the picture.
measure::Picture enlarged(measure::Picture drawn, VkExtent2D size) {
  if (drawn.width == size.width && drawn.height == size.height) return drawn;
  struct Between {
    std::uint32_t first, second;
    float share;  // of the second
  };
  const auto between = [](std::uint32_t pixel, std::uint32_t shown, std::uint32_t pixels) {
    const float at = (static_cast<float>(pixel) + 0.5f) * static_cast<float>(pixels) /
                         static_cast<float>(shown) -
                     0.5f;
    const float first = std::floor(at);
    const auto inside = [&](float place) {
      return static_cast<std::uint32_t>(std::clamp(place, 0.0f, static_cast<float>(pixels - 1)));
    };
    return Between{inside(first), inside(first + 1.0f),
                   std::clamp((at - first - 0.5f) * shared::kEnlargeSlope + 0.5f, 0.0f, 1.0f)};
  };
  measure::Picture out{size.width, size.height, {}};
  out.pixels.reserve(std::size_t{size.width} * size.height);
  for (std::uint32_t row = 0; row < size.height; ++row) {
    const Between y = between(row, size.height, drawn.height);
    for (std::uint32_t column = 0; column < size.width; ++column) {
      const Between x = between(column, size.width, drawn.width);
      const auto in_row = [&](std::uint32_t r) {
        const glm::vec3* pixels = &drawn.pixels[std::size_t{r} * drawn.width];
        return glm::mix(pixels[x.first], pixels[x.second], x.share);
      };
      out.pixels.push_back(glm::mix(in_row(y.first), in_row(y.second), y.share));
    }
  }
  return out;
}

}  // namespace

std::string sha256_hex(std::span<const std::uint8_t> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

SceneDrawer::SceneDrawer(gpu::Device& device, const game::SceneOptions& scene)
    : device_(device), scene_(scene) {}

Result<std::unique_ptr<SceneDrawer>> SceneDrawer::create(gpu::Device& device,
                                                         const game::SceneOptions& scene,
                                                         game::SceneCache* cache) {
  if (Result<void> fits = check_size(device, scene.size); !fits) return fits.error();
  std::unique_ptr<SceneDrawer> drawer(new SceneDrawer(device, scene));
  Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(device, scene, cache);
  if (!view) return view.error();
  drawer->view_ = *std::move(view);
  if (Result<void> loaded = drawer->view_->load_completely(
          {drawer->view_->start_camera(), static_cast<double>(scene.time_of_day_s),
           scene.settings.world_time_s});
      !loaded)
    return loaded.error();
  return drawer;
}

Result<std::uint64_t> SceneDrawer::draw_frame(bool with_radiance) {
  game::SceneView::Moment moment{view_->start_camera(), static_cast<double>(scene_.time_of_day_s),
                                 scene_.settings.world_time_s, false, with_radiance};
  moment.exposure_ev = exposure_ev_;
  return view_->draw(moment, {scene_.size.width, scene_.size.height});
}

Result<void> SceneDrawer::settle() {
  render::Renderer& renderer = view_->renderer();
  exposure_ev_.reset();
  if (view_->settings().render.aa != render::Antialiasing::kTemporal) return {};
  renderer.invalidate_history();
  for (int frame = 0; frame < kSettlingFrames; ++frame) {
    if (Result<std::uint64_t> drawn = draw_frame(false); !drawn) return drawn.error();
    if (frame != 0) continue;
    renderer.finish();
    exposure_ev_ = renderer.report()->exposure_ev;
  }
  return {};
}

Result<Drawn> SceneDrawer::draw(bool with_radiance) {
  if (Result<void> settled = settle(); !settled) return settled.error();
  if (Result<std::uint64_t> drawn = draw_frame(with_radiance); !drawn) return drawn.error();
  render::Renderer& renderer = view_->renderer();
  renderer.finish();
  SKERRY_ASSERT(renderer.report().has_value());
  Drawn out;
  out.size = {scene_.size.width, scene_.size.height};
  out.report = *renderer.report();
  Result<std::vector<std::byte>> bytes = gpu::read_back(device_, renderer.picture(), 4);
  if (!bytes) return bytes.error();
  out.rgba.resize(bytes->size());
  std::memcpy(out.rgba.data(), bytes->data(), bytes->size());
  if (with_radiance)
    out.radiance = enlarged(picture_of(renderer.captured(render::Capture::kRadiance)), out.size);
  return out;
}

Result<std::vector<render::FrameReport>> SceneDrawer::time(int count, bool keep_shadows) {
  if (Result<void> settled = settle(); !settled) return settled.error();
  std::vector<render::FrameReport> out;
  for (int i = 0; i < count; ++i) {
    if (!keep_shadows) view_->renderer().invalidate_shadows();
    if (Result<std::uint64_t> drawn = draw_frame(false); !drawn) return drawn.error();
    view_->renderer().finish();
    out.push_back(view_->renderer().report().value());
  }
  return out;
}

Result<std::vector<std::uint8_t>> drawn_picture(gpu::Device& device, game::SceneView& view,
                                                const game::SceneView::Moment& moment,
                                                VkExtent2D size) {
  if (Result<std::uint64_t> drawn = view.draw(moment, size); !drawn) return drawn.error();
  view.renderer().finish();
  const Result<std::vector<std::byte>> texels =
      gpu::read_back(device, view.renderer().picture(), 4);
  if (!texels) return texels.error();
  std::vector<std::uint8_t> out(texels->size());
  std::memcpy(out.data(), texels->data(), out.size());
  return out;
}

}  // namespace skerry::tools
