// The formulas of shaders/include/light/brdf.glsl and lights.glsl, run on the device and held
// against closed forms, integrals and the reference's own.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/transfer/readback.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/light/lights.h"
#include "tests/gpu/compile_glsl.h"
#include "tests/gpu/test_device.h"
#include "tools/reference/brdf.h"

namespace skerry::render {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// One evaluation. `at` is a surface's point, or where light comes from for kReflectance.
struct Query {
  glm::vec3 at{0.0f};
  glm::vec3 normal{0.0f, 0.0f, 1.0f};
  glm::vec3 to_eye{0.0f, 0.0f, 1.0f};
  glm::vec3 albedo{1.0f};
  float roughness = 1.0f, metalness = 0.0f;
};
enum class Ask : std::uint32_t { kReflectance, kReflected, kReceived, kAround };

constexpr const char* kFormulas =
    "#include \"include/light/lights.glsl\"\n"
    R"(
layout(local_size_x = 64) in;
struct Query { vec3 at; vec3 normal; vec3 to_eye; vec3 albedo; float roughness; float metalness; };
layout(scalar, binding = 0) readonly buffer Queries { Query queries[]; };
layout(scalar, binding = 1) readonly buffer Lights { Light light; };
layout(scalar, binding = 2) writeonly buffer Results { vec3 results[]; };
layout(push_constant) uniform Push { uint count; uint ask; } push;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  Query q = queries[i];
  Brdf b = brdf_of(q.albedo, q.roughness, q.metalness, dot(q.normal, q.to_eye));
  results[i] = push.ask == 0u ? brdf(b, q.normal, q.to_eye, q.at, max(dot(q.normal, q.at), 0.0))
             : push.ask == 1u ? light_reflected(light, b, q.at, q.normal, q.to_eye)
           : push.ask == 2u ? light_received(light, q.at, q.normal)
                            : brdf_around(b);
})";

class LightFormulas : public gpu::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    shaders_.push_back(formulas_.embedded());
    pipelines_ = std::make_unique<gpu::Pipelines>(device(), shaders_);
  }
  void TearDown() override {
    pipelines_.reset();
    GpuTest::TearDown();
  }

  std::vector<glm::dvec3> asked(Ask ask, const std::vector<Query>& queries,
                                const shared::Light& light = {}) {
    gpu::FrameGraph graph(&device());
    gpu::Uploader uploader(device(), gpu::UploadPath::kUpdateBuffer);
    gpu::Buffer in = storage(queries.size() * sizeof(Query)), lights = storage(sizeof(light)),
                out = storage(queries.size() * sizeof(glm::vec3));
    uploader.write(in, 0, std::span<const Query>(queries));
    uploader.write(lights, 0, std::span<const shared::Light>(&light, 1));
    graph.begin();
    const gpu::BufferRef in_ref = graph.import(in), lights_ref = graph.import(lights);
    gpu::BufferRef out_ref = graph.import(out);
    graph.add_pass(
        "ask",
        [&](gpu::PassBuilder& b) {
          b.read(in_ref, gpu::Use::kComputeRead);
          b.read(lights_ref, gpu::Use::kComputeRead);
          out_ref = b.write(out_ref, gpu::Use::kComputeWrite);
        },
        [&](gpu::Commands& c) {
          c.bind(pipelines_->get(gpu::ComputeDesc{"formulas.comp", {}}));
          c.storage(0, in_ref);
          c.storage(1, lights_ref);
          c.storage(2, out_ref);
          const auto count = static_cast<std::uint32_t>(queries.size());
          const struct { std::uint32_t count, ask; } push{count, static_cast<std::uint32_t>(ask)};
          c.push(push);
          c.dispatch(gpu::Commands::groups(count, 64), 1, 1);
        });
    graph.compile();
    device().run_now([&](VkCommandBuffer commands) {
      uploader.record(commands, UINT64_MAX);
      graph.execute(commands, 0);
    });
    const Result<std::vector<std::byte>> bytes = gpu::read_back(device(), out, 0, out.size_bytes());
    EXPECT_TRUE(bytes);
    std::vector<glm::dvec3> results;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      glm::vec3 one;
      std::memcpy(&one, bytes->data() + i * sizeof(one), sizeof(one));
      results.emplace_back(one);
    }
    return results;
  }
  double received(const shared::Light& light, glm::vec3 at, glm::vec3 normal = {0, 0, 1}) {
    return asked(Ask::kReceived, {{at, normal}}, light)[0].x;
  }

 private:
  gpu::Buffer storage(std::uint64_t bytes) {
    return buffer("formulas", bytes,
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                      VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  gpu::TestShader formulas_{"formulas.comp", kFormulas};
  std::vector<gpu::EmbeddedShader> shaders_;
  std::unique_ptr<gpu::Pipelines> pipelines_;
};

glm::vec3 tilted(double cosine, double turn = 0.0) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

/// Directions of light for one eye, by the cosine and by GGX's half vectors, with the sum of both
/// densities (M. Veach's balance heuristic).
struct Samples {
  std::vector<Query> queries;
  std::vector<double> weight;  // cosine over the sum of densities, over the number of each
};
Samples samples_for(const Query& base) {
  constexpr int kRings = 96, kSpokes = 64;
  Samples out;
  const glm::dvec3 eye(base.to_eye);
  const double roughness = std::max(0.06, static_cast<double>(base.roughness));
  const double alpha2 = std::pow(roughness, 4.0);
  const auto add = [&](glm::dvec3 light) {
    if (light.z <= 0.0) return;
    const glm::dvec3 half = glm::normalize(light + eye);
    const double d = alpha2 / (kPi * std::pow(half.z * half.z * (alpha2 - 1.0) + 1.0, 2.0));
    const double density = light.z / kPi + d * half.z / (4.0 * glm::dot(half, eye));
    Query query = base;
    query.at = glm::vec3(light);
    out.queries.push_back(query);
    out.weight.push_back(light.z / density / (kRings * kSpokes));
  };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSpokes; ++j) {
      const double share = (i + 0.5) / kRings, turn = 2.0 * kPi * (j + 0.5) / kSpokes;
      add(glm::dvec3(tilted(std::sqrt(1.0 - share), turn)));
      const double cos2 = (1.0 - share) / (1.0 + (alpha2 - 1.0) * share);
      const glm::dvec3 half(tilted(std::sqrt(cos2), turn));
      if (glm::dot(half, eye) > 0.0) add(half * (2.0 * glm::dot(half, eye)) - eye);
    }
  }
  return out;
}

TEST_F(LightFormulas, AWhiteSurfaceNeverSendsMoreThanItReceives) {
  for (const float metalness : {0.0f, 0.5f, 1.0f}) {
    for (const float roughness : {0.0f, 0.1f, 0.2f, 0.35f, 0.5f, 0.65f, 0.8f, 0.9f, 1.0f}) {
      for (const double cosine : {0.03, 0.1, 0.3, 0.6, 1.0}) {
        Query base;
        base.to_eye = tilted(cosine);
        base.roughness = roughness;
        base.metalness = metalness;
        const Samples samples = samples_for(base);
        const std::vector<glm::dvec3> share = asked(Ask::kReflectance, samples.queries);
        double sum = 0.0;
        for (std::size_t i = 0; i < share.size(); ++i) sum += share[i].x * samples.weight[i];
        EXPECT_LE(sum, 1.0 + 2e-3) << metalness << " " << roughness << " " << cosine;
        EXPECT_GT(sum, metalness == 0.0f ? 0.65 : 0.3)
            << metalness << " " << roughness << " " << cosine;
      }
    }
  }
}

TEST_F(LightFormulas, EvenLightIsReflectedAsTheIntegralOverTheHalfSpaceHasIt) {
  for (const float metalness : {0.0f, 0.5f, 1.0f}) {
    for (const float roughness : {0.15f, 0.3f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1.0f}) {
      for (const double cosine : {0.05, 0.1, 0.2, 0.4, 0.7, 1.0}) {
        Query base;
        base.albedo = {0.0f, 0.1f, 0.8f};
        base.to_eye = tilted(cosine);
        base.roughness = roughness;
        base.metalness = metalness;
        const Samples samples = samples_for(base);
        const std::vector<glm::dvec3> share = asked(Ask::kReflectance, samples.queries);
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < share.size(); ++i) sum += share[i] * samples.weight[i];
        const glm::dvec3 fit = kPi * asked(Ask::kAround, {base})[0];
        const std::string where = std::to_string(metalness) + " " + std::to_string(roughness) +
                                  " " + std::to_string(cosine);
        for (int i = 0; i < 3; ++i) {
          const double mirror = 0.04 + (base.albedo[i] - 0.04) * metalness;
          const double most =
              (roughness < 0.5f ? 0.1 : 0.035) + (roughness < 0.5f ? 0.4 : 0.1) * mirror;
          EXPECT_NEAR(fit[i], sum[i], most) << where << " albedo " << base.albedo[i];
        }
      }
    }
  }
}

/// Random surfaces with light and eye before them.
std::vector<Query> random_queries(std::size_t count, float least_roughness) {
  std::mt19937 random(7);
  const auto in = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<Query> out;
  for (std::size_t i = 0; i < count; ++i) {
    Query query;
    query.at = tilted(in(0.02, 1.0), in(0.0, 7.0));
    query.to_eye = tilted(in(0.02, 1.0), in(0.0, 7.0));
    query.albedo = {in(0.0, 1.0), in(0.0, 1.0), in(0.0, 1.0)};
    query.roughness = static_cast<float>(in(least_roughness, 1.0));
    query.metalness = static_cast<float>(in(0.0, 1.0));
    out.push_back(query);
  }
  return out;
}

TEST_F(LightFormulas, LightAndEyeCanChangePlaces) {
  const std::vector<Query> there = random_queries(2000, 0.2f);
  std::vector<Query> back = there;
  for (Query& query : back) std::swap(query.at, query.to_eye);
  const std::vector<glm::dvec3> a = asked(Ask::kReflectance, there);
  const std::vector<glm::dvec3> b = asked(Ask::kReflectance, back);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[i][c], b[i][c], 1e-4 * a[i][c] + 1e-6);
}

TEST_F(LightFormulas, TheReferenceReflectsTheSame) {
  const std::vector<Query> queries = random_queries(3000, 0.15f);
  const std::vector<glm::dvec3> results = asked(Ask::kReflectance, queries);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Query& q = queries[i];
    const glm::dvec3 expected = reference::surface_brdf(
        glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(q.at)), glm::normalize(glm::dvec3(q.to_eye)),
        glm::dvec3(q.albedo), q.roughness, q.metalness);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(results[i][c], expected[c], 3e-3 * expected[c] + 1e-5) << i;
  }
}

shared::Light light_of(std::uint32_t kind) {
  shared::Light light{};
  light.position = {0.0f, 0.0f, 4.0f};
  light.range = 10.0f;
  light.intensity = glm::vec3(3.0f);
  light.kind = kind;
  light.axis = {0.0f, 0.0f, -1.0f};
  light.cos_inner = 0.9f;
  light.cos_outer = 0.7f;
  light.size = 1.0f;
  const Result<shared::Light> taken = checked_light(light);
  EXPECT_TRUE(taken);
  return *taken;
}

double window(double distance, double range) {
  return distance >= range ? 0.0 : std::pow(1.0 - std::pow(distance / range, 4.0), 2.0);
}

TEST_F(LightFormulas, APointFallsOffBySquareAndWindowAndEndsExactlyAtItsRange) {
  shared::Light light = light_of(shared::kLightPoint);
  light.position = glm::vec3(0.0f);
  for (const double distance : {0.05, 0.5, 1.0, 3.0, 7.0, 9.9}) {
    const glm::vec3 below(0.0f, 0.0f, static_cast<float>(-distance));
    const double expected = 3.0 / (distance * distance) * window(distance, 10.0);
    EXPECT_NEAR(received(light, below), expected, 1e-5 * expected + 1e-7);
    const glm::vec3 aslant(0.6f, 0.0f, 0.8f);
    EXPECT_NEAR(received(light, below, aslant), 0.8 * expected, 1e-5 * expected + 1e-7);
    EXPECT_EQ(received(light, below, {0.0f, 0.0f, -1.0f}), 0.0) << "from behind";
  }
  for (const float distance : {10.0f, 10.01f, 1e3f, 1e6f})
    EXPECT_EQ(received(light, {0.0f, 0.0f, -distance}), 0.0);
}

TEST_F(LightFormulas, ASpotIsFullWithinItsConeNoneBeyondAndSmoothBetween) {
  shared::Light light = light_of(shared::kLightSpot);
  light.position = glm::vec3(0.0f);
  const auto at = [&](double cosine) {  // at distance 2, facing the light
    const glm::vec3 away = tilted(cosine) * glm::vec3(1.0f, 1.0f, -1.0f);
    return received(light, 2.0f * away, -away) / (0.75 * window(2.0, 10.0));
  };
  for (const double cosine : {1.0, 0.95, 0.9001}) EXPECT_NEAR(at(cosine), 1.0, 1e-4) << cosine;
  for (const double cosine : {0.6999, 0.3, 0.0, -0.5, -1.0}) EXPECT_EQ(at(cosine), 0.0) << cosine;
  EXPECT_NEAR(at(0.8), 0.5, 1e-4);
  EXPECT_NEAR(at(0.75), 0.15625, 1e-4);  // 3 t^2 - 2 t^3 at t = 1/4
  light.kind |= shared::kLightDualBit;
  EXPECT_NEAR(at(-0.95), 1.0, 1e-4);
  EXPECT_NEAR(at(-0.8), 0.5, 1e-4);
  EXPECT_EQ(at(0.0), 0.0);
}

TEST_F(LightFormulas, ATubeIsTheMeanOfPointsAlongItsPartBeforeTheSurface) {
  for (const glm::vec3 axis :
       {glm::vec3(1, 0, 0), glm::vec3(0.3f, -0.5f, 0.8f), glm::vec3(0, 0, 1)}) {
    for (const float height : {0.3f, 1.0f, 4.0f}) {
      for (const float size : {0.2f, 1.5f, 3.0f}) {
        shared::Light light = light_of(shared::kLightTube);
        light.axis = glm::normalize(axis);
        light.position = {0.4f, -0.2f, height};
        light.size = size;
        constexpr int kPoints = 20000;
        double sum = 0.0;
        for (int i = 0; i < kPoints; ++i) {
          const glm::dvec3 p = glm::dvec3(light.position) +
                               glm::dvec3(light.axis) * (size * (2.0 * (i + 0.5) / kPoints - 1.0));
          if (p.z > 0.0) sum += p.z / std::pow(glm::length(p), 3.0);
        }
        const double expected =
            3.0 * sum / kPoints * window(glm::length(glm::dvec3(light.position)), 10.0);
        EXPECT_NEAR(received(light, glm::vec3(0.0f)), expected, 2e-3 * expected)
            << axis.x << " " << height << " " << size;
      }
    }
  }
}

TEST_F(LightFormulas, ASphereLightsAsAPointAndItsImageGrowsWithoutGrowingBrighter) {
  const shared::Light sphere = light_of(shared::kLightSphere);
  EXPECT_NEAR(received(sphere, glm::vec3(0.0f)), 3.0 / 16.0 * window(4.0, 10.0), 1e-6);
  // The total of a mirror image over the surface hardly depends on the light's size.
  const auto image = [&](float size) {
    shared::Light light = sphere;
    light.size = size;
    std::vector<Query> queries;
    constexpr int kEdge = 200;
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        Query query;
        query.at = {0.04f * (static_cast<float>(x) + 0.5f - 0.5f * kEdge),
                    0.04f * (static_cast<float>(y) + 0.5f - 0.5f * kEdge), 0.0f};
        query.to_eye = glm::normalize(glm::vec3(0.0f, 0.0f, 4.0f) - query.at);
        query.albedo = glm::vec3(1.0f);
        query.roughness = 0.3f;
        query.metalness = 1.0f;
        queries.push_back(query);
      }
    double sum = 0.0, most = 0.0;
    for (const glm::dvec3& one : asked(Ask::kReflected, queries, light)) {
      sum += one.x;
      most = std::max(most, one.x);
    }
    return std::pair(sum, most);
  };
  const auto [point_sum, point_most] = image(0.0f);
  for (const float size : {0.1f, 0.4f, 0.8f}) {
    const auto [sum, most] = image(size);
    EXPECT_LT(most, point_most);
    EXPECT_NEAR(sum, point_sum, 0.35 * point_sum) << size;
  }
}

TEST_F(LightFormulas, ADirectionalLightIsTheSameEverywhere) {
  const shared::Light light = light_of(shared::kLightDirectional);
  for (const float place : {0.0f, 100.0f, 1e6f})
    EXPECT_NEAR(received(light, {place, 0.0f, place}), 3.0, 1e-6);
  EXPECT_NEAR(received(light, glm::vec3(0.0f), {0.6f, 0.0f, 0.8f}), 2.4, 1e-6);
}

TEST_F(LightFormulas, EveryLightThatMayEnterGivesFiniteLightThatGrowsWithItsIntensity) {
  std::vector<Query> queries;
  for (const float distance : {0.0f, 1e-20f, 1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
    for (const glm::vec3 way : {glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0.6f, 0, -0.8f)})
      for (const float roughness : {0.0f, 0.5f, 1.0f}) {
        Query query;
        query.at = distance * way;
        query.roughness = roughness;
        queries.push_back(query);
      }
  for (std::uint32_t kind = 0; kind < shared::kLightKindCount; ++kind) {
    for (const float range : {1e-6f, 1e-3f, 1.0f, 1e6f}) {
      for (const float size : {0.0f, 1.0f, 1e3f}) {
        std::vector<double> last(queries.size(), 0.0);
        for (const float intensity : {0.0f, 1e-8f, 1e-3f, 1.0f, 1e4f, 1e8f}) {
          shared::Light light = light_of(kind);
          light.position = glm::vec3(0.0f);
          light.range = range;
          light.size = size;
          light.intensity = glm::vec3(intensity);
          const Result<shared::Light> taken = checked_light(light);
          ASSERT_TRUE(taken) << taken.error().message;
          const std::vector<glm::dvec3> results = asked(Ask::kReflected, queries, *taken);
          for (std::size_t i = 0; i < results.size(); ++i) {
            ASSERT_TRUE(std::isfinite(results[i].x)) << kind << " " << range << " " << size;
            ASSERT_GE(results[i].x, last[i]) << kind << " " << range << " " << size;
            last[i] = results[i].x;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace skerry::render
