// A pass that binds anything but what its shaders declare does not compile. docs/decisions/0021.
#include "engine/gpu/graph/bindings.h"

#include <gtest/gtest.h>
#include <shader_names.h>
#include <test_paths.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <tuple>

#include "shaders/shared/marker.h"

namespace skerry::gpu {
namespace {

namespace fs = std::filesystem;

struct Vertex {
  static constexpr std::array<ShaderReflection::Binding, 2> kBindings{
      {{2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {5, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}}};
};
struct Fragment {
  static constexpr std::array<ShaderReflection::Binding, 3> kBindings{
      {{5, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
       {7, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
       {8, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}};
};
struct Nothing {
  static constexpr std::array<ShaderReflection::Binding, 0> kBindings{};
};

template <class... Shaders, class... Each>
std::uint32_t wrong(const Each&... given) {
  return wrong_binding<decltype(std::tuple_cat(flat(given)...)), Shaders...>();
}

TEST(Bindings, WhatBothStagesDeclareIsGivenOnce) {
  const std::tuple group{storage<5>(BufferRef{}), std::tuple{sampled<7>(ImageRef{}, {})}};
  EXPECT_EQ((wrong<Vertex, Fragment>(storage<2>(BufferRef{}), group, storage<8>(ImageRef{}))),
            kNoBinding);
  EXPECT_EQ(wrong<Nothing>(), kNoBinding);
}

TEST(Bindings, AMissingOneIsNamed) {
  EXPECT_EQ(wrong<Vertex>(storage<2>(BufferRef{})), 5u);
  EXPECT_EQ(wrong<Vertex>(), 2u);
  EXPECT_EQ((wrong<Vertex, Fragment>(storage<2>(BufferRef{}), storage<5>(BufferRef{}),
                                     sampled<7>(ImageRef{}, {}))),
            8u);
}

TEST(Bindings, OneThatIsNotDeclaredIsNamed) {
  EXPECT_EQ(
      wrong<Vertex>(storage<2>(BufferRef{}), storage<5>(BufferRef{}), storage<6>(BufferRef{})), 6u);
  EXPECT_EQ(wrong<Nothing>(storage<0>(BufferRef{})), 0u);
}

TEST(Bindings, OneGivenTwiceOrAsAnotherKindIsNamed) {
  EXPECT_EQ(
      wrong<Vertex>(storage<2>(BufferRef{}), storage<5>(BufferRef{}), storage<5>(BufferRef{})), 5u);
  EXPECT_EQ(wrong<Vertex>(storage<2>(ImageRef{}), storage<5>(BufferRef{})), 2u);
  EXPECT_EQ(wrong<Vertex>(texels<2>(BufferRef{}), storage<5>(BufferRef{})), 2u);
  EXPECT_EQ((wrong<Vertex, Fragment>(storage<2>(BufferRef{}), storage<5>(BufferRef{}),
                                     storage<7>(ImageRef{}), sampled<8>(ImageRef{}, {}))),
            7u);
}

template <class... Each>
std::size_t pushed(const Each&... given) {
  return pushed_bytes<decltype(std::tuple_cat(flat(given)...))>();
}

TEST(Bindings, PushConstantsAreCountedAndAreNoBinding) {
  struct Push {
    float scale;
    std::uint32_t first, count;
  };
  const std::tuple group{storage<5>(BufferRef{}), constants(Push{})};
  EXPECT_EQ(wrong<Vertex>(storage<2>(BufferRef{}), group), kNoBinding);
  EXPECT_EQ(pushed(storage<2>(BufferRef{}), group), 12u);
  EXPECT_EQ(pushed(storage<2>(BufferRef{})), 0u);
  EXPECT_NE(pushed(group, constants(1u)), 16u) << "a second block overwrites the first";
}

TEST(Bindings, TheBuildKnowsTheSizeOfPushConstants) {
  EXPECT_EQ(programs::DrawMarker::kPushBytes, sizeof(shared::MarkerConstants));
  EXPECT_EQ(programs::BakeSky::kPushBytes, 0u);
}

/// bind() alone is checked: what Commands has for it is for that function and for tests.
TEST(Bindings, NoPassGoesAroundTheCheck) {
  const std::regex around(R"(\b(c|commands)\.(bind|storage|sampled|texels|push)\()");
  int passes = 0;
  for (const char* folder : {"engine/render", "game", "tools"})
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(SKERRY_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      if (text.find("gpu::Commands&") == std::string::npos) continue;
      ++passes;
      EXPECT_FALSE(std::regex_search(text, around)) << entry.path();
    }
  EXPECT_GT(passes, 10);
}

}  // namespace
}  // namespace skerry::gpu
