#include "engine/gpu/program/pipeline.h"

#include <algorithm>
#include <map>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"
#include "engine/gpu/program/pipeline_build.h"
#include "engine/gpu/program/pipeline_queue.h"

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

std::size_t code_bytes(std::span<const ShaderStage> stages) {
  std::size_t bytes = 0;
  for (const ShaderStage& stage : stages)
    bytes += static_cast<std::size_t>(stage.shader->end - stage.shader->begin);
  return bytes;
}

}  // namespace

void make_layout(Device& device, std::span<const ShaderStage> stages, Pipeline& pipeline) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const ShaderStage& stage : stages) {
    for (const auto& binding : stage.shader->bindings)
      merge_binding(bindings, binding, stage.stage, pipeline.name);
    if (stage.shader->push_bytes > 0)
      pipeline.push_stages |= static_cast<VkShaderStageFlags>(stage.stage);
    pipeline.push_bytes = std::max(pipeline.push_bytes, stage.shader->push_bytes);
  }
  for (const auto& binding : bindings)
    pipeline.bindings.push_back({binding.binding, binding.descriptorType});
  create_layouts(device, pipeline, bindings);
}

struct Pipelines::State {
  /// One that was asked for.
  struct Program {
    Pipeline pipeline;
    bool used = false;  // by a frame
  };

  State(Device& d, std::span<const EmbeddedShader> s) : device(d), shaders(s) {}

  Device& device;
  std::span<const EmbeddedShader> shaders;
  std::map<ComputeDesc, Program> compute;
  std::map<GraphicsDesc, Program> graphics;
  enum class AskedFor : std::uint8_t { kThisFrame, kNextFrame, kLater };
  AskedFor asked_for = AskedFor::kThisFrame;
  int used = 0, late = 0;
  std::size_t unready = 0;  // of what was asked for for the next frame
  PipelineQueue queue;      // ends before what it compiles does

  void begin(const ComputeDesc& desc, Pipeline& pipeline);
  void begin(const GraphicsDesc& desc, Pipeline& pipeline);

  template <class Desc>
  const Pipeline& get(std::map<Desc, Program>& known, const Desc& desc) {
    const auto [place, is_new] = known.try_emplace(desc);
    Program& program = place->second;
    if (is_new) begin(place->first, program.pipeline);
    if (asked_for == AskedFor::kNextFrame && !program.pipeline.ready()) ++unready;
    if (asked_for != AskedFor::kThisFrame || program.used) return program.pipeline;
    program.used = true;
    ++used;
    if (!program.pipeline.ready()) ++late;
    return program.pipeline;
  }
  template <class F>
  void each(F&& f) {
    for (auto& [desc, program] : compute) f(program.pipeline);
    for (auto& [desc, program] : graphics) f(program.pipeline);
  }
};

void Pipelines::State::begin(const ComputeDesc& desc, Pipeline& pipeline) {
  const ShaderStage stage{VK_SHADER_STAGE_COMPUTE_BIT, &find_shader(shaders, desc.shader)};
  pipeline.name = desc.shader;
  make_layout(device, {&stage, 1}, pipeline);
  queue.add(
      pipeline,
      [this, &desc, stage](Pipeline& made) { compile_compute(device, made, stage, desc); },
      code_bytes({&stage, 1}), asked_for == AskedFor::kLater);
}

void Pipelines::State::begin(const GraphicsDesc& desc, Pipeline& pipeline) {
  std::vector<ShaderStage> stages{{VK_SHADER_STAGE_VERTEX_BIT, &find_shader(shaders, desc.vertex)}};
  pipeline.name = desc.vertex;
  pipeline.bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
  if (!desc.fragment.empty()) {
    stages.push_back({VK_SHADER_STAGE_FRAGMENT_BIT, &find_shader(shaders, desc.fragment)});
    pipeline.name += " + " + desc.fragment;
  }
  make_layout(device, stages, pipeline);
  queue.add(
      pipeline,
      [this, &desc, stages](Pipeline& made) { compile_graphics(device, made, stages, desc); },
      code_bytes(stages), asked_for == AskedFor::kLater);
}

Pipelines::Pipelines(Device& device, std::span<const EmbeddedShader> shaders)
    : state_(std::make_unique<State>(device, shaders)) {}

Pipelines::~Pipelines() {
  state_->queue.stop();
  state_->each([this](const Pipeline& pipeline) {
    const auto one = [this](auto handle, VkObjectType type) {
      if (!handle) return;
      state_->device.retire(reinterpret_cast<std::uint64_t>(handle), type, VK_NULL_HANDLE, 0, {});
    };
    one(pipeline.handle, VK_OBJECT_TYPE_PIPELINE);
    one(pipeline.layout, VK_OBJECT_TYPE_PIPELINE_LAYOUT);
    one(pipeline.set_layout, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT);
  });
}

const Pipeline& Pipelines::get(const ComputeDesc& desc) {
  return state_->get(state_->compute, desc);
}

const Pipeline& Pipelines::get(const GraphicsDesc& desc) {
  return state_->get(state_->graphics, desc);
}

void Pipelines::foresee(const std::function<void()>& ask) {
  state_->asked_for = State::AskedFor::kLater;
  ask();
  state_->asked_for = State::AskedFor::kThisFrame;
}

std::size_t Pipelines::prepare(const std::function<void()>& ask) {
  state_->asked_for = State::AskedFor::kNextFrame;
  state_->unready = 0;
  ask();
  state_->asked_for = State::AskedFor::kThisFrame;
  return state_->unready;
}

int Pipelines::used() const {
  return state_->used;
}

int Pipelines::late() const {
  return state_->late;
}

std::size_t Pipelines::pending() const {
  return state_->queue.pending();
}

bool Pipelines::help() {
  return state_->queue.help();
}

void Pipelines::wait() const {
  state_->each([](const Pipeline& pipeline) { pipeline.made(); });
}

}  // namespace skerry::gpu
