#pragma once
#include <volk.h>

namespace skerry::gpu {

/// A Vulkan struct with its type and chain set and everything else zero.
template <class T>
T vk_struct(VkStructureType type, void* next = nullptr) {
  T value{};
  value.sType = type;
  value.pNext = next;
  return value;
}

}  // namespace skerry::gpu
