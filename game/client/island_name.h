#pragma once
#include <cstdint>
#include <string>

namespace skerry::game {

/// What people call an island: the same for the same id, on any machine. Not unique.
std::string island_name(std::uint64_t id);

}  // namespace skerry::game
