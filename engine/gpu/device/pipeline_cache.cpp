#include "engine/gpu/device/pipeline_cache.h"

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "engine/core/log.h"

namespace skerry::gpu {
namespace {

/// Far above what our pipelines take; a file beyond it is not ours.
constexpr std::uintmax_t kMaxCacheBytes = 256u << 20;

}  // namespace

bool pipeline_cache_fits(std::span<const std::byte> bytes,
                         const VkPhysicalDeviceProperties& device) {
  VkPipelineCacheHeaderVersionOne header;
  static_assert(sizeof header == 32);
  if (bytes.size() < sizeof header) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header.headerSize == sizeof header &&
         header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
         header.vendorID == device.vendorID && header.deviceID == device.deviceID &&
         std::memcmp(header.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

std::vector<std::byte> load_pipeline_cache(const std::string& path,
                                           const VkPhysicalDeviceProperties& device) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return {};
  std::vector<std::byte> bytes;
  if (size <= kMaxCacheBytes) {
    bytes.resize(static_cast<std::size_t>(size));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (file && pipeline_cache_fits(bytes, device)) return bytes;
  }
  log_info("pipeline cache " + path + " is damaged or from another driver: ignored and replaced");
  return {};
}

void save_pipeline_cache(const std::string& path, std::span<const std::byte> bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path parent = fs::path(path).parent_path();
  if (!parent.empty()) fs::create_directories(parent, error);
  const std::string temporary = path + "." + std::to_string(::getpid()) + ".tmp";
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) fs::rename(temporary, path, error);
  if (error) {
    log_warning("cannot write the pipeline cache " + path + ": " + error.message() +
                "; the next start will compile shaders again");
    fs::remove(temporary, error);
  }
}

}  // namespace skerry::gpu
