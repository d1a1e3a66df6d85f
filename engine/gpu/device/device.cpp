#include "engine/gpu/device/device.h"

#include <algorithm>
#include <limits>

#include "engine/core/check.h"
#include "engine/gpu/device/device_state.h"
#include "engine/gpu/device/features.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/pipeline_cache.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

Result<VkDevice> create_logical(VkPhysicalDevice physical, std::uint32_t queue_family,
                                bool surface) {
  const float priority = 1.0f;
  auto queue = vk_struct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueFamilyIndex = queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  std::vector<const char*> extensions{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  if (surface) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  FeatureChain features;
  require_features(features);
  auto info = vk_struct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core);
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkDevice device{};
  const VkResult result = vkCreateDevice(physical, &info, nullptr, &device);
  if (result != VK_SUCCESS) {
    return Error{"cannot open the Vulkan device: vkCreateDevice returned " + result_name(result) +
                 "; close other programs that use it, or choose another with --device"};
  }
  return device;
}

VkSemaphore create_timeline(VkDevice device) {
  auto type = vk_struct<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  VkSemaphore semaphore{};
  GPU_CHECK(vkCreateSemaphore(device, &info, nullptr, &semaphore));
  return semaphore;
}

VkPipelineCache create_pipeline_cache(VkDevice device, VkPhysicalDevice physical,
                                      const std::string& path) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  std::vector<std::byte> bytes;
  if (!path.empty()) bytes = load_pipeline_cache(path, properties);
  auto info = vk_struct<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
  info.initialDataSize = bytes.size();
  info.pInitialData = bytes.data();
  VkPipelineCache cache{};
  if (vkCreatePipelineCache(device, &info, nullptr, &cache) != VK_SUCCESS) {
    info.initialDataSize = 0;
    GPU_CHECK(vkCreatePipelineCache(device, &info, nullptr, &cache));
  }
  return cache;
}

std::vector<DeviceInfo> describe_all(const std::vector<VkPhysicalDevice>& devices, bool surface) {
  std::vector<DeviceInfo> infos;
  for (std::uint32_t i = 0; i < devices.size(); ++i)
    infos.push_back(describe_device(devices[i], i, surface));
  return infos;
}

}  // namespace

Result<std::vector<DeviceInfo>> Device::list() {
  Result<Instance> instance = Instance::create(Validation::kOff, {});
  if (!instance) return instance.error();
  Result<std::vector<VkPhysicalDevice>> devices = instance->devices();
  if (!devices) return devices.error();
  return describe_all(*devices, false);
}

Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options) {
  const Validation validation = !options.validate     ? Validation::kOff
                                : options.core_checks ? Validation::kFull
                                                      : Validation::kSynchronization;
  Result<Instance> instance = Instance::create(validation, options.surface_extensions);
  if (!instance) return instance.error();
  Result<std::vector<VkPhysicalDevice>> devices = instance->devices();
  if (!devices) return devices.error();
  const bool surface = !options.surface_extensions.empty();
  const std::vector<DeviceInfo> infos = describe_all(*devices, surface);
  Result<std::uint32_t> chosen = choose_device(infos, options.index);
  if (!chosen) return chosen.error();
  const VkPhysicalDevice physical = (*devices)[*chosen];
  const std::uint32_t queue_family = find_queue_family(physical);
  Result<VkDevice> logical = create_logical(physical, queue_family, surface);
  if (!logical) return logical.error();

  std::unique_ptr<Device> device(new Device);
  device->state_ = std::make_unique<State>(*std::move(instance));
  device->instance_ = device->state_->instance.handle();
  device->physical_ = physical;
  device->device_ = *logical;
  device->queue_family_ = queue_family;
  device->info_ = infos[*chosen];
  device->limits_ = read_limits(physical);
  device->state_->cache_path = options.pipeline_cache_path;
  device->open();
  return device;
}

Device::Device() = default;

void Device::open() {
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  vkGetPhysicalDeviceMemoryProperties(physical_, &state_->memory_types);
  state_->timeline = create_timeline(device_);
  pipeline_cache_ = create_pipeline_cache(device_, physical_, state_->cache_path);
  auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = queue_family_;
  GPU_CHECK(vkCreateCommandPool(device_, &pool, nullptr, &state_->now_pool));
  set_name(reinterpret_cast<std::uint64_t>(queue_), VK_OBJECT_TYPE_QUEUE, "queue");
  set_name(reinterpret_cast<std::uint64_t>(state_->timeline), VK_OBJECT_TYPE_SEMAPHORE, "timeline");
  set_name(reinterpret_cast<std::uint64_t>(state_->now_pool), VK_OBJECT_TYPE_COMMAND_POOL,
           "run_now pool");
  set_name(reinterpret_cast<std::uint64_t>(pipeline_cache_), VK_OBJECT_TYPE_PIPELINE_CACHE,
           "pipeline cache");
}

/// Adds to the file what this process has compiled. Processes that ended since this one began have
/// written theirs there as well; two that end at once may lose what one of them compiled.
void Device::keep_pipelines() {
  const VkPipelineCache of_others = create_pipeline_cache(device_, physical_, state_->cache_path);
  GPU_CHECK(vkMergePipelineCaches(device_, pipeline_cache_, 1, &of_others));
  vkDestroyPipelineCache(device_, of_others, nullptr);
  std::size_t size = 0;
  GPU_CHECK(vkGetPipelineCacheData(device_, pipeline_cache_, &size, nullptr));
  std::vector<std::byte> bytes(size);
  GPU_CHECK(vkGetPipelineCacheData(device_, pipeline_cache_, &size, bytes.data()));
  bytes.resize(size);
  save_pipeline_cache(state_->cache_path, bytes);
}

Device::~Device() {
  vkDeviceWaitIdle(device_);
  if (!state_->cache_path.empty()) keep_pipelines();
  destroy_retired(std::numeric_limits<std::uint64_t>::max());
  // Whoever is left holds a pointer to this device.
  if (!state_->memory_by_name.empty()) {
    gpu_fatal("the resource '" + state_->memory_by_name.begin()->first +
              "' outlives its device: destroy it earlier");
  }
  for (const auto& [desc, sampler] : state_->samplers) vkDestroySampler(device_, sampler, nullptr);
  vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
  vkDestroyCommandPool(device_, state_->now_pool, nullptr);
  vkDestroySemaphore(device_, state_->timeline, nullptr);
  vkDestroyDevice(device_, nullptr);
}

int Device::validation_message_count() const {
  return state_->instance.message_count();
}

std::uint64_t Device::completed_value() const {
  std::uint64_t value = 0;
  GPU_CHECK(vkGetSemaphoreCounterValue(device_, state_->timeline, &value));
  return value;
}

void Device::wait(std::uint64_t value) {
  SKERRY_ASSERT(value < next_value_);  // else nobody will ever signal it
  auto info = vk_struct<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
  info.semaphoreCount = 1;
  info.pSemaphores = &state_->timeline;
  info.pValues = &value;
  GPU_CHECK(vkWaitSemaphores(device_, &info, std::numeric_limits<std::uint64_t>::max()));
}

std::uint64_t Device::submit(VkCommandBuffer commands, std::span<const VkSemaphoreSubmitInfo> waits,
                             std::span<const VkSemaphoreSubmitInfo> signals) {
  std::vector<VkSemaphoreSubmitInfo> all_signals(signals.begin(), signals.end());
  auto timeline = vk_struct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  timeline.semaphore = state_->timeline;
  timeline.value = next_value_;
  timeline.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  all_signals.push_back(timeline);
  auto buffer = vk_struct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
  buffer.commandBuffer = commands;
  auto info = vk_struct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
  info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits.size());
  info.pWaitSemaphoreInfos = waits.data();
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &buffer;
  info.signalSemaphoreInfoCount = static_cast<std::uint32_t>(all_signals.size());
  info.pSignalSemaphoreInfos = all_signals.data();
  GPU_CHECK(vkQueueSubmit2(queue_, 1, &info, VK_NULL_HANDLE));
  return next_value_++;
}

VkCommandBuffer Device::begin_now() {
  auto allocate =
      vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  allocate.commandPool = state_->now_pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands{};
  GPU_CHECK(vkAllocateCommandBuffers(device_, &allocate, &commands));
  set_name(reinterpret_cast<std::uint64_t>(commands), VK_OBJECT_TYPE_COMMAND_BUFFER, "run_now");
  auto begin = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GPU_CHECK(vkBeginCommandBuffer(commands, &begin));
  return commands;
}

void Device::end_now(VkCommandBuffer commands) {
  GPU_CHECK(vkEndCommandBuffer(commands));
  wait(submit(commands));
  vkFreeCommandBuffers(device_, state_->now_pool, 1, &commands);
  collect();
}

void Device::set_name(std::uint64_t object, VkObjectType type, const char* name) {
  if (!vkSetDebugUtilsObjectNameEXT || !object) return;
  auto info =
      vk_struct<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = name;
  GPU_CHECK(vkSetDebugUtilsObjectNameEXT(device_, &info));
}

}  // namespace skerry::gpu
