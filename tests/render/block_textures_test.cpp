#include "engine/render/block_textures.h"

#include <gtest/gtest.h>

namespace skerry::render {
TEST(BlockTextures, HoldsAllLayersWithFullMipChains) {
  const BlockTextures textures = block_textures();
  EXPECT_EQ(textures.edge, 32u);
  EXPECT_EQ(textures.layers, 256u);
  EXPECT_EQ(textures.mips, 6u);
  EXPECT_EQ(textures.texels.size(), 256u * 4u * (1024u + 256u + 64u + 16u + 4u + 1u));
}
}  // namespace skerry::render
