#include "game/client/island_name.h"

#include <gtest/gtest.h>

#include <set>

namespace skerry::game {
namespace {

TEST(IslandName, IsTheSameForTheSameIslandAndSeldomForTwo) {
  std::set<std::string> names;
  for (std::uint64_t id = 0; id < 200; ++id) {
    const std::string name = island_name(id);
    EXPECT_EQ(name, island_name(id));
    EXPECT_LE(name.size(), 12u);
    names.insert(name);
  }
  EXPECT_GT(names.size(), 150u);
}

}  // namespace
}  // namespace skerry::game
