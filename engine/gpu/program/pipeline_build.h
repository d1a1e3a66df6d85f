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

/// Sets up layout, bindings and push constants as the stages' SPIR-V together ask for. Fatal on bad
/// SPIR-V or stages that disagree.
Pipeline reflect_layout(Device& device, const std::string& name,
                        std::span<const ShaderStage> stages);

/// Compiles. @param pipeline comes from reflect_layout; its handle is filled in.
void compile_compute(Device& device, Pipeline& pipeline, const ShaderStage& stage,
                     const ComputeDesc& desc);
void compile_graphics(Device& device, Pipeline& pipeline, std::span<const ShaderStage> stages,
                      const GraphicsDesc& desc);

}  // namespace skerry::gpu
