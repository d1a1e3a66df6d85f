#include "tools/reference/brdf.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace skerry::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// One over Smith's masking term of one direction over its cosine, Schlick's fit.
double smith(double cosine, double k) {
  return 1.0 / (cosine * (1.0 - k) + k);
}

/// Of a lobe whose normals are spread by `distribution`: the rest of it, without Fresnel's factor.
double lobe_of(double distribution, double n_dot_l, double n_dot_v, double alpha) {
  return distribution * smith(n_dot_l, 0.5 * alpha) * smith(n_dot_v, 0.5 * alpha) * 0.25;
}

}  // namespace

double fresnel(double cosine, bool leaving, double index) {
  const double at_normal = std::pow((index - 1.0) / (index + 1.0), 2.0);
  cosine = std::clamp(cosine, 0.0, 1.0);
  if (leaving) {
    const double sine2 = index * index * (1.0 - cosine * cosine);  // Snell
    if (sine2 >= 1.0) return 1.0;
    cosine = std::sqrt(1.0 - sine2);
  }
  return at_normal + (1.0 - at_normal) * std::pow(1.0 - cosine, 5.0);
}

double mirror_lobe_lossless(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye,
                            double roughness) {
  const double n_dot_l = glm::dot(normal, to_light), n_dot_v = glm::dot(normal, to_eye);
  if (n_dot_l <= 0.0 || n_dot_v <= 0.0) return 0.0;
  const glm::dvec3 half = glm::normalize(to_light + to_eye);
  const double alpha = roughness * roughness, alpha2 = alpha * alpha;
  // 1 - cos^2 loses its digits next to the mirror direction; the sine of the half vector does not.
  const double n_dot_h = glm::dot(normal, half);
  const glm::dvec3 across = glm::cross(normal, half);
  const double spread = n_dot_h * n_dot_h * alpha2 + glm::dot(across, across);
  const double distribution = alpha2 / (kPi * spread * spread);
  return lobe_of(distribution, n_dot_l, n_dot_v, alpha);
}

double mirror_lobe(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye, double roughness,
                   double index) {
  const double lossless = mirror_lobe_lossless(normal, to_light, to_eye, roughness);
  if (lossless == 0.0) return 0.0;
  const glm::dvec3 half = glm::normalize(to_light + to_eye);
  return lossless * fresnel(glm::dot(half, to_eye), false, index);
}

double wave_lobe(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye, double alpha,
                 double index) {
  const double n_dot_l = glm::dot(normal, to_light), n_dot_v = glm::dot(normal, to_eye);
  if (n_dot_l <= 0.0 || n_dot_v <= 0.0) return 0.0;
  const glm::dvec3 half = glm::normalize(to_light + to_eye);
  const double cosine2 = std::pow(glm::dot(normal, half), 2.0), alpha2 = alpha * alpha;
  const glm::dvec3 across = glm::cross(normal, half);
  const double slope2 = glm::dot(across, across) / cosine2;
  const double distribution = 2.0 / (std::pow(kPi, 1.5) * alpha2 * cosine2 * cosine2) *
                              std::exp(-std::pow(slope2 / alpha2, 2.0));
  return lobe_of(distribution, n_dot_l, n_dot_v, alpha) *
         fresnel(glm::dot(half, to_eye), false, index);
}

glm::dvec3 surface_brdf(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye,
                        glm::dvec3 albedo, double roughness, double metalness) {
  constexpr double kFromAbove = 0.04, kLeastRoughness = 0.06;
  const double n_dot_l = glm::dot(normal, to_light), n_dot_v = glm::dot(normal, to_eye);
  if (n_dot_l <= 0.0 || n_dot_v <= 0.0) return glm::dvec3(0.0);
  roughness = std::clamp(roughness, kLeastRoughness, 1.0);
  const auto left = [&](double cosine) {
    const double grazing = (1.0 - kFromAbove) * std::pow(1.0 - roughness * roughness, 6.0);
    return 1.0 - kFromAbove - grazing * std::pow(1.0 - cosine, 5.0);
  };
  const glm::dvec3 diffuse = albedo * ((1.0 - metalness) / kPi * left(n_dot_l) * left(n_dot_v));
  const glm::dvec3 mirror = glm::mix(glm::dvec3(kFromAbove), albedo, metalness);
  const double h_dot_v = std::clamp(glm::dot(glm::normalize(to_light + to_eye), to_eye), 0.0, 1.0);
  const glm::dvec3 fresnel = mirror + (1.0 - mirror) * std::pow(1.0 - h_dot_v, 5.0);
  return diffuse + fresnel * mirror_lobe_lossless(normal, to_light, to_eye, roughness);
}

Frame::Frame(glm::dvec3 unit_axis) : axis(unit_axis) {
  const glm::dvec3 other = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  right = glm::normalize(glm::cross(other, axis));
  up = glm::cross(axis, right);
}

glm::dvec3 in_cone(glm::dvec2 pair, double one_minus_cosine) {
  const double down = pair.x * one_minus_cosine;  // 1 - cosine of the angle to the axis
  const double sine = std::sqrt(std::max(0.0, down * (2.0 - down)));
  const double turn = 2.0 * kPi * pair.y;
  return {sine * std::cos(turn), sine * std::sin(turn), 1.0 - down};
}

glm::dvec3 by_cosine(glm::dvec2 pair) {
  const double sine = std::sqrt(pair.x), turn = 2.0 * kPi * pair.y;
  return {sine * std::cos(turn), sine * std::sin(turn), std::sqrt(1.0 - pair.x)};
}

double corner_ao(glm::dvec2 place, const bool (&stands)[9]) {
  const auto corner = [&](int u, int v) {  // each -1 or 1
    const bool side_u = stands[3 + u + 1], side_v = stands[3 * (v + 1) + 1];
    if (side_u && side_v) return 0.0;
    const bool across = stands[3 * (v + 1) + u + 1];
    return (3.0 - static_cast<double>(side_u + side_v + across)) / 3.0;
  };
  const double low = (1.0 - place.x) * corner(-1, -1) + place.x * corner(1, -1);
  const double high = (1.0 - place.x) * corner(-1, 1) + place.x * corner(1, 1);
  return (1.0 - place.y) * low + place.y * high;
}

}  // namespace skerry::reference
