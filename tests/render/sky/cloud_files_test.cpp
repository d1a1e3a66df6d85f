// A real cloud, which the repository does not hold: what it lets through, against OpenVDB's own
// renderer, vdb_render. Skipped where file or program are missing.
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "game/scene_file/cloud_files.h"
#include "tests/folder.h"
#include "tests/real_files.h"
#include "tests/render/renderer_on_gpu.h"
#include "world/vdb/worker.h"

namespace skerry::render {
namespace {

namespace fs = std::filesystem;

constexpr VkExtent2D kSize{160, 120};
constexpr double kDistance = 800.0;      // blocks from the eye to the file's origin
constexpr double kHorizontalFov = 40.0;  // degrees
constexpr double kVoxel = 3.33333;       // blocks

fs::path wdas() {
  return real_file("wdas_cloud_sixteenth.vdb");
}

/// Alpha of an uncompressed EXR file with four channels of 32-bit floats, as vdb_render writes it.
std::vector<float> alpha_of_exr(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const std::size_t row = kSize.width * 4 * 4, line = row + 8;
  std::vector<float> out(std::size_t{kSize.width} * kSize.height);
  // The lines stand at the end: a number, a size, then A, B, G and R of all pixels.
  if (bytes.size() < line * kSize.height) return {};
  const std::size_t first = bytes.size() - line * kSize.height;
  for (std::uint32_t y = 0; y < kSize.height; ++y)
    std::memcpy(out.data() + std::size_t{y} * kSize.width, bytes.data() + first + y * line + 8,
                kSize.width * 4);
  return out;
}

/// The Disney cloud with an extinction [1/block] of density 1, before a sky without sun.
class RealCloud : public RendererOnGpu {
 protected:
  std::vector<double> transmittance(float extinction, CloudPrecision precision, int steps,
                                    int resolution) {
    FrameInput input;
    input.sky = celestial_at(12.0 * 3600.0, 0.0);
    input.sky.sun_irradiance = glm::vec3(0.0f);
    input.sky.sun_casts = false;
    const double tan_y = std::tan(kHorizontalFov * M_PI / 360.0) * kSize.height / kSize.width;
    input.camera = camera_at({0.0, 0.0, -kDistance}, 0.0, 0.0, std::atan(tan_y) * 360.0 / M_PI);
    RenderSettings settings;
    settings.indirect = Indirect::kOff;  // clouds are black
    settings.clouds.file_density = extinction;
    settings.clouds.steps = steps;
    settings.clouds.resolution = resolution;
    const std::vector<glm::vec4> clear = radiance(input, settings, {});
    const std::vector<glm::vec4> seen = radiance(input, settings, loaded_.volumes, precision);
    std::vector<double> out;
    for (std::size_t i = 0; i < seen.size(); ++i)
      out.push_back(static_cast<double>(seen[i].y) / static_cast<double>(clear[i].y));
    return out;
  }
  std::vector<glm::vec4> radiance(const FrameInput& input, const RenderSettings& settings,
                                  std::span<const CloudVolumeDesc> volumes,
                                  CloudPrecision precision = CloudPrecision::k8) {
    EXPECT_TRUE(renderer().set_clouds(volumes, precision));
    return RendererOnGpu::radiance(input, settings, kSize);
  }
  void load() {
    game::CloudFile file;
    file.path = wdas().string();
    Result<game::LoadedClouds> loaded = game::load_clouds(std::span(&file, 1));
    ASSERT_TRUE(loaded) << loaded.error().message;
    loaded_ = *std::move(loaded);
  }
  game::LoadedClouds loaded_;
};

double mean_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

TEST_F(RealCloud, LetsThroughWhatVdbRenderSays) {
  if (!fs::exists(wdas())) GTEST_SKIP() << wdas() << " is not there";
  if (!world::has_openvdb()) GTEST_SKIP() << "this build has no OpenVDB";
  if (std::system("command -v vdb_render > /dev/null") != 0)
    GTEST_SKIP() << "vdb_render (libopenvdb-tools) is not installed";
  load();
  const Folder folder;
  const fs::path out = folder / "wdas.exr";
  const std::string command =
      "vdb_render '" + wdas().string() + "' '" + out.string() +
      "' -res 160x120 -translate 0,0,-800 -lookat 0,0,0 -fov 40 -absorb 0.05,0.05,0.05"
      " -scatter 0,0,0 -gain 0 -cutoff 1e-6 -step 0.25 -compression none -cpus 1 > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::vector<float> alpha = alpha_of_exr(out);
  ASSERT_EQ(alpha.size(), std::size_t{kSize.width} * kSize.height);
  std::vector<double> theirs;
  double covered = 0.0;
  for (const float a : alpha) {
    theirs.push_back(1.0 - static_cast<double>(a));
    covered += a > 0.01f;
  }
  ASSERT_GT(covered, 2000.0);
  const std::vector<double> ours =
      transmittance(static_cast<float>(0.05 / kVoxel), CloudPrecision::k32, 256, 1);
  double off = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) off += theirs[i] < 0.99 ? ours[i] - theirs[i] : 0.0;
  EXPECT_LT(std::abs(off / covered), 0.01);
  EXPECT_LT(mean_difference(ours, theirs) * kSize.width * kSize.height / covered, 0.01);
}

}  // namespace
}  // namespace skerry::render
