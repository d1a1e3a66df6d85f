#pragma once
#include <bitset>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/offset_arena.h"
#include "engine/render/frame/draw_limits.h"
#include "engine/render/scene/geometry_changes.h"
#include "engine/render/scene/memory_budget.h"
#include "engine/render/scene/voxel_box.h"
#include "shaders/shared/geometry.h"

namespace skerry::gpu {
class Device;
class Uploader;
}  // namespace skerry::gpu

namespace skerry::render {

/// Sections of most worlds: tables begin with room for them, so that none grows in a flight.
inline constexpr std::uint32_t kUsualSections = 8192;
/// Likewise draws of their lists.
inline constexpr DrawLimits kUsualDraws{2 * kUsualSections, kUsualSections, kUsualSections / 2};

using BlockSet = std::bitset<shared::kMaxMaterials>;

/// Blocks that take light which passes, and are no liquid.
struct GlassBlocks {
  BlockSet all;
  BlockSet stained;  ///< that take a tenth of a colour or more a block
};
/// @param materials by block id.
GlassBlocks glass_among(std::span<const shared::Material> materials);

/// A resident chunk mesh; only GeometryStore makes one.
struct SectionId {
  std::uint32_t slot = ~0u;
  bool operator==(const SectionId&) const = default;
};

/// Everything drawable that stays on the GPU between frames: quads in one arena, one section record
/// a chunk mesh. Writes go through the uploader's queue, a section's quads before its record, so
/// the GPU never sees a record whose quads are missing.
class GeometryStore {
 public:
  /// @param budget must outlive the store.
  /// @param glass block ids: see glass_boxes().
  /// @param arena_quads capacity to begin with, less if that is much of the budget; it doubles when
  /// full, up to the device's largest storage buffer and what the budget has left.
  static Result<std::unique_ptr<GeometryStore>> create(gpu::Device& device, MemoryBudget& budget,
                                                       const GlassBlocks& glass,
                                                       std::uint32_t arena_quads);
  ~GeometryStore();

  /// Queues a chunk mesh. @param section its record; first_quad is filled in here. @param quads not
  /// empty. Errors, with nothing changed, when the arena is full and cannot grow: what is needed,
  /// what there is, what to lower.
  Result<SectionId> add(gpu::Uploader& uploader, shared::Section section,
                        std::span<const shared::Quad> quads);
  /// Whether it is drawn and casts shadows; at first it does. Its quads stay where they are.
  void show(gpu::Uploader& uploader, SectionId id, bool shown);
  /// In which pixels it is drawn while it is shown: shared::Section::blend. What comes into view is
  /// drawn in all of them.
  /// The GPU has it with the next send_blends(). @pre it is shown.
  void blend(SectionId id, std::uint32_t blend);
  /// Writes the records of which blend() has been called: hundreds change at once, and those that
  /// lie next to each other are written together.
  void send_blends(gpu::Uploader& uploader);
  /// Its quads may be overwritten once the GPU has finished everything submitted so far.
  void remove(gpu::Uploader& uploader, SectionId id);
  /// Once a frame, before recording: reclaims what the GPU has finished with.
  void collect();

  gpu::Buffer& quads() { return quads_; }
  gpu::Buffer& sections() { return sections_; }
  /// Section slots in use or once used: what culling looks at.
  std::uint32_t section_slots() const { return static_cast<std::uint32_t>(records_.size()); }
  std::uint32_t sections_resident() const {
    return section_slots() - static_cast<std::uint32_t>(free_slots_.size());
  }
  std::uint64_t quads_resident() const { return arena_.used(); }
  /// Where the quads are. Nothing in it is ever moved.
  const gpu::OffsetArena& arena() const { return arena_; }
  /// Of quads that are resident or that the GPU may still read.
  std::uint64_t bytes_in_use() const {
    return (std::uint64_t{arena_.used()} + arena_.waiting()) * sizeof(shared::Quad);
  }
  /// Enough for what is resident and for what the GPU holds until the uploads have been recorded:
  /// never less than before.
  const DrawLimits& most_draws() const { return most_draws_; }
  std::uint64_t translucent_quads() const { return translucent_quads_; }
  std::uint64_t cutout_quads() const { return cutout_quads_; }
  /// Drawn in some pixels alone.
  std::uint32_t sections_blended() const { return sections_blended_; }
  std::span<const shared::Section> records() const { return records_; }
  /// Of each slot's translucent quads; of any value where it has none.
  std::span<const VoxelBox> translucent_boxes() const { return translucent_boxes_; }
  /// By slot, of sections that have quads of glass; of those that are not shown, too.
  const std::map<std::uint32_t, GlassBox>& glass_boxes() const { return glass_boxes_; }
  /// For kept shadow maps: what invalidates them.
  const GeometryChanges& changes() const { return changes_; }

 private:
  GeometryStore(gpu::Device& device, MemoryBudget& budget, std::uint32_t arena_quads)
      : device_(&device), budget_(&budget), arena_(arena_quads) {}
  Result<void> grow_sections(gpu::Uploader& uploader);
  void write_record(gpu::Uploader& uploader, std::uint32_t slot);
  void count(const shared::Section& section, std::int64_t sign);

  gpu::Device* device_;
  MemoryBudget* budget_;
  gpu::OffsetArena arena_;
  gpu::Buffer quads_, sections_;
  std::vector<shared::Section> records_;  // CPU copy, one a slot; free slots have no ranges
  std::vector<VoxelBox> translucent_boxes_;
  GlassBlocks glass_;
  std::map<std::uint32_t, GlassBox> glass_boxes_;
  std::map<std::uint32_t, shared::Section> hidden_;  // by slot, whose records have no ranges
  std::vector<std::uint32_t> free_slots_;
  std::vector<shared::Quad> scratch_;
  std::uint32_t section_capacity_ = 0, sections_blended_ = 0;
  std::vector<std::uint32_t> to_send_;  // slots; see send_blends()
  std::uint64_t translucent_quads_ = 0, cutout_quads_ = 0;
  std::array<std::uint64_t, shared::kListCount> runs_{}, quads_of_list_{};
  DrawLimits most_draws_{};
  GeometryChanges changes_;
};

}  // namespace skerry::render
