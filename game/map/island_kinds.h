// What people call the kinds of islands and what grows on them.
#pragma once
#include <string>
#include <string_view>

#include "world/generate/biome.h"
#include "world/generate/shape.h"

namespace skerry::game {

std::string_view kind_name(world::Archetype kind);
std::string_view biome_name(world::Biome biome);
/// "volcano, tropical" of an island that a seed made.
std::string description_of(const world::IslandSpec& spec);

}  // namespace skerry::game
