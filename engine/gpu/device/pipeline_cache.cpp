#include "engine/gpu/device/pipeline_cache.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "engine/core/log.h"
#include "engine/core/output.h"

namespace skerry::gpu {
namespace {

/// Far above what our pipelines take; a file beyond it is not ours.
constexpr std::uintmax_t kMaxCacheBytes = 256u << 20;

constexpr std::string_view kMagic = "SKPIPE1\n";
constexpr std::size_t kPrefixBytes = 16;

/// FNV-1a (Fowler, Noll, Vo): each step is a bijection of the sum, so that one changed byte always
/// shows. Drivers take the bodies of programs as they are and may run what a flipped bit made.
std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  for (const std::byte byte : bytes)
    sum = (sum ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
  return sum;
}

std::array<std::byte, kPrefixBytes> prefix_of(std::span<const std::byte> body) {
  std::array<std::byte, kPrefixBytes> prefix{};
  std::memcpy(prefix.data(), kMagic.data(), kMagic.size());
  std::uint64_t sum = checksum(body);
  for (std::size_t i = kMagic.size(); i < kPrefixBytes; ++i, sum >>= 8)
    prefix[i] = static_cast<std::byte>(sum & 0xff);
  return prefix;
}

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
  if (size >= kPrefixBytes && size <= kMaxCacheBytes) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const std::span<const std::byte> body = std::span(bytes).subspan(kPrefixBytes);
    if (file && std::ranges::equal(prefix_of(body), std::span(bytes).first(kPrefixBytes)) &&
        pipeline_cache_fits(body, device))
      return {body.begin(), body.end()};
  }
  log_info("pipeline cache " + path + " is damaged or from another driver: ignored and replaced");
  return {};
}

void save_pipeline_cache(const std::string& path, std::span<const std::byte> bytes) {
  const std::array<std::byte, kPrefixBytes> prefix = prefix_of(bytes);
  std::vector<std::byte> file(prefix.begin(), prefix.end());
  file.insert(file.end(), bytes.begin(), bytes.end());
  if (const Result<void> written = write_file(path, file); !written)
    log_warning("the next start will compile shaders again: " + written.error().message);
}

}  // namespace skerry::gpu
