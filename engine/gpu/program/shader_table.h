#pragma once
#include <span>

namespace skerry::gpu {

/// One compiled shader inside the program. The bytes are SPIR-V, 16-byte aligned.
struct EmbeddedShader {
  const char* name;            ///< source file name, e.g. "cull_emit.comp"
  const unsigned char* begin;  ///< first byte
  const unsigned char* end;    ///< one past the last byte
};

/// Every shader of the program, in name order.
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace skerry::gpu
