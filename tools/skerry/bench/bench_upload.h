#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/transfer/uploader.h"

namespace skerry::tools {

struct BenchUploadOptions {
  std::optional<std::uint32_t> device;
  bool validate = false;
  std::optional<std::filesystem::path> json;
};

/// Times 8 MiB through each way of gpu::Uploader, once in writes of the sizes chunk meshes have and
/// once in 64 KiB pieces. Rows: device, path, writes_of, writes, bytes, then for record (CPU:
/// queueing and recording), gpu, and total (from the first write until the GPU is done) ms_median,
/// ms_p10, ms_p90; gb_per_s of total and of gpu (null where the GPU does nothing).
/// @return exit status.
int bench_upload(const BenchUploadOptions& options);

/// The total times [ms] of one way, in writes of the sizes chunk meshes have.
Result<std::vector<double>> upload_times(gpu::Device& device, gpu::UploadPath path);

}  // namespace skerry::tools
