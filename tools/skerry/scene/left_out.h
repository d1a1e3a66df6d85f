#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "game/scene_file/options.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {

/// A scene that lacks a feature, and the setting under which the renderer has none of it.
struct LackingScene {
  std::string feature;  ///< as `--explain` names it
  std::string setting;  ///< "leave.out=...", "shadow.enabled=0" or the like
  game::SceneOptions scene;
};

/// One scene for each feature that can be left out. Errors: none but a mistake in the list.
Result<std::vector<LackingScene>> lacking_scenes();

/// One of the two renderers of a row.
struct LeftOutSide {
  gpu::FrameCounts counts;
  int pipelines_created = 0;
  std::uint64_t memory_bytes = 0;  ///< of the device, that this renderer takes
  double ms = 0.0;                 ///< GPU, median of the frames timed
  double start_ms = 0.0;           ///< from nothing to the first picture, with compiled pipelines
};

/// A scene without a feature, drawn by the renderer as it is, and by one that has none of the
/// feature at all.
struct LeftOutRow {
  std::string feature;
  std::string why;            ///< why the frame says it left the feature out; empty: it did not
  bool same_picture = false;  ///< to the last byte
  LeftOutSide as_is, without;
  /// Whether both asked the same of the device. Times are not looked at.
  bool same_counts() const;
};

/// @param frames timed with each renderer, in turns, and as many starts, but three at most; 0:
/// none.
/// @param light of islands, handed on from call to call, but not to starts that are timed; null:
/// found anew. It is found by the CPU: no count knows of it.
/// Errors: the scene cannot be drawn on this device.
Result<LeftOutRow> measure_left_out(gpu::Device& device, const LackingScene& lacking, int frames,
                                    const std::shared_ptr<world::LightCache>& light = nullptr);

}  // namespace skerry::tools
