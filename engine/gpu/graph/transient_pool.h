#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {

/// Images and buffers that frames need at a time. One image or buffer of a name and size serves all
/// frames, whatever they use it for.
class TransientNeeds {
 public:
  /// Adds those of one frame.
  void add(std::span<const ImageDesc> images, std::span<const BufferDesc> buffers);
  const std::vector<ImageDesc>& images() const { return images_; }
  const std::vector<BufferDesc>& buffers() const { return buffers_; }

 private:
  std::vector<ImageDesc> images_;
  std::vector<BufferDesc> buffers_;
};

/// Images and buffers of single frames, kept for the frames after. Without a device it hands out
/// empty ones.
class TransientPool {
 public:
  explicit TransientPool(Device* device) : device_(device) {}
  /// Everything is free again; what no frame will take any more is destroyed.
  void begin_frame();
  /// One of this description, perhaps with more uses, until the next begin_frame(). failure() says
  /// if it could not be made.
  Image& take(const ImageDesc& desc);
  /// One of this name, usage and memory that is at least as large, or has more uses.
  Buffer& take(const BufferDesc& desc);
  /// Makes what frames to come may need, and keeps it until the next call even if none takes it.
  /// What finds no memory is left for the frame that needs it.
  void reserve(const TransientNeeds& needs);
  std::vector<MemoryUse> memory() const;  ///< of those taken this frame
  /// Why something taken this frame could not be made: what take() returned for it owns nothing.
  const std::optional<Error>& failure() const { return failure_; }

 private:
  template <class Desc, class Object>
  struct Entry {
    Desc desc;
    Object object;
    bool taken = false;
    bool reserved = false;
    int idle_frames = 0;
  };
  template <class Entries, class Desc>
  auto& take_from(Entries& entries, const Desc& desc);
  template <class Entries, class Desc>
  void reserve_in(Entries& entries, std::span<const Desc> wanted);
  Device* device_;
  std::optional<Error> failure_;
  // Entries stay at their addresses while the vectors grow: passes hold references to the objects.
  std::vector<std::unique_ptr<Entry<ImageDesc, Image>>> images_;
  std::vector<std::unique_ptr<Entry<BufferDesc, Buffer>>> buffers_;
};

}  // namespace skerry::gpu
