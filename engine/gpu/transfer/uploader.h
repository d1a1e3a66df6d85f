#pragma once
#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {

class Device;

enum class UploadPath : std::uint8_t {
  kUpdateBuffer,  ///< vkCmdUpdateBuffer, split at 65,536 bytes (the default)
  kStaging,       ///< copy from a mapped ring
  /// Written straight into a mapped buffer when the batch is recorded, if the GPU is done with
  /// everything submitted that touches the buffer (AccessState::last_value). Else, or if it is not
  /// mapped, vkCmdUpdateBuffer: never a stall or a race.
  kMapped,
};

/// Bytes sent by each way since the uploader was made.
struct UploadBytes {
  std::uint64_t by_update = 0, by_staging = 0, by_mapping = 0;
};

/// Collects writes to buffers and records them as one batch a frame with one barrier before and one
/// after, outside rendering.
class Uploader {
 public:
  Uploader(Device& device, UploadPath path);
  ~Uploader();
  /// Queues a copy of `bytes`. Offsets and sizes must be multiples of 4 and inside the buffer,
  /// which must stay where it is until recorded and have the usage TRANSFER_DST. Keeps order: a
  /// later write to the same place wins.
  void write(Buffer& to, std::uint64_t offset_bytes, std::span<const std::byte> bytes);
  /// The same for values that the caller writes: `count` of them, of any value, at once.
  template <class T>
  std::span<T> place(Buffer& to, std::uint64_t offset_bytes, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::span<std::byte> bytes = place(to, offset_bytes, count * sizeof(T));
    return {reinterpret_cast<T*>(bytes.data()), count};
  }
  /// Writes one word over and over, in order with the other writes. The GPU does it: it counts for
  /// no bytes. @param offset_bytes, size_bytes multiples of 4.
  void fill(Buffer& to, std::uint64_t offset_bytes, std::uint64_t size_bytes, std::uint32_t word);
  template <class T>
  void write(Buffer& to, std::uint64_t offset_bytes, std::span<const T> values) {
    write(to, offset_bytes, std::as_bytes(values));
  }
  /// Puts another buffer in the place of `table`, for what waits to be written, too. The old one's
  /// bytes are copied to its beginning ahead of the next batch, whatever that one's budget. Until
  /// then nobody may use the table. Both need the usage TRANSFER_SRC.
  /// @pre the bigger one is as large at least, and new.
  void replace(Buffer& table, Buffer bigger);
  std::uint64_t pending_bytes() const;
  /// Records queued writes, oldest first, until about `budget_bytes` (at least one whole write).
  /// @return bytes recorded.
  std::uint64_t record(VkCommandBuffer commands, std::uint64_t budget_bytes);
  /// Drops queued writes and what is to be copied of replaced buffers.
  void discard();
  const UploadBytes& sent() const;
  /// Fills an image's mips and layers once, at start-up: tightly packed, mip by mip, layers in
  /// order within a mip. Leaves it ready to be sampled.
  Result<void> fill_image(Image& image, std::span<const std::byte> bytes);

 private:
  std::span<std::byte> place(Buffer& to, std::uint64_t offset_bytes, std::uint64_t size_bytes);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skerry::gpu
