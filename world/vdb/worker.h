// The OpenVDB process: the program `skerry_openvdb` beside the one that runs.
#pragma once
#include "world/confined/process.h"

namespace skerry::world {

inline constexpr ConfinedProgram kOpenVdb{"skerry_openvdb", "OpenVDB"};

/// Whether this build has an OpenVDB process.
bool has_openvdb();

/// What to say where it has none; without the file's name.
Error no_openvdb();

}  // namespace skerry::world
