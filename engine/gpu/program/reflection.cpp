#include "engine/gpu/program/reflection.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace skerry::gpu {
namespace {

// Numbers of the SPIR-V specification, 3.32 and 3.20.
enum Op : std::uint32_t {
  kOpEntryPoint = 15,
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
  kOpFunction = 54,
  kOpFunctionCall = 57,
  kOpVariable = 59,
  kOpImageTexelPointer = 60,
  kOpLoad = 61,
  kOpStore = 62,
  kOpCopyMemory = 63,
  kOpAccessChain = 65,
  kOpInBoundsAccessChain = 66,
  kOpArrayLength = 68,
  kOpDecorate = 71,
  kOpMemberDecorate = 72,
  kOpCopyObject = 83,
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
  std::uint32_t entry = 0;                                    // function
  std::map<std::uint32_t, std::set<std::uint32_t>> named_by;  // function -> functions, variables

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
    case kOpEntryPoint:
    case kOpFunction:
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
    case kOpEntryPoint:
      module.entry = operands[1];
      break;
    default:
      if (instruction.op >= kOpTypeInt && instruction.op <= kOpTypePointer && !operands.empty()) {
        module.by_id[operands[0]] = instruction;
      }
  }
}

/// Functions and variables that an instruction of a function names: it calls, reads or writes them.
std::span<const std::uint32_t> named(const Instruction& instruction) {
  std::size_t first = 2, count = 1;
  switch (instruction.op) {
    case kOpFunctionCall:
      count = instruction.operands.size();
      break;
    case kOpStore:
      first = 0;
      break;
    case kOpCopyMemory:
      first = 0;
      count = 2;
      break;
    case kOpImageTexelPointer:
    case kOpLoad:
    case kOpAccessChain:
    case kOpInBoundsAccessChain:
    case kOpArrayLength:
    case kOpCopyObject:
      break;
    default:
      count = 0;
  }
  first = std::min(first, instruction.operands.size());
  return instruction.operands.subspan(first, std::min(count, instruction.operands.size() - first));
}

Result<Module> parse(std::span<const std::uint32_t> words) {
  if (words.size() < kHeaderWords || words[0] != kMagic) return Error{"it is not SPIR-V"};
  Module module;
  std::uint32_t function = 0;
  for (std::size_t at = kHeaderWords; at < words.size();) {
    const std::uint32_t op = words[at] & 0xffffu;
    const std::size_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) return Error{"its SPIR-V is truncated"};
    const Instruction instruction{op, words.subspan(at + 1, length - 1)};
    if (instruction.operands.size() < least_operands(op))
      return Error{"its SPIR-V has a malformed instruction"};
    take(module, instruction);
    if (op == kOpFunction) function = instruction.operands[1];
    for (const std::uint32_t id : named(instruction)) module.named_by[function].insert(id);
    at += length;
  }
  return module;
}

/// All that the entry point names, and what the functions that it calls name.
std::set<std::uint32_t> named_by_entry(const Module& module) {
  std::set<std::uint32_t> reached{module.entry};
  std::vector<std::uint32_t> open{module.entry};
  while (!open.empty()) {
    const auto found = module.named_by.find(open.back());
    open.pop_back();
    if (found == module.named_by.end()) continue;
    for (const std::uint32_t id : found->second)
      if (reached.insert(id).second) open.push_back(id);
  }
  return reached;
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
  constexpr std::uint32_t kDimBuffer = 5;
  const Instruction image = type.op == kOpTypeSampledImage ? module.find(type.operands[1]) : type;
  if (image.op == kOpTypeImage && image.operands[2] == kDimBuffer && image.operands[6] == 1)
    return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
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
  const std::set<std::uint32_t> used = named_by_entry(module);
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
    if (!type)
      return Error{what +
                   " is not a buffer, texel buffer, 2D or 3D storage image, texture or sampler"};
    // Two variables may share a binding, say to read a buffer as two types.
    const ShaderReflection::Binding entry{*binding, *type};
    if (std::find(out.bindings.begin(), out.bindings.end(), entry) == out.bindings.end())
      out.bindings.push_back(entry);
    if (!used.contains(id)) out.unused.push_back(*binding);
  }
  std::sort(out.bindings.begin(), out.bindings.end());
  std::sort(out.unused.begin(), out.unused.end());
  return out;
}

}  // namespace skerry::gpu
