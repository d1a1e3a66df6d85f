#include "game/panorama/load_panorama.h"

#include <fmt/format.h>

#include <utility>

#include "engine/platform/files.h"
#include "game/openexr/read_exr.h"
#include "game/panorama/radiance_hdr.h"
#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

/// Of a picture of the largest size, not compressed, and its header.
constexpr std::uint64_t kMostFileBytes = (std::uint64_t{1} << 29) + 65536;

Result<render::Panorama> read_hdr(const std::string& file) {
  const Result<std::string> bytes = platform::read_text(file, kMostFileBytes);
  if (!bytes) return bytes.error();
  return read_radiance_hdr(*bytes);
}

}  // namespace

std::optional<std::string> panorama_file(const SceneOptions& scene) {
  if (scene.ambient == kAmbientSky) return std::nullopt;
  return scene.ambient;
}

Result<std::shared_ptr<const render::PanoramaSky>> load_panorama(const SceneOptions& scene) {
  const std::optional<std::string> file = panorama_file(scene);
  if (!file) return std::shared_ptr<const render::PanoramaSky>();
  Result<render::Panorama> panorama = ends_in(*file, ".exr") ? read_exr(*file) : read_hdr(*file);
  if (!panorama)
    return Error{
        fmt::format("cannot use {} as the sky: {}", quote_text(*file), panorama.error().message)};
  return std::make_shared<const render::PanoramaSky>(*std::move(panorama), scene.settings.ambient);
}

}  // namespace skerry::game
