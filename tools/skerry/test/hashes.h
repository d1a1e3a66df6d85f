// The exact pictures that have been approved, driver by driver.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "tools/skerry/compare/unpacked.h"

namespace skerry::tools {

/// Names what decides a picture's last bits, as part of a file name: driver and version, and for
/// drivers that run on the CPU its vector width and vendor.
std::string driver_key(const gpu::DeviceInfo& device);

/// Lower case; what is neither letter, digit nor dot becomes one underscore.
std::string file_name_part(std::string_view text);

/// Vendor of this machine's processor as it names itself, else "unknown".
std::string cpu_vendor();

/// SHA-256 by scene.
using Hashes = std::map<std::string, std::string>;

/// The file beside a folder's scenes that holds a driver's hashes.
std::filesystem::path hash_file(const std::filesystem::path& scenes, std::string_view driver);

/// Empty when there is no file. @param from an archive: errors name it and what to do with it.
/// Errors: unreadable; not an object of 64 hexadecimal digits.
Result<Hashes> read_hashes(const std::filesystem::path& file,
                           const std::optional<Unpacked>& from = std::nullopt);
/// Sorted, one scene a line.
Result<void> write_hashes(const std::filesystem::path& file, const Hashes& hashes);

/// Takes a scene's hash out of the files of all drivers but one: their pictures belong to a
/// reference that is no more.
Result<void> remove_others(const std::filesystem::path& scenes, std::string_view driver,
                           const std::string& scene,
                           const std::optional<Unpacked>& from = std::nullopt);

}  // namespace skerry::tools
