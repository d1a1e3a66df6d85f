#pragma once
#include <array>

#include "engine/core/result.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/phases.h"

namespace skerry::render {

/// Copies a frame's images out, for Renderer::captured.
class Captures {
 public:
  explicit Captures(gpu::Device& device) : device_(&device) {}

  /// Forgets what was copied out, and makes room for the images of a frame.
  /// @param drawn size of the G-buffer. @param maps null: no shadow maps. Errors: out of memory.
  Result<void> begin(VkExtent2D picture, VkExtent2D drawn, bool geometry, const gpu::Image* maps);
  /// Adds the copy of an image that begin() has made room for.
  void add(gpu::FrameGraph& graph, Capture what, gpu::ImageRef image);
  /// @pre the frame has completed.
  Captured take(Capture what) const;

 private:
  struct Room {
    gpu::Buffer buffer;
    VkExtent2D size{};
    std::uint32_t layers = 0;
  };
  Result<void> reserve(Capture what, VkExtent2D size, std::uint32_t layers,
                       std::uint32_t texel_bytes);
  Room& room(Capture what) { return rooms_[static_cast<std::size_t>(what)]; }

  gpu::Device* device_;
  std::array<Room, 4> rooms_;
};

/// Writes a Fault's value over one texel of an RGBA16F image.
struct FaultPass {
  static gpu::ImageRef add(gpu::FrameGraph& graph, gpu::ImageRef image, const Fault& fault);
  static Shaded add(gpu::FrameGraph& graph, Shaded shaded, const Fault& fault);
};

}  // namespace skerry::render
