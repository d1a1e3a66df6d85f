#pragma once
#include <volk.h>

#include <compare>
#include <cstdint>
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
  std::string shader;  ///< file name in shaders/, e.g. "shade.comp"
  std::vector<SpecConstant> constants;
  auto operator<=>(const ComputeDesc&) const = default;
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
  bool depth_bias = false;  ///< dynamic: Commands::set_depth_bias
  bool blend =
      false;  ///< colours are laid over what is there by their straight alpha; else they replace it
  auto operator<=>(const GraphicsDesc&) const = default;
};

/// A compiled pipeline with the layout that its sources declare: one push-descriptor set 0 and one
/// push-constant block.
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
};

/// Compiles pipelines when first asked for and keeps them. Bindings and push constants are those
/// that the shader's source declares. Bad SPIR-V or a missing shader is fatal with its name.
class Pipelines {
 public:
  /// @param shaders where names are looked up; must outlive this.
  explicit Pipelines(Device& device, std::span<const EmbeddedShader> shaders = embedded_shaders());
  ~Pipelines();
  const Pipeline& get(const ComputeDesc& desc);
  const Pipeline& get(const GraphicsDesc& desc);
  int created() const;  ///< pipelines compiled so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skerry::gpu
