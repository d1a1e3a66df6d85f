#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "shaders/shared/overlay.h"

namespace skerry::game::ui {

/// Triangles to draw over a picture: three vertices each, back to front.
struct OverlayTriangles {
  std::vector<shared::OverlayVertex> vertices;
  std::vector<glm::vec4> clips;  ///< min x, min y, max x, max y [pixels]
};

/// Coverage of the glyphs, 8 bits a texel.
struct FontAtlas {
  int width = 0, height = 0;
  std::span<const unsigned char> texels;
};

/// RGBA8 in sRGB values with straight alpha, rows from the top.
struct PictureView {
  int width = 0, height = 0;
  std::span<const std::uint8_t> pixels;
};

/// What triangles are textured with.
struct OverlayImages {
  FontAtlas font;
  PictureView pictures;
};

}  // namespace skerry::game::ui
