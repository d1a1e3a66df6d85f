#pragma once
// What a pass binds, held against what its shaders declare when the pass is compiled: a binding
// that is missing, of another kind or not declared does not build, nor do push constants of another
// size. docs/decisions/0021.
#include <volk.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/program/reflection.h"

namespace skerry::gpu {

/// As what a pass gives a binding.
enum class Giving : std::uint8_t { kBuffer, kTexels, kStorageImage, kSampled };

/// One binding of a pass, made by storage(), texels() or sampled(). Tuples of them and of Pushed
/// are groups.
template <std::uint32_t kBinding, Giving kGiving, class Ref>
struct Given {
  static constexpr std::uint32_t binding = kBinding;
  static constexpr Giving giving = kGiving;
  Ref ref;
  VkSampler sampler{};
  std::uint32_t layer = 0;
};

/// A storage or a uniform buffer, as the shader declares it.
template <std::uint32_t kBinding>
constexpr auto storage(BufferRef ref) {
  return Given<kBinding, Giving::kBuffer, BufferRef>{ref};
}
/// @param layer that the shader sees, or kAllLayers for an array of them.
template <std::uint32_t kBinding>
constexpr auto storage(ImageRef ref, std::uint32_t layer = 0) {
  return Given<kBinding, Giving::kStorageImage, ImageRef>{ref, {}, layer};
}
template <std::uint32_t kBinding>
constexpr auto texels(BufferRef ref) {
  return Given<kBinding, Giving::kTexels, BufferRef>{ref};
}
template <std::uint32_t kBinding>
constexpr auto sampled(ImageRef ref, VkSampler sampler) {
  return Given<kBinding, Giving::kSampled, ImageRef>{ref, sampler};
}

/// A pass's push constants, made by constants().
template <class T>
struct Pushed {
  T value;
};
/// @param value laid out as in the shader (scalar layout).
template <class T>
constexpr auto constants(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return Pushed<T>{value};
}

/// `kCount` bindings in a row, of as many of a group's references.
template <std::uint32_t kFirst, std::size_t kCount, class Give>
constexpr auto each_of(const Give& give) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) {
    return std::tuple{give.template operator()<kFirst + static_cast<std::uint32_t>(k)>(k)...};
  }
  (std::make_index_sequence<kCount>());
}

/// Groups of groups as one tuple of Given and Pushed.
template <std::uint32_t kBinding, Giving kGiving, class Ref>
constexpr auto flat(const Given<kBinding, kGiving, Ref>& one) {
  return std::tuple{one};
}
template <class T>
constexpr auto flat(const Pushed<T>& constants) {
  return std::tuple{constants};
}
template <class... Each>
constexpr auto flat(const std::tuple<Each...>& group) {
  return std::apply([](const auto&... each) { return std::tuple_cat(flat(each)...); }, group);
}

/// What is wrong with no binding.
inline constexpr std::uint32_t kNoBinding = ~0u;

constexpr bool suits(Giving giving, VkDescriptorType type) {
  switch (giving) {
    case Giving::kBuffer:
      return type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case Giving::kTexels:
      return type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case Giving::kStorageImage:
      return type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    case Giving::kSampled:
      return type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER ||
             type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  }
  return false;
}

/// What a tuple's element is to the checks below.
struct Part {
  std::uint32_t binding = kNoBinding;  ///< kNoBinding: push constants
  Giving giving{};
  std::size_t pushed_bytes = 0;
};
template <std::uint32_t kBinding, Giving kGiving, class Ref>
constexpr Part part_of(const Given<kBinding, kGiving, Ref>*) {
  return {kBinding, kGiving, 0};
}
template <class T>
constexpr Part part_of(const Pushed<T>*) {
  return {kNoBinding, {}, sizeof(T)};
}
template <class... Each>
constexpr auto parts_of(const std::tuple<Each...>*) {
  return std::array<Part, sizeof...(Each)>{part_of(static_cast<const Each*>(nullptr))...};
}

/// The lowest binding that the shaders declare and the group, a flat one, lacks or has of another
/// kind, or that the group has twice or for nothing; else kNoBinding.
/// @tparam Shaders types of generated/shader_names.h.
template <class Group, class... Shaders>
constexpr std::uint32_t wrong_binding() {
  constexpr auto kGiven = parts_of(static_cast<const Group*>(nullptr));
  std::uint32_t wrong = kNoBinding;
  const auto look = [&](const auto& declared) {
    for (const ShaderReflection::Binding& one : declared)
      if (std::ranges::none_of(kGiven, [&](const Part& g) {
            return g.binding == one.binding && suits(g.giving, one.type);
          }))
        wrong = std::min(wrong, one.binding);
  };
  (look(Shaders::kBindings), ...);
  for (const Part& one : kGiven) {
    if (one.binding == kNoBinding) continue;
    const auto declares = [&](const auto& declared) {
      return std::ranges::count(declared, one.binding, &ShaderReflection::Binding::binding) != 0;
    };
    if (std::ranges::count(kGiven, one.binding, &Part::binding) != 1 ||
        !(declares(Shaders::kBindings) || ...))
      wrong = std::min(wrong, one.binding);
  }
  return wrong;
}

/// Does not compile for a wrong binding; the compiler names its number.
template <std::uint32_t kWrong>
struct Fits {
  static_assert(kWrong == kNoBinding,
                "the pass lacks a binding that the shader declares, or gives one that it does not "
                "declare, twice, or as another kind: see the number of this Fits<> in "
                "shaders/shared/bindings.h");
};

/// Bytes of push constants in a flat group; of more than one, none that fits.
template <class Group>
constexpr std::size_t pushed_bytes() {
  std::size_t bytes = 0;
  for (const Part& one : parts_of(static_cast<const Group*>(nullptr)))
    if (one.binding == kNoBinding) bytes = bytes == 0 ? one.pushed_bytes : SIZE_MAX;
  return bytes;
}

/// Does not compile where a pass pushes other constants than its shaders declare.
template <std::size_t kGiven, std::size_t kDeclared>
struct FitsConstants {
  static_assert(kGiven == kDeclared,
                "the pass gives other push constants than the shader declares: see both sizes in "
                "bytes in this FitsConstants<given, declared>");
};

/// A pipeline that knows its shaders: types of generated/shader_names.h.
template <class... Shaders>
struct Program {
  const Pipeline* pipeline = nullptr;
};

template <class Shader>
Program<Shader> compute(Pipelines& pipelines, Shader, std::vector<SpecConstant> constants = {}) {
  return {&pipelines.get(ComputeDesc{Shader::kName, std::move(constants)})};
}
/// @param desc without names of shaders.
template <class Vertex>
Program<Vertex> graphics(Pipelines& pipelines, Vertex, GraphicsDesc desc) {
  desc.vertex = Vertex::kName;
  return {&pipelines.get(desc)};
}
template <class Vertex, class Fragment>
Program<Vertex, Fragment> graphics(Pipelines& pipelines, Vertex, Fragment, GraphicsDesc desc) {
  desc.vertex = Vertex::kName;
  desc.fragment = Fragment::kName;
  return {&pipelines.get(desc)};
}

template <std::uint32_t kBinding, Giving kGiving, class Ref>
void give(Commands& commands, const Given<kBinding, kGiving, Ref>& one) {
  if constexpr (kGiving == Giving::kBuffer)
    commands.storage(kBinding, one.ref);
  else if constexpr (kGiving == Giving::kTexels)
    commands.texels(kBinding, one.ref);
  else if constexpr (kGiving == Giving::kStorageImage)
    commands.storage(kBinding, one.ref, 0, one.layer);
  else
    commands.sampled(kBinding, one.ref, one.sampler);
}
template <class T>
void give(Commands& commands, const Pushed<T>& constants) {
  commands.push(constants.value);
}

/// Binds a program with all that its shaders declare, push constants too.
/// @param given what storage(), texels(), sampled() and constants() make, and groups of it.
template <class... Shaders, class... Each>
void bind(Commands& commands, const Program<Shaders...>& program, const Each&... given) {
  const auto all = std::tuple_cat(flat(given)...);
  using All = std::remove_const_t<decltype(all)>;
  [[maybe_unused]] const Fits<wrong_binding<All, Shaders...>()> fits{};
  [[maybe_unused]] const FitsConstants<pushed_bytes<All>(), std::max({Shaders::kPushBytes...})>
      fits_constants{};
  commands.bind(*program.pipeline);
  std::apply([&](const auto&... one) { (give(commands, one), ...); }, all);
}

}  // namespace skerry::gpu
