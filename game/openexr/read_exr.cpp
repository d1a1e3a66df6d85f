#include "game/openexr/read_exr.h"

#include "game/openexr/panorama_answer.h"

namespace skerry::game {
namespace {

// A row of tiles of the largest picture is held as floats, and what a file states is made room for
// before it is read.
constexpr world::ReadLimits kLimits{std::uint64_t{1} << 30, std::uint64_t{1} << 27, 60, 120.0};

}  // namespace

Result<render::Panorama> read_exr(const std::filesystem::path& path) {
  Result<world::MemoryFile> answer =
      world::read_confined(kOpenExr, path, [](std::uint64_t) { return kLimits; });
  if (!answer) return answer.error();
  const Result<std::span<const std::byte>> bytes = answer->seal();
  if (!bytes) return bytes.error();
  return decode_panorama(*bytes);
}

}  // namespace skerry::game
