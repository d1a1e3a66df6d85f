#include "tools/skerry/shot/shot.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "engine/core/clock.h"
#include "engine/core/output.h"
#include "engine/platform/image_file.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/shot/shot_reference.h"

namespace skerry::tools {
namespace {

using nlohmann::ordered_json;

ordered_json stats_json(const gpu::Device& device, game::SceneView& view, const Drawn& drawn,
                        const ordered_json& cpu_ms) {
  const render::FrameReport& report = drawn.report;
  ordered_json j;
  j["device"] = device.info().name;
  j["driver"] = device.info().driver;
  j["size"] = {drawn.size.width, drawn.size.height};
  j["image_sha256"] = sha256_hex(drawn.rgba);
  ordered_json passes = ordered_json::object();
  for (const gpu::PassTime& pass : report.passes) passes[pass.name] = pass.ms;
  j["gpu_ms"] = {{"total", report.gpu_ms}, {"passes", passes}};
  j["cpu_ms"] = cpu_ms;
  j["passes"] = view.renderer().graph().pass_names();
  j["left_out"] = ordered_json::array();
  for (const gpu::LeftOut& out : view.renderer().graph().left_out())
    j["left_out"].push_back({{"name", out.name}, {"why", out.why}});
  j["quads"] = {{"resident", view.renderer().geometry().quads_resident()},
                {"drawn", report.camera.quads},
                {"drawn_in_shadows", report.shadows.quads}};
  j["chunks"] = {{"resident", view.renderer().geometry().sections_resident()},
                 {"drawn", report.camera.sections_passed}};
  j["draws"] = {{"camera", report.camera.draws}, {"shadows", report.shadows.draws}};
  j["lights"] = view.lights();
  ordered_json by = ordered_json::object();
  for (const gpu::MemoryUse& use : device.memory_use())
    by[use.name] = by.value(use.name, std::uint64_t{0}) + use.bytes;
  j["memory"] = {{"gpu_bytes", device.memory_total()}, {"by", by}};
  const gpu::FrameCounts& counts = report.counts;
  j["counts"] = {{"passes", counts.passes},
                 {"render_passes", counts.render_passes},
                 {"dispatches", counts.dispatches},
                 {"draws", counts.draws},
                 {"copies", counts.copies},
                 {"barriers", counts.barriers},
                 {"descriptor_writes", counts.descriptor_writes},
                 {"pipelines_created", report.pipelines_created},
                 {"images", counts.images},
                 {"buffers", counts.buffers},
                 {"transient_bytes", counts.transient_bytes}};
  j["programs_made"] = report.programs_made;
  j["allocations"] = report.allocations;
  j["exposure"] = {{"ev", report.exposure_ev}, {"metered_ev", nullptr}};
  if (report.metered_ev) j["exposure"]["metered_ev"] = *report.metered_ev;
  j["non_finite_pixels"] = report.pixels.non_finite;
  j["black_fraction"] = static_cast<double>(report.pixels.black) /
                        (static_cast<double>(drawn.size.width) * drawn.size.height);
  return j;
}

void print_explanation(const render::Renderer& renderer, const render::FrameReport& report) {
  fmt::print("runs:\n");
  for (const gpu::PassTime& pass : report.passes)
    fmt::print("  {:<24} {:8.3f} ms\n", pass.name, pass.ms);
  fmt::print("images and buffers made for this frame:\n");
  for (const gpu::MemoryUse& use : renderer.graph().transient_memory())
    fmt::print("  {:<24} {:>12} bytes\n", use.name, use.bytes);
  const gpu::FrameCounts& counts = report.counts;
  fmt::print("counts:\n");
  for (const auto& [name, count] : std::initializer_list<std::pair<const char*, std::uint64_t>>{
           {"render passes", counts.render_passes},
           {"dispatches", counts.dispatches},
           {"draws", counts.draws},
           {"copies", counts.copies},
           {"barriers", counts.barriers},
           {"descriptor writes", counts.descriptor_writes},
           {"pipelines created", static_cast<std::uint64_t>(report.pipelines_created)}})
    fmt::print("  {:<24} {:>12}\n", name, count);
  fmt::print("left out:\n");
  for (const gpu::LeftOut& out : renderer.graph().left_out())
    fmt::print("  {:<24} {}\n", out.name, out.why);
  fmt::print("  {:<24} a picture has none: it belongs to play\n", "overlay");
  for (const std::string& name : renderer.graph().culled_names())
    fmt::print("  {:<24} nothing reads what it writes\n", name);
}

}  // namespace

int shot(const ShotOptions& options) {
  if (options.stats && std::filesystem::weakly_canonical(options.out) ==
                           std::filesystem::weakly_canonical(*options.stats))
    return fail(kUsage, {"--out and --stats name the same file; give two"});
  if (options.scene.settings.renderer == game::RendererKind::kReference)
    return shot_reference(options);
  const Stopwatch total;
  Stopwatch watch;
  const auto lap = [&watch] {
    const double ms = watch.milliseconds();
    watch.restart();
    return ms;
  };
  ordered_json cpu_ms;
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  cpu_ms["device"] = lap();
  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());

  Result<std::unique_ptr<SceneDrawer>> drawer = SceneDrawer::create(**device, options.scene);
  if (!drawer) return fail(kFailed, drawer.error());
  cpu_ms["world"] = lap();
  const Result<Drawn> drawn = (*drawer)->draw();
  if (!drawn) return fail(kFailed, drawn.error());
  cpu_ms["draw"] = lap();
  cpu_ms["gather_lights"] = (*drawer)->view().gather_ms();
  const platform::PixelView image{size.width, size.height, 4, drawn->rgba};
  const std::array<platform::PngText, 2> text{
      {{"Software", "Skerry"}, {"Command", game::shot_command(options.scene)}}};
  Outputs outputs;
  const Result<std::vector<std::byte>> png = platform::encode_png(image, text);
  if (!png) return fail(kFailed, png.error());
  if (Result<void> added = outputs.add(options.out, *png); !added)
    return fail(kFailed, added.error());
  cpu_ms["write"] = lap();
  cpu_ms["total"] = total.milliseconds();

  if (options.stats) {
    const ordered_json j = stats_json(**device, (*drawer)->view(), *drawn, cpu_ms);
    if (Result<void> added = outputs.add(
            *options.stats,
            j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
        !added)
      return fail(kFailed, added.error());
  }
  if (Result<void> written = outputs.publish(); !written) return fail(kFailed, written.error());
  if (options.explain) print_explanation((*drawer)->view().renderer(), drawn->report);
  if (drawn->report.pixels.non_finite != 0)
    return fail(kFailed,
                {fmt::format(
                    "{} pixels were not finite in some pass; this is a bug in Skerry or the driver",
                    drawn->report.pixels.non_finite)});
  return status_after(**device);
}

}  // namespace skerry::tools
