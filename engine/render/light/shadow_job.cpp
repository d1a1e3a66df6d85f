#include "engine/render/light/shadow_job.h"

namespace skerry::render {
namespace {

double quads_in(const TexelBox& part, const shared::Section& section, const Cascade& cascade,
                const FrameInput& input) {
  const std::uint32_t quads = section.range_end[shared::kRangeTranslucent - 1];
  if (quads == 0 || section.island >= input.islands.size()) return 0.0;
  const TexelBox box =
      box_of(section, input.islands[section.island], input.camera.position, cascade);
  // Half of the faces look away from the light.
  return box.touches(part) ? 0.5 * quads : 0.0;
}

}  // namespace

double quads_in(const TexelBox& box, const Cascade& cascade, const FrameInput& input,
                std::span<const shared::Section> sections) {
  double sum = 0.0;
  for (const shared::Section& section : sections) sum += quads_in(box, section, cascade, input);
  return sum;
}

SectionRange next_part(ShadowJob& job, const Cascade& cascade, const FrameInput& input,
                       std::span<const shared::Section> sections) {
  const std::uint32_t first = job.next_section;
  const auto count = static_cast<std::uint32_t>(sections.size());
  const TexelBox whole = whole_map(cascade);
  double quads = 0.0;
  while (job.next_section < count && quads < job.quads_a_frame)
    quads += quads_in(whole, sections[job.next_section++], cascade, input);
  return {first, job.next_section};
}

}  // namespace skerry::render
