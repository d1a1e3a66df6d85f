#pragma once
#include <volk.h>

#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/instance.h"

namespace skerry::gpu {

/// What Device keeps to itself.
struct Device::State {
  struct Retired {
    std::uint64_t value;  ///< destroyed once the timeline reaches it
    std::uint64_t object;
    VkObjectType type;
    VkDeviceMemory memory;
    std::uint64_t bytes;
    std::string name;
  };

  explicit State(Instance made) : instance(std::move(made)) {}

  Instance instance;
  VkPhysicalDeviceMemoryProperties memory_types{};
  VkSemaphore timeline{};
  VkCommandPool now_pool{};
  std::string cache_path;
  std::deque<Retired> retired;  ///< values never fall
  std::map<std::string, std::uint64_t> memory_by_name;
  std::uint64_t memory_total = 0;
  Device::AllocationGate allocation_gate;
  std::uint64_t allocations = 0;
  std::string last_allocation;
  std::vector<std::pair<SamplerDesc, VkSampler>> samplers;
};

}  // namespace skerry::gpu
