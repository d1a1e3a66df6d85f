#include "tools/reference/brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tools/reference/sampler.h"

namespace skerry::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// Share of light from everywhere that the lobe sends to an eye: its integral with the cosine, by
/// the half vector, whose distribution is sampled evenly in alpha^2 tan^2.
double lobe_energy(double cos_eye, double roughness) {
  constexpr int kRings = 400, kSpokes = 128;
  const glm::dvec3 normal(0, 0, 1), eye(std::sqrt(1.0 - cos_eye * cos_eye), 0.0, cos_eye);
  const double alpha2 = std::pow(roughness, 4.0);
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    // GGX: the share of normals within angle t is tan^2 t / (alpha^2 + tan^2 t).
    const double share = (i + 0.5) / kRings;
    const double cos2 = (1.0 - share) / (1.0 + (alpha2 - 1.0) * share);
    for (int j = 0; j < kSpokes; ++j) {
      const double turn = 2.0 * kPi * (j + 0.5) / kSpokes, sine = std::sqrt(1.0 - cos2);
      const glm::dvec3 half(sine * std::cos(turn), sine * std::sin(turn), std::sqrt(cos2));
      const double h_dot_v = glm::dot(half, eye);
      const glm::dvec3 light = half * (2.0 * h_dot_v) - eye;
      if (h_dot_v <= 0.0 || light.z <= 0.0) continue;
      const double d = alpha2 / (kPi * std::pow(cos2 * (alpha2 - 1.0) + 1.0, 2.0));
      const double density = d * half.z / (4.0 * h_dot_v);
      sum += mirror_lobe_lossless(normal, light, eye, roughness) * light.z / density;
    }
  }
  return sum / (kRings * kSpokes);
}

TEST(ReferenceBrdf, AMirrorLobeNeverSendsMoreThanItReceives) {
  for (const double roughness : {0.06, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0}) {
    for (const double cos_eye : {0.02, 0.1, 0.3, 0.6, 0.9, 1.0}) {
      const double energy = lobe_energy(cos_eye, roughness);
      EXPECT_LE(energy, 1.0 + 1e-3) << roughness << " " << cos_eye;
      EXPECT_GT(energy, 0.3) << roughness << " " << cos_eye;
    }
  }
}

TEST(ReferenceBrdf, ANarrowLobeFromAboveLosesNothing) {
  EXPECT_NEAR(lobe_energy(1.0, 0.06), 1.0, 0.01);
}

TEST(ReferenceBrdf, LightAndEyeCanChangePlaces) {
  const glm::dvec3 n(0, 0, 1), a = glm::normalize(glm::dvec3(0.3, 0.2, 0.9)),
                               b = glm::normalize(glm::dvec3(-0.6, 0.5, 0.4));
  for (const double roughness : {0.1, 0.5, 1.0})
    EXPECT_DOUBLE_EQ(mirror_lobe(n, a, b, roughness, kWaterIndex),
                     mirror_lobe(n, b, a, roughness, kWaterIndex));
}

TEST(ReferenceBrdf, WaterMirrorsTwoPercentFromAboveAndAllBeyondTheCriticalAngle) {
  EXPECT_NEAR(fresnel(1.0, false, kWaterIndex), 0.02037, 1e-5);
  EXPECT_NEAR(fresnel(1.0, true, kWaterIndex), 0.02037, 1e-5);
  EXPECT_DOUBLE_EQ(fresnel(0.0, false, kWaterIndex), 1.0);
  const double critical = std::asin(1.0 / kWaterIndex);
  EXPECT_DOUBLE_EQ(fresnel(std::cos(critical + 1e-3), true, kWaterIndex), 1.0);
  EXPECT_LT(fresnel(std::cos(critical - 0.1), true, kWaterIndex), 0.5);
}

TEST(ReferenceBrdf, CornersAreAsOpenAsTheBlocksAboutThemLeaveThem) {
  //  index: 0 1 2 low v, 3 4 5, 6 7 8 high v
  const bool open[9] = {};
  for (const glm::dvec2 place : {glm::dvec2(0.0), glm::dvec2(0.3, 0.8), glm::dvec2(1.0)})
    EXPECT_EQ(corner_ao(place, open), 1.0);

  const bool middle[9] = {false, false, false, false, true};
  EXPECT_EQ(corner_ao({0.0, 0.0}, middle), 1.0);

  const bool across[9] = {true};
  EXPECT_DOUBLE_EQ(corner_ao({0.0, 0.0}, across), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(corner_ao({1.0, 0.0}, across), 1.0);
  EXPECT_DOUBLE_EQ(corner_ao({0.5, 0.5}, across), 1.0 - 1.0 / 12.0);

  const bool side_u[9] = {false, false, false, true};
  EXPECT_DOUBLE_EQ(corner_ao({0.0, 0.0}, side_u), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(corner_ao({0.0, 1.0}, side_u), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(corner_ao({1.0, 1.0}, side_u), 1.0);

  const bool side_and_across[9] = {true, false, false, true};
  EXPECT_DOUBLE_EQ(corner_ao({0.0, 0.0}, side_and_across), 1.0 / 3.0);

  // Two sides close the corner, whether or not the block across stands.
  const bool both[9] = {false, true, false, true};
  const bool all[9] = {true, true, false, true};
  EXPECT_EQ(corner_ao({0.0, 0.0}, both), 0.0);
  EXPECT_EQ(corner_ao({0.0, 0.0}, all), 0.0);
  EXPECT_DOUBLE_EQ(corner_ao({1.0, 0.0}, both), 2.0 / 3.0);
}

TEST(ReferenceBrdf, ASurfaceIsReciprocalAndSendsOutNoMoreThanItGets) {
  const glm::dvec3 normal(0.0, 1.0, 0.0), albedo(1.0);
  const Frame frame(normal);
  for (const double roughness : {0.3, 0.6, 0.9}) {
    for (const double metalness : {0.0, 0.5, 1.0}) {
      for (const double angle : {0.0, 0.7, 1.2, 1.5}) {
        const glm::dvec3 eye(std::sin(angle), std::cos(angle), 0.0);
        double sent = 0.0;
        constexpr std::uint32_t kSamples = 1 << 16;
        for (std::uint32_t i = 0; i < kSamples; ++i) {
          Sampler sampler(1, 2, i);
          const glm::dvec3 light = frame.world(by_cosine(sampler.next()));
          const double share = surface_brdf(normal, light, eye, albedo, roughness, metalness).x;
          EXPECT_NEAR(share, surface_brdf(normal, eye, light, albedo, roughness, metalness).x,
                      1e-9 * share + 1e-12);
          sent += share * std::numbers::pi / kSamples;
        }
        EXPECT_LE(sent, 1.01) << roughness << ' ' << metalness << ' ' << angle;
        EXPECT_GT(sent, metalness == 1.0 ? 0.2 : 0.5);
      }
    }
  }
}

TEST(ReferenceBrdf, ARoughSurfaceFromAboveIsNearlyLambertian) {
  const glm::dvec3 up(0.0, 1.0, 0.0);
  const double share = surface_brdf(up, up, up, glm::dvec3(0.5), 1.0, 0.0).x;
  EXPECT_NEAR(share, (0.5 * 0.96 * 0.96 + 0.04 / 4.0) / std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace skerry::reference
