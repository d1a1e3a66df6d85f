#include "tools/skerry/bench/bench_cull.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "engine/render/renderer/renderer.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

constexpr int kFrames = 15;
/// While sections are made a GPU has nothing to do, and lowers its clocks to a third.
constexpr std::chrono::milliseconds kBusyFirst{500};
constexpr std::uint64_t kUploadBudget = 256u << 20;

struct CullCase {
  std::uint32_t sections;
  double fov_deg;
};
/// The last shows less than 1% of its sections.
constexpr CullCase kCases[] = {{1'000, 70.0},   {10'000, 70.0},    {100'000, 70.0},
                               {400'000, 70.0}, {1'000'000, 70.0}, {1'000'000, 20.0}};

/// One face in each opaque range, so that every section can make draws.
std::array<shared::Quad, 6> six_faces() {
  std::array<shared::Quad, 6> quads{};
  for (std::uint32_t face = 0; face < 6; ++face)
    quads[face] = {face | face << 6 | face << 12, 1u | face << shared::kFaceShift};
  return quads;
}

/// Sections on a cube lattice with the camera in the middle.
Result<void> fill(render::Renderer& renderer, std::uint32_t count) {
  const std::array<shared::Quad, 6> quads = six_faces();
  std::int32_t edge = 1;
  while (static_cast<std::uint32_t>(edge * edge * edge) < count) ++edge;
  for (std::uint32_t i = 0; i < count; ++i) {
    shared::Section section{};
    const auto n = static_cast<std::int32_t>(i);
    section.origin = 64 * (glm::ivec3(n % edge, n / edge % edge, n / edge / edge) - edge / 2);
    section.bounds_max = 6u | 6u << 7 | 6u << 14;
    for (std::uint32_t r = 0; r < shared::kRangeCount; ++r)
      section.range_end[r] = std::min(r + 1, 6u);
    if (Result<render::SectionId> added =
            renderer.geometry().add(renderer.mesh_uploader(), section, quads);
        !added)
      return added.error();
  }
  return {};
}

}  // namespace

int bench_cull(const BenchCullOptions& options) {
  game::SceneOptions scene;
  scene.device = options.device;
  scene.validate = options.validate;
  Result<std::unique_ptr<gpu::Device>> device = open_device(scene);
  if (!device) return fail(kNoDevice, device.error());
  const std::vector<shared::Material> materials(2);
  const std::array<render::IslandPlacement, 1> islands{};
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  fmt::print("{:>9} {:>9} {:>10} {:>10} {:>10} {:>14}\n", "sections", "passed", "ms median",
             "ms p10", "ms p90", "sections/ms");
  for (const auto [count, fov_deg] : kCases) {
    render::RendererDesc desc;
    desc.materials = materials;
    desc.upload_budget_bytes = kUploadBudget;
    desc.arena_quads = count * 6;
    Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(**device, desc);
    if (!renderer) return fail(kFailed, renderer.error());
    if (Result<void> filled = fill(**renderer, count); !filled)
      return fail(kFailed, filled.error());
    render::FrameInput input;
    input.islands = islands;
    input.sky = render::celestial_at(0.0, 0.0);  // a night without moon: the camera's view alone
    input.camera.fov_deg = fov_deg;
    std::vector<double> ms;
    const auto timed_from = std::chrono::steady_clock::now() + kBusyFirst;
    while (ms.size() < kFrames) {
      const bool is_timed = std::chrono::steady_clock::now() >= timed_from;
      input.camera.yaw_deg += 10.0;
      if (Result<std::uint64_t> drawn = (*renderer)->draw(input, {}, {64, 64}); !drawn)
        return fail(kFailed, drawn.error());
      (*renderer)->finish();
      double sum = 0.0;
      for (const gpu::PassTime& pass : (*renderer)->report()->passes)
        if (pass.name == "cull_sections" || pass.name == "cull_scan" || pass.name == "cull_emit")
          sum += pass.ms;
      if (is_timed) ms.push_back(sum);
    }
    const Spread spread = spread_of(ms);
    const std::uint32_t passed = (*renderer)->report()->camera.sections_passed;
    rows.push_back({{"device", (*device)->info().name},
                    {"sections", count},
                    {"passed", passed},
                    {"ms_median", spread.median},
                    {"ms_p10", spread.p10},
                    {"ms_p90", spread.p90},
                    {"sections_per_ms", count / spread.median}});
    fmt::print("{:>9} {:>9} {:>10.3f} {:>10.3f} {:>10.3f} {:>14.0f}\n", count, passed,
               spread.median, spread.p10, spread.p90, count / spread.median);
  }
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
