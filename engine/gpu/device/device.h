#pragma once
#include <volk.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device_info.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {

struct DeviceOptions {
  std::optional<std::uint32_t>
      index;  ///< --device N; else the best usable: discrete, integrated, virtual, CPU
  bool validate =
      false;  ///< Khronos layer, core + synchronisation; messages go to stderr and are counted
  bool core_checks =
      true;  ///< of the layer; with them, programs take twice as long to be made on a CPU
  std::vector<const char*>
      surface_extensions;  ///< instance extensions a window needs; empty: headless
  std::string
      pipeline_cache_path;  ///< empty: no file. A damaged or foreign file is ignored and replaced.
};

/// Bytes of device memory by what they are for.
struct MemoryUse {
  std::string name;
  std::uint64_t bytes = 0;
};

/// One Vulkan device with one queue (graphics + compute + transfer) and one timeline. Not
/// thread-safe unless a member says so.
class Device final : public ResourceOwner {
 public:
  static Result<std::vector<DeviceInfo>> list();
  /// Errors name the missing driver, device or feature.
  static Result<std::unique_ptr<Device>> create(const DeviceOptions& options);
  ~Device();  ///< waits for the GPU, saves the pipeline cache (temporary file, then rename),
              ///< destroys everything
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkDevice handle() const override { return device_; }
  VkQueue queue() const { return queue_; }
  std::uint32_t queue_family() const { return queue_family_; }
  const DeviceInfo& info() const { return info_; }
  const DeviceLimits& limits() const { return limits_; }
  VkPipelineCache pipeline_cache() const { return pipeline_cache_; }

  /// Validation messages seen so far (warnings and errors).
  int validation_message_count() const;

  /// One dedicated allocation each. Errors: out of memory (says the size wanted), size over a
  /// limit.
  Result<Buffer> create_buffer(const BufferDesc& desc);
  Result<Image> create_image(const ImageDesc& desc);
  Result<VkSampler> sampler(const SamplerDesc& desc);  ///< shared, owned by the device

  /// Memory in use now, by resource name, largest first; and its sum.
  std::vector<MemoryUse> memory_use() const;
  std::uint64_t memory_total() const;
  /// Allocations made since the device was opened.
  std::uint64_t allocations() const;
  const std::string& last_allocation() const;  ///< name of what the latest was for; empty: none yet
  /// Asked before each allocation from now on, for injecting faults: one that it answers with false
  /// fails as if memory had run out. Empty: none is asked.
  using AllocationGate = std::function<bool(const std::string& name, std::uint64_t bytes)>;
  void set_allocation_gate(AllocationGate gate);

  /// Frame timeline: the value the next submit signals; whether a value has been reached; wait for
  /// it; destroy what is retired by then.
  std::uint64_t next_value() const { return next_value_; }
  std::uint64_t completed_value() const;
  void wait(std::uint64_t value);
  void collect();
  /// Submits on the queue, signals the timeline. Extra semaphores are for the swapchain. @return
  /// the timeline value signalled.
  std::uint64_t submit(VkCommandBuffer commands, std::span<const VkSemaphoreSubmitInfo> waits = {},
                       std::span<const VkSemaphoreSubmitInfo> signals = {});
  /// Records and submits at once, then waits. For start-up and tests only.
  template <class F>
  void run_now(F&& record) {
    VkCommandBuffer commands = begin_now();
    record(commands);
    end_now(commands);
  }

  /// Called by owners when they die: destroyed after every submit made so far (and the one being
  /// recorded) has completed.
  void retire(std::uint64_t object, VkObjectType type, VkDeviceMemory memory, std::uint64_t bytes,
              const std::string& name) override;
  void set_name(std::uint64_t object, VkObjectType type, const char* name) override;

 private:
  Device();
  void open();
  void keep_pipelines();
  Result<void> check_buffer(const BufferDesc& desc) const;
  Result<void> check_image(const VkImageCreateInfo& info, const std::string& name) const;
  bool may_allocate(const std::string& name, std::uint64_t bytes) const;
  void account(const std::string& name, std::uint64_t bytes);
  void destroy_retired(std::uint64_t completed);
  void destroy(std::uint64_t object, VkObjectType type);
  VkCommandBuffer begin_now();
  void end_now(VkCommandBuffer commands);
  VkInstance instance_{};
  VkPhysicalDevice physical_{};
  VkDevice device_{};
  VkQueue queue_{};
  std::uint32_t queue_family_ = 0;
  VkPipelineCache pipeline_cache_{};
  DeviceInfo info_;
  DeviceLimits limits_;
  std::uint64_t next_value_ = 1;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skerry::gpu
