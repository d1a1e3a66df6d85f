#include "engine/gpu/transfer/uploader.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <iterator>
#include <map>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/device/access.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

constexpr std::uint64_t kMaxUpdateBytes = 65536;  // of one vkCmdUpdateBuffer
constexpr std::uint64_t kStagingBlockBytes = 4u << 20;

/// Everything that may use an uploaded buffer later. The barrier behind a batch covers all of it,
/// so that no user adds one.
constexpr VkPipelineStageFlags2 kReadStages =
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkAccessFlags2 kReadAccess = VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT |
                                       VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_SHADER_READ_BIT;

void memory_barrier(VkCommandBuffer commands, const Scopes& scopes) {
  auto barrier = vk_struct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
  barrier.srcStageMask = scopes.src_stages;
  barrier.srcAccessMask = scopes.src_access;
  barrier.dstStageMask = scopes.dst_stages;
  barrier.dstAccessMask = scopes.dst_access;
  auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

/// Byte ranges of buffers written since the last barrier. Two transfers to the same place are
/// unordered without one.
class WrittenRanges {
 public:
  /// @return false if the range overlaps one already there.
  bool add(const Buffer* buffer, std::uint64_t begin, std::uint64_t end) {
    auto& ranges = by_buffer_[buffer];
    const auto next = ranges.lower_bound(begin);
    if (next != ranges.end() && next->first < end) return false;
    if (next != ranges.begin() && std::prev(next)->second > begin) return false;
    ranges.emplace_hint(next, begin, end);
    return true;
  }
  void clear() { by_buffer_.clear(); }

 private:
  std::map<const Buffer*, std::map<std::uint64_t, std::uint64_t>> by_buffer_;
};

}  // namespace

struct Uploader::State {
  struct Write {
    Buffer* to;
    std::uint64_t offset;
    std::unique_ptr<std::byte[]> storage;
    std::uint64_t size = 0;          ///< of `storage`
    std::uint64_t filled_bytes = 0;  ///< with `word`; then there is no `storage`
    std::uint32_t word = 0;
    std::span<std::byte> bytes() const { return {storage.get(), size}; }
    std::uint64_t end() const { return offset + size + filled_bytes; }
  };
  /// A piece of the staging ring: reused once the submit that read it last has completed.
  struct Block {
    Buffer buffer;
    std::uint64_t used = 0;
    std::uint64_t value = 0;
  };

  /// A buffer that another one has replaced.
  struct Replaced {
    Buffer old;
    Buffer* by;
  };

  void record_copies(VkCommandBuffer commands);
  void record_writes(VkCommandBuffer commands, std::span<const Write> batch);
  void write_mapped(const Write& write);
  void record_transfer(VkCommandBuffer commands, const Write& write);
  void update(VkCommandBuffer commands, const Write& write);
  Block* staging_block(std::uint64_t bytes);
  bool idle(const Buffer& buffer) const {
    return buffer.state.last_value <= device.completed_value();
  }

  Device& device;
  UploadPath path;
  std::deque<Write> queue;
  std::vector<Replaced> replaced;
  std::uint64_t pending = 0;
  std::vector<std::unique_ptr<Block>> blocks;
  Block* current = nullptr;  ///< being filled by this batch
  UploadBytes sent;
};

Uploader::Uploader(Device& device, UploadPath path)
    : state_(new State{device, path, {}, {}, 0, {}, nullptr, {}}) {}

Uploader::~Uploader() = default;

void Uploader::write(Buffer& to, std::uint64_t offset_bytes, std::span<const std::byte> bytes) {
  std::ranges::copy(bytes, place(to, offset_bytes, bytes.size()).begin());
}

std::span<std::byte> Uploader::place(Buffer& to, std::uint64_t offset_bytes,
                                     std::uint64_t size_bytes) {
  SKERRY_ASSERT(offset_bytes % 4 == 0 && size_bytes % 4 == 0);
  SKERRY_ASSERT(offset_bytes <= to.size_bytes() && size_bytes <= to.size_bytes() - offset_bytes);
  if (size_bytes == 0) return {};
  state_->queue.push_back(
      {&to, offset_bytes, std::make_unique_for_overwrite<std::byte[]>(size_bytes), size_bytes});
  state_->pending += size_bytes;
  return state_->queue.back().bytes();
}

void Uploader::fill(Buffer& to, std::uint64_t offset_bytes, std::uint64_t size_bytes,
                    std::uint32_t word) {
  SKERRY_ASSERT(offset_bytes % 4 == 0 && size_bytes % 4 == 0);
  SKERRY_ASSERT(offset_bytes <= to.size_bytes() && size_bytes <= to.size_bytes() - offset_bytes);
  if (size_bytes != 0) state_->queue.push_back({&to, offset_bytes, nullptr, 0, size_bytes, word});
}

void Uploader::discard() {
  state_->queue.clear();
  state_->replaced.clear();
  state_->pending = 0;
}

void Uploader::replace(Buffer& table, Buffer bigger) {
  SKERRY_ASSERT(bigger.size_bytes() >= table.size_bytes());
  const bool waits = std::ranges::any_of(
      state_->replaced, [&](const State::Replaced& entry) { return entry.by == &table; });
  std::swap(table, bigger);
  // One that was replaced before it got its bytes holds none.
  if (!waits) state_->replaced.push_back({std::move(bigger), &table});
}

std::uint64_t Uploader::pending_bytes() const {
  return state_->pending;
}

const UploadBytes& Uploader::sent() const {
  return state_->sent;
}

std::uint64_t Uploader::record(VkCommandBuffer commands, std::uint64_t budget_bytes) {
  state_->record_copies(commands);
  std::vector<State::Write> batch;
  std::uint64_t bytes = 0;
  while (!state_->queue.empty() &&
         (bytes == 0 || bytes + state_->queue.front().size <= budget_bytes)) {
    bytes += state_->queue.front().size;
    batch.push_back(std::move(state_->queue.front()));
    state_->queue.pop_front();
  }
  state_->pending -= bytes;
  if (!batch.empty()) state_->record_writes(commands, batch);
  return bytes;
}

void Uploader::State::record_copies(VkCommandBuffer commands) {
  for (Replaced& entry : replaced) {
    touch(device, commands, entry.old,
          {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}, false});
    touch(device, commands, *entry.by,
          {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, {}, true});
    const VkBufferCopy region{0, 0, entry.old.size_bytes()};
    vkCmdCopyBuffer(commands, entry.old.handle(), entry.by->handle(), 1, &region);
    touch(device, commands, *entry.by, {kReadStages, kReadAccess, {}, false});
  }
  replaced.clear();  // retired until this batch has run
}

void Uploader::State::record_writes(VkCommandBuffer commands, std::span<const Write> batch) {
  // The way is chosen once a buffer: writes to one buffer must not overtake each other.
  std::map<Buffer*, bool> mapped;
  Scopes before;
  for (const Write& write : batch) {
    const auto [entry, added] = mapped.try_emplace(write.to, false);
    if (!added) continue;
    entry->second = path == UploadPath::kMapped && write.to->mapped() && idle(*write.to);
    if (entry->second) continue;
    const Access transfer{
        VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, {}, true};
    if (const std::optional<Scopes> scopes = hazard(write.to->state, transfer)) {
      before.src_stages |= scopes->src_stages;
      before.src_access |= scopes->src_access;
    }
  }
  before.dst_stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  before.dst_access = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  if (before.src_stages != 0) memory_barrier(commands, before);

  const Scopes again{before.dst_stages, before.dst_access, before.dst_stages, before.dst_access};
  WrittenRanges written;
  bool transfers = false;
  for (const Write& write : batch) {
    if (mapped[write.to]) {
      // Visible to the GPU without a barrier: a submit orders host writes made before it.
      write_mapped(write);
      continue;
    }
    if (!written.add(write.to, write.offset, write.end())) {
      memory_barrier(commands, again);
      written.clear();
      written.add(write.to, write.offset, write.end());
    }
    record_transfer(commands, write);
    transfers = true;
  }
  current = nullptr;
  // A shader may also write over what was uploaded, behind one that has read it.
  if (transfers)
    memory_barrier(commands, {before.dst_stages, before.dst_access, kReadStages,
                              kReadAccess | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
  for (const auto& [buffer, by_mapping] : mapped) {
    if (!by_mapping)
      buffer->state = {kReadStages, kReadAccess, VK_IMAGE_LAYOUT_UNDEFINED, false,
                       device.next_value()};
  }
}

void Uploader::State::write_mapped(const Write& write) {
  std::byte* to = write.to->mapped() + write.offset;
  std::ranges::copy(write.bytes(), to);
  for (std::uint64_t at = 0; at < write.filled_bytes; at += sizeof write.word)
    std::memcpy(to + at, &write.word, sizeof write.word);
  sent.by_mapping += write.size;
}

void Uploader::State::record_transfer(VkCommandBuffer commands, const Write& write) {
  if (write.filled_bytes != 0) {
    vkCmdFillBuffer(commands, write.to->handle(), write.offset, write.filled_bytes, write.word);
    return;
  }
  Block* block = path == UploadPath::kStaging ? staging_block(write.size) : nullptr;
  if (!block) {
    update(commands, write);
    sent.by_update += write.size;
    return;
  }
  std::memcpy(block->buffer.mapped() + block->used, write.storage.get(), write.size);
  const VkBufferCopy region{block->used, write.offset, write.size};
  vkCmdCopyBuffer(commands, block->buffer.handle(), write.to->handle(), 1, &region);
  block->used += write.size;
  sent.by_staging += write.size;
}

void Uploader::State::update(VkCommandBuffer commands, const Write& write) {
  for (std::uint64_t at = 0; at < write.size; at += kMaxUpdateBytes) {
    const std::uint64_t size = std::min<std::uint64_t>(kMaxUpdateBytes, write.size - at);
    vkCmdUpdateBuffer(commands, write.to->handle(), write.offset + at, size,
                      write.storage.get() + at);
  }
}

// A block with room for `bytes`, or null when there is no memory for one: the caller then has
// another way.
Uploader::State::Block* Uploader::State::staging_block(std::uint64_t bytes) {
  if (current && current->buffer.size_bytes() - current->used >= bytes) return current;
  const std::uint64_t completed = device.completed_value();
  for (auto& block : blocks) {
    if (block.get() == current || block->value > completed || block->buffer.size_bytes() < bytes)
      continue;
    current = block.get();
    current->used = 0;
    current->value = device.next_value();
    return current;
  }
  const std::uint64_t size = std::max(kStagingBlockBytes, bytes);
  Result<Buffer> made = device.create_buffer(
      {"staging ring", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::kUpload});
  if (!made) return nullptr;
  auto block = std::make_unique<Block>();
  block->buffer = *std::move(made);
  block->value = device.next_value();
  blocks.push_back(std::move(block));
  current = blocks.back().get();
  return current;
}

Result<void> Uploader::fill_image(Image& image, std::span<const std::byte> bytes) {
  const ImageDesc& desc = image.desc();
  const auto edge = [](std::uint32_t size, std::uint32_t mip) { return std::max(1u, size >> mip); };
  std::uint64_t texels = 0;
  for (std::uint32_t mip = 0; mip < desc.mips; ++mip) {
    texels += std::uint64_t{edge(desc.extent.width, mip)} * edge(desc.extent.height, mip) *
              edge(desc.depth, mip) * desc.layers;
  }
  const std::uint64_t texel_bytes = bytes.size() / texels;
  SKERRY_ASSERT(texel_bytes > 0 && texel_bytes * texels == bytes.size());
  Result<Buffer> staging = state_->device.create_buffer(
      {desc.name + " staging", bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::kUpload});
  if (!staging) return staging.error();
  std::memcpy(staging->mapped(), bytes.data(), bytes.size());

  std::vector<VkBufferImageCopy> regions;
  std::uint64_t offset = 0;
  for (std::uint32_t mip = 0; mip < desc.mips; ++mip) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {image.aspect(), mip, 0, desc.layers};
    region.imageExtent = {edge(desc.extent.width, mip), edge(desc.extent.height, mip),
                          edge(desc.depth, mip)};
    regions.push_back(region);
    offset += texel_bytes * region.imageExtent.width * region.imageExtent.height *
              region.imageExtent.depth * desc.layers;
  }
  state_->device.run_now([&](VkCommandBuffer commands) {
    touch(state_->device, commands, image,
          {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true});
    vkCmdCopyBufferToImage(commands, staging->handle(), image.handle(), image.state.layout,
                           static_cast<std::uint32_t>(regions.size()), regions.data());
    touch(state_->device, commands, image,
          {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
           VK_ACCESS_2_SHADER_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false});
  });
  return {};
}

}  // namespace skerry::gpu
