// The sky's shaders on a real device, judged by the CPU's double-precision model and by closed
// forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "engine/render/frame/display.h"
#include "tests/render/sky_on_gpu.h"
#include "tools/reference/reference.h"

namespace skerry::render {
namespace {

/// The table's layout as shaders/shared/sky.h words it.
glm::dvec3 lut_direction(double u, double v, double horizon) {
  const double azimuth = (u - 0.5) * 2.0 * M_PI, root = 2.0 * v - 1.0;
  const double elevation =
      horizon + root * std::abs(root) * (root < 0.0 ? M_PI_2 + horizon : M_PI_2 - horizon);
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

/// What a camera that sees the whole sky is exposed to.
double exposure_of(const SkyModel& sky) {
  measure::Picture picture{32, 16, {}};
  for (int i = 0; i < 32 * 16; ++i)
    picture.pixels.emplace_back(
        sky_radiance(lut_direction((i % 32 + 0.5) / 32.0, (i / 32 + 0.5) / 16.0, 0.0), sky));
  return std::exp2(-reference::metered_ev(picture, {}).value_or(0.0));
}

std::vector<Celestial> moments() {
  std::vector<Celestial> all;
  for (const double hour : {0.0, 5.5, 6.0, 6.5, 9.0, 12.0, 17.9, 18.3, 18.7}) {
    for (const double phase : {0.0, 0.3, 0.5}) all.push_back(celestial_at(hour * kHour, phase));
  }
  return all;
}

TEST_F(SkyOnGpu, TableEqualsTheDoublePrecisionModel) {
  double worst = 0.0;
  for (const Celestial& now : moments()) {
    SkyModel sky = sky_model(now);
    sky.constants.stars = 0.0f;
    const std::vector<Texel> texels = read<Texel>(baked(sky));
    for (std::uint32_t j = 0; j < shared::kSkyLutHeight; ++j) {
      for (std::uint32_t i = 0; i < shared::kSkyLutWidth; ++i) {
        const glm::dvec3 d =
            lut_direction(i / (shared::kSkyLutWidth - 1.0), j / (shared::kSkyLutHeight - 1.0),
                          static_cast<double>(sky.constants.horizon));
        const glm::dvec3 expected = sky_radiance(d, sky);
        const glm::dvec3 got = decoded(texels[j * shared::kSkyLutWidth + i]);
        // A half has 11 bits, and steps of 6e-8 at worst below 6e-5.
        const double error =
            (glm::length(got - expected) - 1.2e-7) / std::max(1e-12, glm::length(expected));
        worst = std::max(worst, error);
      }
    }
  }
  EXPECT_LT(worst, 0.002);
}

TEST_F(SkyOnGpu, SampledTableFollowsTheModelInEveryDirection) {
  double worst = 0.0, sum = 0.0;
  int count = 0;
  for (const Celestial& now : moments()) {
    SkyModel sky = sky_model(now);
    const SkyModel model = sky;
    sky.constants.sun_disc = sky.constants.moon_disc = glm::vec3(0.0f);
    sky.constants.stars = 0.0f;
    const double exposure = exposure_of(model);
    const glm::uvec2 size{96, 96};
    for (int axis = 0; axis < 6; ++axis) {
      glm::vec3 forward(0.0f);
      forward[axis / 2] = axis % 2 ? -1.0f : 1.0f;
      const std::vector<glm::dvec3> got = seen(sky, forward, 1.0f, size);
      const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0.001f, 1.0f, 0.002f)));
      const glm::vec3 up = glm::cross(right, forward);
      for (std::uint32_t p = 0; p < got.size(); ++p) {
        const glm::vec2 ndc =
            (glm::vec2(p % size.x, p / size.x) + 0.5f) * (2.0f / glm::vec2(size)) - 1.0f;
        const glm::dvec3 d = glm::normalize(glm::dvec3(forward + right * ndc.x - up * ndc.y));
        const glm::dvec3 expected = sky_radiance(d, model);
        const double error =
            glm::length(got[p] - expected) / (glm::length(expected) + 0.01 / exposure);
        worst = std::max(worst, error);
        sum += error;
        ++count;
      }
    }
  }
  EXPECT_LT(worst, 0.03);
  EXPECT_LT(sum / count, 0.002);
}

/// A square view and what each of its pixels covers of the sphere.
struct View {
  glm::dvec3 forward;
  double tan_half_fov;
  std::uint32_t edge;

  glm::dvec2 ndc(std::uint32_t pixel) const {
    return (glm::dvec2(pixel % edge, pixel / edge) + 0.5) * (2.0 / edge) - 1.0;
  }
  double solid_angle(std::uint32_t pixel) const {
    const glm::dvec2 at = ndc(pixel) * tan_half_fov;
    const double side = 2.0 * tan_half_fov / edge;
    return side * side / std::pow(1.0 + glm::dot(at, at), 1.5);
  }
};

glm::dvec3 energy(const std::vector<glm::dvec3>& image, const View& view) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t p = 0; p < image.size(); ++p) sum += image[p] * view.solid_angle(p);
  return sum;
}

TEST_F(SkyOnGpu, SunDiscSendsTheSunsIrradiance) {
  for (const double hour : {7.0, 12.0}) {
    const Celestial now = celestial_at(hour * kHour, 0.0);
    SkyModel sky = sky_model(now);
    const View view{now.to_sun, 0.03, 256};
    const auto with = seen(sky, view.forward, 0.03f, glm::uvec2(view.edge));
    sky.constants.sun_disc = glm::vec3(0.0f);
    const auto without = seen(sky, view.forward, 0.03f, glm::uvec2(view.edge));
    const glm::dvec3 disc = energy(with, view) - energy(without, view);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(disc[i] / now.sun_irradiance[i], 1.0, 0.02) << hour;
  }
}

TEST_F(SkyOnGpu, MoonIsLitFromTheSunsSideByItsPhase) {
  for (const double phase : {0.1, 0.25, 0.4, 0.5, 0.7}) {
    // The hour at which the moon stands in the south.
    const Celestial now = celestial_at((12.0 + 24.0 * phase) * kHour, phase);
    SkyModel sky = sky_model(now);
    const View view{now.to_moon, 0.02, 256};
    const auto with = seen(sky, view.forward, 0.02f, glm::uvec2(view.edge));
    const double disc = luminance(sky.constants.moon_disc);
    sky.constants.moon_disc = glm::vec3(0.0f);
    const auto without = seen(sky, view.forward, 0.02f, glm::uvec2(view.edge));
    double lit_area = 0.0;
    glm::dvec2 centroid(0.0);
    for (std::uint32_t p = 0; p < with.size(); ++p) {
      if (luminance(with[p] - without[p]) < 0.003 * disc) continue;
      lit_area += view.solid_angle(p);
      centroid += view.ndc(p);
    }
    const double disc_area = M_PI * std::pow(shared::kDiscRadius, 2);
    EXPECT_NEAR(lit_area / disc_area, now.moon_lit_fraction, 0.03) << phase;
    if (phase == 0.5) continue;
    // Right of the picture is forward x up: the west for one who looks south.
    const glm::dvec3 right = glm::normalize(glm::cross(now.to_moon, glm::dvec3(0, 1, 0)));
    EXPECT_GT(centroid.x * glm::dot(now.to_sun, right), 0.0) << phase;
  }
}

TEST_F(SkyOnGpu, StarsKeepTheirLightAtEveryResolution) {
  const SkyModel sky = sky_model(celestial_at(0.0, 0.0));
  const View coarse{{0.1, 1.0, 0.2}, 0.5, 200}, fine{{0.1, 1.0, 0.2}, 0.5, 600};
  const glm::dvec3 a = energy(seen(sky, coarse.forward, 0.5f, glm::uvec2(coarse.edge)), coarse);
  const glm::dvec3 b = energy(seen(sky, fine.forward, 0.5f, glm::uvec2(fine.edge)), fine);
  EXPECT_GT(luminance(a), 0.0);
  EXPECT_NEAR(luminance(a) / luminance(b), 1.0, 0.03);
}

TEST_F(SkyOnGpu, StarsDoNotTwinkleAsTheyMoveAcrossPixels) {
  const View view{{0.1, 1.0, 0.2}, 0.2, 200};
  double least = 1e300, most = 0.0;
  // A pixel is 0.002 rad: 27 s of turning. Steps of a fifth of that.
  for (int step = 0; step < 15; ++step) {
    const auto image =
        seen(sky_model(celestial_at(step * 5.5, 0.0)), view.forward, 0.2f, glm::uvec2(view.edge));
    // The brightest star well inside is the same one in every step.
    std::uint32_t best = 0;
    for (std::uint32_t p = 0; p < image.size(); ++p) {
      const glm::dvec2 at = glm::abs(view.ndc(p));
      if (std::max(at.x, at.y) < 0.8 && luminance(image[p]) > luminance(image[best])) best = p;
    }
    double sum = 0.0;
    for (int dy = -4; dy <= 4; ++dy) {
      for (int dx = -4; dx <= 4; ++dx) {
        sum += luminance(
            image[best + static_cast<std::uint32_t>(dy * static_cast<int>(view.edge) + dx)]);
      }
    }
    least = std::min(least, sum);
    most = std::max(most, sum);
  }
  EXPECT_GT(least / most, 0.9);
}

TEST_F(SkyOnGpu, StarsAreThousandsOverTheWholeSphereAndNoneByDay) {
  SkyModel sky = sky_model(celestial_at(0.0, 0.0));
  const int edge = 800;
  // A view of 90 by 90 degrees is a sixth of the sphere.
  const auto image = seen(sky, {0.0f, 1.0f, 0.0f}, 1.0f, glm::uvec2(edge));
  const auto light = [&](int x, int y) {
    return luminance(image[static_cast<std::size_t>(y * edge + x)]);
  };
  int peaks = 0;
  for (int y = 3; y + 3 < edge; ++y) {
    for (int x = 3; x + 3 < edge; ++x) {
      // A local maximum that rises over its surroundings by half of what the faintest star does.
      const double around =
          0.25 * (light(x - 3, y) + light(x + 3, y) + light(x, y - 3) + light(x, y + 3));
      bool peak = light(x, y) > around + 1.5e-5;
      for (int n = 0; n < 9 && peak; ++n)
        peak = n == 4 || light(x, y) > light(x + n % 3 - 1, y + n / 3 - 1);
      peaks += peak;
    }
  }
  EXPECT_GT(peaks, 400);
  EXPECT_LT(peaks, 1200);
  sky.constants.stars = 0.0f;
  for (const glm::dvec3& c : seen(sky, {0.0f, 1.0f, 0.0f}, 1.0f, {64, 64}))
    EXPECT_EQ(c, glm::dvec3(0.0));
  EXPECT_EQ(sky_model(celestial_at(12 * kHour, 0.0)).constants.stars, 0.0f);
}

/// The reference's tone curve, then IEC 61966-2-1, in double precision.
glm::dvec3 expected_picture(glm::dvec3 radiance) {
  glm::dvec3 shown = reference::tone_mapped(radiance, ToneCurve::kAces);
  for (int i = 0; i < 3; ++i) shown[i] = srgb_encoded(shown[i]);
  return shown;
}

TEST_F(SkyOnGpu, PictureIsTheToneCurveAndBlackStaysBlack) {
  const glm::uvec2 size{64, 64};
  std::vector<Texel> scene(std::size_t{size.x} * size.y);
  std::mt19937 random(7);
  for (std::size_t i = 1; i < scene.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const float value = std::exp2(std::uniform_real_distribution<float>(-14.0f, 15.9f)(random));
      scene[i][static_cast<std::size_t>(k)] =
          glm::packHalf1x16(i % 5 == 0 && k == 0 ? 0.0f : value);
    }
  }
  const gpu::Image radiance = image(size.x, size.y, VK_FORMAT_R16G16B16A16_SFLOAT);
  copy(radiance, buffer(scene.data(), scene.size() * sizeof(Texel)), true);
  const gpu::Image picture = image(size.x, size.y, VK_FORMAT_R8G8B8A8_UNORM);
  const gpu::Image grained = image(size.x, size.y, VK_FORMAT_R8G8B8A8_UNORM);
  dispatch("develop_test.comp",
           {{0, nullptr, &radiance}, {1, nullptr, &picture}, {2, nullptr, &grained}}, size.x,
           size.y);
  const auto pixels = read<std::array<std::uint8_t, 4>>(picture);
  const auto dithered = read<std::array<std::uint8_t, 4>>(grained);
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const glm::dvec3 expected = expected_picture(decoded(scene[i]) * 0.7) * 255.0;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(pixels[i][k], expected[static_cast<int>(k)], 0.52) << i;
      EXPECT_NEAR(dithered[i][k], expected[static_cast<int>(k)], 1.02) << i;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(pixels[0][k], 0);
    EXPECT_EQ(dithered[0][k], 0);
  }
}

}  // namespace
}  // namespace skerry::render
