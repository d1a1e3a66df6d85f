#pragma once
#include <volk.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace skerry::gpu {

/// What a shader's SPIR-V asks of its pipeline layout.
struct ShaderReflection {
  struct Binding {
    std::uint32_t binding = 0;
    VkDescriptorType type{};
    auto operator<=>(const Binding&) const = default;
  };
  std::vector<Binding> bindings;  ///< of set 0, by binding number
  std::uint32_t push_bytes =
      0;  ///< end of the push-constant block's last member, in its own (scalar) layout
  /// Numbers of declared bindings that no function uses which the entry point calls, directly or
  /// not. A source has none: what is declared is what a pass must bind.
  std::vector<std::uint32_t> unused;
};

/// Reads descriptor bindings and the push-constant size from SPIR-V, optimised or not. Errors: not
/// SPIR-V, truncated, a descriptor set other than 0, an arrayed or unsupported kind of descriptor.
/// Source: SPIR-V specification 1.5, sections 2.3 (layout), 3.32.3 and 3.32.6 (decorations, types).
Result<ShaderReflection> reflect(std::span<const std::uint32_t> words);

}  // namespace skerry::gpu
