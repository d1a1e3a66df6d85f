// The frame graph on a device, with synchronisation validation watching: results, not plans.
#include <array>
#include <cstring>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/transfer/readback.h"
#include "tests/gpu/compile_glsl.h"
#include "tests/gpu/test_device.h"

namespace skerry::gpu {
namespace {

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                        VK_BUFFER_USAGE_TRANSFER_DST_BIT;

class GraphTest : public GpuTest {
 protected:
  using GpuTest::contents;
  std::vector<std::uint8_t> contents(Image& from, std::uint32_t texel_bytes,
                                     std::uint32_t layer = 0) {
    const Result<std::vector<std::byte>> bytes = read_back(device(), from, texel_bytes, 0, layer);
    std::vector<std::uint8_t> values(bytes->size());
    std::memcpy(values.data(), bytes->data(), values.size());
    return values;
  }
  void run(FrameGraph& graph) {
    graph.compile();
    device().run_now([&](VkCommandBuffer commands) { graph.execute(commands, 0); });
  }
};

// Each value becomes factor * value + 1.
constexpr const char* kStep = R"(
  layout(local_size_x = 64) in;
  layout(constant_id = 3) const uint factor = 1;
  layout(scalar, push_constant) uniform Push { uint count; } push;
  layout(scalar, binding = 0) readonly buffer From { uint from[]; };
  layout(scalar, binding = 5) writeonly buffer To { uint to[]; };
  void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.count) to[i] = from[i] * factor + 1;
  })";

TEST_F(GraphTest, AChainOfComputePassesComputes) {
  constexpr std::uint32_t kCount = 1000;
  const TestShader shader("step.comp", kStep);
  const std::array table{shader.embedded()};
  Pipelines pipelines(device(), table);
  Buffer result = buffer("result", kCount * 4, kStorage);
  FrameGraph graph(&device());
  for (int frame = 0; frame < 3; ++frame) {
    graph.begin();
    BufferRef value = graph.create(BufferDesc{"start", kCount * 4});
    graph.add_pass(
        "start", [&](PassBuilder& b) { value = b.write(value, Use::kTransferWrite); },
        [value](Commands& c) { c.fill(value, 0, VK_WHOLE_SIZE, 5); });
    for (std::uint32_t factor = 2; factor <= 4; ++factor) {
      const BufferRef from = value;
      BufferRef to =
          factor == 4 ? graph.import(result) : graph.create(BufferDesc{"step", kCount * 4});
      graph.add_pass(
          "step_" + std::to_string(factor),
          [&](PassBuilder& b) {
            b.read(from, Use::kComputeRead);
            to = b.write(to, Use::kComputeWrite);
          },
          [&pipelines, from, factor, kept = to, kCount](Commands& c) {
            c.bind(pipelines.get(ComputeDesc{"step.comp", {{3, factor}}}));
            c.storage(0, from);
            c.storage(5, kept);
            c.push(kCount);
            c.dispatch(Commands::groups(kCount, 64), 1, 1);
          });
      value = to;
    }
    run(graph);
    const FrameCounts counts = graph.counts();
    EXPECT_EQ(counts.passes, 4u);
    EXPECT_EQ(counts.copies, 1u) << "the fill";
    EXPECT_EQ(counts.dispatches, 3u);
    EXPECT_EQ(counts.descriptor_writes, 6u) << "two bindings a dispatch";
    // Each step waits for what it reads; later, each write for last frame's use of its buffer, too.
    EXPECT_EQ(counts.barriers, frame == 0 ? 3u : 7u);
    EXPECT_EQ(counts.draws + counts.render_passes, 0u);
    EXPECT_EQ(counts.buffers, 3u);
    EXPECT_GE(counts.transient_bytes, 3u * kCount * 4);
  }
  EXPECT_EQ(contents<std::uint32_t>(result),
            std::vector<std::uint32_t>(kCount, ((5 * 2 + 1) * 3 + 1) * 4 + 1));
  EXPECT_EQ(pipelines.used(), 3);

  const std::vector<PassTime> times = graph.times(0);
  ASSERT_EQ(times.size(), 4u);
  EXPECT_EQ(times[1].name, "step_2");
  for (const PassTime& time : times) {
    EXPECT_GE(time.ms, 0.0);
    EXPECT_LT(time.ms, 1000.0);
  }

  graph.time_passes(false);
  graph.begin();
  BufferRef cleared = graph.import(result);
  graph.add_pass(
      "clear", [&](PassBuilder& b) { cleared = b.write(cleared, Use::kTransferWrite); },
      [&cleared](Commands& c) { c.fill(cleared, 0, VK_WHOLE_SIZE, 7); });
  run(graph);
  ASSERT_EQ(graph.times(0).size(), 1u);
  EXPECT_EQ(graph.times(0)[0].name, "frame");
  EXPECT_LT(graph.times(0)[0].ms, 1000.0);
}

/// Adds a pass that clears an image of the frame.
void add_clear(FrameGraph& graph, const char* name, std::uint32_t edge) {
  ImageRef image = graph.create(
      ImageDesc{.name = name, .format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {edge, edge}});
  graph.add_pass(
      "clear",
      [&](PassBuilder& b) {
        image = b.color(image, Load::cleared({}));
        b.keep();
      },
      [](Commands&) {});
}

/// Adds a pass that fills a buffer of the frame.
void add_fill(FrameGraph& graph, const char* name, std::uint64_t bytes) {
  BufferRef list = graph.create(BufferDesc{name, bytes});
  graph.add_pass(
      "fill",
      [&](PassBuilder& b) {
        list = b.write(list, Use::kTransferWrite);
        b.keep();
      },
      [list](Commands& c) { c.fill(list, 0, VK_WHOLE_SIZE, 0); });
}

// Water that leaves the view and comes back, a list that grows, a window that changes its size.
TEST_F(GraphTest, WhatComesBackIsNotAllocatedAgain) {
  FrameGraph graph(&device());
  const auto frame = [&](std::uint32_t edge, std::uint64_t list_bytes, bool water) {
    const std::uint64_t before = device().allocations();
    graph.begin();
    add_clear(graph, "radiance", edge);
    if (water) add_clear(graph, "water", edge);
    add_fill(graph, "list", list_bytes);
    run(graph);
    return device().allocations() - before;
  };
  const auto bytes_of = [&](const std::string& name) {
    std::uint64_t bytes = 0;
    for (const MemoryUse& use : device().memory_use())
      if (use.name == name) bytes += use.bytes;
    return bytes;
  };
  EXPECT_EQ(frame(64, 100, true), 3u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frame(64, 100, false), 0u);
  EXPECT_EQ(frame(64, 100, true), 0u) << "it was away for a hundred frames";
  EXPECT_EQ(frame(64, 100'000, false), 1u);
  const std::uint64_t both = bytes_of("list");
  for (int i = 0; i < 40; ++i) EXPECT_EQ(frame(64, i % 2 ? 100 : 90'000, false), 0u);
  EXPECT_LT(bytes_of("list"), both) << "the smaller list is given back";
  // Each size supersedes the one before; nothing of them adds up.
  const std::uint64_t small = bytes_of("radiance");
  for (std::uint32_t edge = 65; edge < 100; ++edge) (void)frame(edge, 100, edge % 2 == 0);
  for (int i = 0; i < 20; ++i) (void)frame(64, 100, true);
  EXPECT_EQ(bytes_of("radiance"), small);
  EXPECT_EQ(bytes_of("water"), small);
  // A frame that needs more than all others have does not keep it from them.
  graph.begin();
  add_clear(graph, "once", 1024);
  run(graph);
  EXPECT_GT(bytes_of("once"), 0u);
  for (int i = 0; i < 20; ++i) (void)frame(64, 100, true);
  EXPECT_EQ(bytes_of("once"), 0u);
}

// Lists of lamps are larger than all other lists together, and nothing beside the picture.
TEST_F(GraphTest, ListsAreKeptForAllThatAFrameTakes) {
  FrameGraph graph(&device());
  const auto frame = [&](bool lamps) {
    const std::uint64_t before = device().allocations();
    graph.begin();
    add_clear(graph, "radiance", 1024);
    add_fill(graph, "tiles", 100);
    if (lamps) add_fill(graph, "lamps", 1'000'000);
    run(graph);
    return device().allocations() - before;
  };
  EXPECT_EQ(frame(true), 3u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frame(false), 0u);
  EXPECT_EQ(frame(true), 0u);
}

// A triangle on the plane z = -1, seen from the origin along -z; the projection is
// docs/conventions.md's, with its y flip.
constexpr const char* kTriangle = R"(
  layout(scalar, push_constant) uniform Push { uint clockwise; float depth; } push;
  void main() {
    const vec2 corners[3] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1));  // counter-clockwise, y up
    vec2 p = corners[push.clockwise != 0 ? 2 - gl_VertexIndex : gl_VertexIndex];
    gl_Position = vec4(p.x, -p.y, push.depth, 1.0);
  })";
constexpr const char* kRed = R"(
  layout(location = 0) out vec4 colour;
  void main() { colour = vec4(1, 0, 0, 1); })";

struct TrianglePush {
  std::uint32_t clockwise = 0;
  float depth = 0.5f;
};

TEST_F(GraphTest, FrontFacesAreCounterClockwiseAndBackFacesVanish) {
  const TestShader vertex("triangle.vert", kTriangle), fragment("red.frag", kRed);
  const std::array table{fragment.embedded(), vertex.embedded()};
  Pipelines pipelines(device(), table);
  GraphicsDesc desc;
  desc.vertex = "triangle.vert";
  desc.fragment = "red.frag";
  desc.color_formats = {VK_FORMAT_R8G8B8A8_UNORM};
  const ImageDesc picture{
      .name = "picture",
      .format = VK_FORMAT_R8G8B8A8_UNORM,
      .extent = {16, 16},
      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
  for (const std::uint32_t clockwise : {0u, 1u}) {
    Image target = image(picture);
    FrameGraph graph(&device());
    graph.begin();
    ImageRef ref = graph.import(target);
    graph.add_pass(
        "draw", [&](PassBuilder& b) { ref = b.color(ref, Load::cleared({})); },
        [&](Commands& c) {
          c.bind(pipelines.get(desc));
          c.push(TrianglePush{clockwise});
          c.draw(3, 1);
        });
    run(graph);
    const std::vector<std::uint8_t> texels = contents(target, 4);
    // World (-, -) is the lower left of the picture: row 15. The upper right stays empty.
    EXPECT_EQ(texels[(15 * 16 + 0) * 4], clockwise ? 0 : 255);
    EXPECT_EQ(texels[(0 * 16 + 15) * 4], 0);
  }
}

TEST_F(GraphTest, CascadesDrawLayersOfOneImageAndAreReadTogether) {
  constexpr std::uint32_t kLayers = 3, kEdge = 8;
  const TestShader vertex("triangle.vert", kTriangle), shader("gather.comp", R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) uniform sampler2DArray map;
    layout(scalar, binding = 1) writeonly buffer Out { float depths[]; };
    void main() { depths[gl_GlobalInvocationID.x] = texture(map, vec3(0.1, 0.9, float(gl_GlobalInvocationID.x))).x; })");
  const std::array table{shader.embedded(), vertex.embedded()};
  Pipelines pipelines(device(), table);
  GraphicsDesc desc;
  desc.vertex = "triangle.vert";
  desc.depth_format = VK_FORMAT_D32_SFLOAT;
  desc.depth_clamp = true;
  Buffer result = buffer("result", kLayers * sizeof(float), kStorage);
  Image map =
      image({.name = "shadow map",
             .format = VK_FORMAT_D32_SFLOAT,
             .extent = {kEdge, kEdge},
             .layers = kLayers,
             .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
  const VkSampler sampler = *device().sampler({.mag = VK_FILTER_NEAREST, .min = VK_FILTER_NEAREST});
  FrameGraph graph(&device());
  // In the second frame one cascade alone is drawn anew; the others keep what they have.
  for (std::uint32_t frame = 0; frame < 2; ++frame) {
    graph.begin();
    ImageRef ref = graph.import(map);
    for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
      if (frame == 1 && layer != 1) continue;
      graph.add_pass(
          "shadow_" + std::to_string(layer),
          [&](PassBuilder& b) { ref = b.depth(ref, Load::cleared({}), layer); },
          [&, layer, frame](Commands& c) {
            c.bind(pipelines.get(desc));
            c.push(TrianglePush{0, frame == 0 ? 0.25f * static_cast<float>(layer + 1) : 0.125f});
            c.draw(3, 1);
          });
    }
    BufferRef out = graph.import(result);
    graph.add_pass(
        "gather",
        [&](PassBuilder& b) {
          b.read(ref, Use::kComputeSampled);
          out = b.write(out, Use::kComputeWrite);
        },
        [&](Commands& c) {
          c.bind(pipelines.get(ComputeDesc{"gather.comp", {}}));
          c.sampled(0, ref, sampler);
          c.storage(1, out);
          c.dispatch(kLayers, 1, 1);
        });
    run(graph);
    const float middle = frame == 0 ? 0.5f : 0.125f;
    EXPECT_EQ(contents<float>(result), (std::vector<float>{0.25f, middle, 0.75f}));
  }
}

TEST_F(GraphTest, IndirectDrawsTakeTheirCountFromTheGpu) {
  const TestShader vertex("triangle.vert", kTriangle), fragment("red.frag", kRed);
  const TestShader cull("cull.comp", R"(
    layout(local_size_x = 1) in;
    layout(scalar, binding = 0) buffer Draws { uint draws[]; };
    layout(scalar, binding = 1) buffer Count { uint count; };
    layout(scalar, binding = 2) buffer Indices { uint indices[]; };
    void main() {
      for (uint i = 0; i < 3; ++i) indices[i] = i;
      draws[0] = 3; draws[1] = 1; draws[2] = 0; draws[3] = 0; draws[4] = 7;
      count = 1;
    })");
  const std::array table{cull.embedded(), fragment.embedded(), vertex.embedded()};
  Pipelines pipelines(device(), table);
  GraphicsDesc desc;
  desc.vertex = "triangle.vert";
  desc.fragment = "red.frag";
  desc.color_formats = {VK_FORMAT_R8G8B8A8_UNORM};
  Image target =
      image({.name = "picture",
             .format = VK_FORMAT_R8G8B8A8_UNORM,
             .extent = {4, 4},
             .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
  Buffer landing =
      buffer("landing", 4 * 4 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::kReadback);
  FrameGraph graph(&device());
  graph.begin();
  BufferRef draws = graph.create(BufferDesc{"draws", 10 * 20}),
            count = graph.create(BufferDesc{"count", 4}),
            indices = graph.create(BufferDesc{"indices", 12}), to_cpu = graph.import(landing);
  ImageRef picture = graph.import(target);
  graph.add_pass(
      "cull",
      [&](PassBuilder& b) {
        draws = b.write(draws, Use::kComputeWrite);
        count = b.write(count, Use::kComputeWrite);
        indices = b.write(indices, Use::kComputeWrite);
      },
      [&](Commands& c) {
        c.bind(pipelines.get(ComputeDesc{"cull.comp", {}}));
        c.storage(0, draws);
        c.storage(1, count);
        c.storage(2, indices);
        c.dispatch(1, 1, 1);
      });
  graph.add_pass(
      "draw",
      [&](PassBuilder& b) {
        b.read(draws, Use::kIndirect);
        b.read(count, Use::kIndirect);
        b.read(indices, Use::kIndex);
        picture = b.color(picture, Load::cleared({}));
      },
      [&](Commands& c) {
        c.bind(pipelines.get(desc));
        c.index_buffer(indices, VK_INDEX_TYPE_UINT32);
        c.push(TrianglePush{});
        c.draw_indirect_count(draws, 0, count, 0, 10);
      });
  graph.add_pass(
      "to_cpu",
      [&](PassBuilder& b) {
        b.read(picture, Use::kTransferRead);
        to_cpu = b.write(to_cpu, Use::kTransferWrite);
        b.read(to_cpu, Use::kHostRead);
      },
      [&](Commands& c) { c.copy(picture, to_cpu); });
  run(graph);
  EXPECT_EQ(landing.mapped()[3 * 4 * 4], std::byte{255});  // lower left is inside the triangle
  EXPECT_EQ(landing.mapped()[3 * 4], std::byte{0});        // upper right is not
}

class GraphDeathTest : public GraphTest {
 protected:
  void SetUp() override {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    GraphTest::SetUp();
  }
  /// One compute pass over kStep that records `record`.
  void record_step(
      const std::function<void(Commands&, const Pipeline&, BufferRef from, BufferRef to)>& record) {
    const TestShader shader("step.comp", kStep);
    const std::array table{shader.embedded()};
    Pipelines pipelines(device(), table);
    Buffer a = buffer("a", 64, kStorage), b = buffer("b", 64, kStorage);
    FrameGraph graph(&device());
    graph.begin();
    BufferRef from = graph.import(a), to = graph.import(b);
    graph.add_pass(
        "step",
        [&](PassBuilder& builder) {
          builder.read(from, Use::kComputeRead);
          to = builder.write(to, Use::kComputeWrite);
        },
        [&](Commands& c) {
          record(c, pipelines.get(ComputeDesc{"step.comp", {}}), from, to);
        });
    run(graph);
  }
};

TEST_F(GraphDeathTest, AMissingBindingIsFatal) {
  EXPECT_DEATH(record_step([](Commands& c, const Pipeline& step, BufferRef from, BufferRef) {
                 c.bind(step);
                 c.storage(0, from);
                 c.push(16u);
                 c.dispatch(1, 1, 1);
               }),
               "'step' with the shader 'step.comp' draws or dispatches without the binding 5");
}

TEST_F(GraphDeathTest, ABindingTheShaderDoesNotHaveIsFatal) {
  EXPECT_DEATH(record_step([](Commands& c, const Pipeline& step, BufferRef from, BufferRef) {
                 c.bind(step);
                 c.storage(1, from);
               }),
               "'step.comp' sets the binding 1, which the shader does not have");
}

TEST_F(GraphDeathTest, PushConstantsOfAnotherSizeAreFatal) {
  EXPECT_DEATH(record_step([](Commands& c, const Pipeline& step, BufferRef, BufferRef) {
                 c.bind(step);
                 c.push(std::uint64_t{16});
               }),
               "'step.comp' pushes 8 bytes of constants, but the shader has 4");
}

TEST_F(GraphDeathTest, ForgottenPushConstantsAreFatal) {
  EXPECT_DEATH(record_step([](Commands& c, const Pipeline& step, BufferRef from, BufferRef to) {
                 c.bind(step);
                 c.storage(0, from);
                 c.storage(5, to);
                 c.dispatch(1, 1, 1);
               }),
               "'step.comp' draws or dispatches before push");
}

TEST_F(GraphDeathTest, AnotherUseThanTheDeclaredOneIsFatal) {
  EXPECT_DEATH(record_step([](Commands& c, const Pipeline&, BufferRef from, BufferRef) {
                 c.fill(from, 0, 64, 0);
               }),
               "'step' uses 'a', which it declared for another use");
}

TEST_F(GraphDeathTest, AShaderThatDoesNotExistIsFatal) {
  Pipelines pipelines(device());
  EXPECT_DEATH(pipelines.get(ComputeDesc{"nowhere.comp", {}}), "there is no shader 'nowhere.comp'");
}

}  // namespace
}  // namespace skerry::gpu
