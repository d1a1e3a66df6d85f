// Of SceneView: at which level of detail sections are drawn, and how they change it.
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <utility>

#include "engine/core/check.h"
#include "engine/render/scene/voxel_box.h"
#include "game/sections/section_record.h"
#include "game/view/scene_view.h"

namespace skerry::game {
namespace {

/// Of the world's memory: while more of it is used, nothing that has been replaced is kept.
constexpr double kMostForBlends = 0.75;

}  // namespace

/// How near an island's sections of each level may come before their voxels show [blocks]: what is
/// made at full detail is drawn so, and beyond that a surface may be off by view.error pixels.
std::vector<double> SceneView::nearest_of_levels(const render::Camera& camera,
                                                 const world::IslandSpec& spec) const {
  // A surface is off by a quarter of a voxel's edge in the mean.
  constexpr double kShareOfVoxel = 0.25;
  const double pixels_a_block_away = 0.5 * static_cast<double>(size_.height) *
                                     static_cast<double>(settings_.render.render_scale) /
                                     std::tan(0.5 * glm::radians(double{camera.fov_deg}));
  std::vector<double> nearest{0.0};
  for (int level = 1; level < world::kLevelCount; ++level) {
    const double voxel = std::ldexp(1.0, level);
    nearest.push_back(
        std::max(world::level_from(spec, level, static_cast<double>(settings_.view_detail)),
                 kShareOfVoxel * voxel * pixels_a_block_away / settings_.view_error));
  }
  return nearest;
}

/// The streamer has taken a section out. What is shown stays while levels blend.
void SceneView::leave_section(const world::SectionKey& key) {
  ResidentSection& section = sections_.at(key);
  const render::Renderer::WorldMemory memory = renderer_->world_memory();
  const bool room =
      static_cast<double>(memory.used) <= kMostForBlends * static_cast<double>(memory.limit);
  if (!blends_levels_ || !section.shown || !room || fresh_.contains(key)) {
    blends_.finish(key.island);
    return remove_section(key);
  }
  section.leaves = true;
  cuts_.remove(key);
  if (section.chosen) left_.push_back(key);
}

void SceneView::choose_levels(const render::Camera& camera, double world_time_s,
                              const Choosing& how) {
  choose_cuts(camera, world_time_s, how.keep);
  for (const world::SectionKey& key : std::exchange(fresh_, {}))
    chosen_[key.island].came.push_back(key);
  for (auto& [island, chosen] : std::exchange(chosen_, {}))
    blends_.change(island, chosen.came, chosen.went);
  if (blends_.idle()) return;
  if (how.blend_s)
    blends_.advance(*how.blend_s);
  else
    blends_.finish_all();
  apply_blends();
  // Pixels of two levels complete each other only if all of them arrive with one frame.
  renderer_->set_upload_budget(UINT64_MAX);
}

/// Decides at which level each section of the islands is drawn that are there at several.
void SceneView::choose_cuts(const render::Camera& camera, double world_time_s, bool keep) {
  const world::IslandPoses poses = world_->poses(world_time_s);
  SectionCuts::View view{.keep = keep};
  view.nearest_of = [&](std::uint64_t id) {
    const auto row = near_slots_.lower_bound({id, INT32_MIN});
    return nearest_of_levels(camera, islands_[row->second].spec);
  };
  view.camera_in = [&](std::uint64_t id) {
    const auto row = near_slots_.lower_bound({id, INT32_MIN});
    const world::Pose pose = poses.of(islands_[row->second].spec);
    const world::WorldPos eye{camera.position[0], camera.position[1], camera.position[2]};
    return glm::conjugate(pose.rotation) * world::difference_blocks(eye, pose.origin);
  };
  std::optional<world::IslandLevel> last;
  for (const world::ReadySection& ready : waiting_)
    if (last != ready.key.row()) view.coming.insert(*(last = ready.key.row()));
  cuts_.choose(view, [this](const world::SectionKey& key, bool chosen, std::uint8_t seams) {
    choose_section(key, chosen);
    ResidentSection& section = sections_.at(key);
    section.to_close = chosen ? seams : 0;
    // What another level still shows beside it is closed against that, too.
    const bool both = chosen || section.shown;
    close_section(key, section, both ? section.closed | section.to_close : section.to_close);
    to_close_[key.island].insert(key);
  });
  tell_left(view.coming);
}

void SceneView::choose_section(const world::SectionKey& key, bool chosen) {
  ResidentSection& section = sections_.at(key);
  const bool fresh = fresh_.erase(key) != 0;
  if (!fresh && section.chosen == chosen) return;
  light_field_.show(key, chosen);
  section.chosen = chosen;
  if (chosen)
    chosen_[key.island].came.push_back(key);
  else if (fresh)
    show_section(key, section, false);
  else
    chosen_[key.island].went.push_back(key);
}

/// What leaves goes when all that replaces it is there.
void SceneView::tell_left(const std::set<world::IslandLevel>& coming) {
  std::erase_if(left_, [&](const world::SectionKey& key) {
    const auto next = coming.lower_bound({key.island, INT32_MIN});
    const bool waits = next != coming.end() && next->island == key.island;
    if (waits && !is_full()) return false;
    const auto found = sections_.find(key);
    if (found == sections_.end() || !found->second.leaves) return true;
    light_field_.show(key, false);
    found->second.chosen = false;
    chosen_[key.island].went.push_back(key);
    return true;
  });
}

void SceneView::apply_blends() {
  std::vector<std::pair<world::SectionKey, LevelBlends::Shown>> all;
  blends_.each_changed([&](const world::SectionKey& key, const LevelBlends::Shown& shown) {
    all.emplace_back(key, shown);
  });
  for (const auto& [key, now] : all) {
    const auto found = sections_.find(key);
    if (found == sections_.end()) continue;
    ResidentSection& section = found->second;
    const bool gone = now.goes && now.none();
    if (gone && section.leaves) {
      remove_section(key);
      continue;
    }
    if (!gone) blend_section(section, now.packed());
    show_section(key, section, !gone);
  }
  renderer_->geometry().send_blends(renderer_->mesh_uploader());
  for (const std::uint64_t island : blends_.settle()) {
    for (const world::SectionKey& key : to_close_[island])
      if (const auto found = sections_.find(key); found != sections_.end())
        close_section(key, found->second, found->second.to_close);
    to_close_.erase(island);
  }
}

void SceneView::show_section(const world::SectionKey& key, ResidentSection& section, bool shown) {
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  if (section.shown == shown) return;
  section.shown = shown;
  if (!shown) {
    section.blend = 0;
    close_section(key, section, 0);
  }
  for (const render::SectionId part : section.parts) {
    renderer_->geometry().show(uploader, part, shown);
    if (shown) renderer_->geometry().blend(part, section.blend);
  }
}

void SceneView::blend_section(ResidentSection& section, std::uint32_t blend) {
  if (section.blend == blend) return;
  section.blend = blend;
  if (!section.shown) return;
  for (const render::SectionId part : section.parts) renderer_->geometry().blend(part, blend);
  if (section.closing) renderer_->geometry().blend(*section.closing, blend);
}

/// @param seams at which faces another level is drawn, a bit each.
void SceneView::close_section(const world::SectionKey& key, ResidentSection& section,
                              std::uint8_t seams) {
  for (std::uint32_t face = 0; face < shared::kFaceCount; ++face)
    if (section.seams[face].empty()) seams = static_cast<std::uint8_t>(seams & ~(1u << face));
  if (section.closed == seams) return;
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  section.closed = seams;
  if (section.closing) renderer_->geometry().remove(uploader, *section.closing);
  section.closing.reset();
  world::ChunkMesh mesh;
  for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
    if (range < shared::kFaceCount && (seams >> range & 1u) != 0)
      mesh.quads.insert(mesh.quads.end(), section.seams[range].begin(), section.seams[range].end());
    mesh.range_end[range] = static_cast<std::uint32_t>(mesh.quads.size());
  }
  if (!mesh.quads.empty()) {
    shared::Section record = section_record(key, mesh, island_slots_.at(key.row()));
    const render::VoxelBox box = render::box_of(mesh.quads);
    record.bounds_min = box.low;
    record.bounds_max = box.high;
    record.blend = section.blend;
    // Without memory for it, a crack is better than no picture.
    Result<render::SectionId> added = renderer_->geometry().add(uploader, record, mesh.quads);
    if (added) section.closing = *added;
  }
  if (island_light_) island_light_->close(key, std::move(mesh.quads));
}

/// Before sections are taken out in another way.
void SceneView::forget_blends() {
  blends_.clear();
  fresh_.clear();
  left_.clear();
  chosen_.clear();
  to_close_.clear();
}

}  // namespace skerry::game
