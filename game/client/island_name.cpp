#include "game/client/island_name.h"

#include <iterator>

#include "world/voxel/hash.h"

namespace skerry::game {
namespace {

constexpr const char* kFirst[] = {"Ar",  "Bal",  "Cal", "Dun", "Eil", "Far", "Gar",
                                  "Hal", "Inn",  "Kir", "Lun", "Mor", "Nor", "Os",
                                  "Rag", "Skar", "Tor", "Ul",  "Ven", "Wyr"};
constexpr const char* kMiddle[] = {"", "", "a", "en", "i", "la", "o", "ra", "ve"};
constexpr const char* kLast[] = {"ay",   "bost", "dal",  "fell", "holm", "mar",
                                 "ness", "say",  "stad", "voe",  "wick"};

template <class T, std::size_t kCount>
T part(const T (&parts)[kCount], std::uint64_t& bits) {
  const T chosen = parts[bits % kCount];
  bits /= kCount;
  return chosen;
}

}  // namespace

std::string island_name(std::uint64_t id) {
  std::uint64_t bits = world::mix64(id);
  std::string name = part(kFirst, bits);
  name += part(kMiddle, bits);
  return name + part(kLast, bits);
}

}  // namespace skerry::game
