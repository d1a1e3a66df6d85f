// The bytes in which the program skerry_openexr hands over a panorama. Only one machine ever sees
// them, so numbers stand as in memory.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>

#include "engine/core/result.h"
#include "engine/render/sky/panorama.h"
#include "world/confined/answer_text.h"

namespace skerry::game {

bool encode_panorama(const render::Panorama& panorama, const world::ByteSink& sink);
/// An answer that says why there is no panorama; cut at world::kMostAnswerText.
bool encode_refusal(std::string_view why, const world::ByteSink& sink);

/// Parses what a child that may be out of control has written: a panorama as panorama.h promises
/// it, of at most kKeptPanoramaColumns. Errors: the child's own message, or that the bytes are no
/// answer; one printable line without the file's name.
Result<render::Panorama> decode_panorama(std::span<const std::byte> bytes);

}  // namespace skerry::game
