#include "tools/textures/canvas.h"

#include <algorithm>
#include <numeric>

namespace skerry::textures {
namespace {

Field box(const Field& field, int radius) {
  const float area = static_cast<float>((2 * radius + 1) * (2 * radius + 1));
  return make_field([&](int x, int y) {
    float sum = 0.0f;
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) sum += field.at(x + dx, y + dy);
    return sum / area;
  });
}

}  // namespace

Field even_fbm(Cells cells, int octaves, std::uint32_t seed) {
  return equalize(make_field([&](int x, int y) {
    return fbm(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, cells, octaves, seed);
  }));
}

Field equalize(const Field& field) {
  std::array<int, kTexels> order;
  std::iota(order.begin(), order.end(), 0);
  const auto& values = field.values();
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  Field ranks;
  for (int rank = 0; rank < kTexels; ++rank) {
    ranks.values()[order[rank]] = static_cast<float>(rank) / (kTexels - 1);
  }
  return ranks;
}

Field relief(const Field& height) {
  return make_field([&](int x, int y) {
    const float diagonal = height.at(x + 1, y + 1) - height.at(x - 1, y - 1);
    const float straight =
        height.at(x + 1, y) - height.at(x - 1, y) + height.at(x, y + 1) - height.at(x, y - 1);
    return diagonal + 0.5f * straight;
  });
}

Field blur(const Field& field, int radius) {
  return box(box(field, radius), radius);
}

Field flatten(const Field& field, float amount) {
  const Field wide = blur(field, 4);
  const auto& values = field.values();
  const float mean = std::accumulate(values.begin(), values.end(), 0.0f) / kTexels;
  return make_field([&](int x, int y) { return field.at(x, y) - amount * (wide.at(x, y) - mean); });
}

Canvas empty_canvas() {
  Canvas canvas;
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) canvas.at(x, y) = {{}, 0.0f};
  return canvas;
}

Canvas paint(const Ramp& ramp, const Field& tone, int steps) {
  Canvas canvas;
  const float count = static_cast<float>(steps);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const float t = std::clamp(tone.at(x, y), 0.0f, 1.0f);
      const float flat = (std::floor(t * (count - 1.0f) + 0.5f)) / (count - 1.0f);
      canvas.set(x, y, ramp.at(t + (flat - t) * 0.75f));
    }
  }
  return canvas;
}

Field brush(const Brushwork& work, std::uint32_t seed) {
  Field tone = make_field([](int, int) { return 0.5f; });
  Random random(seed);
  for (int i = 0; i < work.touches; ++i) {
    const float length = random.range(work.length_low, work.length_high);
    const auto [x, y] = spread_point(i, seed);
    const Direction along = direction(random.range(work.turn_low, work.turn_high));
    const float level = 0.5f + work.contrast * random.range(-1.0f, 1.0f);
    for_dab({x, y, along, length, length * work.flatness}, [&](int px, int py, float u, float v) {
      tone.at(px, py) = level - work.contrast * (0.9f * v + 0.25f * u);
    });
  }
  return flatten(tone, 0.85f);
}

Direction direction(float turn) {
  const float quarters = (turn - std::floor(turn)) * 4.0f;
  const int quarter = static_cast<int>(quarters);
  const float t = quarters - static_cast<float>(quarter);
  // Rational points of the unit circle; t is close to the share of the quarter turn.
  const float x = (1.0f - t * t) / (1.0f + t * t), y = 2.0f * t / (1.0f + t * t);
  switch (quarter & 3) {
    case 0:
      return {x, y};
    case 1:
      return {-y, x};
    case 2:
      return {-x, -y};
    default:
      return {y, -x};
  }
}

}  // namespace skerry::textures
