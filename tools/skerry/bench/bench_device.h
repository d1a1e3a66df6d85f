#pragma once
#include <filesystem>
#include <optional>

namespace skerry::tools {

struct BenchDeviceOptions {
  std::optional<std::uint32_t> device;
  bool validate = false;
  std::optional<std::filesystem::path> json;
};

/// Times what things cost on a device: loads by where they load from, branches, exits of loops,
/// shapes of groups, texture filters, what a quad writes, a pass that does nothing. Cases are timed
/// in turns, so that what else the machine does affects all alike. Rows: group, name, ms_median,
/// ms_p10, ms_p90, ns (median of one step of one invocation, of one quad, or of one pass).
/// @return exit status.
int bench_device(const BenchDeviceOptions& options);

}  // namespace skerry::tools
