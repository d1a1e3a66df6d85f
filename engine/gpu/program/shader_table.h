#pragma once
#include <cstdint>
#include <span>

#include "engine/gpu/program/reflection.h"

namespace skerry::gpu {

/// One compiled shader inside the program. The bytes are optimised SPIR-V, 16-byte aligned. What it
/// asks of a pipeline layout is what its source declares, whatever an optimiser leaves of that:
/// every build binds alike.
struct EmbeddedShader {
  const char* name;                                     ///< source file name, e.g. "cull.comp"
  const unsigned char* begin;                           ///< first byte
  const unsigned char* end;                             ///< one past the last byte
  std::span<const ShaderReflection::Binding> bindings;  ///< of set 0, by number
  std::uint32_t push_bytes = 0;                         ///< of push constants
};

/// Every shader of the program, in name order.
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace skerry::gpu
