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

/// Whether they differ in their uses alone.
bool same_but_usage(const ImageDesc& a, const ImageDesc& b) {
  ImageDesc with = a;
  with.usage = b.usage;
  return with == b;
}
/// Whether they differ in their uses and sizes alone.
bool same_but_usage(const BufferDesc& a, const BufferDesc& b) {
  return a.name == b.name && a.memory == b.memory;
}

bool serves(const ImageDesc& kept, const ImageDesc& wanted) {
  return (kept.usage & wanted.usage) == wanted.usage && same_but_usage(kept, wanted);
}
bool serves(const BufferDesc& kept, const BufferDesc& wanted) {
  return (kept.usage & wanted.usage) == wanted.usage && same_but_usage(kept, wanted) &&
         kept.size_bytes >= wanted.size_bytes;
}

void add_uses(ImageDesc& to, const ImageDesc& other) {
  to.usage |= other.usage;
}
void add_uses(BufferDesc& to, const BufferDesc& other) {
  to.usage |= other.usage;
  to.size_bytes = std::max(to.size_bytes, other.size_bytes);
}

template <class Desc>
void add_needs(std::vector<Desc>& all, std::span<const Desc> frame) {
  std::vector<bool> met(all.size(), false);
  for (const Desc& desc : frame) {
    std::size_t i = 0;
    while (i < all.size() && (met[i] || !same_but_usage(all[i], desc))) ++i;
    if (i == all.size()) {
      all.push_back(desc);
      met.push_back(false);
    }
    add_uses(all[i], desc);
    met[i] = true;
  }
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
    if (entry->taken)
      shares.taken_bytes += entry->object.allocated_bytes();
    else if (!entry->reserved)
      shares.idle_bytes += entry->object.allocated_bytes();
  }
}

/// Drops what has been superseded for a while, and the longest idle where `shares` allows no more.
template <class Entries>
void release(Entries& entries, Shares& shares) {
  for (auto& entry : entries) {
    if (entry->idle_frames <= kIdleFrames) continue;
    for (const auto& other : entries)
      if (other && other->idle_frames == 0 && !entry->reserved &&
          supersedes(other->desc, entry->desc)) {
        shares.idle_bytes -= entry->object.allocated_bytes();
        entry.reset();
        break;
      }
  }
  std::erase(entries, nullptr);
  while (!entries.empty() && shares.idle_bytes > shares.taken_bytes) {
    const auto oldest = std::ranges::max_element(
        entries, {}, [](const auto& entry) { return entry->reserved ? 0 : entry->idle_frames; });
    if ((*oldest)->reserved || (*oldest)->idle_frames <= kIdleFrames) break;
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
      std::erase_if(images_, [](const auto& other) { return !other->taken; });
      std::erase_if(buffers_, [](const auto& other) { return !other->taken; });
    }
  }
  // In front of smaller ones, which then are no longer taken.
  return (*entries.insert(entries.begin(), std::move(entry)))->object;
}

template <class Entries, class Desc>
void TransientPool::reserve_in(Entries& entries, std::span<const Desc> wanted) {
  for (auto& entry : entries) entry->reserved = false;
  for (const Desc& desc : wanted) {
    const auto found = std::ranges::find_if(entries, [&](const auto& entry) {
      return !entry->reserved && serves(entry->desc, desc) && (entry->object || !device_);
    });
    if (found != entries.end()) {
      (*found)->reserved = true;
      continue;
    }
    using EntryType = typename Entries::value_type::element_type;
    auto entry = std::make_unique<EntryType>();
    entry->desc = desc;
    entry->reserved = true;
    if (device_) {
      auto made = create(*device_, desc);
      if (!made) return;
      entry->object = *std::move(made);
    }
    entries.insert(entries.begin(), std::move(entry));
  }
}

void TransientPool::reserve(const TransientNeeds& needs) {
  std::vector<BufferDesc> buffers = needs.buffers();
  if (device_)
    for (BufferDesc& desc : buffers)
      desc.size_bytes = roomy(desc.size_bytes, device_->limits().max_storage_range);
  reserve_in(images_, std::span<const ImageDesc>(needs.images()));
  reserve_in(buffers_, std::span<const BufferDesc>(buffers));
}

void TransientNeeds::add(std::span<const ImageDesc> images, std::span<const BufferDesc> buffers) {
  add_needs(images_, images);
  add_needs(buffers_, buffers);
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
