#include "tools/skerry/scene/draw_scene.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "engine/gpu/transfer/readback.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

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
                                                         const game::SceneOptions& scene) {
  if (Result<void> fits = check_size(device, scene.size); !fits) return fits.error();
  std::unique_ptr<SceneDrawer> drawer(new SceneDrawer(device, scene));
  Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(device, scene);
  if (!view) return view.error();
  drawer->view_ = *std::move(view);
  if (Result<void> loaded = drawer->view_->load_completely(drawer->view_->start_camera(),
                                                           scene.settings.world_time_s);
      !loaded)
    return loaded.error();
  return drawer;
}

Result<std::uint64_t> SceneDrawer::draw_frame(bool with_radiance) {
  return view_->draw({view_->start_camera(), static_cast<double>(scene_.time_of_day_s),
                      scene_.settings.world_time_s, false, with_radiance},
                     {scene_.size.width, scene_.size.height});
}

Result<Drawn> SceneDrawer::draw(bool with_radiance) {
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
  if (with_radiance) out.radiance = picture_of(renderer.captured(render::Capture::kRadiance));
  return out;
}

Result<std::vector<render::FrameReport>> SceneDrawer::time(int count, bool keep_shadows) {
  std::vector<render::FrameReport> out;
  for (int i = 0; i < count; ++i) {
    if (!keep_shadows) view_->renderer().forget_shadows();
    if (Result<std::uint64_t> drawn = draw_frame(false); !drawn) return drawn.error();
    view_->renderer().finish();
    out.push_back(view_->renderer().report().value());
  }
  return out;
}

}  // namespace skerry::tools
