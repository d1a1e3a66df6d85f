#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/sky/cloud_volume.h"

namespace skerry::render {

/// How a brick's values are kept.
enum class CloudPrecision : std::uint8_t { k8 = 8, k16 = 16, k32 = 32 };

/// Where one volume is in the atlas; all but value_range are as in shared::CloudVolume.
struct PackedVolume {
  glm::ivec3 low{0}, high{0};  ///< support box [index]
  glm::ivec3 first_cell{0}, cell_count{0};
  glm::ivec3 cell_low{0};  ///< [index]
  glm::ivec3 light_texels{0};
  float value_range = 0.0f;  ///< the value that the texel 1 stands for; 0: the volume is empty
};

/// Texels of three images, x fastest, then y, then z.
struct CloudAtlas {
  glm::uvec3 brick_texels{0};  ///< size of the bricks' image
  std::vector<std::byte> bricks;
  glm::uvec3 cells{0};                 ///< size of the cells' image, RGBA8, kCloudCellLevels mips
  std::vector<std::byte> cell_texels;  ///< mip by mip
  std::uint32_t brick_count = 0;
  std::vector<PackedVolume> volumes;
};

/// Packs volumes into bricks of 9^3 texels and a table of cells that finds them. Bricks that would
/// hold only zeros are left out, and those of one value within a tile are kept once.
/// @param most_texels along an image's edge.
/// Errors, naming a limit: more than kMaxCloudVolumes volumes, a volume with too many cells or
/// bricks, a transform that cannot be inverted.
Result<CloudAtlas> pack_clouds(std::span<const CloudVolumeDesc> volumes, CloudPrecision precision,
                               std::uint32_t most_texels);

}  // namespace skerry::render
