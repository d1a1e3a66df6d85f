#include "engine/gpu/program/pipeline_build.h"

#include <array>
#include <cstddef>
#include <list>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

/// A shader module for as long as a pipeline is being compiled.
class Module {
 public:
  Module(Device& device, const EmbeddedShader& shader) : device_(device) {
    auto info = vk_struct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = static_cast<std::size_t>(shader.end - shader.begin);
    info.pCode = reinterpret_cast<const std::uint32_t*>(shader.begin);
    GPU_CHECK(vkCreateShaderModule(device.handle(), &info, nullptr, &handle_));
    device.set_name(reinterpret_cast<std::uint64_t>(handle_), VK_OBJECT_TYPE_SHADER_MODULE,
                    shader.name);
  }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;
  ~Module() { vkDestroyShaderModule(device_.handle(), handle_, nullptr); }
  VkShaderModule handle() const { return handle_; }

 private:
  Device& device_;
  VkShaderModule handle_{};
};

/// Vulkan's view of specialization constants; points into itself and into the constants given.
class Specialization {
 public:
  explicit Specialization(const std::vector<SpecConstant>& constants) {
    for (const SpecConstant& constant : constants) {
      const auto offset = static_cast<std::uint32_t>(entries_.size() * sizeof(SpecConstant) +
                                                     offsetof(SpecConstant, value));
      entries_.push_back({constant.id, offset, sizeof constant.value});
    }
    info_.mapEntryCount = static_cast<std::uint32_t>(entries_.size());
    info_.pMapEntries = entries_.data();
    info_.dataSize = constants.size() * sizeof(SpecConstant);
    info_.pData = constants.data();
  }
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;
  const VkSpecializationInfo* info() const { return &info_; }

 private:
  std::vector<VkSpecializationMapEntry> entries_;
  VkSpecializationInfo info_{};
};

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, const Module& module,
                                           const Specialization& specialization) {
  auto info = vk_struct<VkPipelineShaderStageCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
  info.stage = stage;
  info.module = module.handle();
  info.pName = "main";
  info.pSpecializationInfo = specialization.info();
  return info;
}

void name_pipeline(Device& device, const Pipeline& pipeline) {
  device.set_name(reinterpret_cast<std::uint64_t>(pipeline.handle), VK_OBJECT_TYPE_PIPELINE,
                  pipeline.name.c_str());
}

VkPipelineRasterizationStateCreateInfo rasterization(const GraphicsDesc& desc) {
  auto info = vk_struct<VkPipelineRasterizationStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  info.depthClampEnable = desc.depth_clamp ? VK_TRUE : VK_FALSE;
  info.polygonMode = VK_POLYGON_MODE_FILL;
  info.cullMode = desc.cull;
  // Counter-clockwise in the world, seen from the front, stays counter-clockwise on screen, as the
  // projection's y flip only undoes framebuffer y pointing down. Vulkan's sign of area is defined
  // so that what looks counter-clockwise in such a picture (y down) has positive area, which is
  // VK_FRONT_FACE_COUNTER_CLOCKWISE (specification, 28.10 "Basic Polygon Rasterization": a = -1/2
  // sum(x_i y_i+1 - x_i+1 y_i)).
  info.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  info.lineWidth = 1.0f;
  return info;
}

VkPipelineDepthStencilStateCreateInfo depth_state(const GraphicsDesc& desc) {
  auto info = vk_struct<VkPipelineDepthStencilStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
  const bool depth = desc.depth_format != VK_FORMAT_UNDEFINED;
  info.depthTestEnable = depth ? VK_TRUE : VK_FALSE;
  info.depthWriteEnable = depth && desc.depth_write ? VK_TRUE : VK_FALSE;
  info.depthCompareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  return info;
}

VkPipelineColorBlendAttachmentState attachment_state(const GraphicsDesc& desc) {
  VkPipelineColorBlendAttachmentState state{};
  const bool over = desc.blend == Blend::kOver;
  const VkBlendFactor kept = over ? VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
  state.blendEnable = desc.blend == Blend::kReplace ? VK_FALSE : VK_TRUE;
  state.srcColorBlendFactor = over ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
  state.dstColorBlendFactor = kept;
  state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstAlphaBlendFactor = kept;
  state.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                         VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  return state;
}

constexpr std::array kDynamicStates{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};

VkPipelineDynamicStateCreateInfo dynamic_state() {
  auto info = vk_struct<VkPipelineDynamicStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
  info.dynamicStateCount = kDynamicStates.size();
  info.pDynamicStates = kDynamicStates.data();
  return info;
}

/// @return points to the formats of `desc`.
VkPipelineRenderingCreateInfo targets(const GraphicsDesc& desc) {
  auto info =
      vk_struct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
  info.colorAttachmentCount = static_cast<std::uint32_t>(desc.color_formats.size());
  info.pColorAttachmentFormats = desc.color_formats.data();
  info.depthAttachmentFormat = desc.depth_format;
  return info;
}

}  // namespace

void compile_compute(Device& device, Pipeline& pipeline, const ShaderStage& stage,
                     const ComputeDesc& desc) {
  const Module module(device, *stage.shader);
  const Specialization specialization(desc.constants);
  auto info =
      vk_struct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
  info.stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, module, specialization);
  info.layout = pipeline.layout;
  GPU_CHECK(vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr,
                                     &pipeline.handle));
  name_pipeline(device, pipeline);
}

void compile_graphics(Device& device, Pipeline& pipeline, std::span<const ShaderStage> stages,
                      const GraphicsDesc& desc) {
  const Specialization specialization(desc.constants);
  std::list<Module> modules;  // not copyable, so not in a vector
  std::vector<VkPipelineShaderStageCreateInfo> stage_infos;
  for (const ShaderStage& stage : stages) {
    stage_infos.push_back(
        stage_info(stage.stage, modules.emplace_back(device, *stage.shader), specialization));
  }

  // Vertices are pulled from storage buffers: no vertex input.
  const auto input = vk_struct<VkPipelineVertexInputStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  auto assembly = vk_struct<VkPipelineInputAssemblyStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  auto viewport = vk_struct<VkPipelineViewportStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  const auto raster = rasterization(desc);
  auto samples = vk_struct<VkPipelineMultisampleStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const auto depth = depth_state(desc);
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(desc.color_formats.size(),
                                                                     attachment_state(desc));
  auto blend = vk_struct<VkPipelineColorBlendStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  const auto dynamic = dynamic_state();
  auto rendering = targets(desc);

  auto info = vk_struct<VkGraphicsPipelineCreateInfo>(
      VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering);
  info.stageCount = static_cast<std::uint32_t>(stage_infos.size());
  info.pStages = stage_infos.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = pipeline.layout;
  GPU_CHECK(vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr,
                                      &pipeline.handle));
  name_pipeline(device, pipeline);
}

}  // namespace skerry::gpu
