#include "engine/render/scene/section_parts.h"

#include <array>
#include <cstddef>
#include <utility>

#include "engine/render/scene/voxel_box.h"

namespace skerry::render {
namespace {

constexpr std::size_t kQuadsOfWhole = 1024;  // a mesh of no more stays whole
constexpr std::size_t kParts = 64;

/// Which quarter of the chunk along each axis a quad begins in: bits 0-1 x, 2-3 y, 4-5 z.
std::size_t part_of(const shared::Quad& quad) {
  return (quad.geometry >> 4 & 3u) | (quad.geometry >> 10 & 3u) << 2 |
         (quad.geometry >> 16 & 3u) << 4;
}

}  // namespace

std::vector<SectionPart> parts_of(const shared::Section& section,
                                  std::span<const shared::Quad> quads) {
  std::vector<SectionPart> parts;
  if (quads.size() <= kQuadsOfWhole) {
    parts.push_back({section, {quads.begin(), quads.end()}});
    return parts;
  }
  std::array<std::size_t, kParts> sizes{};
  for (const shared::Quad& quad : quads) ++sizes[part_of(quad)];
  parts.resize(kParts);
  for (std::size_t i = 0; i < kParts; ++i) {
    parts[i].section = section;
    parts[i].quads.reserve(sizes[i]);
  }
  std::size_t next = 0;
  for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
    for (; next < section.range_end[range]; ++next)
      parts[part_of(quads[next])].quads.push_back(quads[next]);
    for (SectionPart& part : parts)
      part.section.range_end[range] = static_cast<std::uint32_t>(part.quads.size());
  }
  std::erase_if(parts, [](const SectionPart& part) { return part.quads.empty(); });
  for (SectionPart& part : parts) {
    const VoxelBox box = box_of(part.quads);
    part.section.bounds_min = box.low;
    part.section.bounds_max = box.high;
  }
  return parts;
}

}  // namespace skerry::render
