#include "engine/gpu/program/reflection.h"

#include <algorithm>
#include <map>
#include <optional>

namespace skerry::gpu {
namespace {

// Numbers of the SPIR-V specification, 3.32 and 3.20.
enum Op : std::uint32_t {
  kOpTypeInt = 21,
  kOpTypeFloat = 22,
  kOpTypeVector = 23,
  kOpTypeMatrix = 24,
  kOpTypeImage = 25,
  kOpTypeSampler = 26,
  kOpTypeSampledImage = 27,
  kOpTypeArray = 28,
  kOpTypeRuntimeArray = 29,
  kOpTypeStruct = 30,
  kOpTypePointer = 32,
  kOpConstant = 43,
  kOpVariable = 59,
  kOpDecorate = 71,
  kOpMemberDecorate = 72,
};
enum Decoration : std::uint32_t {
  kBlock = 2,
  kBufferBlock = 3,
  kArrayStride = 6,
  kMatrixStride = 7,
  kBinding = 33,
  kDescriptorSet = 34,
  kOffset = 35,
};
enum StorageClass : std::uint32_t {
  kUniformConstant = 0,
  kUniform = 2,
  kPushConstant = 9,
  kStorageBuffer = 12
};

constexpr std::uint32_t kMagic = 0x07230203;
constexpr std::size_t kHeaderWords = 5;

struct Instruction {
  std::uint32_t op = 0;
  std::span<const std::uint32_t> operands;
};

struct Module {
  std::map<std::uint32_t, Instruction> by_id;  // types and constants
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>
      decorations;  // (id, decoration) -> value
  // (struct id, member) -> decoration -> value
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::map<std::uint32_t, std::uint32_t>> members;
  std::vector<Instruction> variables;

  std::optional<std::uint32_t> decoration(std::uint32_t id, std::uint32_t which) const {
    const auto found = decorations.find({id, which});
    if (found == decorations.end()) return std::nullopt;
    return found->second;
  }
  std::uint32_t member(std::uint32_t id, std::uint32_t index, std::uint32_t which) const {
    const auto found = members.find({id, index});
    if (found == members.end()) return 0;
    const auto value = found->second.find(which);
    return value == found->second.end() ? 0 : value->second;
  }
  Instruction find(std::uint32_t id) const {
    const auto found = by_id.find(id);
    return found == by_id.end() ? Instruction{} : found->second;
  }
};

// Fewest operands of the instructions we read, so that later code may index them freely.
std::size_t least_operands(std::uint32_t op) {
  switch (op) {
    case kOpTypeSampler:
    case kOpTypeStruct:
      return 1;
    case kOpTypeFloat:
    case kOpTypeSampledImage:
    case kOpTypeRuntimeArray:
    case kOpDecorate:
      return 2;
    case kOpTypeInt:
    case kOpTypeVector:
    case kOpTypeMatrix:
    case kOpTypeArray:
    case kOpTypePointer:
    case kOpConstant:
    case kOpVariable:
    case kOpMemberDecorate:
      return 3;
    case kOpTypeImage:
      return 8;
    default:
      return 0;
  }
}

void take(Module& module, const Instruction& instruction) {
  const auto& operands = instruction.operands;
  switch (instruction.op) {
    case kOpDecorate:
      module.decorations[{operands[0], operands[1]}] = operands.size() > 2 ? operands[2] : 0;
      break;
    case kOpMemberDecorate:
      if (operands.size() > 3)
        module.members[{operands[0], operands[1]}][operands[2]] = operands[3];
      break;
    case kOpVariable:
      module.variables.push_back(instruction);
      break;
    case kOpConstant:
      module.by_id[operands[1]] = instruction;
      break;
    default:
      if (instruction.op >= kOpTypeInt && instruction.op <= kOpTypePointer && !operands.empty()) {
        module.by_id[operands[0]] = instruction;
      }
  }
}

Result<Module> parse(std::span<const std::uint32_t> words) {
  if (words.size() < kHeaderWords || words[0] != kMagic) return Error{"it is not SPIR-V"};
  Module module;
  for (std::size_t at = kHeaderWords; at < words.size();) {
    const std::uint32_t op = words[at] & 0xffffu;
    const std::size_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) return Error{"its SPIR-V is truncated"};
    const Instruction instruction{op, words.subspan(at + 1, length - 1)};
    if (instruction.operands.size() < least_operands(op))
      return Error{"its SPIR-V has a malformed instruction"};
    take(module, instruction);
    at += length;
  }
  return module;
}

// Bytes of a type inside a block. `matrix_stride` comes from the member that has the type. Depth
// bounds damaged modules.
std::uint32_t type_bytes(const Module& module, std::uint32_t id, std::uint32_t matrix_stride,
                         int depth = 0) {
  const Instruction type = module.find(id);
  if (depth > 8) return 0;
  switch (type.op) {
    case kOpTypeInt:
    case kOpTypeFloat:
      return type.operands[1] / 8;
    case kOpTypeVector:
      return type_bytes(module, type.operands[1], 0, depth + 1) * type.operands[2];
    case kOpTypeMatrix:
      return matrix_stride * type.operands[2];
    case kOpTypeArray: {
      const Instruction length = module.find(type.operands[2]);
      if (length.op != kOpConstant) return 0;
      return module.decoration(id, kArrayStride).value_or(0) * length.operands[2];
    }
    case kOpTypeStruct: {
      std::uint32_t end = 0;
      for (std::uint32_t i = 0; i + 1 < type.operands.size(); ++i) {
        const std::uint32_t size = type_bytes(module, type.operands[i + 1],
                                              module.member(id, i, kMatrixStride), depth + 1);
        end = std::max(end, module.member(id, i, kOffset) + size);
      }
      return end;
    }
    default:
      return 0;
  }
}

std::optional<VkDescriptorType> descriptor_type(const Module& module, std::uint32_t storage_class,
                                                std::uint32_t type_id) {
  const Instruction type = module.find(type_id);
  const bool block = type.op == kOpTypeStruct;
  if (block && storage_class == kStorageBuffer) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  if (block && storage_class == kUniform && module.decoration(type_id, kBufferBlock)) {
    return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;  // how SPIR-V before 1.3 says it
  }
  if (block && storage_class == kUniform) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  if (storage_class != kUniformConstant) return std::nullopt;
  if (type.op == kOpTypeSampledImage) return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  if (type.op == kOpTypeSampler) return VK_DESCRIPTOR_TYPE_SAMPLER;
  constexpr std::uint32_t kStorageImage = 2, kDim2D = 1, kDim3D = 2;
  if (type.op == kOpTypeImage && (type.operands[2] == kDim2D || type.operands[2] == kDim3D)) {
    return type.operands[6] == kStorageImage ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                             : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  }
  return std::nullopt;
}

}  // namespace

Result<ShaderReflection> reflect(std::span<const std::uint32_t> words) {
  Result<Module> parsed = parse(words);
  if (!parsed) return parsed.error();
  const Module& module = *parsed;
  ShaderReflection out;
  for (const Instruction& variable : module.variables) {
    const std::uint32_t id = variable.operands[1], storage_class = variable.operands[2];
    const Instruction pointer = module.find(variable.operands[0]);
    if (pointer.op != kOpTypePointer)
      return Error{"its SPIR-V has a variable without a pointer type"};
    const std::uint32_t pointee = pointer.operands[2];
    if (storage_class == kPushConstant)
      out.push_bytes = std::max(out.push_bytes, type_bytes(module, pointee, 0));
    const std::optional<std::uint32_t> binding = module.decoration(id, kBinding);
    if (!binding) continue;
    const std::string what = "its binding " + std::to_string(*binding);
    if (module.decoration(id, kDescriptorSet).value_or(0) != 0)
      return Error{what + " is not in descriptor set 0"};
    const std::optional<VkDescriptorType> type = descriptor_type(module, storage_class, pointee);
    if (!type) return Error{what + " is not a buffer, 2D or 3D storage image, texture or sampler"};
    // Two variables may share a binding, say to read a buffer as two types.
    const ShaderReflection::Binding entry{*binding, *type};
    if (std::find(out.bindings.begin(), out.bindings.end(), entry) == out.bindings.end())
      out.bindings.push_back(entry);
  }
  std::sort(out.bindings.begin(), out.bindings.end());
  return out;
}

}  // namespace skerry::gpu
