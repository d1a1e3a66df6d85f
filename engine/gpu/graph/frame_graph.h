#pragma once
#include <volk.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/device/access.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/program/pipeline.h"

namespace skerry::gpu {

class TransientNeeds;

class Device;
struct MemoryUse;
class FrameGraph;
class PassBuilder;
class Commands;

/// A versioned name of an image in one frame's graph. Writing returns a new version; using an old
/// one is an error at compile().
struct ImageRef {
  std::uint32_t id = ~0u, version = 0;
  explicit operator bool() const { return id != ~0u; }
};
/// Same for a buffer.
struct BufferRef {
  std::uint32_t id = ~0u, version = 0;
  explicit operator bool() const { return id != ~0u; }
};

/// What happens to an attachment when its pass begins.
struct Load {
  VkAttachmentLoadOp op = VK_ATTACHMENT_LOAD_OP_LOAD;
  VkClearValue value{};
  static Load keep() { return {}; }
  static Load cleared(VkClearValue v) { return {VK_ATTACHMENT_LOAD_OP_CLEAR, v}; }
  /// Pixels that the pass does not draw have any value.
  static Load discarded() { return {VK_ATTACHMENT_LOAD_OP_DONT_CARE, {}}; }
  bool keeps() const { return op == VK_ATTACHMENT_LOAD_OP_LOAD; }
};

/// Milliseconds of one pass on the GPU.
struct PassTime {
  std::string name;
  double ms = 0.0;
};

struct LeftOut {
  std::string name;
  std::string why;
};

/// What a frame asks of the GPU.
struct FrameCounts {
  std::uint32_t passes = 0;               ///< kept ones
  std::uint32_t render_passes = 0;        ///< of them, begun with attachments
  std::uint32_t barriers = 0;             ///< of images and buffers
  std::uint32_t dispatches = 0;           ///< direct and indirect
  std::uint32_t draws = 0;                ///< calls; an indirect one counts once
  std::uint32_t copies = 0;               ///< fills and clears, too
  std::uint32_t descriptor_writes = 0;    ///< bindings pushed
  std::uint32_t images = 0, buffers = 0;  ///< made for this frame alone
  std::uint64_t transient_bytes = 0;      ///< of their memory
  bool operator==(const FrameCounts&) const = default;
};

/// Declares one pass. Only what is declared here may be used while recording.
class PassBuilder {
 public:
  void read(ImageRef image, Use use);
  void read(BufferRef buffer, Use use);
  [[nodiscard]] ImageRef write(ImageRef image, Use use);
  [[nodiscard]] BufferRef write(BufferRef buffer, Use use);
  /// Attachment of this pass. @param layer array layer drawn to. The render area is the image's
  /// extent, or what area() says.
  [[nodiscard]] ImageRef color(ImageRef image, Load load, std::uint32_t layer = 0);
  [[nodiscard]] ImageRef depth(ImageRef image, Load load, std::uint32_t layer = 0);
  /// Part of the attachments that the pass clears and draws to. Outside of it, images that live on
  /// keep what they hold; those of the frame hold nothing.
  /// @param area not empty, within the images.
  void area(VkRect2D area);
  /// The pass runs even when no pass reads what it writes.
  void keep();

 private:
  friend class FrameGraph;
  explicit PassBuilder(FrameGraph& graph, std::uint32_t pass) : graph_(graph), pass_(pass) {}
  ImageRef attach(ImageRef image, Use use, Load load, std::uint32_t layer);
  FrameGraph& graph_;
  std::uint32_t pass_;
};

/// Of an image that is given to a binding as the array that it is.
constexpr std::uint32_t kAllLayers = VK_REMAINING_ARRAY_LAYERS;

/// Records one pass. Resolves refs, pushes descriptors, checks that each resource was declared and
/// each binding is set.
class Commands {
 public:
  void bind(const Pipeline& pipeline);  ///< waits for it; clears all bindings
  void storage(std::uint32_t binding,
               BufferRef buffer);  ///< a storage or a uniform buffer, as the shader declares it
  /// A buffer made with BufferDesc::texels, declared as one that is read.
  void texels(std::uint32_t binding, BufferRef buffer);
  /// @param layer or kAllLayers: an image array, of one mip.
  void storage(std::uint32_t binding, ImageRef image, std::uint32_t mip = 0,
               std::uint32_t layer = 0);
  void sampled(std::uint32_t binding, ImageRef image, VkSampler sampler);
  template <class T>
  void push(const T& constants) {
    push_bytes(&constants, sizeof(T));
  }
  void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z);
  /// Groups that cover `threads` with `group` threads each.
  static std::uint32_t groups(std::uint32_t threads, std::uint32_t group) {
    return (threads + group - 1) / group;
  }
  void dispatch_indirect(BufferRef arguments, std::uint64_t offset_bytes);
  void index_buffer(BufferRef buffer, VkIndexType type);
  void draw(std::uint32_t vertices, std::uint32_t instances);
  /// vkCmdDrawIndexedIndirectCount over shared::DrawCommand.
  void draw_indirect_count(BufferRef commands, std::uint64_t offset_bytes, BufferRef count,
                           std::uint64_t count_offset_bytes, std::uint32_t max_draws);
  void fill(BufferRef buffer, std::uint64_t offset, std::uint64_t size, std::uint32_t value);
  void copy(BufferRef from, BufferRef to, std::uint64_t from_offset, std::uint64_t to_offset,
            std::uint64_t size);
  void copy(ImageRef from, BufferRef to);  ///< mip 0, all layers, tightly packed
  void copy_texel(BufferRef from, ImageRef to, VkOffset2D at);  ///< of mip 0, layer 0
  void clear(ImageRef image, VkClearColorValue value);
  VkCommandBuffer raw() const { return commands_; }
  const Image& image(ImageRef ref) const;
  const Buffer& buffer(BufferRef ref) const;

 private:
  friend class FrameGraph;
  Commands(FrameGraph& graph, std::uint32_t pass, VkCommandBuffer commands);
  FrameCounts& counted() const;
  void require(std::uint32_t id, std::uint32_t version, VkAccessFlags2 access) const;
  VkImageLayout layout_of(ImageRef ref) const;
  [[noreturn]] void fail(const std::string& text) const;
  void push_bytes(const void* data, std::size_t size);
  void flush_bindings();
  FrameGraph& graph_;
  std::uint32_t pass_;
  VkCommandBuffer commands_;
  const Pipeline* pipeline_ = nullptr;
  struct Bound {
    bool set = false;
    VkDescriptorType type{};
    VkDescriptorBufferInfo buffer{};
    VkDescriptorImageInfo image{};
    VkBufferView texels{};
  };
  Bound& slot(std::uint32_t binding);
  std::vector<Bound> bound_;  ///< by place in the pipeline's bindings
  bool dirty_ = false;        ///< bindings changed since they were last pushed
  bool pushed_ = false;       ///< push() was called for this pipeline
};

/// One frame's passes, rebuilt each frame: unused passes and their images vanish, barriers, debug
/// labels and GPU timers come from here. Passes run in the order they were added. A pass is kept if
/// keep() was called, it writes an imported resource, or a kept pass reads what it writes. Without
/// a device (device == nullptr) compile() still works: for tests.
class FrameGraph {
 public:
  explicit FrameGraph(Device* device);
  ~FrameGraph();

  /// Forgets last frame's passes; transient images and buffers go back to a pool keyed by their
  /// description and are reused. Pool entries neither used for a few frames nor reserved are
  /// retired.
  void begin();
  ImageRef create(const ImageDesc& desc);    ///< transient; its usage flags are added from its uses
  BufferRef create(const BufferDesc& desc);  ///< transient
  ImageRef import(
      Image& image);  ///< lives on after the frame, its state is carried in Image::state
  BufferRef import(Buffer& buffer);
  void add_pass(std::string name, const std::function<void(PassBuilder&)>& setup,
                std::function<void(Commands&)> record);
  /// Names a pass this frame does not have and why, for --explain.
  void leave_out(std::string name, std::string why);

  /// Culls, checks versions, assigns resources, plans barriers. An error is a programmer's mistake
  /// and is fatal, with the pass's name.
  void compile();
  /// Adds the images and buffers of the frame that compile() saw last. Images without a format,
  /// which stand for imported ones, do not count.
  void add_needs(TransientNeeds& to) const;
  /// See TransientPool::reserve.
  void reserve(const TransientNeeds& needs);
  /// Why an image or buffer could not be made by the last compile(), if so; then execute() must not
  /// be called. The next begin() starts afresh.
  std::optional<Error> allocation_failure() const;
  /// Records everything into `commands`. @param frame_slot which of the frames in flight (0, 1,
  /// ...), for timer queries. @param before_pass is called before each kept pass, where `commands`
  /// may be submitted and begun anew.
  void execute(VkCommandBuffer commands, std::uint32_t frame_slot,
               const std::function<void()>& before_pass = {});

  std::vector<std::string> pass_names() const;    ///< kept passes, in order
  std::vector<std::string> culled_names() const;  ///< added but unused
  const std::vector<LeftOut>& left_out() const;
  std::vector<MemoryUse> transient_memory() const;  ///< images and buffers made for this frame
  /// Of this frame: what is planned once compiled, what is recorded once executed.
  FrameCounts counts() const;
  /// Whether frames to come time each of their passes, as they do to begin with, or themselves as a
  /// whole. A driver may wait for the work so far at each timestamp: lavapipe does.
  void time_passes(bool each);
  /// GPU times of the frame last executed in this slot, or one of the whole frame. @pre that frame
  /// has completed.
  std::vector<PassTime> times(std::uint32_t frame_slot);

 private:
  friend class PassBuilder;
  friend class Commands;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skerry::gpu
