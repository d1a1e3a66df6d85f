#include "engine/gpu/graph/transient_pool.h"

#include <algorithm>

#include "engine/gpu/device/gpu_check.h"

namespace skerry::gpu {
namespace {

/// Frames that an unused entry survives at least.
constexpr int kIdleFrames = 8;

Result<Image> create(Device& device, const ImageDesc& desc) {
  return device.create_image(desc);
}
Result<Buffer> create(Device& device, const BufferDesc& desc) {
  return device.create_buffer(desc);
}

/// Buffers begin with what counts of a usual world need, and grow by a quarter to a half: counts
/// that change from frame to frame rarely make one anew.
std::uint64_t roomy(std::uint64_t bytes, std::uint64_t most) {
  constexpr std::uint64_t kConstants = 1024;  // of so many bytes are no lists
  std::uint64_t step = bytes <= kConstants ? kConstants : std::uint64_t{1} << 19;
  while (step * 4 < bytes) step *= 2;
  const std::uint64_t rounded = (bytes + step - 1) / step * step;
  return rounded <= most ? rounded : bytes;
}

bool serves(const ImageDesc& kept, const ImageDesc& wanted) {
  return kept == wanted;
}
bool serves(const BufferDesc& kept, const BufferDesc& wanted) {
  return kept.name == wanted.name && kept.usage == wanted.usage && kept.memory == wanted.memory &&
         kept.size_bytes >= wanted.size_bytes;
}

/// Whether frames that take `taken` have no use for `idle` any more.
bool supersedes(const ImageDesc& taken, const ImageDesc& idle) {
  return taken.name == idle.name && !(taken == idle);
}
bool supersedes(const BufferDesc& taken, const BufferDesc& idle) {
  return taken.name == idle.name && taken.size_bytes > idle.size_bytes;
}

/// Memory of what the last frame took and of what it did without.
struct Shares {
  std::uint64_t taken_bytes = 0, idle_bytes = 0;
};

template <class Entries>
void count(Entries& entries, Shares& shares) {
  for (auto& entry : entries) {
    entry->idle_frames = entry->taken ? 0 : entry->idle_frames + 1;
    (entry->taken ? shares.taken_bytes : shares.idle_bytes) += entry->object.allocated_bytes();
  }
}

/// Drops what has been superseded for a while, and the longest idle where `shares` allows no more.
template <class Entries>
void release(Entries& entries, Shares& shares) {
  for (auto& entry : entries) {
    if (entry->idle_frames <= kIdleFrames) continue;
    for (const auto& other : entries)
      if (other && other->idle_frames == 0 && supersedes(other->desc, entry->desc)) {
        shares.idle_bytes -= entry->object.allocated_bytes();
        entry.reset();
        break;
      }
  }
  std::erase(entries, nullptr);
  while (!entries.empty() && shares.idle_bytes > shares.taken_bytes) {
    const auto oldest =
        std::ranges::max_element(entries, {}, [](const auto& entry) { return entry->idle_frames; });
    if ((*oldest)->idle_frames <= kIdleFrames) break;
    shares.idle_bytes -= (*oldest)->object.allocated_bytes();
    entries.erase(oldest);
  }
  for (auto& entry : entries) entry->taken = false;
}

}  // namespace

void TransientPool::begin_frame() {
  failure_.reset();
  // What frames only do without for the time being, as where water leaves the view and comes back,
  // stays while all of it takes no more memory than what is in use: then no frame allocates for it
  // anew. Images and buffers count together, or the lists of lamps would go wherever the sky alone
  // is in view.
  Shares shares;
  count(images_, shares);
  count(buffers_, shares);
  release(images_, shares);
  release(buffers_, shares);
}

template <class Entries, class Desc>
auto& TransientPool::take_from(Entries& entries, const Desc& desc) {
  for (auto& entry : entries) {
    if (!entry->taken && serves(entry->desc, desc) && (entry->object || !device_)) {
      entry->taken = true;
      return entry->object;
    }
  }
  using EntryType = typename Entries::value_type::element_type;
  auto entry = std::make_unique<EntryType>();
  entry->desc = desc;
  entry->taken = true;
  if (device_) {
    auto made = create(*device_, desc);
    if (made) {
      entry->object = *std::move(made);
    } else {
      failure_ = made.error();
      // The next frame finds their memory free.
      std::erase_if(entries, [](const auto& other) { return !other->taken; });
    }
  }
  // In front of smaller ones, which then are no longer taken.
  return (*entries.insert(entries.begin(), std::move(entry)))->object;
}

Image& TransientPool::take(const ImageDesc& desc) {
  return take_from(images_, desc);
}
Buffer& TransientPool::take(const BufferDesc& desc) {
  if (!device_) return take_from(buffers_, desc);
  BufferDesc wanted = desc;
  wanted.size_bytes = roomy(desc.size_bytes, device_->limits().max_storage_range);
  return take_from(buffers_, wanted);
}

std::vector<MemoryUse> TransientPool::memory() const {
  std::vector<MemoryUse> list;
  for (const auto& entry : images_) {
    if (entry->taken) list.push_back({entry->desc.name, entry->object.allocated_bytes()});
  }
  for (const auto& entry : buffers_) {
    if (entry->taken) list.push_back({entry->desc.name, entry->object.allocated_bytes()});
  }
  return list;
}

}  // namespace skerry::gpu
