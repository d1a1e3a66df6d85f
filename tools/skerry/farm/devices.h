// Tasks over all devices of a machine, a process a device.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/gpu/device/device_info.h"
#include "tools/skerry/scene/arguments.h"

namespace skerry::tools {

/// The best device and the others of its name and driver, by index: what `--devices all` stands
/// for. Rows of unlike devices could not be merged.
/// Errors: no device is usable.
Result<std::vector<std::uint32_t>> devices_alike(const std::vector<gpu::DeviceInfo>& devices);

/// The same of this machine, looked up by a process of its own: a driver may start threads.
Result<std::vector<std::uint32_t>> devices_alike_here();

/// Reads --devices, if given, into `devices`. @param device --device, which excludes it.
std::optional<Refusal> parse_devices(const std::optional<std::string>& text,
                                     const std::optional<std::string>& device,
                                     std::vector<std::uint32_t>& devices);

/// The next task that nobody has; none: all are taken.
using NextTask = std::function<std::optional<std::size_t>()>;

/// Calls `body` in a process for each device, on a share of the processors; together they are given
/// each task once. The tasks that a process had when it died are lost, the others go to the rest.
/// @param body returns an exit status. @return the highest one; of a process that a signal ended:
/// kFailed, after a line. @pre this process has no thread but its main one.
int run_on_devices(std::span<const std::uint32_t> devices, std::size_t tasks,
                   const std::function<int(std::uint32_t device, const NextTask&)>& body);

}  // namespace skerry::tools
