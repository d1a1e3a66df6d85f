#include "tools/reference/textures.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "engine/render/scene/block_textures.h"

namespace skerry::reference {
namespace {

/// IEC 61966-2-1.
double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Place on a texture [blocks], row 0 on top: docs/conventions.md.
glm::dvec2 place_on_face(int face, glm::dvec3 p) {
  switch (axis_of_face(face)) {
    case 0:
      return {p.z, -p.y};
    case 1:
      return {p.x, p.z};
    default:
      return {p.x, -p.y};
  }
}

std::size_t layer_of(world::BlockId block, int face) {
  const world::BlockType& type = world::block_types()[block];
  return static_cast<std::size_t>(face == 2 ? type.top : face == 3 ? type.bottom : type.side);
}

}  // namespace

const BlockTexels& BlockTexels::shared() {
  static const BlockTexels texels;
  return texels;
}

BlockTexels::BlockTexels() {
  const render::BlockTextures file = render::block_textures();
  edge_ = file.edge;
  mask_ = static_cast<int>(file.edge) - 1;
  std::array<float, 256> decoded;
  for (std::size_t i = 0; i < 256; ++i)
    decoded[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / 255.0));
  texels_.resize(edge_ * edge_ * file.layers);
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    const auto byte = [&](std::size_t c) {
      return std::to_integer<std::size_t>(file.texels[4 * i + c]);
    };
    texels_[i] = {decoded[byte(0)], decoded[byte(1)], decoded[byte(2)],
                  static_cast<float>(byte(3)) / 255.0f};
  }
}

glm::dvec4 BlockTexels::texel(world::BlockId block, int face, glm::dvec3 point) const {
  const glm::dvec2 p = place_on_face(face, point) * static_cast<double>(edge_);
  return at(layer_of(block, face), static_cast<int>(std::floor(p.x)),
            static_cast<int>(std::floor(p.y)));
}

bool BlockTexels::covers(world::BlockId block, int face, glm::dvec3 point) const {
  const double texel = 1.0 / static_cast<double>(edge_);
  if (axis_of_face(face) == 3)
    point = glm::clamp(point, glm::dvec3(0.5 * texel), glm::dvec3(1.0 - 0.5 * texel));
  const glm::dvec2 p = place_on_face(face, point) / texel - 0.5;
  const glm::dvec2 low{std::floor(p.x), std::floor(p.y)};
  const double x = p.x - low.x, y = p.y - low.y;
  const std::size_t layer = layer_of(block, face);
  const int i = static_cast<int>(low.x), j = static_cast<int>(low.y);
  const double upper = (1.0 - x) * at(layer, i, j).w + x * at(layer, i + 1, j).w;
  const double lower = (1.0 - x) * at(layer, i, j + 1).w + x * at(layer, i + 1, j + 1).w;
  return (1.0 - y) * upper + y * lower >= 0.5;
}

}  // namespace skerry::reference
