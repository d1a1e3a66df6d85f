#include "engine/render/scene/geometry_store.h"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <iterator>

#include "engine/core/check.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/scene/grow_buffer.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kLeastSections = 1024;
constexpr std::uint32_t kLeastQuads = 1u << 19;
constexpr std::uint64_t kMostQuads = std::uint64_t{1} << 29;

std::uint32_t range_quads(const shared::Section& section, std::uint32_t first, std::uint32_t end) {
  return section.range_end[end - 1] - (first == 0 ? 0 : section.range_end[first - 1]);
}

constexpr std::array<std::uint32_t, shared::kListCount + 1> kListRanges{
    shared::kRangeOpaque, shared::kRangeCutout, shared::kRangeTranslucent, shared::kRangeCount};

constexpr std::uint32_t kCutoutList = 1;

/// Neighbouring ranges are drawn at once, so that most draws come of every second one.
std::uint32_t most_runs(const shared::Section& section, std::uint32_t first, std::uint32_t end) {
  std::uint32_t filled = 0;
  for (std::uint32_t range = first; range < end; ++range)
    filled += range_quads(section, range, range + 1) != 0 ? 1 : 0;
  return (filled + 1) / 2;
}

/// What goes while a level of detail changes casts no shadow.
bool casts(const shared::Section& section) {
  return (section.blend & shared::kBlendGoes) == 0;
}

}  // namespace

GlassBlocks glass_among(std::span<const shared::Material> materials) {
  constexpr float kLeastStain = 0.1f;  // absorption a block
  GlassBlocks out;
  for (std::size_t id = 0; id < std::min(materials.size(), out.all.size()); ++id) {
    const shared::Material& m = materials[id];
    if (m.liquid != 0) continue;
    out.all[id] = m.absorption != glm::vec3(0.0f) || m.scattering != 0.0f;
    out.stained[id] = glm::any(glm::greaterThanEqual(m.absorption, glm::vec3(kLeastStain)));
  }
  return out;
}

Result<std::unique_ptr<GeometryStore>> GeometryStore::create(gpu::Device& device,
                                                             MemoryBudget& budget,
                                                             const GlassBlocks& glass,
                                                             std::uint32_t arena_quads) {
  arena_quads =
      budget.first_elements(sizeof(shared::Quad), std::min(arena_quads, kLeastQuads), arena_quads);
  const std::uint32_t sections_first =
      budget.first_elements(sizeof(shared::Section), kLeastSections, kUsualSections);
  std::unique_ptr<GeometryStore> store(new GeometryStore(device, budget, arena_quads));
  store->glass_ = glass;
  Result<gpu::Buffer> quads =
      make_table(device, budget, "quad arena", std::uint64_t{arena_quads} * sizeof(shared::Quad));
  if (!quads) return quads.error();
  store->quads_ = *std::move(quads);
  Result<gpu::Buffer> sections =
      make_table(device, budget, "section table", sections_first * sizeof(shared::Section));
  if (!sections) return sections.error();
  store->sections_ = *std::move(sections);
  store->section_capacity_ = sections_first;
  return store;
}

GeometryStore::~GeometryStore() {
  budget_->give_back(quads_.size_bytes() + sections_.size_bytes());
}

Result<SectionId> GeometryStore::add(gpu::Uploader& uploader, shared::Section section,
                                     std::span<const shared::Quad> quads) {
  SKERRY_ASSERT(!quads.empty() && quads.size() == section.range_end[shared::kRangeCount - 1]);
  const auto wanted = static_cast<std::uint32_t>(quads.size());
  if (free_slots_.empty() && section_slots() == section_capacity_)
    if (Result<void> grew = grow_sections(uploader); !grew) return grew.error();
  const Result<gpu::ArenaRange> range = allocate(
      *device_, *budget_, uploader, {arena_, quads_, sizeof(shared::Quad), kMostQuads}, wanted);
  if (!range) return range.error();
  std::uint32_t slot = section_slots();
  if (!free_slots_.empty()) {
    slot = free_slots_.back();
    free_slots_.pop_back();
  } else {
    records_.emplace_back();
    translucent_boxes_.emplace_back();
  }
  section.first_quad = range->first;
  records_[slot] = section;
  const std::span translucent = quads.subspan(section.range_end[shared::kRangeTranslucent - 1]);
  if (!translucent.empty()) translucent_boxes_[slot] = box_of(translucent);
  scratch_.clear();
  std::ranges::copy_if(translucent, std::back_inserter(scratch_), [&](const shared::Quad& quad) {
    return glass_.all[shared::surface_block(quad.material)];
  });
  if (!scratch_.empty())
    glass_boxes_[slot] = {box_of(scratch_), std::ranges::any_of(scratch_, [&](auto& quad) {
                            return glass_.stained[shared::surface_block(quad.material)];
                          })};
  const std::span placed = uploader.place<shared::Quad>(
      quads_, std::uint64_t{range->first} * sizeof(shared::Quad), quads.size());
  std::ranges::transform(quads, placed.begin(), [&](const shared::Quad& quad) {
    return shared::Quad{quad.geometry, quad.material | section.island << shared::kIslandShift};
  });
  write_record(uploader, slot);
  count(section, 1);
  changes_.note(section);
  return SectionId{slot};
}

void GeometryStore::show(gpu::Uploader& uploader, SectionId id, bool shown) {
  const auto hidden = hidden_.find(id.slot);
  if (shown == (hidden == hidden_.end())) return;
  shared::Section& record = records_[id.slot];
  if (shown) {
    record = hidden->second;
    hidden_.erase(hidden);
    count(record, 1);
    changes_.note(record);
  } else {
    count(record, -1);
    if (casts(record)) changes_.note(record);
    record.blend = 0;
    hidden_.emplace(id.slot, record);
    record = {};
  }
  write_record(uploader, id.slot);
}

void GeometryStore::blend(SectionId id, std::uint32_t blend) {
  shared::Section& record = records_[id.slot];
  SKERRY_ASSERT(!hidden_.contains(id.slot));
  if (record.blend == blend) return;
  const bool cast = casts(record);
  count(record, -1);
  record.blend = blend;
  count(record, 1);
  if (casts(record) != cast) changes_.note(record);
  to_send_.push_back(id.slot);
}

void GeometryStore::send_blends(gpu::Uploader& uploader) {
  constexpr std::uint32_t kMostApart = 8;  // what lies between is written as it is
  std::ranges::sort(to_send_);
  for (std::size_t next = 0; next < to_send_.size();) {
    const std::uint32_t first = to_send_[next];
    std::uint32_t last = first;
    for (; next < to_send_.size() && to_send_[next] - last <= kMostApart; ++next)
      last = to_send_[next];
    uploader.write(sections_, std::uint64_t{first} * sizeof(shared::Section),
                   std::span<const shared::Section>(records_).subspan(first, last - first + 1));
  }
  to_send_.clear();
}

void GeometryStore::remove(gpu::Uploader& uploader, SectionId id) {
  show(uploader, id, true);
  SKERRY_ASSERT(id.slot < records_.size() &&
                records_[id.slot].range_end[shared::kRangeCount - 1] != 0);
  const shared::Section old = records_[id.slot];
  count(old, -1);
  changes_.note(old);
  records_[id.slot] = {};
  write_record(uploader, id.slot);
  arena_.free({old.first_quad, old.range_end[shared::kRangeCount - 1]}, device_->next_value());
  glass_boxes_.erase(id.slot);
  free_slots_.push_back(id.slot);
}

void GeometryStore::collect() {
  arena_.collect(device_->completed_value());
}

Result<void> GeometryStore::grow_sections(gpu::Uploader& uploader) {
  const std::uint32_t next = section_capacity_ * 2;
  if (Result<void> grew = grow_buffer(*device_, *budget_, uploader, sections_,
                                      std::uint64_t{next} * sizeof(shared::Section));
      !grew)
    return grew;
  section_capacity_ = next;
  return {};
}

void GeometryStore::write_record(gpu::Uploader& uploader, std::uint32_t slot) {
  uploader.write(sections_, std::uint64_t{slot} * sizeof(shared::Section),
                 std::span<const shared::Section>(&records_[slot], 1));
}

void GeometryStore::count(const shared::Section& section, std::int64_t sign) {
  cutout_quads_ += static_cast<std::uint64_t>(
      sign * range_quads(section, shared::kRangeCutout, shared::kRangeTranslucent));
  translucent_quads_ += static_cast<std::uint64_t>(
      sign * range_quads(section, shared::kRangeTranslucent, shared::kRangeCount));
  for (std::uint32_t list = 0; list < shared::kListCount; ++list) {
    const std::uint32_t end = kListRanges[list + 1];
    const bool opaque_too = list == kCutoutList && section.blend != 0;
    const std::uint32_t first = kListRanges[opaque_too ? list - 1 : list];
    runs_[list] += static_cast<std::uint64_t>(sign * most_runs(section, first, end));
    quads_of_list_[list] += static_cast<std::uint64_t>(sign * range_quads(section, first, end));
    // A run is split at kMaxQuadsPerDraw.
    const std::uint64_t most = runs_[list] + quads_of_list_[list] / shared::kMaxQuadsPerDraw;
    most_draws_[list] = std::max(most_draws_[list], static_cast<std::uint32_t>(most));
  }
  if (section.blend != 0) sections_blended_ += static_cast<std::uint32_t>(sign);
}

}  // namespace skerry::render
