#pragma once
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/scene_facts.h"
#include "shaders/shared/clouds.h"

namespace skerry::render {

/// Whether any section with cut-out quads or plants touches a view's frustum. @param islands
/// relative to the camera.
bool cutouts_in_view(std::span<const shared::Section> sections,
                     std::span<const shared::IslandTransform> islands,
                     const shared::CullView& view);

/// Whether any section that is drawn in some pixels alone touches a view's frustum. @param islands
/// relative to the camera.
bool blended_in_view(std::span<const shared::Section> sections,
                     std::span<const shared::IslandTransform> islands,
                     const shared::CullView& view);

/// Whether an island's bounding sphere, and what coarse levels stand out of it, touches the
/// frustum.
/// @param view relative to `eye`.
bool island_in_view(const IslandPlacement& island, const shared::CullView& view,
                    const FixedPos& eye);

/// Which of the islands have sections that are drawn.
std::vector<bool> islands_with_sections(const SceneFacts& facts, std::size_t islands);

/// Which islands the camera's picture may show: those with sections whose bounding sphere touches
/// the frustum.
/// @param view the camera's, relative to `eye`.
std::vector<bool> islands_in_view(const SceneFacts& facts, std::span<const IslandPlacement> islands,
                                  const shared::CullView& view, const FixedPos& eye);

/// Part of the camera's picture that holds whatever translucent quads can cover: from xy to before
/// zw [pixels]. None if the box of no section's translucent quads touches the frustum.
std::optional<glm::uvec4> translucent_area(const SceneFacts& facts, const FrameTables& tables);

/// Rectangle of the camera's picture, from xy to before zw [pixels], in which sections that came or
/// went since a version of the geometry may show, and some pixels about it. Empty, or the whole
/// picture where nothing is known.
glm::uvec4 changed_area(const SceneFacts& facts, const FrameTables& tables, std::uint64_t version);

/// Whether a ray of the camera's picture may meet the layer of clouds or the box of a volume,
/// whatever stands before them. False is certain. @param layer there is one. @param volumes of
/// `clouds`, that there are.
bool clouds_in_view(const shared::CloudConstants& clouds, bool layer, std::size_t volumes,
                    const shared::FrameConstants& frame);

}  // namespace skerry::render
