// Giant mushrooms.
#include <algorithm>

#include "tools/textures/painters.h"

namespace skerry::textures {

Canvas paint_mushroom_cap(Color base, Color spot, std::uint32_t seed) {
  const Ramp skin = ramp(base, 0.55f), spots = ramp(spot, 0.5f);
  Canvas canvas = paint(skin, brush({90, 2.5f, 5.0f, 0.55f, -0.2f, 0.2f, 0.12f}, seed), 9);
  // Warts: round, raised, with a soft shadow below.
  constexpr float kSpots[][3] = {{6, 7, 3.0f},  {19, 4, 2.1f},  {27, 13, 3.3f}, {14, 16, 2.6f},
                                 {4, 22, 2.0f}, {22, 25, 2.8f}, {11, 28, 1.9f}};
  for (const auto& [x, y, size] : kSpots) {
    for_dab({x + 0.8f, y + 1.2f, {1, 0}, size, size * 0.92f},
            [&](int px, int py, float, float) { canvas.tint(px, py, hex(0x231a24), 0.32f); });
    for_dab({x, y, {1, 0}, size, size * 0.88f}, [&](int px, int py, float u, float v) {
      canvas.set(px, py, spots.at(0.6f - 0.22f * (u + v)));
    });
  }
  return canvas;
}

Canvas paint_mushroom_stem() {
  const Field height = make_field([](int x, int y) {
    const float bend =
        2.0f * gradient_noise(static_cast<float>(x) + 0.5f, static_cast<float>(y), {3, 2}, 951);
    return 0.5f +
           gradient_noise(static_cast<float>(x) + 0.5f + bend, static_cast<float>(y), {9, 2}, 952);
  });
  const Field light = relief(height);
  return paint(ramp(hex(0xd3c8b4), 0.5f),
               flatten(make_field([&](int x, int y) {
                         return 0.5f + 0.28f * light.at(x, y) + 0.3f * (height.at(x, y) - 0.5f);
                       }),
                       0.8f),
               8);
}

}  // namespace skerry::textures
