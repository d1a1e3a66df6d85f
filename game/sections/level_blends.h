#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// In which pixels sections of islands are drawn while their level of detail changes.
///
/// A section of a level is a place in a tree of places: its parent is the place of twice its edge,
/// and the far sections of an island hold all of it. Each place whose level changes has a share of
/// the pixels that show its finer levels, which rises or falls with time. A pixel shows the first
/// section on its way from the coarsest place to the finest whose share does not reach the pixel's
/// own step of a pattern. So each pixel shows one level of each place, whatever changes again
/// before it is done. Places take the steps of their shares at different times, so that at high
/// frame rates a frame changes a part of an island's sections. A function of its calls; there is no
/// clock in it.
class LevelBlends {
 public:
  static constexpr double kSeconds = 0.5;      ///< that a change takes
  static constexpr double kMostAStep = 0.125;  ///< of a change, however long a frame took

  /// Of the steps of the pattern [first, end) show the section.
  struct Shown {
    std::uint32_t first = 0, end = shared::kBlendSteps;
    bool goes = false;
    bool whole() const { return first == 0 && end == shared::kBlendSteps && !goes; }
    bool none() const { return first >= end; }
    bool operator==(const Shown&) const = default;
    /// As shared::Section::blend.
    std::uint32_t packed() const;
  };

  /// Other sections of an island are chosen. @param came, went together each place once before and
  /// once after, where the island has anything there.
  void change(std::uint64_t island, std::span<const world::SectionKey> came,
              std::span<const world::SectionKey> went);
  void advance(double seconds);
  /// What has been chosen is shown at once.
  void finish(std::uint64_t island);
  void finish_all();
  /// Of each section that has come or gone and is not done: those that are shown otherwise than
  /// when this was last called, or of which change() or repeat() has been called since.
  void each_changed(const std::function<void(const world::SectionKey&, const Shown&)>& visit);
  /// Has the next each_changed() visit a section, if it is not done.
  void repeat(const world::SectionKey& key);
  /// Drops what is done. @return islands of which nothing changes any more.
  std::vector<std::uint64_t> settle();
  bool idle() const { return islands_.empty(); }
  bool blends(std::uint64_t island) const { return islands_.contains(island); }
  void clear() { islands_.clear(); }

 private:
  struct Share {
    double finer = 0.0;  // 0: the place itself is shown, 1: what is finer
    bool rises = false;
    std::uint32_t step = 0;  // of the pattern that `finer` has reached
    bool done = false;       // its section is: erased next
  };
  static constexpr std::size_t kMostAbove = world::kLevelCount + world::kFarLevelCount - 1;
  struct Section {
    bool chosen = false;
    bool visited = false;  // with `shown`
    Shown shown;
    // What decides about it; null: that place does not change.
    Share* own = nullptr;
    std::array<Share*, kMostAbove> above{};
  };
  struct Island {
    std::map<world::SectionKey, Share> shares;  // of places, not all of which are sections
    std::map<world::SectionKey, Section> sections;
    bool linked = false;    // sections have the shares there are
    bool unsettled = true;  // sections or steps have changed since settle()
  };
  static void set(const world::SectionKey& place, Share& share, double finer, Island& island);
  static void link(Island& island);
  static Shown shown(const Section& section);

  std::map<std::uint64_t, Island> islands_;
};

}  // namespace skerry::game
