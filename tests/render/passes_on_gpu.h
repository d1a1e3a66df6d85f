#pragma once
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/transfer/readback.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/light/shadow_maps.h"
#include "engine/render/light/shadow_pass.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/scene/cull_pass.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/geometry_pass.h"
#include "engine/render/scene/geometry_store.h"
#include "tests/gpu/compile_glsl.h"
#include "tests/gpu/test_device.h"
#include "tests/render/random_scenes.h"
#include "tests/render/voxel_chunks.h"

namespace skerry::render {

/// The renderer's own passes, one by one, with what they write read back. Opaque blocks only.
class PassesOnGpu : public gpu::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    shaders_.assign(gpu::embedded_shaders().begin(), gpu::embedded_shaders().end());
    shaders_.push_back(copy_layer_.embedded());
    shaders_.push_back(decode_.embedded());
    pipelines_ = std::make_unique<gpu::Pipelines>(device(), shaders_);
    graph_ = std::make_unique<gpu::FrameGraph>(&device());
    uploader_ = std::make_unique<gpu::Uploader>(device(), gpu::UploadPath::kUpdateBuffer);
    shadows_ = std::make_unique<ShadowMaps>(device());
    Result<std::unique_ptr<GeometryStore>> store =
        GeometryStore::create(device(), budget_, {}, 1u << 12);
    ASSERT_TRUE(store) << store.error().message;
    store_ = *std::move(store);
    std::vector<std::uint16_t> index(shared::kMaxQuadsPerDraw * 6);
    constexpr std::array<unsigned, 6> kCorners{0, 1, 2, 0, 2, 3};
    for (std::size_t i = 0; i < index.size(); ++i)
      index[i] = static_cast<std::uint16_t>(i / 6 * 4 + kCorners[i % 6]);
    indices_ = buffer("quad indices", index.size() * 2,
                      VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    uploader_->write(indices_, 0, std::span<const std::uint16_t>(index));
    coverage_ = image({.name = "block coverage",
                       .format = VK_FORMAT_R16_SFLOAT,
                       .extent = {1, 1},
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                       .array = true});
    ASSERT_TRUE(uploader_->fill_image(coverage_, std::vector<std::byte>(2)));
  }
  void TearDown() override {
    tables_.clear();
    coverage_ = {};
    indices_ = {};
    store_.reset();
    shadows_.reset();
    uploader_.reset();
    graph_.reset();
    pipelines_.reset();
    GpuTest::TearDown();
  }

  GeometryStore& store() { return *store_; }
  gpu::Uploader& uploader() { return *uploader_; }
  /// Decides on cascades as a frame does that is then submitted.
  ShadowPlan next_shadows(const FrameInput& input, const RenderSettings& settings,
                          const GeometryChanges& changes,
                          std::optional<std::span<const shared::Section>> sections = {}) {
    ShadowPlan plan = plan_shadows(input, settings, sections.value_or(store_->records()), changes,
                                   shadow_history_, shadows_->generation());
    const Result<void> made = shadows_->ensure(plan.layout);
    EXPECT_TRUE(made);
    shadow_history_ = plan.next;
    shadow_history_.generation = shadows_->generation();
    return plan;
  }
  std::vector<ActiveCascade> update_shadows(const FrameInput& input, const RenderSettings& settings,
                                            const GeometryChanges& changes) {
    return next_shadows(input, settings, changes).cascades;
  }
  void invalidate_shadows() { shadow_history_ = {}; }
  ShadowHistory& shadow_history() { return shadow_history_; }

  struct Drawn {
    std::vector<std::uint32_t> words;  ///< G-buffer words, rows from the top; 0: no surface
    std::vector<float> depth;
    shared::CullStats stats{};
  };
  /// Culls and draws the camera's view.
  Drawn drawn(const FrameInput& input, VkExtent2D size) {
    const FrameTables tables = build_tables(input, {}, size, {});
    const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
    gpu::Buffer words = back("words", pixels * 4), depth = back("depth values", pixels * 4),
                stats = back("stats", sizeof(shared::CullStats));
    const SceneRefs scene = begin(input, size, tables);
    const CulledDraws draws = cull(scene, 1);
    const Geometry geometry =
        GeometryPass::add(*graph_, *pipelines_, scene, draws, {GBufferStore{}, false, false, true});
    const gpu::ImageRef surfaces = geometry.surfaces(), depths = geometry.depth();
    gpu::BufferRef words_ref = graph_->import(words), depth_ref = graph_->import(depth),
                   stats_ref = graph_->import(stats);
    graph_->add_pass(
        "read_back",
        [&](gpu::PassBuilder& b) {
          b.read(surfaces, gpu::Use::kTransferRead);
          b.read(depths, gpu::Use::kTransferRead);
          b.read(draws.stats, gpu::Use::kTransferRead);
          for (gpu::BufferRef* ref : {&words_ref, &depth_ref, &stats_ref})
            *ref = b.write(*ref, gpu::Use::kTransferWrite);
        },
        [=, from_stats = draws.stats](gpu::Commands& c) {
          c.copy(surfaces, words_ref);
          c.copy(depths, depth_ref);
          c.copy(from_stats, stats_ref, 0, 0, sizeof(shared::CullStats));
        });
    run();
    Drawn out;
    out.words = contents<std::uint32_t>(words);
    out.depth = contents<float>(depth);
    out.stats = contents<shared::CullStats>(stats)[0];
    for (std::size_t i = 0; i < out.words.size(); ++i)
      if (out.depth[i] == 0.0f) out.words[i] = 0;  // it has any value there
    return out;
  }

  struct DrawnStored {
    std::vector<glm::vec3> normals, positions;  ///< decoded as shading does
  };
  /// Draws the camera's view into a G-buffer that keeps normals and positions.
  DrawnStored drawn_stored(const FrameInput& input, VkExtent2D size, const GBufferStore& store) {
    const FrameTables tables = build_tables(input, {}, size, {});
    const std::uint64_t bytes = std::uint64_t{size.width} * size.height * sizeof(glm::vec3);
    gpu::Buffer normals = back("normal values", bytes), positions = back("position values", bytes);
    SceneRefs scene = begin(input, size, tables);
    scene.islands = texel_table("island transforms", tables.islands);
    const CulledDraws draws = cull(scene, 1);
    const SurfaceReads surfaces(
        GeometryPass::add(*graph_, *pipelines_, scene, draws, {store, false, false, true}));
    gpu::BufferRef to_normals = graph_->import(normals), to_positions = graph_->import(positions);
    const VkSampler point = *device().sampler({VK_FILTER_NEAREST, VK_FILTER_NEAREST});
    graph_->add_pass(
        "decode",
        [&](gpu::PassBuilder& b) {
          surfaces.declare(b);
          to_normals = b.write(to_normals, gpu::Use::kComputeWrite);
          to_positions = b.write(to_positions, gpu::Use::kComputeWrite);
        },
        [&](gpu::Commands& c) {
          c.bind(pipelines_->get(gpu::ComputeDesc{"decode.comp", surfaces.with_store({})}));
          c.sampled(13, surfaces.normals, point);
          c.sampled(14, surfaces.positions, point);
          c.storage(0, to_normals);
          c.storage(1, to_positions);
          c.dispatch(size.width / 8, size.height / 8, 1);
        });
    run();
    return {contents<glm::vec3>(normals), contents<glm::vec3>(positions)};
  }

  struct DrawnMaps {
    std::vector<bool> redrawn;    ///< a cascade
    std::vector<VkRect2D> areas;  ///< of each, what was drawn of it
    std::vector<float> texels;    ///< of all cascades
    std::size_t parts = 0;        ///< drawn of maps that are not shown yet
  };
  /// Brings the shadow maps up to date and reads all of them.
  DrawnMaps shadow_maps(const FrameInput& input, const RenderSettings& settings) {
    const ShadowPlan plan = next_shadows(input, settings, store_->changes());
    const auto edge = static_cast<std::uint32_t>(settings.shadow_size);
    DrawnMaps out;
    out.parts = plan.ahead.size();
    std::vector<ShadowDraw> shown, draws_of_maps;
    std::uint32_t view = 1;
    for (const ActiveCascade& c : plan.cascades) {
      out.redrawn.push_back(c.redraw);
      out.areas.push_back(c.area);
      if (c.redraw) shown.push_back({view++, c.layer, "draw_shadow", false, c.area});
    }
    for (const PartAhead& part : plan.ahead)
      draws_of_maps.push_back(
          {view++, part.layer, "draw_shadow", false, {{0, 0}, {edge, edge}}, part.clear});
    draws_of_maps.insert(draws_of_maps.end(), shown.begin(), shown.end());
    constexpr VkExtent2D kSize{8, 8};
    const FrameTables tables = build_tables(input, settings, kSize, plan.cascades, plan.ahead);
    const SceneRefs scene = begin(input, kSize, tables);
    const CulledDraws draws = cull(scene, static_cast<std::uint32_t>(tables.views.size()));
    const gpu::ImageRef array =
        shadows_->maps() ? graph_->import(*shadows_->maps()) : gpu::ImageRef{};
    const Shadows maps = ShadowPass::add(*graph_, *pipelines_, scene, draws, array, draws_of_maps);
    const std::uint32_t layers = shadows_->maps() ? shadows_->maps()->desc().layers : 0;
    gpu::Buffer texels = back("texels", std::uint64_t{edge} * edge * layers * 4);
    gpu::BufferRef to = graph_->import(texels);
    const VkSampler sampler = *device().sampler({VK_FILTER_NEAREST, VK_FILTER_NEAREST});
    graph_->add_pass(
        "copy_maps",
        [&](gpu::PassBuilder& b) {
          b.read(maps.maps(), gpu::Use::kComputeSampled);
          to = b.write(to, gpu::Use::kComputeWrite);
        },
        [&, from = maps.maps()](gpu::Commands& c) {
          c.bind(pipelines_->get(gpu::ComputeDesc{"copy_layer.comp", {}}));
          c.sampled(0, from, sampler);
          c.storage(1, to);
          c.dispatch(edge / 8, edge / 8, layers);
        });
    run();
    const std::vector<float> all = contents<float>(texels);
    for (const ActiveCascade& c : plan.cascades) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(c.layer) * edge * edge;
      out.texels.insert(out.texels.end(), first, first + static_cast<std::ptrdiff_t>(edge) * edge);
    }
    return out;
  }

 private:
  gpu::Buffer back(const char* name, std::uint64_t bytes) {
    return buffer(name, bytes,
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  template <class T>
  gpu::BufferRef table(const char* name, const std::vector<T>& values) {
    gpu::Buffer& made =
        *tables_.emplace_back(std::make_unique<gpu::Buffer>(back(name, values.size() * sizeof(T))));
    uploader_->write(made, 0, std::span<const T>(values));
    return graph_->import(made);
  }
  /// The same, for shaders that fetch texels.
  template <class T>
  gpu::BufferRef texel_table(const char* name, const std::vector<T>& values) {
    gpu::Buffer& made = *tables_.emplace_back(
        std::make_unique<gpu::Buffer>(texel_buffer(name, values.size() * sizeof(T))));
    uploader_->write(made, 0, std::span<const T>(values));
    return graph_->import(made);
  }
  SceneRefs begin(const FrameInput& input, VkExtent2D size, const FrameTables& tables) {
    tables_.clear();
    graph_->begin();
    SceneRefs scene;
    scene.frame = table("frame constants", std::vector<shared::FrameConstants>{tables.constants});
    scene.islands = table("island transforms", tables.islands);
    scene.views = table("cull views", tables.views);
    scene.clip_from_source = tables.matrices;
    scene.edge_growth = tables.edge_growth;
    scene.quads = graph_->import(store_->quads());
    scene.sections = graph_->import(store_->sections());
    scene.indices = graph_->import(indices_);
    // Bound, though opaque blocks are drawn without.
    scene.materials = table("materials", std::vector<shared::Material>(shared::kMaxMaterials));
    scene.block_coverage = graph_->import(coverage_);
    scene.block_sampler = *device().sampler({VK_FILTER_NEAREST, VK_FILTER_NEAREST});
    scene.islands_per_view = static_cast<std::uint32_t>(input.islands.size());
    scene.size = size;
    return scene;
  }
  CulledDraws cull(const SceneRefs& scene, std::uint32_t views) {
    return add_cull_passes(*graph_, *pipelines_, scene,
                           {store_->section_slots(), store_->most_draws(), views});
  }
  void run() {
    graph_->compile();
    device().run_now([&](VkCommandBuffer commands) {
      uploader_->record(commands, UINT64_MAX);
      graph_->execute(commands, 0);
    });
  }

  static constexpr const char* kCopyLayer = R"(
    layout(local_size_x = 8, local_size_y = 8) in;
    layout(binding = 0) uniform sampler2DArray maps;
    layout(scalar, binding = 1) writeonly buffer To { float texels[]; };
    void main() {
      uvec3 at = gl_GlobalInvocationID, size = gl_NumWorkGroups * uvec3(8, 8, 1);
      texels[(at.z * size.y + at.y) * size.x + at.x] = texelFetch(maps, ivec3(at), 0).r;
    })";
  static constexpr const char* kDecode =
      "#include \"include/scene/stored.glsl\"\n"
      R"(
    layout(local_size_x = 8, local_size_y = 8) in;
    layout(constant_id = 4) const uint kNormalCode = 0u;
    layout(binding = 13) uniform sampler2D normals;
    layout(binding = 14) uniform sampler2D positions;
    layout(scalar, binding = 0) writeonly buffer Normals { vec3 normal_of[]; };
    layout(scalar, binding = 1) writeonly buffer Positions { vec3 position_of[]; };
    void main() {
      uvec2 at = gl_GlobalInvocationID.xy;
      uint i = at.y * gl_NumWorkGroups.x * 8u + at.x;
      normal_of[i] = normal_from_texel(texelFetch(normals, ivec2(at), 0), kNormalCode);
      position_of[i] = texelFetch(positions, ivec2(at), 0).xyz;
    })";
  gpu::TestShader decode_{"decode.comp", kDecode};
  gpu::TestShader copy_layer_{"copy_layer.comp", kCopyLayer};
  std::vector<gpu::EmbeddedShader> shaders_;
  std::unique_ptr<gpu::Pipelines> pipelines_;
  std::unique_ptr<gpu::FrameGraph> graph_;
  std::unique_ptr<gpu::Uploader> uploader_;
  std::unique_ptr<ShadowMaps> shadows_;
  ShadowHistory shadow_history_;
  MemoryBudget budget_{UINT64_MAX};
  std::unique_ptr<GeometryStore> store_;
  gpu::Buffer indices_;
  gpu::Image coverage_;
  std::vector<std::unique_ptr<gpu::Buffer>> tables_;
};

}  // namespace skerry::render
