// The coloured pictures on our screens: blocks in the hand, worlds in the list, the map.
#pragma once
#include <imgui.h>

#include <cstdint>
#include <span>
#include <vector>

#include "world/voxel/blocks.h"

namespace skerry::game::ui {

/// What ImGui calls the one image that holds all pictures; the font's is null.
inline ImTextureID pictures_id() {
  return reinterpret_cast<ImTextureID>(std::uintptr_t{1});
}

/// Part of the image, in its coordinates 0 .. 1.
struct PicturePart {
  ImVec2 low, high;
};

inline constexpr int kBlockPictureEdge = 64;                         ///< pixels
inline constexpr int kThumbnailWidth = 256, kThumbnailHeight = 144;  ///< pixels

/// RGBA8 pixels, sRGB with straight alpha, rows from the top.
struct Rgba {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// A block as it looks in the hand: a cube seen from above a corner, or a plant from the side.
Rgba block_picture(world::BlockId block);

/// A picture's middle, cut to a thumbnail's shape and averaged down to its size. @param pixels
/// width * height * 4 bytes. An empty picture gives none.
Rgba thumbnail_of(int width, int height, std::span<const std::uint8_t> pixels);

/// One texel of what is held, as large as a step of x and y.
struct HeldTexel {
  int x = 0, y = 0;                           ///< right of the middle, above the foot
  std::uint32_t colour = 0;                   ///< as ImGui packs it
  bool open_right = false, open_top = false;  ///< no texel is there
};

inline constexpr int kMapEdge = 512;  ///< pixels

/// All kinds, in one image.
class Pictures {
 public:
  static constexpr int kWidth = 1024, kHeight = 2464;
  /// How many thumbnails there is room for.
  static constexpr int kThumbnails = 40;

  Pictures();  ///< draws all blocks
  PicturePart block(world::BlockId block) const;
  PicturePart thumbnail(int slot) const;
  /// @param slot 0 .. kThumbnails - 1. @param picture of a thumbnail's size.
  void set_thumbnail(int slot, const Rgba& picture);
  PicturePart map() const;
  /// @param picture kMapEdge each way.
  void set_map(const Rgba& picture);

  /// A torch, texel by texel.
  std::span<const HeldTexel> torch() const { return torch_; }

  std::span<const std::uint8_t> pixels() const { return pixels_; }
  /// Grows with every change.
  std::uint64_t version() const { return version_; }

 private:
  void put(int x, int y, const Rgba& picture);
  std::vector<std::uint8_t> pixels_;
  std::uint64_t version_ = 0;
  std::vector<HeldTexel> torch_;
};

}  // namespace skerry::game::ui
