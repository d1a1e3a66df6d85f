#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gpu/device.h"
#include "engine/gpu/frame_graph.h"
#include "engine/render/settings.h"
#include "shaders/shared/overlay.h"

struct ImGuiContext;

namespace skerry::game {

/// What the overlay shows. Points into the caller's data, for one frame.
struct OverlayFacts {
  struct Count {
    std::string_view name;
    std::uint64_t value = 0;
  };
  std::span<const float> frame_ms;     ///< recent frames, oldest first
  std::span<const std::string> lines;  ///< where, when and how, ready to read
  double gpu_ms = 0.0;
  std::span<const gpu::PassTime> passes;  ///< of the newest finished frame
  std::span<const Count> counts;
  std::span<const gpu::MemoryUse> memory;  ///< largest first
  bool numbers = true;                     ///< whether anything of the above is shown
  std::optional<render::DisplaySettings>
      calibration;  ///< the calibration screen (F9) is, with these
};

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

/// The developer's overlay (F3), laid out by Dear ImGui. Only its core is used: packaged builds of
/// its Vulkan backend call Vulkan through prototypes, which cannot be linked together with volk's
/// function pointers of the same names, and its shape is one draw anyway.
class Overlay {
 public:
  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  FontAtlas font() const;
  /// @param width, height of the picture [pixels]. @param seconds since the frame before.
  OverlayTriangles layout(const OverlayFacts& facts, std::uint32_t width, std::uint32_t height,
                          double seconds);

 private:
  ImGuiContext* context_;
};

/// Median and the slowest hundredth of some frames [ms]; zeros for none.
struct FrameSpread {
  float median = 0.0f, slowest_1_percent = 0.0f;
};
FrameSpread spread_of_frames(std::span<const float> frame_ms);

}  // namespace skerry::game
