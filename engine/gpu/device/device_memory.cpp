// Device's resources: creation with one dedicated allocation each, accounting, and destruction by
// timeline value.
#include <algorithm>
#include <array>
#include <limits>

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/device_state.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

struct MemoryWish {
  VkMemoryPropertyFlags required;
  VkMemoryPropertyFlags preferred;
  VkMemoryPropertyFlags avoided;
};

constexpr VkMemoryPropertyFlags kHost =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;

MemoryWish wish_for(Memory memory) {
  switch (memory) {
    case Memory::kDevice:
      return {0, kLocal, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT};
    case Memory::kUpload:
      return {kHost, 0, kLocal | VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
    case Memory::kReadback:
      return {kHost, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kLocal};
    case Memory::kMapped:
      return {kHost, kLocal, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
  }
  return {};
}

/// Memory types that may hold the resource, best first.
std::vector<std::uint32_t> rank_types(const VkPhysicalDeviceMemoryProperties& types,
                                      std::uint32_t allowed, Memory memory) {
  // Lazily allocated, protected and vendor-specific types are never wanted.
  constexpr VkMemoryPropertyFlags kKnown = kHost | kLocal | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  const MemoryWish wish = wish_for(memory);
  const auto penalty = [&](std::uint32_t i) {
    const VkMemoryPropertyFlags flags = types.memoryTypes[i].propertyFlags;
    return ((flags & wish.preferred) == wish.preferred ? 0 : 2) +
           ((flags & wish.avoided) != 0 ? 1 : 0);
  };
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < types.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = types.memoryTypes[i].propertyFlags;
    if ((allowed >> i & 1u) && (flags & wish.required) == wish.required && (flags & ~kKnown) == 0)
      order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return penalty(a) < penalty(b); });
  return order;
}

constexpr std::uint64_t kTexelBytes = 16;  // of RGBA32_UINT

struct Allocation {
  VkDeviceMemory memory{};
  VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
};

Allocation allocate(VkDevice device, const std::vector<std::uint32_t>& types, std::uint64_t size,
                    const VkMemoryDedicatedAllocateInfo& dedicated) {
  Allocation out;
  for (const std::uint32_t type : types) {
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &dedicated, size, type};
    out.result = vkAllocateMemory(device, &info, nullptr, &out.memory);
    if (out.result == VK_SUCCESS) break;
  }
  return out;
}

std::string mebibytes(std::uint64_t bytes) {
  const std::uint64_t tenths = bytes / (1024 * 1024 / 10);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " MiB";
}

Error out_of_memory(const std::string& name, std::uint64_t wanted, std::uint64_t used,
                    VkResult result) {
  return Error{"cannot allocate " + mebibytes(wanted) + " of device memory for '" + name + "' (" +
               result_name(result) + ", " + mebibytes(used) +
               " in use): lower --quality, --size or view.distance"};
}

}  // namespace

Result<void> Device::check_buffer(const BufferDesc& desc) const {
  if (desc.size_bytes == 0)
    return Error{"cannot create the buffer '" + desc.name + "': its size is zero"};
  if ((desc.usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) &&
      desc.size_bytes > limits_.max_storage_range) {
    return Error{"cannot create the buffer '" + desc.name + "' of " + mebibytes(desc.size_bytes) +
                 ": this device binds at most " + mebibytes(limits_.max_storage_range) +
                 "; lower view.distance"};
  }
  if (desc.texels && desc.size_bytes > limits_.max_texels * kTexelBytes) {
    return Error{"cannot create the buffer '" + desc.name + "' of " + mebibytes(desc.size_bytes) +
                 ": this device fetches from at most " + std::to_string(limits_.max_texels) +
                 " texels; set indirect=off"};
  }
  if (desc.size_bytes > limits_.max_buffer_bytes)
    return out_of_memory(desc.name, desc.size_bytes, state_->memory_total,
                         VK_ERROR_OUT_OF_DEVICE_MEMORY);
  return {};
}

Result<Buffer> Device::create_buffer(const BufferDesc& desc) {
  if (Result<void> ok = check_buffer(desc); !ok) return ok.error();
  Buffer buffer;
  auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = desc.size_bytes;
  info.usage = desc.usage;
  const VkResult created = vkCreateBuffer(device_, &info, nullptr, &buffer.handle_);
  if (created != VK_SUCCESS)
    return out_of_memory(desc.name, desc.size_bytes, state_->memory_total, created);
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device_, buffer.handle_, &needs);
  auto dedicated =
      vk_struct<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
  dedicated.buffer = buffer.handle_;
  Allocation got;
  if (may_allocate(desc.name, needs.size))
    got = allocate(device_, rank_types(state_->memory_types, needs.memoryTypeBits, desc.memory),
                   needs.size, dedicated);
  if (got.result != VK_SUCCESS) {
    vkDestroyBuffer(device_, buffer.handle_, nullptr);
    return out_of_memory(desc.name, needs.size, state_->memory_total, got.result);
  }
  buffer.owner_ = this;
  buffer.memory_ = got.memory;
  buffer.size_ = desc.size_bytes;
  buffer.allocated_ = needs.size;
  buffer.name_ = desc.name;
  account(desc.name, needs.size);
  GPU_CHECK(vkBindBufferMemory(device_, buffer.handle_, buffer.memory_, 0));
  if (desc.memory != Memory::kDevice) {
    void* mapped = nullptr;
    GPU_CHECK(vkMapMemory(device_, buffer.memory_, 0, VK_WHOLE_SIZE, 0, &mapped));
    buffer.mapped_ = static_cast<std::byte*>(mapped);
  }
  set_name(reinterpret_cast<std::uint64_t>(buffer.handle_), VK_OBJECT_TYPE_BUFFER,
           desc.name.c_str());
  set_name(reinterpret_cast<std::uint64_t>(buffer.memory_), VK_OBJECT_TYPE_DEVICE_MEMORY,
           desc.name.c_str());
  if (desc.texels) {
    auto view = vk_struct<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
    view.buffer = buffer.handle_;
    view.format = VK_FORMAT_R32G32B32A32_UINT;
    view.range = VK_WHOLE_SIZE;
    GPU_CHECK(vkCreateBufferView(device_, &view, nullptr, &buffer.texels_));
    set_name(reinterpret_cast<std::uint64_t>(buffer.texels_), VK_OBJECT_TYPE_BUFFER_VIEW,
             desc.name.c_str());
  }
  return buffer;
}

Result<void> Device::check_image(const VkImageCreateInfo& info, const std::string& name) const {
  VkImageFormatProperties limits{};
  const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
      physical_, info.format, info.imageType, info.tiling, info.usage, info.flags, &limits);
  const std::string what =
      "cannot create the image '" + name + "' of " + std::to_string(info.extent.width) + "x" +
      std::to_string(info.extent.height) + ", " + std::to_string(info.arrayLayers) + " layers: ";
  if (info.extent.width == 0 || info.extent.height == 0 || info.arrayLayers == 0)
    return Error{what + "a size is zero"};
  if (result != VK_SUCCESS) {
    return Error{what + "this device does not support its format " + std::to_string(info.format) +
                 " for this use; choose another with --device"};
  }
  if (info.extent.width > limits.maxExtent.width || info.extent.height > limits.maxExtent.height ||
      info.extent.depth > limits.maxExtent.depth || info.arrayLayers > limits.maxArrayLayers ||
      info.mipLevels > limits.maxMipLevels) {
    return Error{what + "this device allows " + std::to_string(limits.maxExtent.width) + "x" +
                 std::to_string(limits.maxExtent.height) + ", " +
                 std::to_string(limits.maxArrayLayers) + " layers; lower --size or --quality"};
  }
  return {};
}

Result<Image> Device::create_image(const ImageDesc& desc) {
  auto info = vk_struct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = desc.depth != 0 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.extent.width, desc.extent.height, std::max(desc.depth, 1u)};
  info.mipLevels = desc.mips;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  if (Result<void> possible = check_image(info, desc.name); !possible) return possible.error();
  Image image;
  const VkResult created = vkCreateImage(device_, &info, nullptr, &image.handle_);
  if (created != VK_SUCCESS) return out_of_memory(desc.name, 0, state_->memory_total, created);
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device_, image.handle_, &needs);
  auto dedicated =
      vk_struct<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
  dedicated.image = image.handle_;
  Allocation got;
  if (may_allocate(desc.name, needs.size))
    got = allocate(device_, rank_types(state_->memory_types, needs.memoryTypeBits, Memory::kDevice),
                   needs.size, dedicated);
  if (got.result != VK_SUCCESS) {
    vkDestroyImage(device_, image.handle_, nullptr);
    return out_of_memory(desc.name, needs.size, state_->memory_total, got.result);
  }
  GPU_CHECK(vkBindImageMemory(device_, image.handle_, got.memory, 0));
  account(desc.name, needs.size);
  set_name(reinterpret_cast<std::uint64_t>(image.handle_), VK_OBJECT_TYPE_IMAGE, desc.name.c_str());
  set_name(reinterpret_cast<std::uint64_t>(got.memory), VK_OBJECT_TYPE_DEVICE_MEMORY,
           desc.name.c_str());
  image.adopt(*this, got.memory, needs.size, desc);
  return image;
}

Result<VkSampler> Device::sampler(const SamplerDesc& desc) {
  for (const auto& [known, sampler] : state_->samplers) {
    if (known == desc) return sampler;
  }
  auto info = vk_struct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
  info.magFilter = desc.mag;
  info.minFilter = desc.min;
  info.mipmapMode = desc.mip;
  info.addressModeU = info.addressModeV = info.addressModeW = desc.address;
  info.compareEnable = desc.compare ? VK_TRUE : VK_FALSE;
  info.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  info.maxLod = VK_LOD_CLAMP_NONE;
  VkSampler sampler{};
  const VkResult result = vkCreateSampler(device_, &info, nullptr, &sampler);
  if (result != VK_SUCCESS)
    return Error{"cannot create a sampler: vkCreateSampler returned " + result_name(result)};
  set_name(reinterpret_cast<std::uint64_t>(sampler), VK_OBJECT_TYPE_SAMPLER,
           desc.compare ? "compare sampler" : "sampler");
  state_->samplers.emplace_back(desc, sampler);
  return sampler;
}

std::vector<MemoryUse> Device::memory_use() const {
  std::vector<MemoryUse> list;
  for (const auto& [name, bytes] : state_->memory_by_name) list.push_back({name, bytes});
  std::stable_sort(list.begin(), list.end(),
                   [](const MemoryUse& a, const MemoryUse& b) { return a.bytes > b.bytes; });
  return list;
}

std::uint64_t Device::memory_total() const {
  return state_->memory_total;
}

bool Device::may_allocate(const std::string& name, std::uint64_t bytes) const {
  return !state_->allocation_gate || state_->allocation_gate(name, bytes);
}

std::uint64_t Device::allocations() const {
  return state_->allocations;
}

const std::string& Device::last_allocation() const {
  return state_->last_allocation;
}

void Device::set_allocation_gate(AllocationGate gate) {
  state_->allocation_gate = std::move(gate);
}

void Device::account(const std::string& name, std::uint64_t bytes) {
  state_->memory_by_name[name] += bytes;
  state_->memory_total += bytes;
  ++state_->allocations;
  state_->last_allocation = name;
}

void Device::retire(std::uint64_t object, VkObjectType type, VkDeviceMemory memory,
                    std::uint64_t bytes, const std::string& name) {
  state_->retired.push_back({next_value_, object, type, memory, bytes, name});
}

void Device::collect() {
  destroy_retired(completed_value());
}

void Device::destroy_retired(std::uint64_t completed) {
  while (!state_->retired.empty() && state_->retired.front().value <= completed) {
    const State::Retired& dead = state_->retired.front();
    destroy(dead.object, dead.type);
    if (dead.memory) {
      vkFreeMemory(device_, dead.memory, nullptr);
      state_->memory_total -= dead.bytes;
      const auto entry = state_->memory_by_name.find(dead.name);
      if ((entry->second -= dead.bytes) == 0) state_->memory_by_name.erase(entry);
    }
    state_->retired.pop_front();
  }
}

void Device::destroy(std::uint64_t object, VkObjectType type) {
  switch (type) {
#define SKERRY_DESTROY(suffix, enumerator)                                     \
  case VK_OBJECT_TYPE_##enumerator:                                            \
    vkDestroy##suffix(device_, reinterpret_cast<Vk##suffix>(object), nullptr); \
    return
    SKERRY_DESTROY(Buffer, BUFFER);
    SKERRY_DESTROY(BufferView, BUFFER_VIEW);
    SKERRY_DESTROY(Image, IMAGE);
    SKERRY_DESTROY(ImageView, IMAGE_VIEW);
    SKERRY_DESTROY(Pipeline, PIPELINE);
    SKERRY_DESTROY(PipelineLayout, PIPELINE_LAYOUT);
    SKERRY_DESTROY(DescriptorSetLayout, DESCRIPTOR_SET_LAYOUT);
    SKERRY_DESTROY(QueryPool, QUERY_POOL);
    SKERRY_DESTROY(CommandPool, COMMAND_POOL);
    SKERRY_DESTROY(Semaphore, SEMAPHORE);
    SKERRY_DESTROY(SwapchainKHR, SWAPCHAIN_KHR);
#undef SKERRY_DESTROY
    default:
      gpu_fatal("Device::retire does not know the object type " + std::to_string(type));
  }
}

}  // namespace skerry::gpu
