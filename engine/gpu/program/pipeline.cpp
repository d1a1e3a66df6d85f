#include "engine/gpu/program/pipeline.h"

#include <algorithm>
#include <map>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"
#include "engine/gpu/program/pipeline_build.h"

namespace skerry::gpu {
namespace {

void merge_binding(std::vector<VkDescriptorSetLayoutBinding>& all,
                   const ShaderReflection::Binding& one, VkShaderStageFlags stage,
                   const std::string& name) {
  const auto same =
      std::find_if(all.begin(), all.end(), [&](const auto& b) { return b.binding == one.binding; });
  if (same == all.end()) {
    all.push_back({one.binding, one.type, 1, stage, nullptr});
  } else if (same->descriptorType != one.type) {
    gpu_fatal("the shaders of '" + name + "' disagree about the kind of binding " +
              std::to_string(one.binding));
  } else {
    same->stageFlags |= stage;
  }
}

void create_layouts(Device& device, Pipeline& pipeline,
                    const std::vector<VkDescriptorSetLayoutBinding>& bindings) {
  auto set_info = vk_struct<VkDescriptorSetLayoutCreateInfo>(
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  set_info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  GPU_CHECK(vkCreateDescriptorSetLayout(device.handle(), &set_info, nullptr, &pipeline.set_layout));
  device.set_name(reinterpret_cast<std::uint64_t>(pipeline.set_layout),
                  VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, pipeline.name.c_str());
  const VkPushConstantRange range{pipeline.push_stages, 0, pipeline.push_bytes};
  auto info = vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  info.setLayoutCount = 1;
  info.pSetLayouts = &pipeline.set_layout;
  info.pushConstantRangeCount = pipeline.push_bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  GPU_CHECK(vkCreatePipelineLayout(device.handle(), &info, nullptr, &pipeline.layout));
  device.set_name(reinterpret_cast<std::uint64_t>(pipeline.layout), VK_OBJECT_TYPE_PIPELINE_LAYOUT,
                  pipeline.name.c_str());
}

const EmbeddedShader& find_shader(std::span<const EmbeddedShader> shaders,
                                  const std::string& name) {
  for (const EmbeddedShader& shader : shaders) {
    if (name == shader.name) return shader;
  }
  gpu_fatal("there is no shader '" + name + "' in the program: is it in shaders/?");
}

}  // namespace

Pipeline make_layout(Device& device, const std::string& name, std::span<const ShaderStage> stages) {
  Pipeline pipeline;
  pipeline.name = name;
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const ShaderStage& stage : stages) {
    for (const auto& binding : stage.shader->bindings)
      merge_binding(bindings, binding, stage.stage, name);
    if (stage.shader->push_bytes > 0)
      pipeline.push_stages |= static_cast<VkShaderStageFlags>(stage.stage);
    pipeline.push_bytes = std::max(pipeline.push_bytes, stage.shader->push_bytes);
  }
  for (const auto& binding : bindings)
    pipeline.bindings.push_back({binding.binding, binding.descriptorType});
  create_layouts(device, pipeline, bindings);
  return pipeline;
}

struct Pipelines::State {
  Device& device;
  std::span<const EmbeddedShader> shaders;
  std::map<ComputeDesc, Pipeline> compute;
  std::map<GraphicsDesc, Pipeline> graphics;
};

Pipelines::Pipelines(Device& device, std::span<const EmbeddedShader> shaders)
    : state_(std::make_unique<State>(State{device, shaders, {}, {}})) {}

Pipelines::~Pipelines() {
  const auto retire = [this](const Pipeline& pipeline) {
    const auto one = [this](auto handle, VkObjectType type) {
      state_->device.retire(reinterpret_cast<std::uint64_t>(handle), type, VK_NULL_HANDLE, 0, {});
    };
    one(pipeline.handle, VK_OBJECT_TYPE_PIPELINE);
    one(pipeline.layout, VK_OBJECT_TYPE_PIPELINE_LAYOUT);
    one(pipeline.set_layout, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT);
  };
  for (const auto& [desc, pipeline] : state_->compute) retire(pipeline);
  for (const auto& [desc, pipeline] : state_->graphics) retire(pipeline);
}

const Pipeline& Pipelines::get(const ComputeDesc& desc) {
  const auto found = state_->compute.find(desc);
  if (found != state_->compute.end()) return found->second;
  const ShaderStage stage{VK_SHADER_STAGE_COMPUTE_BIT, &find_shader(state_->shaders, desc.shader)};
  Pipeline pipeline = make_layout(state_->device, desc.shader, {&stage, 1});
  compile_compute(state_->device, pipeline, stage, desc);
  return state_->compute.emplace(desc, std::move(pipeline)).first->second;
}

const Pipeline& Pipelines::get(const GraphicsDesc& desc) {
  const auto found = state_->graphics.find(desc);
  if (found != state_->graphics.end()) return found->second;
  std::vector<ShaderStage> stages{
      {VK_SHADER_STAGE_VERTEX_BIT, &find_shader(state_->shaders, desc.vertex)}};
  std::string name = desc.vertex;
  if (!desc.fragment.empty()) {
    stages.push_back({VK_SHADER_STAGE_FRAGMENT_BIT, &find_shader(state_->shaders, desc.fragment)});
    name += " + " + desc.fragment;
  }
  Pipeline pipeline = make_layout(state_->device, name, stages);
  compile_graphics(state_->device, pipeline, stages, desc);
  return state_->graphics.emplace(desc, std::move(pipeline)).first->second;
}

int Pipelines::created() const {
  return static_cast<int>(state_->compute.size() + state_->graphics.size());
}

}  // namespace skerry::gpu
