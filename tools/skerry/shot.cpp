#include "tools/skerry/shot.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "engine/core/check.h"
#include "engine/gpu/readback.h"
#include "engine/platform/files.h"
#include "engine/platform/image_file.h"
#include "game/scene_view.h"
#include "tools/skerry/scene_device.h"

namespace skerry::tools {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::ordered_json;

/// Milliseconds between calls.
class Stopwatch {
 public:
  double lap() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

std::string sha256_hex(std::span<const std::byte> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

ordered_json stats_json(const gpu::Device& device, game::SceneView& view,
                        const render::FrameReport& report, VkExtent2D size, std::string image_hash,
                        const ordered_json& cpu_ms) {
  ordered_json j;
  j["device"] = device.info().name;
  j["driver"] = device.info().driver;
  j["size"] = {size.width, size.height};
  j["image_sha256"] = std::move(image_hash);
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
  j["lights"] = 0;
  ordered_json by = ordered_json::object();
  for (const gpu::MemoryUse& use : device.memory_use())
    by[use.name] = by.value(use.name, std::uint64_t{0}) + use.bytes;
  j["memory"] = {{"gpu_bytes", device.memory_total()}, {"by", by}};
  j["pipelines_created"] = view.renderer().pipelines_created();
  j["barriers"] = view.renderer().graph().barrier_count();
  j["non_finite_pixels"] = report.pixels.non_finite;
  j["black_fraction"] =
      static_cast<double>(report.pixels.black) / (static_cast<double>(size.width) * size.height);
  return j;
}

void print_explanation(const render::Renderer& renderer, const render::FrameReport& report) {
  fmt::print("runs:\n");
  for (const gpu::PassTime& pass : report.passes)
    fmt::print("  {:<24} {:8.3f} ms\n", pass.name, pass.ms);
  fmt::print("images and buffers made for this frame:\n");
  for (const gpu::MemoryUse& use : renderer.graph().transient_memory())
    fmt::print("  {:<24} {:>12} bytes\n", use.name, use.bytes);
  fmt::print("pipelines: {}\nbarriers: {}\nleft out:\n", renderer.pipelines_created(),
             renderer.graph().barrier_count());
  for (const gpu::LeftOut& out : renderer.graph().left_out())
    fmt::print("  {:<24} {}\n", out.name, out.why);
  for (const std::string& name : renderer.graph().culled_names())
    fmt::print("  {:<24} nothing reads what it writes\n", name);
}

}  // namespace

int shot(const ShotOptions& options) {
  if (options.stats && std::filesystem::weakly_canonical(options.out) ==
                           std::filesystem::weakly_canonical(*options.stats))
    return fail(kUsage, {"--out and --stats name the same file; give two"});
  Stopwatch watch, total;
  ordered_json cpu_ms;
  Result<std::unique_ptr<gpu::Device>> device = open_device(options.scene);
  if (!device) return fail(kNoDevice, device.error());
  cpu_ms["device"] = watch.lap();
  const VkExtent2D size{options.scene.size.width, options.scene.size.height};
  if (Result<void> fits = check_size(**device, options.scene.size); !fits)
    return fail(kUsage, fits.error());

  Result<std::unique_ptr<game::SceneView>> view = game::SceneView::create(**device, options.scene);
  if (!view) return fail(kFailed, view.error());
  cpu_ms["renderer"] = watch.lap();
  const render::Camera camera = (*view)->start_camera();
  const double world_time_s = options.scene.settings.world_time_s;
  if (Result<void> loaded = (*view)->load_completely(camera, world_time_s); !loaded)
    return fail(kFailed, loaded.error());
  cpu_ms["world"] = watch.lap();
  const game::SceneView::Moment moment{camera, static_cast<double>(options.scene.time_of_day_s),
                                       world_time_s, false};
  if (Result<std::uint64_t> drawn = (*view)->draw(moment, size); !drawn)
    return fail(kFailed, drawn.error());
  render::Renderer& renderer = (*view)->renderer();
  renderer.finish();
  cpu_ms["draw"] = watch.lap();

  Result<std::vector<std::byte>> pixels = gpu::read_back(**device, renderer.picture(), 4);
  if (!pixels) return fail(kFailed, pixels.error());
  const platform::PixelView image{
      size.width,
      size.height,
      4,
      {reinterpret_cast<const std::uint8_t*>(pixels->data()), pixels->size()}};
  game::SceneOptions reproduced = options.scene;
  const std::array<platform::PngText, 2> text{
      {{"Software", "Skerry"}, {"Command", game::shot_command(reproduced)}}};
  if (Result<void> written = platform::write_png(options.out, image, text); !written)
    return fail(kFailed, written.error());
  cpu_ms["write"] = watch.lap();
  cpu_ms["total"] = total.lap();

  SKERRY_ASSERT(renderer.report().has_value());
  if (options.explain) print_explanation(renderer, *renderer.report());
  if (options.stats) {
    const ordered_json j =
        stats_json(**device, **view, *renderer.report(), size, sha256_hex(*pixels), cpu_ms);
    if (Result<void> written = platform::write_text(
            *options.stats,
            j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
        !written)
      return fail(kFailed, written.error());
  }
  if (renderer.report()->pixels.non_finite != 0)
    return fail(kFailed,
                {fmt::format(
                    "{} pixels were not finite in some pass; this is a bug in Skerry or the driver",
                    renderer.report()->pixels.non_finite)});
  return status_after(**device);
}

}  // namespace skerry::tools
