// Lights sorted into clusters on the GPU, held against what can be worked out pixel by pixel.
#include "engine/render/light/light_clusters.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <random>

#include "engine/gpu/transfer/readback.h"
#include "engine/render/frame/camera.h"
#include "engine/render/light/lights.h"
#include "shaders/shared/geometry.h"
#include "tests/gpu/test_device.h"

namespace skerry::render {
namespace {

/// Numbers that are the same with every compiler.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float in(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_()) / 4294967296.0f;
  }
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(engine_() % end); }

 private:
  std::mt19937 engine_;
};

/// A picture of depths and the camera that sees it.
struct View {
  CameraView camera;
  VkExtent2D size{};
  std::vector<float> depth;                // reverse-Z; 0 where there is nothing
  std::vector<std::vector<float>> layers;  // translucent
  bool inside_medium = false;
  std::uint32_t tile = 16;  // pixels along a cluster's
};

float depth_at(float z) {
  return kNearPlane / z;
}

/// Slanted planes in rectangles, some of them sky, from a hand's breadth to the horizon.
std::vector<float> random_depths(Random& random, VkExtent2D size) {
  std::vector<float> out(std::size_t{size.width} * size.height, 0.0f);
  for (int i = 0; i < 12; ++i) {
    const std::uint32_t x0 = random.below(size.width), y0 = random.below(size.height);
    const std::uint32_t x1 = x0 + 1 + random.below(size.width - x0),
                        y1 = y0 + 1 + random.below(size.height - y0);
    const float z = std::exp2(random.in(-3.0f, 9.0f)), slope = random.in(-0.02f, 0.02f);
    for (std::uint32_t y = y0; y < y1; ++y)
      for (std::uint32_t x = x0; x < x1; ++x)
        out[std::size_t{y} * size.width + x] =
            depth_at(z * std::exp2(slope * static_cast<float>(x - x0)));
  }
  return out;
}

View random_view(Random& random, VkExtent2D size) {
  Camera camera;
  camera.yaw_deg = random.in(0.0f, 360.0f);
  camera.pitch_deg = random.in(-80.0f, 80.0f);
  camera.fov_deg = random.in(5.0f, 150.0f);
  View view;
  view.camera = view_of(camera, size.width, size.height);
  view.size = size;
  view.depth = random_depths(random, size);
  return view;
}

/// Where a pixel's centre lies at a distance along the view axis.
glm::dvec3 place(const View& view, std::uint32_t x, std::uint32_t y, double z) {
  const double u = (2.0 * x + 1.0) / view.size.width - 1.0,
               v = (2.0 * y + 1.0) / view.size.height - 1.0;
  return (glm::dvec3(view.camera.forward) +
          glm::dvec3(view.camera.right) * (u * view.camera.tan_half_x) -
          glm::dvec3(view.camera.up) * (v * view.camera.tan_half_y)) *
         z;
}

shared::Light random_light(Random& random, const View& view, float reach) {
  // Near what is seen, at all distances.
  const double z = std::exp2(random.in(-3.0f, 9.0f));
  const glm::dvec3 middle =
      place(view, random.below(view.size.width), random.below(view.size.height), z);
  shared::Light light{};
  light.range = reach * static_cast<float>(z) * random.in(0.02f, 0.6f);
  light.position = glm::vec3(middle) +
                   light.range * glm::vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1));
  light.intensity = glm::vec3(1.0f);
  light.kind = std::array{shared::kLightPoint, shared::kLightSpot, shared::kLightTube,
                          shared::kLightSphere}[random.below(4)];
  if (light.kind == shared::kLightSpot && random.below(2) == 0) light.kind |= shared::kLightDualBit;
  light.axis = {random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
  light.cos_outer = random.in(-0.9f, 0.99f);
  light.cos_inner = random.in(light.cos_outer, 1.0f);
  const Result<shared::Light> taken = checked_light(light);
  EXPECT_TRUE(taken) << taken.error().message;
  return *taken;
}

std::vector<shared::Light> random_lights(Random& random, const View& view, std::size_t count,
                                         float reach = 1.0f) {
  std::vector<shared::Light> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(random_light(random, view, reach));
  return out;
}

bool lights_up(const shared::Light& light, glm::dvec3 point) {
  const std::uint32_t kind = light.kind & shared::kLightKindMask;
  if (kind == shared::kLightDirectional) return true;
  const glm::dvec3 from = point - glm::dvec3(light.position);
  const double distance = glm::length(from);
  if (distance >= light.range) return false;
  if (kind != shared::kLightSpot) return true;
  double cosine = glm::dot(from, glm::dvec3(light.axis)) / distance;
  if ((light.kind & shared::kLightDualBit) != 0) cosine = std::abs(cosine);
  return cosine > light.cos_outer;
}

using Lists = std::map<std::uint32_t, std::vector<std::uint32_t>>;  // of occupied clusters

class LightClustersOnGpu : public gpu::GpuTest {
 protected:
  struct Sorted {
    Lists lists;
    shared::ClusterWork work{};
    shared::ClusterGrid grid{};
    std::size_t whole = 0;  // clusters whose list did not fit
  };

  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    pipelines_ = std::make_unique<gpu::Pipelines>(device());
    graph_ = std::make_unique<gpu::FrameGraph>(&device());
    uploader_ = std::make_unique<gpu::Uploader>(device(), gpu::UploadPath::kUpdateBuffer);
    clusters_ = std::make_unique<LightClusters>(device());
  }
  void TearDown() override {
    clusters_.reset();
    uploader_.reset();
    graph_.reset();
    pipelines_.reset();
    GpuTest::TearDown();
  }

  Sorted sorted(const View& view, std::span<const shared::Light> lights) {
    SceneRefs scene;
    scene.size = view.size;
    scene.point_sampler = *device().sampler({VK_FILTER_NEAREST, VK_FILTER_NEAREST});
    EXPECT_TRUE(clusters_->upload(
        *uploader_, lights, {}, {}, view.camera,
        {view.size, {0, 0, view.size.width, view.size.height}, view.inside_medium, view.tile}));
    std::vector<gpu::Image> images;
    images.reserve(2 + view.layers.size());
    images.push_back(image(view, VK_FORMAT_R32_UINT, std::vector<float>(view.depth.size())));
    images.push_back(image(view, VK_FORMAT_R32_SFLOAT, view.depth));
    for (const std::vector<float>& layer : view.layers)
      images.push_back(image(view, VK_FORMAT_R32_SFLOAT, layer));
    graph_->begin();
    gpu::Buffer islands = texel_buffer("islands", sizeof(shared::IslandTransform));  // not read
    scene.islands = graph_->import(islands);
    ClusterDepths depths;
    depths.surfaces = graph_->import(images[0]);
    depths.depth = graph_->import(images[1]);
    for (std::size_t k = 0; k < view.layers.size(); ++k)
      depths.layers[depths.layer_count++] = graph_->import(images[2 + k]);
    const ClusteredLights found = clusters_->add(*graph_, *pipelines_, scene, depths, false);
    Sorted out;
    out.grid = clusters_->grid();
    const std::uint64_t cluster_bytes = std::uint64_t{out.grid.tiles_x} * out.grid.tiles_y *
                                        shared::kClusterSlices * sizeof(shared::Cluster);
    const std::uint64_t entry_bytes = std::uint64_t{out.grid.capacity} << (out.grid.unit_log2 + 2);
    gpu::Buffer clusters = back(cluster_bytes), entries = back(entry_bytes),
                work = back(sizeof(shared::ClusterWork));
    copy({found.clusters, found.entries, clusters_->work()}, {&clusters, &entries, &work});
    graph_->compile();
    device().run_now([&](VkCommandBuffer commands) {
      uploader_->record(commands, UINT64_MAX);
      graph_->execute(commands, 0);
    });
    out.work = contents<shared::ClusterWork>(work)[0];
    clusters_->learn(out.grid, out.work);
    unpack(view, contents<shared::Cluster>(clusters), contents<std::uint32_t>(entries), out);
    return out;
  }

  /// The slice of a distance, by its definition: two an octave from one block on.
  static std::uint32_t slice_of(float z) {
    if (z < 1.0f) return 0;
    int octave = 0;
    const float mantissa = std::frexp(z, &octave);  // z = mantissa * 2^octave, from 0.5 below 1
    const int slice = 2 * (octave - 1) + (mantissa >= 0.75f ? 1 : 0) + 1;
    return std::min<std::uint32_t>(static_cast<std::uint32_t>(slice), shared::kClusterSlices - 1);
  }
  static std::uint32_t cluster_of(const View& view, std::uint32_t x, std::uint32_t y, float z) {
    const std::uint32_t tiles_x = (view.size.width + view.tile - 1) / view.tile;
    return (y / view.tile * tiles_x + x / view.tile) * shared::kClusterSlices + slice_of(z);
  }
  /// Calls see(x, y, z) for each surface of a view.
  template <class See>
  static void each_surface(const View& view, See&& see) {
    std::vector<const std::vector<float>*> all{&view.depth};
    for (const std::vector<float>& layer : view.layers) all.push_back(&layer);
    for (const std::vector<float>* depths : all)
      for (std::uint32_t y = 0; y < view.size.height; ++y)
        for (std::uint32_t x = 0; x < view.size.width; ++x)
          if (const float d = (*depths)[std::size_t{y} * view.size.width + x]; d > 0.0f)
            see(x, y, kNearPlane / d);
  }

  /// Every light that reaches a surface is in the list of the surface's cluster.
  static void expect_nothing_lost(const View& view, std::span<const shared::Light> lights,
                                  const Sorted& found) {
    std::size_t lost = 0, surfaces = 0;
    each_surface(view, [&](std::uint32_t x, std::uint32_t y, float z) {
      const auto list = found.lists.find(cluster_of(view, x, y, z));
      ASSERT_NE(list, found.lists.end());
      const glm::dvec3 point = place(view, x, y, z);
      ++surfaces;
      for (std::uint32_t i = 0; i < lights.size(); ++i)
        if (lights_up(lights[i], point) &&
            !std::binary_search(list->second.begin(), list->second.end(), i))
          ++lost;
    });
    EXPECT_EQ(lost, 0u);
    EXPECT_GT(surfaces, 0u);
  }
  /// Lists are in the lights' order, and a light in one touches the ball around its surfaces.
  static void expect_nothing_far(const View& view, std::span<const shared::Light> lights,
                                 const Sorted& found) {
    std::map<std::uint32_t, std::pair<glm::dvec3, glm::dvec3>> boxes;  // of tiles, slices' parts
    each_surface(view, [&](std::uint32_t x, std::uint32_t y, float z) {
      const std::uint32_t id = cluster_of(view, x, y, z);
      const std::uint32_t slice = id % shared::kClusterSlices;
      const double low = slice == 0 ? 0.0 : std::exp2((slice - 1) / 2) * (slice % 2 ? 1.0 : 1.5);
      const double high = slice == 0 ? 1.0 : low * 1.5;
      auto [box, fresh] = boxes.try_emplace(id, glm::dvec3(INFINITY), glm::dvec3(-INFINITY));
      if (!fresh) return;
      for (const std::uint32_t corner : {0u, 1u, 2u, 3u})
        for (const double end : {low, std::min(high, 1e4)}) {
          const glm::dvec3 at = place(view, (x / view.tile + (corner & 1)) * view.tile,
                                      (y / view.tile + (corner >> 1)) * view.tile, end);
          box->second.first = glm::min(box->second.first, at);
          box->second.second = glm::max(box->second.second, at);
        }
    });
    std::size_t far = 0;
    for (const auto& [id, list] : found.lists) {
      EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
      EXPECT_EQ(std::adjacent_find(list.begin(), list.end()), list.end());
      if (id % shared::kClusterSlices == shared::kClusterSlices - 1 || !boxes.contains(id))
        continue;
      const auto& [low, high] = boxes.at(id);
      for (const std::uint32_t i : list) {
        if ((lights[i].kind & shared::kLightKindMask) == shared::kLightDirectional) continue;
        const double apart = glm::length(glm::dvec3(lights[i].position) - 0.5 * (low + high));
        if (apart > lights[i].range * 1.001 + 0.51 * glm::length(high - low) + 1e-3) ++far;
      }
    }
    EXPECT_EQ(far, 0u);
  }

 private:
  gpu::Buffer back(std::uint64_t bytes) {
    Result<gpu::Buffer> made = device().create_buffer({"back", bytes,
                                                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                                           VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                                       gpu::Memory::kDevice});
    EXPECT_TRUE(made);
    return *std::move(made);
  }
  gpu::Image image(const View& view, VkFormat format, const std::vector<float>& texels) {
    Result<gpu::Image> made =
        device().create_image({.name = "test depths",
                               .format = format,
                               .extent = view.size,
                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    EXPECT_TRUE(made);
    EXPECT_TRUE(uploader_->fill_image(*made, std::as_bytes(std::span(texels))));
    return *std::move(made);
  }
  void copy(const std::vector<gpu::BufferRef>& from, const std::vector<gpu::Buffer*>& to) {
    std::vector<gpu::BufferRef> targets;
    for (gpu::Buffer* one : to) targets.push_back(graph_->import(*one));
    graph_->add_pass(
        "copy_back",
        [&](gpu::PassBuilder& b) {
          for (const gpu::BufferRef ref : from) b.read(ref, gpu::Use::kTransferRead);
          for (gpu::BufferRef& ref : targets) ref = b.write(ref, gpu::Use::kTransferWrite);
        },
        [from, &written = written_, to](gpu::Commands& c) {
          for (std::size_t i = 0; i < from.size(); ++i)
            c.copy(from[i], written[i], 0, 0, to[i]->size_bytes());
        });
    written_ = targets;
  }
  static void unpack(const View& view, const std::vector<shared::Cluster>& clusters,
                     const std::vector<std::uint32_t>& entries, Sorted& out) {
    each_surface(view, [&](std::uint32_t x, std::uint32_t y, float z) {
      const std::uint32_t id = cluster_of(view, x, y, z);
      auto [list, fresh] = out.lists.try_emplace(id);
      if (!fresh) return;
      const shared::Cluster c = clusters[id];
      if (c.first == shared::kAllLights) {
        ++out.whole;
        for (std::uint32_t i = 0; i < c.count; ++i) list->second.push_back(i);
        return;
      }
      ASSERT_LE(std::uint64_t{c.first} + c.count, entries.size());
      list->second.assign(entries.begin() + c.first, entries.begin() + c.first + c.count);
    });
  }

  std::unique_ptr<gpu::Pipelines> pipelines_;
  std::unique_ptr<gpu::FrameGraph> graph_;
  std::unique_ptr<gpu::Uploader> uploader_;
  std::unique_ptr<LightClusters> clusters_;
  std::vector<gpu::BufferRef> written_;
};

TEST_F(LightClustersOnGpu, ListsOfRandomViewsHoldWhatReachesTheirSurfacesAndNothingFar) {
  Random random(1);
  const VkExtent2D sizes[] = {{97, 61}, {64, 64}, {16, 130}, {130, 33}, {200, 120}};
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    View view = random_view(random, sizes[round % 5]);
    view.tile = 8u << round % 4;
    const std::vector<shared::Light> lights = random_lights(random, view, 100);
    const Sorted found = sorted(view, lights);
    EXPECT_EQ(found.work.clusters, found.lists.size());
    EXPECT_EQ(found.whole, 0u);
    expect_nothing_lost(view, lights, found);
    expect_nothing_far(view, lights, found);
  }
}

TEST_F(LightClustersOnGpu, AnyNumberOfLightsIsSorted) {
  Random random(2);
  for (const std::size_t count : {1u, 31u, 32u, 33u, 255u, 256u, 257u, 8192u, 65536u}) {
    SCOPED_TRACE(count);
    const View view = random_view(random, {64, 48});
    const std::vector<shared::Light> lights = random_lights(random, view, count);
    const Sorted found = sorted(view, lights);
    expect_nothing_lost(view, lights, found);
    expect_nothing_far(view, lights, found);
  }
}

TEST_F(LightClustersOnGpu, TranslucentSurfacesHaveClustersToo) {
  Random random(3);
  for (std::size_t layers = 1; layers <= 4; ++layers) {
    View view = random_view(random, {90, 70});
    for (std::size_t k = 0; k < layers; ++k)
      view.layers.push_back(random_depths(random, view.size));
    const std::vector<shared::Light> lights = random_lights(random, view, 150);
    expect_nothing_lost(view, lights, sorted(view, lights));
  }
}

TEST_F(LightClustersOnGpu, NoListHasACap) {
  Random random(4);
  View view = random_view(random, {160, 128});
  std::fill(view.depth.begin(), view.depth.end(), depth_at(5.0f));
  std::vector<shared::Light> lights = random_lights(random, view, 10000);
  for (shared::Light& light : lights) {
    light.kind = shared::kLightPoint;
    light.range = 1e5f;
  }
  std::vector<std::uint32_t> all(lights.size());
  std::iota(all.begin(), all.end(), 0u);
  const auto expect_all = [&](const Sorted& found) {
    EXPECT_EQ(found.lists.size(), 80u);
    for (const auto& [id, list] : found.lists) EXPECT_EQ(list, all) << id;
  };
  Sorted found = sorted(view, lights);
  expect_all(found);
  EXPECT_GT(found.work.units, found.grid.capacity) << "the first frame has too little room";
  EXPECT_GT(found.whole, 0u);
  found = sorted(view, lights);
  expect_all(found);
  EXPECT_EQ(found.whole, 0u) << "the second has enough";
}

TEST_F(LightClustersOnGpu, ListsDoNotDependOnTiming) {
  Random random(5);
  const View view = random_view(random, {200, 120});
  const std::vector<shared::Light> lights = random_lights(random, view, 700);
  const Lists first = sorted(view, lights).lists;
  for (int again = 0; again < 3; ++again) EXPECT_EQ(sorted(view, lights).lists, first);
}

TEST_F(LightClustersOnGpu, DirectionalLightsReachEverything) {
  Random random(6);
  const View view = random_view(random, {100, 60});
  std::vector<shared::Light> lights = random_lights(random, view, 50);
  lights[20].kind = shared::kLightDirectional;
  const Sorted found = sorted(view, lights);
  for (const auto& [id, list] : found.lists)
    EXPECT_TRUE(std::binary_search(list.begin(), list.end(), 20u)) << id;
}

TEST(ClusterGrid, TheRoomCounterCannotWrapHoweverManyLightsReachAllClusters) {
  const CameraView camera = view_of({}, 7680, 4320);
  for (const std::uint32_t lights : {1u, 1000u, 65536u, 2097120u}) {
    const shared::ClusterGrid g = cluster_grid(camera, {{7680, 4320}}, lights, 1u << 20, 8);
    const std::uint64_t units = std::uint64_t{(lights - 1) >> g.unit_log2} + 1;
    EXPECT_LT(std::uint64_t{g.tiles_x} * g.tiles_y * shared::kClusterSlices * units, 1ull << 32);
    EXPECT_LE(std::uint64_t{g.capacity} << g.unit_log2, 1u << 20);
  }
}

TEST(ClusterGrid, MoreLightsThanADeviceCanSortAreCounted) {
  gpu::DeviceLimits limits;
  limits.max_storage_range = 256u << 20;
  limits.max_texels = 1u << 27;
  EXPECT_EQ(most_lights(limits, {{1920, 1080}}), 2097120u);
  EXPECT_EQ(most_lights(limits, {{15360, 8640}}), 32u * ((64u << 20) / (240 * 135)));
  limits.max_storage_range = 1u << 20;
  EXPECT_EQ(most_lights(limits, {{64, 64}}), (1u << 20) / sizeof(shared::Light));
  limits.max_texels = 1u << 16;
  EXPECT_EQ(most_lights(limits, {{64, 64}}), (1u << 16) / shared::kLightTexels);
}

TEST(LightsInView, OnlyThoseThatTouchTheFrustumAndShineAreKeptInOrder) {
  const CameraView camera = view_of({}, 100, 100);
  shared::CullView view{};
  for (std::size_t i = 0; i < camera.planes.size(); ++i) view.planes[i] = camera.planes[i];
  std::vector<shared::Light> lights(6);
  for (shared::Light& light : lights) {
    light.range = 2.0f;
    light.intensity = glm::vec3(1.0f);
  }
  lights[0].position = {0.0f, 0.0f, 10.0f};  // ahead
  lights[1].position = {0.0f, 0.0f, -3.0f};  // behind
  lights[2].position = {0.0f, 0.0f, -1.5f};  // behind, reaching
  lights[3].position = {0.0f, 0.0f, 12.0f};  // ahead, dark
  lights[3].intensity = glm::vec3(0.0f);
  lights[4].position = {40.0f, 0.0f, 10.0f};  // aside
  lights[5].kind = shared::kLightDirectional;
  const std::vector<shared::Light> kept = lights_in_view(lights, view);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[0].position, lights[0].position);
  EXPECT_EQ(kept[1].position, lights[2].position);
  EXPECT_EQ(kept[2].kind, shared::kLightDirectional);
}

}  // namespace
}  // namespace skerry::render
