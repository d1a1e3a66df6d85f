#include "game/ui/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/core/check.h"
#include "engine/render/scene/block_textures.h"

namespace skerry::game::ui {
namespace {

constexpr int kBlocksPerRow = Pictures::kWidth / kBlockPictureEdge;
constexpr int kThumbnailsPerRow = Pictures::kWidth / kThumbnailWidth;
constexpr int kThumbnailsTop = 512;  // room for 128 blocks above
constexpr int kMapTop =
    kThumbnailsTop + Pictures::kThumbnails / kThumbnailsPerRow * kThumbnailHeight;
static_assert(kMapTop + kMapEdge <= Pictures::kHeight && kMapEdge <= Pictures::kWidth);
static_assert(world::block::kBuiltInCount <= kBlocksPerRow * (kThumbnailsTop / kBlockPictureEdge));

constexpr float kClear = 0.06f;  // absorption of what looks like nothing [1/block]
constexpr float kDepth = 1.6f;   // optical, of what absorbs most, in a picture
constexpr float kSeen = 190.0f;  // alpha of it

using Texel = std::array<float, 4>;  // sRGB values 0 .. 255, alpha

/// A face of a block, sampled at u right and v down, 0 .. 1.
Texel sample(const render::BlockTextures& textures, world::Texture layer, float u, float v) {
  const auto edge = static_cast<std::size_t>(textures.edge);
  const auto place = [&](float t) {
    return std::min(edge - 1, static_cast<std::size_t>(t * static_cast<float>(edge)));
  };
  const std::size_t at =
      ((static_cast<std::size_t>(layer) * edge + place(v)) * edge + place(u)) * 4;
  Texel out{};
  for (std::size_t c = 0; c < 4; ++c)
    out[c] = std::to_integer<std::uint8_t>(textures.texels[at + c]);
  return out;
}

bool within(float value) {
  return value >= 0.0f && value < 1.0f;
}

/// What a cube seen from above a corner shows at a place of its picture, 0 .. 1 across: the top is
/// a rhomb, below it are two sides, each shaded as if lit from the upper left.
Texel cube_at(const render::BlockTextures& textures, const world::BlockType& type, float x,
              float y) {
  constexpr float kHalf = 0.44f, kRise = 0.22f, kTall = 0.46f, kTop = 0.05f;
  const float dx = (x - 0.5f) / kHalf, dy = (y - kTop) / kRise;
  const float u = 0.5f * (dy + dx), v = 0.5f * (dy - dx);
  const auto shaded = [](Texel texel, float light) {
    for (std::size_t c = 0; c < 3; ++c) texel[c] *= light;
    return texel;
  };
  if (within(u) && within(v)) return shaded(sample(textures, type.top, u, v), 1.0f);
  const bool left = dx < 0.0f;
  const float across = left ? dx + 1.0f : dx;
  const float edge = kTop + kRise * (left ? 1.0f + across : 2.0f - across);
  const float down = (y - edge) / kTall;
  if (!within(across) || !within(down)) return {};
  return shaded(sample(textures, type.side, across, down), left ? 0.80f : 0.62f);
}

/// What takes light all the way through, as water does, is seen by that and not by its faces.
Texel tinted(Texel texel, const world::BlockType& type) {
  const float strongest = *std::max_element(type.absorption.begin(), type.absorption.end());
  if (type.kind != world::BlockKind::kTranslucent || strongest < kClear) return texel;
  const bool on_a_face = texel[0] + texel[1] + texel[2] > 0.0f;
  if (!on_a_face) return texel;
  for (std::size_t c = 0; c < 3; ++c)
    texel[c] = 255.0f * std::exp(-kDepth / strongest * type.absorption[c]);
  texel[3] = std::max(texel[3], kSeen);
  return texel;
}

Texel picture_at(const render::BlockTextures& textures, const world::BlockType& type, float x,
                 float y) {
  if (type.kind != world::BlockKind::kPlant) return tinted(cube_at(textures, type, x, y), type);
  constexpr float kMargin = 0.08f;
  const float u = (x - kMargin) / (1.0f - 2.0f * kMargin);
  const float v = (y - kMargin) / (1.0f - 2.0f * kMargin);
  return within(u) && within(v) ? sample(textures, type.side, u, v) : Texel{};
}

/// The texels of a plant's texture that are there.
std::vector<HeldTexel> held_texels(world::BlockId plant) {
  const render::BlockTextures textures = render::block_textures();
  const int edge = textures.edge;
  const auto texel = [&](int x, int y) {
    if (x >= edge || y >= edge) return Texel{};
    const auto middle = [&](int t) {
      return (static_cast<float>(t) + 0.5f) / static_cast<float>(edge);
    };
    return sample(textures, world::block_types()[plant].side, middle(x), middle(edge - 1 - y));
  };
  const auto there = [](const Texel& t) { return t[3] >= 128.0f; };
  std::vector<HeldTexel> out;
  for (int y = 0; y < edge; ++y) {
    for (int x = 0; x < edge; ++x) {
      const Texel t = texel(x, y);
      if (!there(t)) continue;
      const auto byte = [](float v) { return static_cast<int>(v); };
      out.push_back({x - edge / 2, y, IM_COL32(byte(t[0]), byte(t[1]), byte(t[2]), 255),
                     !there(texel(x + 1, y)), !there(texel(x, y + 1))});
    }
  }
  return out;
}

}  // namespace

Rgba block_picture(world::BlockId block) {
  constexpr int kSamples = 3;  // each way, a pixel
  const render::BlockTextures textures = render::block_textures();
  const world::BlockType& type = world::block_types()[block];
  Rgba out{kBlockPictureEdge, kBlockPictureEdge, {}};
  if (type.kind == world::BlockKind::kAir) {
    out.pixels.assign(std::size_t{kBlockPictureEdge} * kBlockPictureEdge * 4, 0);
    return out;
  }
  const float step = 1.0f / (kBlockPictureEdge * kSamples);
  for (int y = 0; y < kBlockPictureEdge; ++y) {
    for (int x = 0; x < kBlockPictureEdge; ++x) {
      Texel sum{};
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const auto place = [&](int pixel, int part) {
          return (static_cast<float>(pixel * kSamples + part) + 0.5f) * step;
        };
        const Texel t = picture_at(textures, type, place(x, i % kSamples), place(y, i / kSamples));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += t[c] * t[3];
        sum[3] += t[3];
      }
      for (std::size_t c = 0; c < 3; ++c)
        out.pixels.push_back(
            static_cast<std::uint8_t>(sum[3] > 0.0f ? std::lround(sum[c] / sum[3]) : 0));
      out.pixels.push_back(static_cast<std::uint8_t>(std::lround(sum[3] / (kSamples * kSamples))));
    }
  }
  return out;
}

Rgba thumbnail_of(int width, int height, std::span<const std::uint8_t> pixels) {
  Rgba out;
  if (width <= 0 || height <= 0) return out;
  SKERRY_ASSERT(pixels.size() ==
                static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  out.width = kThumbnailWidth;
  out.height = kThumbnailHeight;
  // The largest part of that shape.
  const double scale = std::min(static_cast<double>(width) / kThumbnailWidth,
                                static_cast<double>(height) / kThumbnailHeight);
  const double left = 0.5 * (width - scale * kThumbnailWidth);
  const double top = 0.5 * (height - scale * kThumbnailHeight);
  const auto span = [&](double low, int at, int limit) {
    const int first = std::min(limit - 1, static_cast<int>(low + scale * at));
    const int last = std::min(limit, static_cast<int>(low + scale * (at + 1)));
    return std::pair(first, std::max(first + 1, last));
  };
  for (int y = 0; y < kThumbnailHeight; ++y) {
    const auto [y0, y1] = span(top, y, height);
    for (int x = 0; x < kThumbnailWidth; ++x) {
      const auto [x0, x1] = span(left, x, width);
      std::array<int, 3> sum{};
      for (int sy = y0; sy < y1; ++sy)
        for (int sx = x0; sx < x1; ++sx)
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += pixels[(static_cast<std::size_t>(sy) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(sx)) *
                                 4 +
                             c];
      const int count = (y1 - y0) * (x1 - x0);
      for (const int channel : sum)
        out.pixels.push_back(static_cast<std::uint8_t>((channel + count / 2) / count));
      out.pixels.push_back(255);
    }
  }
  return out;
}

Pictures::Pictures()
    : pixels_(std::size_t{kWidth} * kHeight * 4), torch_(held_texels(world::block::kTorch)) {
  for (world::BlockId block = 0; block < world::block::kBuiltInCount; ++block)
    put(block % kBlocksPerRow * kBlockPictureEdge, block / kBlocksPerRow * kBlockPictureEdge,
        block_picture(block));
}

PicturePart Pictures::block(world::BlockId block) const {
  const int row = block / kBlocksPerRow;
  const auto x = static_cast<float>(block % kBlocksPerRow * kBlockPictureEdge);
  const auto y = static_cast<float>(row * kBlockPictureEdge);
  return {{x / kWidth, y / kHeight},
          {(x + kBlockPictureEdge) / kWidth, (y + kBlockPictureEdge) / kHeight}};
}

PicturePart Pictures::thumbnail(int slot) const {
  const int row = slot / kThumbnailsPerRow;
  const auto x = static_cast<float>(slot % kThumbnailsPerRow * kThumbnailWidth);
  const auto y = static_cast<float>(kThumbnailsTop + row * kThumbnailHeight);
  return {{x / kWidth, y / kHeight},
          {(x + kThumbnailWidth) / kWidth, (y + kThumbnailHeight) / kHeight}};
}

void Pictures::set_thumbnail(int slot, const Rgba& picture) {
  SKERRY_ASSERT(slot >= 0 && slot < kThumbnails && picture.width == kThumbnailWidth &&
                picture.height == kThumbnailHeight);
  put(slot % kThumbnailsPerRow * kThumbnailWidth,
      kThumbnailsTop + slot / kThumbnailsPerRow * kThumbnailHeight, picture);
}

PicturePart Pictures::map() const {
  return {
      {0.0f, static_cast<float>(kMapTop) / kHeight},
      {static_cast<float>(kMapEdge) / kWidth, static_cast<float>(kMapTop + kMapEdge) / kHeight}};
}

void Pictures::set_map(const Rgba& picture) {
  SKERRY_ASSERT(picture.width == kMapEdge && picture.height == kMapEdge);
  put(0, kMapTop, picture);
}

void Pictures::put(int x, int y, const Rgba& picture) {
  const auto row_bytes = static_cast<std::size_t>(picture.width) * 4;
  for (int row = 0; row < picture.height; ++row) {
    const std::size_t to =
        (static_cast<std::size_t>(y + row) * kWidth + static_cast<std::size_t>(x)) * 4;
    std::copy_n(picture.pixels.data() + static_cast<std::size_t>(row) * row_bytes, row_bytes,
                pixels_.data() + to);
  }
  ++version_;
}

}  // namespace skerry::game::ui
