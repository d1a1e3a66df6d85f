// What an ear makes of samples: level, brightness, clicks. Written for tests, from definitions.
#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace skerry {

inline double rms_of(std::span<const float> x) {
  double sum = 0.0;
  for (const float v : x) sum += double{v} * v;
  return x.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(x.size()));
}
inline double decibels(double amplitude) {
  return 20.0 * std::log10(std::max(amplitude, 1e-12));
}
inline double peak_of(std::span<const float> x) {
  double peak = 0.0;
  for (const float v : x) peak = std::max(peak, std::abs(double{v}));
  return peak;
}

/// Power in each bin of a spectrum of 2^n samples, windowed; bin k is at k * rate / size.
inline std::vector<double> power_spectrum(std::span<const float> x) {
  std::size_t size = 1;
  while (size < x.size()) size *= 2;
  std::vector<std::complex<double>> a(size);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(x.size());
    a[i] = double{x[i]} * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * part));
  }
  for (std::size_t i = 1, j = 0; i < size; ++i) {
    std::size_t bit = size / 2;
    for (; j & bit; bit /= 2) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(a[i], a[j]);
  }
  for (std::size_t length = 2; length <= size; length *= 2) {
    const auto step = std::polar(1.0, -2.0 * std::numbers::pi / static_cast<double>(length));
    for (std::size_t i = 0; i < size; i += length) {
      std::complex<double> w = 1.0;
      for (std::size_t k = 0; k < length / 2; ++k, w *= step) {
        const auto even = a[i + k], odd = a[i + k + length / 2] * w;
        a[i + k] = even + odd;
        a[i + k + length / 2] = even - odd;
      }
    }
  }
  std::vector<double> power(size / 2);
  for (std::size_t k = 0; k < power.size(); ++k) power[k] = std::norm(a[k]);
  return power;
}

/// The centre of gravity of the power spectrum [Hz].
inline double centroid_hz(std::span<const float> x, double rate = 48000.0) {
  const std::vector<double> power = power_spectrum(x);
  double sum = 0.0, moment = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    sum += power[k];
    moment += power[k] * static_cast<double>(k);
  }
  return sum > 0.0 ? moment / sum * rate / (2.0 * static_cast<double>(power.size())) : 0.0;
}

}  // namespace skerry
