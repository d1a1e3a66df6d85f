#pragma once
#include <volk.h>

#include <span>
#include <string>
#include <vector>

#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/program/shader_table.h"

namespace skerry::gpu {

/// One stage of a pipeline being built.
struct ShaderStage {
  VkShaderStageFlagBits stage{};
  const EmbeddedShader* shader = nullptr;
};

/// Sets up layout, bindings and push constants as the stages' sources together declare them. Fatal
/// on stages that disagree. @param pipeline has its name.
void make_layout(Device& device, std::span<const ShaderStage> stages, Pipeline& pipeline);

/// Compiles, on any thread. @param pipeline comes from make_layout; its handle is filled in.
void compile_compute(Device& device, Pipeline& pipeline, const ShaderStage& stage,
                     const ComputeDesc& desc);
void compile_graphics(Device& device, Pipeline& pipeline, std::span<const ShaderStage> stages,
                      const GraphicsDesc& desc);

}  // namespace skerry::gpu
