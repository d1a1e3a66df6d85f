#pragma once
#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/resources.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/cascades.h"
#include "engine/render/scene/geometry_changes.h"

namespace skerry::gpu {
class Device;
}

namespace skerry::render {

/// A body's cascade this frame.
struct ActiveCascade {
  int body = 0;             ///< 0 the sun, 1 the moon
  int index = 0;            ///< in its body
  std::uint32_t layer = 0;  ///< of the map array, and index in FrameConstants::cascades
  bool redraw = false;      ///< false: the kept map still shows the same
  Cascade cascade;
};

/// The shadow maps and what each of them shows. Bodies below the horizon have no cascades, and
/// without any the array itself is given back. A map is kept while its window, its light, the
/// geometry in the window and the islands stay: islands may have moved by a quarter of a texel.
class ShadowMaps {
 public:
  explicit ShadowMaps(gpu::Device& device) : device_(&device) {}

  /// Decides this frame's cascades. @return all that are active, sun first. Errors: out of memory.
  Result<std::span<const ActiveCascade>> update(const FrameInput& input,
                                                const RenderSettings& settings,
                                                const GeometryChanges& geometry);
  /// Null when nothing casts.
  gpu::Image* maps() { return maps_ ? &maps_ : nullptr; }
  void forget();

 private:
  struct Kept {
    bool valid = false;
    CascadeKey key;
    std::uint64_t geometry_version = 0;
    std::vector<IslandPlacement> islands;
    FixedPos anchor{};
  };
  /// Takes note, in `kept`, of changes that do not touch it.
  bool still_right(Kept& kept, const Cascade& cascade, const FrameInput& input,
                   const GeometryChanges& geometry) const;

  gpu::Device* device_;
  gpu::Image maps_;
  std::array<Kept, 8> kept_;
  std::vector<ActiveCascade> active_;
  std::array<bool, 2> casting_{};
  int map_size_ = 0;
};

}  // namespace skerry::render
