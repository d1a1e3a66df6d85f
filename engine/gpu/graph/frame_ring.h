#pragma once
#include <volk.h>

#include <cstdint>
#include <span>
#include <vector>

namespace skerry::gpu {

class Device;

/// Command buffers of the frames in flight.
class FrameRing {
 public:
  struct Frame {
    VkCommandBuffer commands{};
    std::uint32_t slot = 0;  ///< 0 .. slots - 1; what FrameGraph::execute and times take
  };

  FrameRing(Device& device, std::uint32_t slots);
  FrameRing(const FrameRing&) = delete;
  FrameRing& operator=(const FrameRing&) = delete;
  ~FrameRing();

  /// Waits until the frame that last used the next slot is done, destroys what is retired by now,
  /// begins recording.
  Frame begin();
  /// Submits what the frame begun has recorded so far and waits for it; recording goes on.
  void flush();
  /// Ends and submits the frame begun. @return its timeline value.
  std::uint64_t submit(std::span<const VkSemaphoreSubmitInfo> waits = {},
                       std::span<const VkSemaphoreSubmitInfo> signals = {});

 private:
  struct Slot {
    VkCommandPool pool{};
    VkCommandBuffer commands{};
    std::uint64_t value = 0;  ///< timeline value of its last submit
  };
  void begin_commands(const Slot& slot);
  Device& device_;
  std::vector<Slot> slots_;
  std::uint32_t current_ = 0;
};

}  // namespace skerry::gpu
