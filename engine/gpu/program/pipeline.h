#pragma once
#include <volk.h>

#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/program/shader_table.h"

namespace skerry::gpu {

class Device;

/// A specialization constant: constant_id and its 32-bit value (bool, int, uint or the bits of a
/// float).
struct SpecConstant {
  std::uint32_t id = 0;
  std::uint32_t value = 0;
  auto operator<=>(const SpecConstant&) const = default;
};

struct ComputeDesc {
  std::string shader;  ///< file name below shaders/, e.g. "shade.comp"
  std::vector<SpecConstant> constants;
  auto operator<=>(const ComputeDesc&) const = default;
};

/// What drawn colours do to those that are there.
enum class Blend : std::uint8_t {
  kReplace,
  kOver,  ///< are laid over them by their straight alpha
  kSum,   ///< are added to them
};

struct GraphicsDesc {
  std::string vertex{};
  std::string fragment{};  ///< empty: depth only
  std::vector<SpecConstant> constants;
  std::vector<VkFormat> color_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  VkCullModeFlags cull = VK_CULL_MODE_BACK_BIT;  ///< front faces are counter-clockwise in the
                                                 ///< world; the y flip is accounted for
  bool depth_write = true;                       ///< test is GREATER_OR_EQUAL (reverse-Z)
  bool depth_clamp = false;
  Blend blend = Blend::kReplace;
  auto operator<=>(const GraphicsDesc&) const = default;
};

class PipelineQueue;

/// A pipeline with the layout that its sources declare: one push-descriptor set 0 and one
/// push-constant block. The layout exists from the start; the handle exists once made() returns.
struct Pipeline {
  VkPipeline handle{};
  VkPipelineLayout layout{};
  VkDescriptorSetLayout set_layout{};  ///< pushing descriptors refers to it
  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
  VkShaderStageFlags push_stages = 0;
  std::uint32_t push_bytes = 0;
  struct Binding {
    std::uint32_t binding;
    VkDescriptorType type;
  };
  std::vector<Binding> bindings;
  std::string name;  ///< its shaders' file names

  bool ready() const { return ready_.load(std::memory_order_acquire); }
  /// Waits until the pipeline is compiled; compiles it on this thread when no worker has begun.
  const Pipeline& made() const;

 private:
  friend class PipelineQueue;
  PipelineQueue* queue_ = nullptr;
  std::function<void(Pipeline&)> compile_;
  std::size_t code_bytes_ = 0;
  bool begun_ = false;  // guarded by the queue
  std::atomic<bool> ready_{false};
};

/// Compiles pipelines on worker threads when first asked for and keeps them. Bindings and push
/// constants are those that the shader's source declares. Bad SPIR-V or a missing shader is fatal
/// with its name. One thread calls the members.
class Pipelines {
 public:
  /// @param shaders where names are looked up; must outlive this.
  explicit Pipelines(Device& device, std::span<const EmbeddedShader> shaders = embedded_shaders());
  ~Pipelines();  ///< waits for what is being compiled
  /// Returns at once; Commands::bind waits for the pipeline.
  const Pipeline& get(const ComputeDesc& desc);
  const Pipeline& get(const GraphicsDesc& desc);
  /// Runs `ask`, whose get() calls are for later frames: workers compile those pipelines last.
  void foresee(const std::function<void()>& ask);
  /// Runs `ask`, whose get() calls are for the next frame: workers compile those pipelines first.
  /// @return how many of them are not ready.
  std::size_t prepare(const std::function<void()>& ask);
  /// Pipelines that get() was called for outside those two; and those of them that were not ready
  /// by then, so that a frame had to wait.
  int used() const;
  int late() const;
  std::size_t pending() const;  ///< pipelines that are still to be compiled
  /// Compiles one on this thread that frames asked for, or prepare(). @return false: none waits for
  /// that.
  bool help();
  void wait() const;  ///< until all are compiled

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skerry::gpu
