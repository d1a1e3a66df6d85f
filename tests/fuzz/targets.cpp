#include "tests/fuzz/targets.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>
#include <string>

#include "engine/core/check.h"
#include "engine/core/output.h"
#include "engine/platform/image_file.h"
#include "engine/platform/tar.h"
#include "game/input/actions.h"
#include "game/input/hints.h"
#include "game/openexr/panorama_answer.h"
#include "game/pace/learnt_costs.h"
#include "game/pace/quality_front.h"
#include "game/panorama/radiance_hdr.h"
#include "game/scene_file/options.h"
#include "game/scene_file/setting_keys.h"
#include "game/session/journal.h"
#include "game/worlds/gallery.h"
#include "tools/skerry/farm/plan.h"
#include "tools/skerry/farm/record.h"
#include "tools/skerry/test/hashes.h"
#include "world/store/bytes.h"
#include "world/store/chunk_blob.h"
#include "world/store/log.h"
#include "world/store/page_bytes.h"
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
  const Result<void> fits = game::check_expectations(text->expectations, scene->size);
  if (!fits) check_line(fits.error());
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

/// For parsers that take a file's name, in a folder of their own. @return where the input is now.
std::filesystem::path written(std::span<const std::uint8_t> input,
                              const std::filesystem::path& name = "input") {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("skerry_fuzz_{}", getpid()) / name;
  std::filesystem::create_directories(path.parent_path());
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

void check_panorama(const Result<render::Panorama>& panorama) {
  if (!panorama) return check_line(panorama.error());
  SKERRY_ASSERT(panorama->columns == 2 * panorama->rows);
  SKERRY_ASSERT(panorama->texels.size() == std::size_t{panorama->columns} * panorama->rows);
  for (const glm::vec3& texel : panorama->texels)
    for (int c = 0; c < 3; ++c)
      SKERRY_ASSERT(texel[c] >= 0.0f && texel[c] <= render::kMostPanoramaRadiance);
}

void radiance_hdr(std::span<const std::uint8_t> input) {
  check_panorama(game::read_radiance_hdr(text_of(input)));
}

void panorama_answer(std::span<const std::uint8_t> input) {
  check_panorama(game::decode_panorama(std::as_bytes(input)));
}

/// Nothing but regular files comes out, in the folder, and no more than the archive has.
void check_tar(std::span<const std::uint8_t> input) {
  const std::filesystem::path path = written(input), into = path.parent_path() / "unpacked";
  std::filesystem::remove_all(into);
  std::filesystem::create_directories(into);
  const auto entries = [&] {
    return std::distance(std::filesystem::directory_iterator(path.parent_path()),
                         std::filesystem::directory_iterator());
  };
  const auto before = entries();
  const Result<void> done = platform::unpack_tar(path, into);
  SKERRY_ASSERT(entries() == before);
  std::uintmax_t bytes = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(into)) {
    SKERRY_ASSERT(!file.is_symlink() && (file.is_regular_file() || file.is_directory()));
    if (file.is_regular_file()) bytes += file.file_size();
  }
  SKERRY_ASSERT(bytes <= input.size());
  if (!done) check_line(done.error());
}

/// An archive with checksums that fit its headers: nothing behind them would be reached otherwise.
/// Source: POSIX.1-2017, pax, "ustar Interchange Format".
std::vector<std::uint8_t> with_header_sums(std::span<const std::uint8_t> input) {
  constexpr std::size_t kBlock = 512, kSize = 124, kSum = 148, kFieldBytes = 12, kSumBytes = 8;
  std::vector<std::uint8_t> tar(input.begin(), input.end());
  for (std::size_t at = 0; tar.size() - at >= kBlock;) {
    const std::span header = std::span(tar).subspan(at, kBlock);
    at += kBlock;
    if (std::ranges::all_of(header, [](std::uint8_t byte) { return byte == 0; })) continue;
    std::ranges::fill(header.subspan(kSum, kSumBytes), ' ');
    const std::string sum =
        fmt::format("{:06o}", std::accumulate(header.begin(), header.end(), 0u));
    std::ranges::copy_n(sum.c_str(), 7, header.begin() + kSum);
    std::size_t bytes = 0;
    for (const std::uint8_t digit : header.subspan(kSize, kFieldBytes))
      if (digit >= '0' && digit <= '7') bytes = bytes * 8 + (digit - '0');
    at += std::min((bytes + kBlock - 1) / kBlock * kBlock, tar.size() - at);
  }
  return tar;
}

void tar(std::span<const std::uint8_t> input) {
  check_tar(input);
  check_tar(with_header_sums(input));
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

/// A log of SQLite with whatever pages, of which read_log() must name none that is not there.
void check_log(const std::string& bytes) {
  std::istringstream log(bytes);
  for (const auto& [page, where] : world::read_log(log).where)
    SKERRY_ASSERT(where + world::kPageBytes <= bytes.size());
}

/// The same log with checksums that fit: nothing behind them would be reached otherwise.
/// Source: https://www.sqlite.org/fileformat2.html#walformat.
std::string with_checksums(std::string log) {
  constexpr std::size_t kHeader = 32, kFrameHeader = 24;
  if (log.size() < kHeader) return log;
  std::uint32_t first = 0, second = 0;
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(log[at + i]);
    return value;
  };
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) log[at + i] = static_cast<char>(value >> (24 - 8 * i));
  };
  const auto add = [&](std::size_t at, std::size_t count) {
    for (const std::size_t end = at + count; at < end; at += 8) {
      first += word(at) + second;
      second += word(at + 4) + first;
    }
  };
  const auto put_sum = [&](std::size_t at) {
    put(at, first);
    put(at + 4, second);
  };
  put(0, 0x377f0683);  // words are big-endian
  put(8, world::kPageBytes);
  add(0, 24);
  put_sum(24);
  for (std::size_t at = kHeader; at + kFrameHeader + world::kPageBytes <= log.size();
       at += kFrameHeader + world::kPageBytes) {
    log.replace(at + 8, 8, log, 16, 8);  // its salts
    add(at, 8);
    add(at + kFrameHeader, world::kPageBytes);
    put_sum(at + 16);
  }
  return log;
}

void world_log(std::span<const std::uint8_t> input) {
  check_log(std::string(text_of(input)));
  check_log(with_checksums(std::string(text_of(input))));
}

void farm_plan(std::span<const std::uint8_t> input) {
  const std::filesystem::path dir = written(input, "plan.json").parent_path();
  for (const char* command : {"stability", "report"}) {
    const Result<tools::Plan> plan = tools::read_plan(dir, command);
    if (!plan) {
      check_line(plan.error());
      continue;
    }
    for (const tools::Task& task : plan->tasks) {
      const std::array<std::string, 2> wanted{task.id, task.name};
      SKERRY_ASSERT(tools::chosen_tasks(*plan, wanted));
      // A row's file lies where rows are, whatever the plan says.
      SKERRY_ASSERT(tools::record_file(dir, task.id).parent_path() == dir / "rows");
    }
    SKERRY_ASSERT(tools::write_plan(dir, *plan));
    const Result<tools::Plan> again = tools::read_plan(dir, command);
    SKERRY_ASSERT(again && again->tasks == plan->tasks && again->arguments == plan->arguments);
  }
}

void farm_row(std::span<const std::uint8_t> input) {
  tools::Plan plan;
  plan.tasks = {{"t000000000000000000000000", "one"}};
  const std::filesystem::path file = written(input, "rows/t000000000000000000000000.json");
  const std::array<std::filesystem::path, 1> dirs{file.parent_path().parent_path()};
  const Result<tools::Collected> rows = tools::collect(plan, dirs);
  if (!rows) return check_line(rows.error());
  SKERRY_ASSERT(tools::write_record(dirs[0], *rows->records[0]));
  const Result<tools::Collected> again = tools::collect(plan, dirs);
  SKERRY_ASSERT(again && again->records[0]->result == rows->records[0]->result);
}

void learnt_costs(std::span<const std::uint8_t> input) {
  const std::filesystem::path path = written(input);
  const auto learnt = game::load_learnt_costs(path, "a");
  if (!learnt) check_line(learnt.error());
  const game::LearntCosts other{
      0, std::vector<std::optional<double>>(game::quality_front().size(), 1.5)};
  SKERRY_ASSERT(game::save_learnt_costs(path, "another", other));
  const auto again = game::load_learnt_costs(path, "another");
  SKERRY_ASSERT(again && *again && (*again)->costs_ms == other.costs_ms);
}

void hints(std::span<const std::uint8_t> input) {
  const std::string printed = game::Hints::read(text_of(input)).print();
  SKERRY_ASSERT(game::Hints::read(printed).print() == printed);
}

void journal(std::span<const std::uint8_t> input) {
  world::ByteReader in(std::as_bytes(input));
  const std::optional<game::Journal> read = game::decode_journal(in);
  if (!read) return;
  SKERRY_ASSERT(game::fits_file(*read));
  world::ByteWriter out;
  game::encode_journal(*read, out);
  world::ByteReader again(out.bytes());
  SKERRY_ASSERT(game::decode_journal(again) == read && again.done());
}

/// A picture from anywhere may hold any text.
void picture_command(std::span<const std::uint8_t> input) {
  const Result<game::SceneText> place = game::place_of_command(text_of(input));
  if (!place) return check_line(place.error());
  const Result<game::SceneOptions> scene = game::make_scene(*place, {});
  if (!scene) return check_line(scene.error());
  // What leads somewhere leads there again.
  const Result<game::SceneText> again = game::place_of_command(game::shot_command(*scene));
  SKERRY_ASSERT(again && game::make_scene(*again, {}));
}

void hashes(std::span<const std::uint8_t> input) {
  const std::filesystem::path path = written(input);
  const Result<tools::Hashes> read = tools::read_hashes(path);
  if (!read) return check_line(read.error());
  SKERRY_ASSERT(tools::write_hashes(path, *read));
  SKERRY_ASSERT(*tools::read_hashes(path) == *read);
}

constexpr std::array<Target, 21> kTargets{{{"scene", scene},
                                           {"setting", setting},
                                           {"camera", camera},
                                           {"time_and_size", time_and_size},
                                           {"bindings", bindings},
                                           {"png", png},
                                           {"radiance_hdr", radiance_hdr},
                                           {"panorama_answer", panorama_answer},
                                           {"tar", tar},
                                           {"vdb_answer", vdb_answer},
                                           {"chunk_blob", chunk_blob},
                                           {"world_rows", world_rows},
                                           {"world_pages", world_pages},
                                           {"world_log", world_log},
                                           {"farm_plan", farm_plan},
                                           {"farm_row", farm_row},
                                           {"learnt_costs", learnt_costs},
                                           {"hints", hints},
                                           {"journal", journal},
                                           {"picture_command", picture_command},
                                           {"hashes", hashes}}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

}  // namespace skerry::fuzz
