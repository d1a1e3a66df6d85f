#include "tests/fuzz/targets.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/core/check.h"
#include "engine/platform/image_file.h"
#include "game/options.h"
#include "world/vdb/answer.h"

namespace skerry::fuzz {
namespace {

std::string_view text_of(std::span<const std::uint8_t> input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// Errors are shown on a terminal: one line, and nothing that moves the cursor.
void check_line(const Error& error) {
  SKERRY_ASSERT(!error.message.empty());
  for (const char c : error.message) SKERRY_ASSERT(static_cast<unsigned char>(c) >= 32);
}

void scene(std::span<const std::uint8_t> input) {
  const Result<game::SceneText> text = game::parse_scene(text_of(input));
  if (!text) return check_line(text.error());
  const Result<game::SceneOptions> scene = game::make_scene(*text, {});
  if (!scene) return check_line(scene.error());
  SKERRY_ASSERT(!game::shot_command(*scene).empty());
}

void setting(std::span<const std::uint8_t> input) {
  game::Settings settings;
  if (const Result<void> ok = game::apply_setting(text_of(input), settings); !ok)
    return check_line(ok.error());
  game::Settings again;
  for (const std::string& assignment : game::assignments_from(game::Quality::kMedium, settings))
    SKERRY_ASSERT(game::apply_setting(assignment, again));
  SKERRY_ASSERT(again == settings);
}

void camera(std::span<const std::uint8_t> input) {
  const Result<game::CameraPlace> place = game::parse_camera(text_of(input));
  if (!place) return check_line(place.error());
  const Result<game::CameraPlace> again = game::parse_camera(game::format_camera(*place));
  SKERRY_ASSERT(again && *again == *place);
}

void time_and_size(std::span<const std::uint8_t> input) {
  if (const Result<int> time = game::parse_time_of_day(text_of(input)); time)
    SKERRY_ASSERT(*game::parse_time_of_day(game::format_time_of_day(*time)) == *time);
  else
    check_line(time.error());
  if (const Result<game::PictureSize> size = game::parse_size(text_of(input)); !size)
    check_line(size.error());
}

void png(std::span<const std::uint8_t> input) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("skerry_fuzz_{}.png", getpid());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()),
             static_cast<std::streamsize>(input.size()));
  const Result<platform::PngImage> image = platform::read_png(path);
  std::filesystem::remove(path);
  if (!image) return check_line(image.error());
  SKERRY_ASSERT(image->pixels.size() == std::size_t{image->width} * image->height * 4);
}

void vdb_answer(std::span<const std::uint8_t> input) {
  const auto grids = world::decode_answer(std::as_bytes(input));
  if (!grids) return check_line(grids.error());
  for (const world::VolumeGrid& grid : *grids) {
    SKERRY_ASSERT(std::isfinite(grid.min_value) && std::isfinite(grid.max_value));
    SKERRY_ASSERT(std::isfinite(grid.mean_value));
  }
}

constexpr std::array<Target, 6> kTargets{{{"scene", scene},
                                          {"setting", setting},
                                          {"camera", camera},
                                          {"time_and_size", time_and_size},
                                          {"png", png},
                                          {"vdb_answer", vdb_answer}}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

}  // namespace skerry::fuzz
