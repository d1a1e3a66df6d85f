#pragma once
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/transfer/readback.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/scene/occupancy_store.h"
#include "shaders/shared/bindings.h"
#include "tests/gpu/compile_glsl.h"
#include "tests/gpu/test_device.h"
#include "world/mesh/mesh.h"
#include "world/mesh/occupancy.h"

namespace skerry::render {

/// Whether a voxel of an island's lattice is opaque [voxels of its level].
using OpaqueAt = std::function<bool(int x, int y, int z)>;

/// Occupancy as the game fills it, and compute shaders that ask it.
class OccupancyOnGpu : public gpu::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    uploader_ = std::make_unique<gpu::Uploader>(device(), gpu::UploadPath::kUpdateBuffer);
    Result<std::unique_ptr<OccupancyStore>> made = OccupancyStore::create(device(), budget_);
    ASSERT_TRUE(made) << made.error().message;
    store_ = *std::move(made);
  }
  void TearDown() override {
    store_.reset();
    uploader_.reset();
    GpuTest::TearDown();
  }
  OccupancyStore& store() { return *store_; }
  gpu::Uploader& uploader() { return *uploader_; }

  static world::ChunkOccupancy occupancy(const OpaqueAt& opaque, glm::ivec3 chunk) {
    std::vector<world::BlockId> voxels(world::kPaddedVoxels);
    std::size_t index = 0;
    for (int y = -1; y < 65; ++y)
      for (int x = -1; x < 65; ++x)
        for (int z = -1; z < 65; ++z, ++index)
          voxels[index] = opaque(chunk.x * 64 + x, chunk.y * 64 + y, chunk.z * 64 + z)
                              ? world::BlockId{world::block::kStone}
                              : world::kAir;
    return world::occupancy_of(voxels);
  }
  void add(std::uint32_t island, glm::ivec3 chunk, const world::ChunkOccupancy& made) {
    if (made.fill == world::ChunkOccupancy::Fill::kEmpty) return;
    const Result<void> added =
        store_->add(*uploader_, island, chunk,
                    {made.fill == world::ChunkOccupancy::Fill::kFull, made.table, made.words});
    ASSERT_TRUE(added) << added.error().message;
  }
  /// All chunks of a box of chunks, [low, low + size).
  void add_island(std::uint32_t island, const OpaqueAt& opaque, const IslandChunks& box) {
    ASSERT_TRUE(store_->begin_island(*uploader_, island, box));
    for (int y = 0; y < box.size.y; ++y)
      for (int x = 0; x < box.size.x; ++x)
        for (int z = 0; z < box.size.z; ++z) {
          const glm::ivec3 chunk = box.low + glm::ivec3(x, y, z);
          add(island, chunk, occupancy(opaque, chunk));
        }
  }

  /// A buffer that a shader reads besides.
  struct Table {
    std::uint32_t binding = 0;
    std::vector<std::byte> bytes;
  };
  template <class T>
  static Table table(std::uint32_t binding, const std::vector<T>& values) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span<const T>(values));
    return {binding, {bytes.begin(), bytes.end()}};
  }

  /// @param body GLSL of `Answer answer_to(Question q)`, behind the structs Question and Answer.
  template <class Answer, class Question>
  std::vector<Answer> ask(const std::string& body, const std::vector<Question>& questions,
                          const std::vector<Table>& besides = {},
                          const std::vector<gpu::SpecConstant>& constants = {}) {
    const gpu::TestShader shader("ask.comp",
                                 "#include \"include/frame/common.glsl\"\n"
                                 "#include \"include/scene/occupancy.glsl\"\n" +
                                     body + R"(
      layout(local_size_x = 64) in;
      layout(scalar, binding = 0) readonly buffer Questions { Question questions[]; };
      layout(scalar, binding = 1) writeonly buffer Answers { Answer answers[]; };
      void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i < questions.length()) answers[i] = answer_to(questions[i]);
      })");
    const std::vector<gpu::EmbeddedShader> shaders{shader.embedded()};
    gpu::Pipelines pipelines(device(), shaders);
    gpu::FrameGraph graph(&device());
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    gpu::Buffer in = buffer("questions", questions.size() * sizeof(Question), kUsage),
                out = buffer("answers", questions.size() * sizeof(Answer), kUsage);
    uploader_->write(in, 0, std::span<const Question>(questions));
    std::vector<gpu::Buffer> tables_besides;
    for (const Table& one : besides)
      tables_besides.push_back(buffer("table", one.bytes.size(), kUsage));
    for (std::size_t i = 0; i < besides.size(); ++i)
      uploader_->write(tables_besides[i], 0, std::span<const std::byte>(besides[i].bytes));
    graph.begin();
    std::vector<gpu::BufferRef> refs_besides;
    for (gpu::Buffer& one : tables_besides) refs_besides.push_back(graph.import(one));
    gpu::BufferRef from = graph.import(in), to = graph.import(out);
    const gpu::BufferRef grids = graph.import(store_->grids()),
                         tables = graph.import(store_->tables()),
                         words = graph.import(store_->words());
    graph.add_pass(
        "ask",
        [&](gpu::PassBuilder& b) {
          for (const gpu::BufferRef ref : {from, grids, tables, words})
            b.read(ref, gpu::Use::kComputeRead);
          for (const gpu::BufferRef ref : refs_besides) b.read(ref, gpu::Use::kComputeRead);
          to = b.write(to, gpu::Use::kComputeWrite);
          b.keep();
        },
        [&](gpu::Commands& c) {
          c.bind(pipelines.get(gpu::ComputeDesc{"ask.comp", constants}));
          c.storage(0, from);
          c.storage(1, to);
          c.storage(shared::kOccupancyGridsBinding, grids);
          c.storage(shared::kOccupancyTablesBinding, tables);
          c.storage(shared::kOccupancyBricksBinding, words);
          for (std::size_t i = 0; i < besides.size(); ++i)
            c.storage(besides[i].binding, refs_besides[i]);
          c.dispatch(gpu::Commands::groups(static_cast<std::uint32_t>(questions.size()), 64), 1, 1);
        });
    graph.compile();
    device().run_now([&](VkCommandBuffer commands) {
      uploader_->record(commands, UINT64_MAX);
      graph.execute(commands, 0);
    });
    const Result<std::vector<std::byte>> bytes = gpu::read_back(device(), out, 0, out.size_bytes());
    EXPECT_TRUE(bytes);
    std::vector<Answer> answers(questions.size());
    std::memcpy(answers.data(), bytes->data(), bytes->size());
    return answers;
  }

 private:
  std::unique_ptr<gpu::Uploader> uploader_;
  MemoryBudget budget_{UINT64_MAX};
  std::unique_ptr<OccupancyStore> store_;
};

}  // namespace skerry::render
