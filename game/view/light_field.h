#pragma once
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "engine/render/frame/camera.h"
#include "game/scene_file/emission.h"
#include "game/scene_file/scene_contents.h"
#include "world/light/lamp_reach.h"
#include "world/mesh/stained_boxes.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// A light that shines evenly to all sides and moves with an island.
struct LatticeLight {
  glm::vec3 place{};      ///< from the lowest corner of its section's chunk, lattice axes [blocks]
  glm::vec3 intensity{};  ///< see shared::Light
  float range = 0.0f;     ///< blocks
};

/// An island as it is in a frame.
struct PlacedIsland {
  std::uint64_t id = 0;
  std::uint32_t index = 0;  ///< in FrameInput::islands
  glm::dmat3 rotation{1.0};
  glm::dvec3 origin{};  ///< of its lattice, relative to the camera [blocks]
  double radius = 0.0;  ///< of its voxels about the origin [blocks]
  std::int32_t level = 0;
  bool main = true;  ///< the finest of its levels: the one that lamps of other islands are held to
};

/// The lights of one frame, as FrameInput takes them.
struct FrameLights {
  std::vector<shared::Light> lights;
  std::vector<std::uint32_t> islands;
  std::vector<shared::LightReach> reaches;
  std::vector<shared::LightPane> panes;
  struct NearPane {
    float distance2 = 0.0f;  // from the light to the box
    shared::LightPane pane;
  };
  /// Working memory of LightField::gather, kept between frames.
  std::vector<const PlacedIsland*> near;
  std::vector<std::uint32_t> found;
  std::vector<NearPane> near_panes;
};

/// Of the panes in a light's range so many colour it, the nearest.
inline constexpr std::size_t kMostPanes = 32;

/// All lights of a world but sun and moon, and those of them that a frame needs. Their order is
/// that of section keys, then voxels, then places of the world: it does not depend on when a
/// section came or went.
class LightField {
 public:
  LightField() : emission_(emission_table()) {}

  /// What glows in a section. Places are from the lowest corner of its chunk.
  std::vector<LatticeLight> lights_of(const world::SectionKey& key,
                                      std::span<const world::Emitter> emitters) const;
  /// Takes in a section's lights, or those that its emitters make. @pre it has none yet.
  void add(const world::SectionKey& key, std::span<const world::Emitter> emitters) {
    add_lights(key, lights_of(key, emitters));
  }
  void add_lights(const world::SectionKey& key, std::vector<LatticeLight> lights);
  /// Says where on their own island a section's lights can arrive, in their order. Holds until
  /// invalidate_reach() of the island, or until the section is removed.
  void set_reach(const world::SectionKey& key, std::vector<world::LampReach::Bricks> reach);
  /// Takes in a section's stained glass. @pre it has none yet.
  void add_glass(const world::SectionKey& key, std::span<const world::StainedBox> boxes);
  /// To be called whenever a voxel of the island changes.
  void invalidate_reach(std::uint64_t island) { stale_.insert(island); }
  /// Whether a section's lights shine and its glass is there; at first they are. One without is no
  /// concern.
  void show(const world::SectionKey& key, bool shown) {
    if (shown)
      hidden_.erase(key);
    else
      hidden_.insert(key);
  }
  /// Forgets them and its glass. A section without is no concern.
  void remove(const world::SectionKey& key) {
    emitted_.erase(key);
    glass_.erase(key);
    hidden_.erase(key);
  }
  /// Forgets all that add() took in.
  void remove_sections() {
    emitted_.clear();
    glass_.clear();
    hidden_.clear();
    stale_.clear();
  }
  /// Lights that no section brings, kept for good. Keys are of level 0.
  void scatter(std::map<world::SectionKey, std::vector<LatticeLight>> lights);
  void set_world_lights(std::vector<WorldLight> lights) { world_ = std::move(lights); }

  const BlockEmission& emission(world::BlockId block) const { return emission_[block]; }

  /// @param camera what world lights are seen from. @param view none: everything is gathered, as if
  /// the camera looked to all sides. @param islands in order of their ids; lights on others are
  /// left out; an island's levels in ascending order. @param held a light relative to the camera.
  /// @param in_the_open lights count where no surface is or walls hide them, too, as in clouds, in
  /// water or without shadows. @param out replaced; keeps its memory.
  void gather(const world::WorldPos& camera, const std::optional<render::CameraView>& view,
              std::span<const PlacedIsland> islands, const std::optional<shared::Light>& held,
              bool in_the_open, FrameLights& out) const;

 private:
  /// The lights of one section.
  struct Group {
    glm::dvec3 corner{};  // of its chunk, in the lattice
    glm::vec3 centre{};   // of the sphere about all they light, from the corner
    float reach = 0.0f;   // its radius
    std::vector<LatticeLight> lights;
    std::vector<world::LampReach::Bricks> bricks;  // that each can arrive at; empty: not known
  };
  using Groups = std::map<world::SectionKey, Group>;
  /// The stained glass of one section, in the lattice [blocks].
  struct Glass {
    shared::LightPane about{};  // all of it
    std::vector<shared::LightPane> panes;
  };
  class Writer;
  static Group group_of(const world::SectionKey& key, std::vector<LatticeLight> lights);
  void gather_groups(const Groups& groups, const std::optional<render::CameraView>& view,
                     std::span<const PlacedIsland> islands, bool in_the_open,
                     FrameLights& out) const;
  void gather_world(const world::WorldPos& camera, std::span<const PlacedIsland> islands,
                    FrameLights& out) const;

  std::vector<BlockEmission> emission_;  // by block id
  Groups emitted_, scattered_;
  std::map<world::SectionKey, Glass> glass_;
  std::set<world::SectionKey> hidden_;  // of emitted_ and glass_
  std::set<std::uint64_t> stale_;       // islands whose groups' bricks no longer hold
  std::vector<WorldLight> world_;
};

}  // namespace skerry::game
