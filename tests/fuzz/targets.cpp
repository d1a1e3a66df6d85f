#include "tests/fuzz/targets.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/core/check.h"
#include "engine/platform/image_file.h"
#include "game/input/actions.h"
#include "game/scene_file/options.h"
#include "game/scene_file/setting_keys.h"
#include "world/store/bytes.h"
#include "world/store/chunk_blob.h"
#include "world/store/pages.h"
#include "world/store/rows.h"
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

/// For parsers that take a file's name. @return where the input is now.
std::filesystem::path written(std::span<const std::uint8_t> input) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("skerry_fuzz_{}", getpid());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()),
             static_cast<std::streamsize>(input.size()));
  return path;
}

void bindings(std::span<const std::uint8_t> input) {
  const game::ReadBindings read = game::read_bindings(text_of(input));
  for (const std::string& problem : read.problems) check_line({problem});
  const game::ReadBindings again = game::read_bindings(game::print_bindings(read.bindings));
  SKERRY_ASSERT(again.problems.empty() && again.bindings == read.bindings);
}

void png(std::span<const std::uint8_t> input) {
  const std::filesystem::path path = written(input);
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

constexpr world::ChunkName kChunk{7, {-1, 2, 3}};

/// A blob of a world file as it is described, about any payload: nothing behind the checksum would
/// be reached otherwise.
std::vector<std::byte> blob_about(std::uint32_t magic, std::span<const std::byte> payload) {
  world::ByteWriter key, blob;
  key.u64(kChunk.island);
  for (const std::int32_t axis : {kChunk.chunk.x, kChunk.chunk.y, kChunk.chunk.z})
    key.u32(static_cast<std::uint32_t>(axis));
  blob.u32(magic);
  blob.u32(static_cast<std::uint32_t>(payload.size()));
  blob.u64(world::checksum(payload, world::checksum(key.bytes())));
  std::vector<std::byte> out = blob.take();
  const std::size_t header = out.size();
  out.resize(header + ZSTD_compressBound(payload.size()));
  out.resize(header + ZSTD_compress(out.data() + header, out.size() - header, payload.data(),
                                    payload.size(), 1));
  return out;
}

void check_edits(std::span<const std::byte> blob) {
  const Result<world::ChunkEdits> edits = world::decode_edits(kChunk, blob);
  if (!edits) return check_line(edits.error());
  for (const world::VoxelEdit& edit : *edits)
    SKERRY_ASSERT(edit.index < world::kChunkVoxels && edit.block < world::block::kBuiltInCount);
  SKERRY_ASSERT(*world::decode_edits(kChunk, world::encode_edits(kChunk, *edits)) == *edits);
}

void chunk_blob(std::span<const std::uint8_t> input) {
  const std::span<const std::byte> bytes = std::as_bytes(input);
  check_edits(bytes);
  check_edits(blob_about(0x31456b53, bytes));
  const Result<world::Chunk> chunk = world::decode_chunk(kChunk, bytes);
  if (!chunk) check_line(chunk.error());
  const Result<world::Chunk> made = world::decode_chunk(kChunk, blob_about(0x31576b53, bytes));
  if (!made) check_line(made.error());
}

/// Whatever decodes can be used, and encodes to the same bytes; of rows that an older version wrote
/// differently, to the same values.
void world_rows(std::span<const std::uint8_t> input) {
  const std::span<const std::byte> bytes = std::as_bytes(input);
  const auto same = [&](const std::vector<std::byte>& again) {
    SKERRY_ASSERT(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
  };
  if (const auto motion = world::decode_motion(bytes))
    SKERRY_ASSERT(world::decode_motion(world::encode_motion(*motion)) == motion);
  if (const auto spare = world::decode_spare(1, bytes)) same(world::encode_spare(*spare));
  if (const auto spec = world::decode_spec(1, bytes)) {
    same(world::encode_spec(*spec));
    world::pose_at(*spec, 1e9);
  }
  if (const auto info = world::decode_info(bytes))
    SKERRY_ASSERT(world::decode_info(world::encode_info(*info)) == info);
}

/// Pages of a world file that SQLite would not read any more.
void world_pages(std::span<const std::uint8_t> input) {
  const std::filesystem::path path = written(input);
  world::PageFile file(path);
  for (std::uint32_t page = 1; page <= file.count(); ++page)
    file.rows_of(page, [](std::int64_t, std::span<const world::Field> row) {
      std::size_t sum = 0;  // every byte that a field claims to have is read
      for (const world::Field& field : row)
        for (const std::byte byte : field.bytes) sum += std::to_integer<std::size_t>(byte);
      SKERRY_ASSERT(!row.empty() && sum < SIZE_MAX);
    });
  std::filesystem::remove(path);
}

constexpr std::array<Target, 10> kTargets{{{"scene", scene},
                                           {"setting", setting},
                                           {"camera", camera},
                                           {"time_and_size", time_and_size},
                                           {"bindings", bindings},
                                           {"png", png},
                                           {"vdb_answer", vdb_answer},
                                           {"chunk_blob", chunk_blob},
                                           {"world_rows", world_rows},
                                           {"world_pages", world_pages}}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

}  // namespace skerry::fuzz
