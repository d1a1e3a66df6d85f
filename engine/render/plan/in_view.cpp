#include "engine/render/plan/in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace skerry::render {
namespace {

/// Of a section's voxels, in its island's lattice [blocks].
struct LatticeBox {
  LatticeBox(const shared::Section& section, const VoxelBox& voxels) {
    const float voxel = static_cast<float>(1u << section.voxel_size_log2);
    low = glm::vec3(section.origin) + voxels.low_corner() * voxel;
    high = glm::vec3(section.origin) + voxels.high_corner() * voxel;
  }
  glm::vec3 low, high;
};

glm::vec3 world_from(const shared::IslandTransform& t, const glm::vec3& lattice) {
  return t.axis_x * lattice.x + t.axis_y * lattice.y + t.axis_z * lattice.z + t.translation;
}

bool touches(const shared::CullView& view, const shared::IslandTransform& t,
             const LatticeBox& box) {
  const glm::vec3 world = world_from(t, 0.5f * (box.low + box.high));
  const glm::vec3 half = 0.5f * (box.high - box.low);
  return std::all_of(std::begin(view.planes), std::end(view.planes), [&](const glm::vec4& plane) {
    const glm::vec3 n(plane);
    const float reach = std::abs(glm::dot(n, t.axis_x)) * half.x +
                        std::abs(glm::dot(n, t.axis_y)) * half.y +
                        std::abs(glm::dot(n, t.axis_z)) * half.z;
    return glm::dot(n, world) + plane.w + reach >= -1e-3f * (1.0f + reach);
  });
}

/// Grows with points of clip space in front of the near plane, in normalised device coordinates.
struct Projected {
  glm::vec2 low{1.0f}, high{-1.0f};

  void add(const glm::vec4& clip) {
    const glm::vec2 at = glm::vec2(clip) / clip.w;
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  void add(const shared::IslandTransform& t, const LatticeBox& box,
           const shared::FrameConstants& frame) {
    // Just before the near plane: nothing nearer is drawn.
    const float nearest = 0.99f * frame.near_plane;
    std::array<glm::vec4, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::vec3 at((i & 1u) ? box.high.x : box.low.x, (i & 2u) ? box.high.y : box.low.y,
                         (i & 4u) ? box.high.z : box.low.z);
      corners[i] = frame.clip_from_world * glm::vec4(world_from(t, at), 1.0f);
      if (corners[i].w >= nearest) add(corners[i]);
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (const std::size_t axis : {1u, 2u, 4u}) {
        const glm::vec4 &a = corners[i], &b = corners[i | axis];
        if ((a.w >= nearest) != (b.w >= nearest))
          add(a + (b - a) * ((nearest - a.w) / (b.w - a.w)));
      }
  }
};

/// Pixels that two of normalised device coordinates span, and two more about them for rounding and
/// for what quads grow by.
glm::uvec2 pixels_between(float low, float high, std::uint32_t size) {
  const float whole = static_cast<float>(size);
  const auto pixel = [&](float ndc) { return (0.5f * ndc + 0.5f) * whole; };
  const float first = std::floor(pixel(low)) - 2.0f, end = std::ceil(pixel(high)) + 2.0f;
  return {static_cast<std::uint32_t>(std::clamp(first, 0.0f, whole - 1.0f)),
          static_cast<std::uint32_t>(std::clamp(end, 1.0f, whole))};
}

/// A ray is as long as its part along the view axis or longer, so that it rises no faster than
/// its end at a corner of the picture does.
bool layer_in_view(const shared::CloudLayer& layer, const shared::FrameConstants& frame) {
  constexpr float kNear = 1.0f;  // blocks from the layer at which the eye counts as within
  const float height = layer.place.y;
  const float below = -height, above = height - layer.thickness;
  if (std::max(below, above) <= kNear) return true;
  const float spread = std::abs(frame.ray_right.y) + std::abs(frame.ray_up.y);
  const float towards = below > 0.0f ? frame.ray_forward.y + spread : spread - frame.ray_forward.y;
  return towards >= 0.999f * std::max(below, above) / shared::kLayerFadeEnd;
}

/// Whether the box, in the world, has a corner on the inner side of each of the picture's edges.
bool volume_in_view(const shared::CloudVolume& volume, const shared::FrameConstants& frame) {
  constexpr float kEdge = 1.001f;
  const glm::mat4 world_from_index = glm::inverse(glm::transpose(
      glm::mat4(volume.index_x, volume.index_y, volume.index_z, glm::vec4(0, 0, 0, 1))));
  const glm::vec3 right = frame.ray_right / glm::dot(frame.ray_right, frame.ray_right);
  const glm::vec3 up = frame.ray_up / glm::dot(frame.ray_up, frame.ray_up);
  std::array<bool, 5> inside{};
  for (unsigned i = 0; i < 8; ++i) {
    const glm::vec4 corner((i & 1u) ? volume.high.x : volume.low.x,
                           (i & 2u) ? volume.high.y : volume.low.y,
                           (i & 4u) ? volume.high.z : volume.low.z, 1.0f);
    const glm::vec3 at(world_from_index * corner);
    const float x = glm::dot(at, right), y = glm::dot(at, up);
    const float z = glm::dot(at, frame.ray_forward), edge = kEdge * z;
    const std::array<bool, 5> now{x <= edge, -x <= edge, y <= edge, -y <= edge, z >= 0.0f};
    for (std::size_t k = 0; k < inside.size(); ++k) inside[k] = inside[k] || now[k];
  }
  return std::ranges::all_of(inside, [](bool some) { return some; });
}

}  // namespace

bool cutouts_in_view(std::span<const shared::Section> sections,
                     std::span<const shared::IslandTransform> islands,
                     const shared::CullView& view) {
  return std::any_of(sections.begin(), sections.end(), [&](const shared::Section& s) {
    return s.range_end[shared::kRangeTranslucent - 1] != s.range_end[shared::kRangeCutout - 1] &&
           touches(view, islands[s.island], LatticeBox(s, {s.bounds_min, s.bounds_max}));
  });
}

bool blended_in_view(std::span<const shared::Section> sections,
                     std::span<const shared::IslandTransform> islands,
                     const shared::CullView& view) {
  return std::any_of(sections.begin(), sections.end(), [&](const shared::Section& s) {
    return s.blend != 0 &&
           touches(view, islands[s.island], LatticeBox(s, {s.bounds_min, s.bounds_max}));
  });
}

bool island_in_view(const IslandPlacement& island, const shared::CullView& view,
                    const FixedPos& eye) {
  constexpr float kCoarser = 64.0f;  // blocks that voxels of coarse levels may stand out by
  const float radius = static_cast<float>(island.bounding_radius) + kCoarser;
  const glm::vec3 place(blocks_between(island.origin, eye));
  return std::ranges::all_of(view.planes, [&](const glm::vec4& plane) {
    return glm::dot(glm::vec3(plane), place) + plane.w >= -radius;
  });
}

std::vector<bool> islands_with_sections(const SceneFacts& facts, std::size_t islands) {
  std::vector<bool> out(islands, false);
  for (const shared::Section& s : facts.sections)
    if (s.range_end[shared::kRangeCount - 1] != 0) out[s.island] = true;
  return out;
}

std::vector<bool> islands_in_view(const SceneFacts& facts, std::span<const IslandPlacement> islands,
                                  const shared::CullView& view, const FixedPos& eye) {
  std::vector<bool> out = islands_with_sections(facts, islands.size());
  for (std::size_t i = 0; i < islands.size(); ++i)
    if (out[i]) out[i] = island_in_view(islands[i], view, eye);
  return out;
}

std::optional<glm::uvec4> translucent_area(const SceneFacts& facts, const FrameTables& tables) {
  const shared::FrameConstants& frame = tables.constants;
  Projected on_picture;
  bool any = false;
  for (std::size_t slot = 0; slot < facts.sections.size(); ++slot) {
    const shared::Section& s = facts.sections[slot];
    if (s.range_end[shared::kRangeCount - 1] == s.range_end[shared::kRangeTranslucent - 1])
      continue;
    const shared::IslandTransform& t = tables.islands[s.island];
    const LatticeBox box(s, facts.translucent_boxes[slot]);
    if (!touches(tables.views[0], t, box)) continue;
    any = true;
    on_picture.add(t, box, frame);
  }
  if (!any) return std::nullopt;
  // Clip space points down, like the picture's rows.
  const glm::uvec2 x = pixels_between(on_picture.low.x, on_picture.high.x, frame.size.x);
  const glm::uvec2 y = pixels_between(on_picture.low.y, on_picture.high.y, frame.size.y);
  return glm::uvec4(x.x, y.x, std::max(x.y, x.x + 1), std::max(y.y, y.x + 1));
}

glm::uvec4 changed_area(const SceneFacts& facts, const FrameTables& tables, std::uint64_t version) {
  constexpr std::uint32_t kAbout = 8;  // pixels that islands may have moved since, and jitter
  const shared::FrameConstants& frame = tables.constants;
  const glm::uvec4 all(0, 0, frame.size.x, frame.size.y);
  const auto changed = facts.changes->since(version);
  if (!changed) return all;
  Projected on_picture;
  bool any = false;
  for (const shared::Section& s : *changed) {
    // A section that went may have taken its island with it.
    if (s.island >= tables.islands.size() / tables.views.size()) return all;
    const shared::IslandTransform& t = tables.islands[s.island];
    const LatticeBox box(s, {s.bounds_min, s.bounds_max});
    if (!touches(tables.views[0], t, box)) continue;
    any = true;
    on_picture.add(t, box, frame);
  }
  if (!any) return glm::uvec4(0);
  const glm::uvec2 x = pixels_between(on_picture.low.x, on_picture.high.x, frame.size.x);
  const glm::uvec2 y = pixels_between(on_picture.low.y, on_picture.high.y, frame.size.y);
  return {x.x - std::min(x.x, kAbout), y.x - std::min(y.x, kAbout),
          std::min(x.y + kAbout, frame.size.x), std::min(y.y + kAbout, frame.size.y)};
}

bool clouds_in_view(const shared::CloudConstants& clouds, bool layer, std::size_t volumes,
                    const shared::FrameConstants& frame) {
  if (layer && layer_in_view(clouds.layer, frame)) return true;
  return std::any_of(
      std::begin(clouds.volumes), std::begin(clouds.volumes) + volumes,
      [&](const shared::CloudVolume& volume) { return volume_in_view(volume, frame); });
}

}  // namespace skerry::render
