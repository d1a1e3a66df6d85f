#include "tools/skerry/bench/bench_upload.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "engine/core/clock.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/graph/frame_ring.h"
#include "engine/gpu/transfer/uploader.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

constexpr std::uint64_t kBytes = 8u << 20;
constexpr int kUploadWarmUp = 3, kRuns = 25;

struct Way {
  std::string_view name;
  gpu::UploadPath path;
  gpu::Memory memory;
};
constexpr std::array kWays{
    Way{"update_buffer", gpu::UploadPath::kUpdateBuffer, gpu::Memory::kDevice},
    Way{"staging", gpu::UploadPath::kStaging, gpu::Memory::kDevice},
    Way{"mapped", gpu::UploadPath::kMapped, gpu::Memory::kMapped}};

/// Sizes that add up to kBytes.
struct Pattern {
  std::string_view name;
  std::vector<std::uint64_t> sizes;
};

void add_size(std::vector<std::uint64_t>& sizes, std::uint64_t& left, std::uint64_t size) {
  sizes.push_back(std::min(size, left));
  left -= sizes.back();
}

/// Chunk meshes as the generator makes them: most hold the ground's few thousand quads of 8 bytes,
/// every eighth a cave or a forest several times that, every fourth only a shore. The pattern is
/// fixed, so that runs compare.
Pattern chunk_meshes() {
  constexpr std::array<std::uint64_t, 8> kUploadQuads{2373,  1800, 310, 3100,
                                                      10690, 2050, 120, 2700};
  Pattern pattern{"chunk_meshes", {}};
  std::uint64_t left = kBytes;
  for (std::size_t i = 0; left > 0; ++i)
    add_size(pattern.sizes, left, kUploadQuads[i % kUploadQuads.size()] * 8);
  return pattern;
}

Pattern pieces_of_64k() {
  Pattern pattern{"64_kib", {}};
  std::uint64_t left = kBytes;
  while (left > 0) add_size(pattern.sizes, left, 65536);
  return pattern;
}

struct Times {
  std::vector<double> record_ms, gpu_ms, total_ms;
};

Result<Times> measure(gpu::Device& device, const Way& way, const Pattern& pattern) {
  Result<gpu::Buffer> to = device.create_buffer(
      {"upload target", kBytes,
       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, way.memory});
  if (!to) return to.error();
  std::vector<std::byte> bytes(kBytes);
  gpu::Uploader uploader(device, way.path);
  gpu::FrameGraph graph(&device);
  gpu::FrameRing ring(device, 1);
  Times times;
  for (int run = 0; run < kUploadWarmUp + kRuns; ++run) {
    std::fill(bytes.begin(), bytes.end(), static_cast<std::byte>(run));
    graph.begin();
    // A pass of its own gives the batch its timer.
    graph.add_pass(
        "upload", [](gpu::PassBuilder& b) { b.keep(); },
        [&](gpu::Commands& c) {
          uploader.record(c.raw(), std::numeric_limits<std::uint64_t>::max());
        });
    graph.compile();
    const gpu::FrameRing::Frame frame = ring.begin();
    const Stopwatch total;
    std::uint64_t offset = 0;
    for (const std::uint64_t size : pattern.sizes) {
      uploader.write<std::byte>(*to, offset, std::span(bytes).subspan(offset, size));
      offset += size;
    }
    graph.execute(frame.commands, frame.slot);
    const double record_ms = total.milliseconds();
    device.wait(ring.submit());
    const double total_ms = total.milliseconds();
    if (run < kUploadWarmUp) continue;
    times.record_ms.push_back(record_ms);
    times.total_ms.push_back(total_ms);
    for (const gpu::PassTime& pass : graph.times(frame.slot)) times.gpu_ms.push_back(pass.ms);
  }
  if (times.gpu_ms.empty())
    return Error{"this device's queue has no timestamps; choose another with --device"};
  return times;
}

double gb_per_s(double ms) {
  return static_cast<double>(kBytes) / (ms * 1e6);
}

nlohmann::ordered_json spread_json(const Spread& spread) {
  return {{"ms_median", spread.median}, {"ms_p10", spread.p10}, {"ms_p90", spread.p90}};
}

nlohmann::ordered_json report(const gpu::Device& device, const Way& way, const Pattern& pattern,
                              const Times& times) {
  const Spread record = spread_of(times.record_ms), gpu = spread_of(times.gpu_ms),
               total = spread_of(times.total_ms);
  nlohmann::ordered_json row{{"device", device.info().name},
                             {"path", way.name},
                             {"writes_of", pattern.name},
                             {"writes", pattern.sizes.size()},
                             {"bytes", kBytes},
                             {"record", spread_json(record)},
                             {"gpu", spread_json(gpu)},
                             {"total", spread_json(total)}};
  row["total"]["gb_per_s"] = gb_per_s(total.median);
  // Mapped writes leave the GPU nothing to do: a rate over its few microseconds would mean nothing.
  const bool gpu_works = way.path != gpu::UploadPath::kMapped;
  row["gpu"]["gb_per_s"] =
      gpu_works ? nlohmann::ordered_json(gb_per_s(gpu.median)) : nlohmann::ordered_json();
  const std::string gpu_rate = gpu_works ? fmt::format("{:.2f}", gb_per_s(gpu.median)) : "-";
  fmt::print("{:<14} {:<13} {:>6} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>10.2f} {:>10}\n",
             way.name, pattern.name, pattern.sizes.size(), record.median, gpu.median, total.median,
             total.p10, total.p90, gb_per_s(total.median), gpu_rate);
  return row;
}

}  // namespace

int bench_upload(const BenchUploadOptions& options) {
  game::SceneOptions scene;
  scene.device = options.device;
  scene.validate = options.validate;
  Result<std::unique_ptr<gpu::Device>> device = open_device(scene);
  if (!device) return fail(kNoDevice, device.error());
  fmt::print("{:<14} {:<13} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>10}\n", "path",
             "writes of", "writes", "record ms", "gpu ms", "total ms", "p10", "p90", "GB/s total",
             "GB/s gpu");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Pattern& pattern : {chunk_meshes(), pieces_of_64k()}) {
    for (const Way& way : kWays) {
      const Result<Times> times = measure(**device, way, pattern);
      if (!times) return fail(kFailed, times.error());
      rows.push_back(report(**device, way, pattern, *times));
    }
  }
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

Result<std::vector<double>> upload_times(gpu::Device& device, gpu::UploadPath path) {
  const auto* way = std::ranges::find(kWays, path, &Way::path);
  Result<Times> times = measure(device, *way, chunk_meshes());
  if (!times) return times.error();
  return times->total_ms;
}

}  // namespace skerry::tools
