// What is shown while a view is made ready.
#pragma once
#include <cstddef>
#include <cstdint>

namespace skerry::game::ui {

struct LoadingFacts {
  std::uint32_t passes_done = 0, passes = 0;  ///< of the frame whose programs are compiled
  std::size_t islands_to_come = 0;            ///< tasks left; 0: it is about programs so far
  double seconds = 0.0;                       ///< since it began
};

/// Between Gui::begin and end.
void show_loading(const LoadingFacts& facts);

}  // namespace skerry::game::ui
