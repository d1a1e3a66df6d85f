#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/core/worker_threads.h"
#include "game/map/map_picture.h"
#include "world/voxel/island.h"

namespace skerry::game {

/// Draws maps on a thread of its own and keeps the charts of islands.
class MapMaker {
 public:
  /// Cells of a map's picture, each way.
  static constexpr int kEdge = ui::kMapEdge;

  struct Island {
    world::IslandSpec spec;
    bool planned = true;  ///< a seed made it, and it has a plan
    MapLand land;         ///< without its chart
  };
  struct Request {
    world::WorldPos middle;
    double radius = 500.0;  ///< blocks, from the middle to an edge
    std::vector<Island> islands;
  };
  struct Map {
    world::WorldPos middle;
    double radius = 500.0;
    ui::Rgba picture;
    std::size_t to_come = 0;  ///< islands whose charts were not ready
    double chart_ms = 0.0, draw_ms = 0.0;
  };

  /// Whether nothing is being drawn: else ask() would have to wait.
  bool idle() const { return !busy_; }
  /// @pre idle()
  void ask(Request request);
  /// The newest map, once.
  std::optional<Map> take();

 private:
  struct Known {
    std::shared_ptr<const IslandChart> chart;
    world::IVec3 box_min, box_max;  // of an outline: it grows as blocks are put
  };
  Map draw(Request& request);
  bool chart(Island& island, bool may_make);

  std::map<std::uint64_t, Known> known_;  // of the thread
  std::atomic<bool> busy_ = false;
  std::mutex mutex_;
  std::optional<Map> done_;
  WorkerThreads thread_{1};  // last, so that it ends first
};

}  // namespace skerry::game
