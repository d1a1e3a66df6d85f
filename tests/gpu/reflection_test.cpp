// Reflection of optimised, stripped SPIR-V, which is what ships.
#include "engine/gpu/program/reflection.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/gpu/compile_glsl.h"

namespace skerry::gpu {
namespace {

ShaderReflection reflect_ok(const TestShader& shader) {
  Result<ShaderReflection> reflection = reflect(shader.words());
  EXPECT_TRUE(reflection) << (reflection ? "" : reflection.error().message);
  return reflection ? *reflection : ShaderReflection{};
}

TEST(Reflection, EveryKindOfBindingIsFound) {
  const TestShader shader("kinds.comp", R"(
    layout(local_size_x = 8) in;
    layout(scalar, binding = 7) buffer Numbers { uint numbers[]; };
    layout(binding = 2, rgba8) uniform writeonly image2D picture;
    layout(binding = 4) uniform sampler2DArray textures;
    layout(binding = 0) uniform texture2D plain;
    layout(binding = 1) uniform sampler how;
    void main() {
      vec4 c = texture(textures, vec3(0)) + texture(sampler2D(plain, how), vec2(0));
      imageStore(picture, ivec2(gl_GlobalInvocationID.xy), c * float(numbers[gl_GlobalInvocationID.x]));
    })");
  const std::vector<ShaderReflection::Binding> expected{
      {0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
      {1, VK_DESCRIPTOR_TYPE_SAMPLER},
      {2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
      {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {7, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  EXPECT_EQ(reflect_ok(shader).bindings, expected);
  EXPECT_EQ(reflect_ok(shader).push_bytes, 0u);
}

TEST(Reflection, UseIsWhatTheEntryPointReaches) {
  // 0 read in main, 1 written by a function of a function, 2 an image read, 3 an atomic on an
  // image, 4 only the length of, 5 in a function that nobody calls, 6 nowhere.
  const TestShader shader("use.comp", R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) buffer A { uint a; };
    layout(binding = 1) buffer B { uint b[]; };
    layout(binding = 2) uniform sampler2D c;
    layout(binding = 3, r32ui) uniform uimage2D d;
    layout(binding = 4) buffer E { uint e[]; };
    layout(binding = 5) buffer F { uint f; };
    layout(binding = 6) buffer G { uint g; };
    void inner(uint value) { b[value] = value; }
    void outer(uint value) { inner(value + 1); }
    void nobody() { f = 1; }
    void main() {
      outer(a + uint(texelFetch(c, ivec2(0), 0).r) + e.length());
      imageAtomicAdd(d, ivec2(0), 1u);
    })");
  const Result<ShaderReflection> reflection = reflect(shader.words_with_names());
  ASSERT_TRUE(reflection) << reflection.error().message;
  EXPECT_EQ(reflection->bindings.size(), 7u);
  EXPECT_EQ(reflection->unused, (std::vector<std::uint32_t>{5, 6}));
}

TEST(Reflection, PushConstantsEndWithTheirLastMemberInScalarLayout) {
  // 64 (mat4) + 12 (vec3) + 4 (uint) + 3 * 12 (vec3[3]) + 2 * (12 + 4) (struct[2]) = 148
  const TestShader shader("push.comp", R"(
    layout(local_size_x = 1) in;
    struct Pair { vec3 p; uint q; };
    layout(scalar, push_constant) uniform Push { mat4 m; vec3 v; uint u; vec3 list[3]; Pair pairs[2]; } push;
    layout(binding = 0) buffer A { float a; };
    void main() { a = push.m[0].x + push.v.y + float(push.u) + push.list[2].z + push.pairs[1].p.x; })");
  EXPECT_EQ(reflect_ok(shader).push_bytes, 148u);
}

TEST(Reflection, SetsBeyondTheFirstAreRefused) {
  const TestShader shader("sets.comp", R"(
    layout(local_size_x = 1) in;
    layout(set = 1, binding = 3) buffer A { uint a; };
    void main() { a = 1; })");
  const Result<ShaderReflection> reflection = reflect(shader.words());
  ASSERT_FALSE(reflection);
  EXPECT_EQ(reflection.error().message, "its binding 3 is not in descriptor set 0");
}

TEST(Reflection, UniformAndStorageBuffersAreToldApart) {
  const TestShader shader("uniform.comp", R"(
    layout(local_size_x = 1) in;
    layout(scalar, binding = 0) uniform U { uint u; };
    layout(scalar, binding = 1) buffer A { uint a; };
    void main() { a = u; })");
  const std::vector<ShaderReflection::Binding> expected{{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                                        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  EXPECT_EQ(reflect_ok(shader).bindings, expected);
}

TEST(Reflection, ImagesMayHaveThreeDimensions) {
  const TestShader shader("volume.comp", R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) uniform sampler3D from;
    layout(binding = 1, r16f) uniform writeonly image3D to;
    void main() { imageStore(to, ivec3(0), textureLod(from, vec3(0.5), 0.0)); })");
  const std::vector<ShaderReflection::Binding> expected{
      {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
  EXPECT_EQ(reflect_ok(shader).bindings, expected);
}

TEST(Reflection, DescriptorsWithoutAUseHereAreRefused) {
  const TestShader shader("texels.comp", R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) uniform samplerBuffer texels;
    layout(binding = 1, rgba8) uniform image1D line;
    void main() { imageStore(line, 0, texelFetch(texels, 0)); })");
  EXPECT_FALSE(reflect(shader.words()));
}

TEST(Reflection, DamagedModulesAreErrorsOrHarmless) {
  const TestShader shader("damage.comp", R"(
    layout(local_size_x = 1) in;
    layout(scalar, push_constant) uniform Push { mat4 m; vec3 list[3]; } push;
    layout(binding = 0) buffer A { float a[]; };
    void main() { a[0] = push.m[0].x + push.list[1].y; })");
  std::vector<std::uint32_t> words = shader.words();
  EXPECT_FALSE(reflect({}));
  EXPECT_FALSE(reflect(std::span(words).first(4)));
  std::vector<std::uint32_t> other = words;
  other[0] ^= 1;
  EXPECT_FALSE(reflect(other));
  // Cut anywhere, or with any word replaced, it must not read outside; sanitizers watch this.
  for (std::size_t cut = 5; cut < words.size(); ++cut)
    static_cast<void>(reflect(std::span(words).first(cut)));
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint32_t> broken = words;
    for (int k = 0; k < 3; ++k)
      broken[5 + random() % (broken.size() - 5)] = static_cast<std::uint32_t>(random());
    static_cast<void>(reflect(broken));
  }
}

}  // namespace
}  // namespace skerry::gpu
