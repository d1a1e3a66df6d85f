#include "game/client/session_client.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "game/client/island_name.h"
#include "tests/folder.h"
#include "tests/world/made_islands.h"
#include "world/store/world_file.h"

namespace skerry::game {
namespace {

using world::IVec3;

/// Two plates and a post between them; the player stands on the lower one.
class CutTest : public testing::Test {
 protected:
  static constexpr std::uint64_t kIsland = 7;

  void SetUp() override {
    write_world();
    auto session = Session::open(path_);
    ASSERT_TRUE(session) << session.error().message;
    for (const IVec3& chunk : (*session)->world()->chunks(kIsland, 0))
      (*session)->world()->ensure_chunk(kIsland, chunk);
    client_ = std::make_unique<SessionClient>(*std::move(session));
    SavedPlay here;
    here.player.island = kIsland;
    here.player.feet = world::blocks(1.5, 3.0, 1.5);
    here.eye.position = world::blocks(1.5, 4.62, 1.5);
    client_->send(PlayerMoved{here});
    client_->advance(1.0);
  }

  void write_world() const {
    world::WorldInfo info{"Post", "1", {}};
    info.desc.seed = 1;
    info.desc.generated = false;
    auto file = world::WorldFile::create(path_, info);
    ASSERT_TRUE(file);
    std::vector<IVec3> voxels = world::voxels_in({-8, 0, -8}, {9, 3, 9});
    for (const IVec3& v : world::voxels_in({0, 3, 0}, {1, 8, 1})) voxels.push_back(v);
    for (const IVec3& v : world::voxels_in({-3, 8, -3}, {4, 9, 4})) voxels.push_back(v);
    auto transaction = (*file)->begin();
    world::IslandSpec spec;
    spec.id = kIsland;
    transaction.put_island({spec, true, {}});
    for (const auto& [at, chunk] : world::chunks_from(voxels, world::block::kStone))
      transaction.put_chunk(kIsland, at, chunk);
    ASSERT_TRUE(transaction.commit());
  }

  /// Digs a block; what the player is told of it once all is worked out.
  std::vector<std::string> dig(IVec3 voxel) {
    EXPECT_TRUE(client_->set_block(kIsland, voxel, world::kAir));
    EXPECT_TRUE(client_->save());  // waits for the search for parts
    client_->advance(0.1);
    std::vector<std::string> lines;
    for (const Answer& answer : client_->hear()) {
      if (const auto* island = std::get_if<IslandIs>(&answer); island && island->broken_off)
        pieces_.push_back(island->spec.id);
      if (std::optional<std::string> line = line_of(answer)) lines.push_back(*std::move(line));
    }
    return lines;
  }

  Folder folder_;
  std::filesystem::path path_ = folder_ / "post.skerry";
  std::unique_ptr<SessionClient> client_;
  std::vector<std::uint64_t> pieces_;
};

TEST_F(CutTest, APartThatIsCutOffIsToldWithItsSizeAndItsName) {
  // Of the post, two blocks are left above the cut.
  const std::vector<std::string> lines = dig({0, 5, 0});
  ASSERT_EQ(pieces_.size(), 1u);
  EXPECT_EQ(lines, std::vector<std::string>{std::to_string(2 + 7 * 7) +
                                            " blocks broke off and drift away: " +
                                            island_name(pieces_[0]) + ", an island of its own"});
  EXPECT_TRUE(client_->world()->island(pieces_[0]));
}

TEST_F(CutTest, ABlockThatHoldsNothingIsToldByNothing) {
  EXPECT_TRUE(dig({3, 2, 3}).empty());
  EXPECT_TRUE(pieces_.empty());
}

}  // namespace
}  // namespace skerry::game
