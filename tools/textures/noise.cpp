#include "tools/textures/noise.h"

#include <cmath>

namespace skerry::textures {
namespace {

int modulo(int i, int n) {
  return ((i % n) + n) % n;
}

float blend(float a, float b, float t) {
  return a + (b - a) * t;
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

float gradient(int cell_x, int cell_y, Cells cells, std::uint32_t seed, float dx, float dy) {
  const int x = modulo(cell_x, cells.x), y = modulo(cell_y, cells.y);
  return (unit(x, y, seed) * 2.0f - 1.0f) * dx + (unit(x, y, seed ^ 0x5bd1u) * 2.0f - 1.0f) * dy;
}

}  // namespace

float gradient_noise(float x, float y, Cells cells, std::uint32_t seed) {
  const float u = x * static_cast<float>(cells.x) / kEdge,
              v = y * static_cast<float>(cells.y) / kEdge;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const float fx = u - static_cast<float>(i), fy = v - static_cast<float>(j);
  const float top = blend(gradient(i, j, cells, seed, fx, fy),
                          gradient(i + 1, j, cells, seed, fx - 1.0f, fy), fade(fx));
  const float bottom = blend(gradient(i, j + 1, cells, seed, fx, fy - 1.0f),
                             gradient(i + 1, j + 1, cells, seed, fx - 1.0f, fy - 1.0f), fade(fx));
  return blend(top, bottom, fade(fy));
}

float noise_at(int x, int y, Cells cells, std::uint32_t seed) {
  return gradient_noise(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, cells, seed);
}

float fbm(float x, float y, Cells cells, int octaves, std::uint32_t seed) {
  float sum = 0.0f, weight = 1.0f;
  for (int octave = 0; octave < octaves; ++octave, weight *= 0.5f) {
    sum += weight * gradient_noise(x, y, cells, seed + static_cast<std::uint32_t>(octave) * 101u);
    cells = {cells.x * 2, cells.y * 2};
  }
  return sum;
}

Cellular cell_at(int x, int y, Cells cells, float jitter, std::uint32_t seed) {
  return cellular(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, cells, jitter, seed);
}

float cell_unit(const Cellular& cell, std::uint32_t seed) {
  return unit(static_cast<int>(cell.id & 0xffffu), 0, seed);
}

Point spread_point(int i, std::uint32_t seed) {
  const float n = static_cast<float>(i);
  const float u = unit(0, 3, seed) + n * 0.7548777f + 0.22f * unit(i, 5, seed);
  const float v = unit(1, 3, seed) + n * 0.5698403f + 0.22f * unit(i, 7, seed);
  return {(u - std::floor(u)) * kEdge, (v - std::floor(v)) * kEdge};
}

Cellular cellular(float x, float y, Cells cells, float jitter, std::uint32_t seed) {
  const float u = x * static_cast<float>(cells.x) / kEdge,
              v = y * static_cast<float>(cells.y) / kEdge;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  Cellular found{9.0f, 9.0f, 0};
  for (int cell_y = j - 2; cell_y <= j + 2; ++cell_y) {
    for (int cell_x = i - 2; cell_x <= i + 2; ++cell_x) {
      const int wrapped_x = modulo(cell_x, cells.x), wrapped_y = modulo(cell_y, cells.y);
      const float px =
          static_cast<float>(cell_x) + 0.5f + (unit(wrapped_x, wrapped_y, seed) - 0.5f) * jitter;
      const float py = static_cast<float>(cell_y) + 0.5f +
                       (unit(wrapped_x, wrapped_y, seed + 77u) - 0.5f) * jitter;
      const float distance = std::sqrt((px - u) * (px - u) + (py - v) * (py - v));
      if (distance < found.nearest) {
        found.second = found.nearest;
        found.nearest = distance;
        found.id = hash(static_cast<std::uint32_t>(wrapped_x),
                        static_cast<std::uint32_t>(wrapped_y), seed + 154u);
      } else if (distance < found.second) {
        found.second = distance;
      }
    }
  }
  return found;
}

}  // namespace skerry::textures
