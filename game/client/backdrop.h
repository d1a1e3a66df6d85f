#pragma once
#include <memory>
#include <string>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "game/client/presenter.h"
#include "game/view/scene_view.h"

namespace skerry::game {

/// The world behind the screens while none is played.
class Backdrop {
 public:
  enum class View {
    kAround,  ///< slowly around the seed's first island, from above
    kSpawn,   ///< from where a player of that seed will stand, turning slowly
  };
  /// Errors: no memory on the device.
  static Result<std::unique_ptr<Backdrop>> create(gpu::Device& device, const SceneOptions& options,
                                                  View view);

  SceneView& view() { return *view_; }
  void advance(double seconds) { passed_s_ += seconds; }
  /// What to draw now.
  SceneView::Moment moment() const;

 private:
  Backdrop(std::unique_ptr<SceneView> view, View kind);
  std::unique_ptr<SceneView> view_;
  View kind_;
  world::WorldPos middle_;   // that kAround turns about
  double distance_ = 100.0;  // blocks
  double passed_s_ = 0.0;
};

}  // namespace skerry::game
