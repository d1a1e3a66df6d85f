#include "engine/render/air/light_moments.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace skerry::render {
namespace {

using PhaseMoments = std::array<double, kLightDegrees>;

/// Of molecules: degrees 0 and 2 alone.
constexpr PhaseMoments kMolecules{1.0, 0.0, 0.1};

/// Of aerosol without kForward. Cornette and Shanks' function is 1 + c^2 times Henyey and
/// Greenstein's, whose moments are powers of g.
constexpr PhaseMoments aerosol_moments() {
  std::array<double, kLightDegrees + 2> powers{1.0};
  for (std::size_t l = 1; l < powers.size(); ++l) powers[l] = powers[l - 1] * kMieG;
  PhaseMoments out{};
  for (std::size_t l = 0; l < kLightDegrees; ++l) {
    const auto d = static_cast<double>(l);
    // c^2 P_l as a sum of P_(l + 2), P_l and P_(l - 2).
    const double next = (d + 1.0) / ((2.0 * d + 1.0) * (2.0 * d + 3.0)),
                 last = l == 0 ? 0.0 : d / ((2.0 * d + 1.0) * (2.0 * d - 1.0));
    double squared = next * (d + 2.0) * powers[l + 2] + (next * (d + 1.0) + last * d) * powers[l];
    if (l >= 2) squared += last * (d - 1.0) * powers[l - 2];
    const double whole = 1.5 / (2.0 + kMieG * kMieG) * (powers[l] + squared);
    out[l] = (whole - kForward) / (1.0 - kForward);
  }
  return out;
}
constexpr PhaseMoments kAerosol = aerosol_moments();

/// What is lower than kLowestSine lights no air at all.
constexpr double kLowestSine = 0.35;
double place_of_sine(double sine) {
  return sine < 0.0 ? 0.5 - 0.5 * std::sqrt(-sine / kLowestSine) : 0.5 + 0.5 * std::sqrt(sine);
}

/// Norms of real harmonics, for P_l^m / sin^m times sin^m cos(m phi).
std::array<float, kLightTerms> harmonic_norms() {
  std::array<float, kLightTerms> out{};
  for (int l = 0; l <= kLightDegree; ++l)
    for (int m = 0; m <= l; ++m) {
      double ratio = 1.0;  // (l - m)! / (l + m)!
      for (int i = l - m + 1; i <= l + m; ++i) ratio /= i;
      const double squared =
          (2.0 * l + 1.0) / (4.0 * std::numbers::pi) * ratio * (m == 0 ? 1.0 : 2.0);
      out[light_term(static_cast<std::size_t>(l), static_cast<std::size_t>(m))] =
          static_cast<float>(std::sqrt(squared));
    }
  return out;
}

/// A direction's horizontal part along a body's. @param cosine of the angle between the two.
double towards_body(double view_sine, double body_sine, double cosine) {
  const double flat = std::sqrt(std::max(0.0, 1.0 - body_sine * body_sine));
  const double most = std::sqrt(std::max(0.0, 1.0 - view_sine * view_sine));
  if (flat < 1e-6) return 0.0;
  return std::clamp((cosine - view_sine * body_sine) / flat, -most, most);
}

}  // namespace

std::array<float, kLightTerms> elevation_harmonics(double sine) {
  static const std::array<float, kLightTerms> kNorms = harmonic_norms();
  const auto z = static_cast<float>(sine);
  std::array<float, kLightTerms> out;
  float diagonal = 1.0f;  // P_m^m / sin^m
  for (std::size_t m = 0; m < kLightDegrees; ++m) {
    const auto order = static_cast<float>(m);
    float now = diagonal, before = 0.0f;
    for (std::size_t l = m; l < kLightDegrees; ++l) {
      out[light_term(l, m)] = kNorms[light_term(l, m)] * now;
      const auto d = static_cast<float>(l);
      const float next = ((2.0f * d + 1.0f) * z * now - (d + order) * before) / (d + 1.0f - order);
      before = now;
      now = next;
    }
    diagonal *= 2.0f * order + 1.0f;
  }
  return out;
}

std::array<float, kLightDegrees> azimuth_harmonics(double sine, double towards) {
  const auto z = static_cast<float>(sine), x = static_cast<float>(towards);
  const float flat2 = std::max(0.0f, 1.0f - z * z);
  std::array<float, kLightDegrees> out{1.0f, x};
  for (std::size_t m = 2; m < kLightDegrees; ++m)  // Chebyshev's recurrence
    out[m] = 2.0f * x * out[m - 1] - flat2 * out[m - 2];
  return out;
}

double smooth_mie_phase(double cosine, int degree) {
  double before = 0.0, now = 1.0, sum = 0.0;  // Legendre's polynomials
  for (std::size_t l = 0; l <= static_cast<std::size_t>(degree); ++l) {
    const auto d = static_cast<double>(l);
    sum += (2.0 * d + 1.0) * kAerosol[l] * now;
    const double next = ((2.0 * d + 1.0) * cosine * now - d * before) / (d + 1.0);
    before = now;
    now = next;
  }
  return sum / (4.0 * std::numbers::pi);
}

double moment_sine(int node) {
  const double root = 2.0 * node / (kMomentSines - 1.0) - 1.0;
  return root < 0.0 ? -kLowestSine * root * root : root * root;
}

double moment_height(int node) {
  const double place = node / (kMomentHeights - 1.0);
  return place * place * kAirDepthKm;
}

Between between(double place, int count) {
  const double at = std::clamp(place, 0.0, 1.0) * (count - 1);
  const int first = std::min(static_cast<int>(at), count - 2);
  return {first, at - first};
}

Between between_sines(double sine) {
  return between(place_of_sine(sine), kMomentSines);
}

StepLight::StepLight(const MomentTable& table, const AirStep& step, int degree)
    : view_sine_(step.view_sine), degrees_(static_cast<std::size_t>(degree) + 1) {
  const Between height =
      between(std::sqrt(std::max(0.0, step.height) / kAirDepthKm), kMomentHeights);
  low_ = table.data() + static_cast<std::ptrdiff_t>(height.first) * kMomentSines;
  high_ = low_ + kMomentSines;
  share_ = static_cast<float>(height.share);
  const std::array<float, kLightTerms> basis = elevation_harmonics(view_sine_);
  for (std::size_t l = 0; l < degrees_; ++l) {
    const glm::vec4 share(
        step.rayleigh * kMolecules[l] + step.mie * ((1.0 - kForward) * kAerosol[l]), 0.0);
    for (std::size_t m = 0; m <= l; ++m)
      weights_[light_term(l, m)] = share * basis[light_term(l, m)];
  }
}

const StepLight::Rounds& StepLight::node(std::size_t sine) {
  Rounds& out = nodes_[sine];
  if (std::exchange(known_[sine], true)) return out;
  const LightMoments &low = low_[sine], &high = high_[sine];
  for (std::size_t m = 0; m < degrees_; ++m) {
    glm::vec4 sum(0.0f);
    for (std::size_t l = m; l < degrees_; ++l) {
      const std::size_t t = light_term(l, m);
      sum += (low[t] + (high[t] - low[t]) * share_) * weights_[t];
    }
    out[m] = sum;
  }
  return out;
}

glm::dvec3 StepLight::at(double sine, double cosine) {
  const Between place = between_sines(sine);
  const Rounds &low = node(static_cast<std::size_t>(place.first)),
               &high = node(static_cast<std::size_t>(place.first) + 1);
  const auto share = static_cast<float>(place.share);
  const std::array<float, kLightDegrees> basis =
      azimuth_harmonics(view_sine_, towards_body(view_sine_, sine, cosine));
  glm::vec4 sum(0.0f);
  for (std::size_t m = 0; m < degrees_; ++m)
    sum += (low[m] + (high[m] - low[m]) * share) * basis[m];
  return glm::dvec3(sum);
}

}  // namespace skerry::render
