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
                                  std::span<const shared::Quad> quads,
                                  std::vector<shared::Quad>& sorted) {
  if (quads.size() <= kQuadsOfWhole) return {{section, quads}};
  // Where the quads of a part and range go: first how many there are.
  std::array<std::array<std::uint32_t, shared::kRangeCount>, kParts> places{};
  const auto each = [&](const auto& visit) {
    std::size_t next = 0;
    for (std::uint32_t range = 0; range < shared::kRangeCount; ++range)
      for (; next < section.range_end[range]; ++next)
        visit(quads[next], places[part_of(quads[next])][range]);
  };
  each([](const shared::Quad&, std::uint32_t& count) { ++count; });
  std::vector<SectionPart> parts;
  std::uint32_t place = 0;
  sorted.resize(quads.size());
  for (auto& counts : places) {
    const std::uint32_t first = place;
    SectionPart part{section, {}};
    for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
      place += std::exchange(counts[range], place);
      part.section.range_end[range] = place - first;
    }
    part.quads = std::span(sorted).subspan(first, place - first);
    if (!part.quads.empty()) parts.push_back(part);
  }
  each([&](const shared::Quad& quad, std::uint32_t& next) { sorted[next++] = quad; });
  for (SectionPart& part : parts) {
    const VoxelBox box = box_of(part.quads);
    part.section.bounds_min = box.low;
    part.section.bounds_max = box.high;
  }
  return parts;
}

}  // namespace skerry::render
