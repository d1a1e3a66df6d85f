#include "game/map/island_kinds.h"

#include <fmt/format.h>

#include <iterator>

#include "game/words/words.h"

namespace skerry::game {
namespace {

constexpr const char* kKinds[] = {
    word("plateau"), word("crescent"), word("spires"), word("terraces"), word("twin"),
    word("buttes"),  word("volcano"),  word("ridge"),  word("shard"),    word("arches")};
static_assert(std::size(kKinds) == static_cast<std::size_t>(world::Archetype::kCount));
constexpr const char* kBiomes[] = {word("meadow"),      word("highland"), word("mesa"),
                                   word("autumn wood"), word("blossom"),  word("tropical"),
                                   word("marsh"),       word("volcanic"), word("mushrooms")};
static_assert(std::size(kBiomes) == static_cast<std::size_t>(world::Biome::kCount));

}  // namespace

std::string_view kind_name(world::Archetype kind) {
  return tr(kKinds[static_cast<std::size_t>(kind)]);
}

std::string_view biome_name(world::Biome biome) {
  return tr(kBiomes[static_cast<std::size_t>(biome)]);
}

std::string description_of(const world::IslandSpec& spec) {
  return fmt::format("{}, {}", kind_name(static_cast<world::Archetype>(spec.archetype)),
                     biome_name(static_cast<world::Biome>(spec.biome)));
}

}  // namespace skerry::game
