#pragma once
#include <filesystem>

#include "engine/core/result.h"
#include "engine/render/sky/panorama.h"
#include "world/confined/process.h"

namespace skerry::game {

inline constexpr world::ConfinedProgram kOpenExr{"skerry_openexr", "OpenEXR"};

/// Reads the panorama of an OpenEXR file: the first part that has red, green and blue, or one
/// channel Y, of any type, in scanlines or tiles, compressed in any way; its data window within its
/// display window, black around it, and chromaticities other than Rec. 709's turned into those. A
/// process of its own reads it, within limits.
/// Errors, one line without the file's name: those of read_confined; not such a file, damaged, cut
/// short, deep, a cube, subsampled, not twice as wide as high, too large.
Result<render::Panorama> read_exr(const std::filesystem::path& path);

}  // namespace skerry::game
