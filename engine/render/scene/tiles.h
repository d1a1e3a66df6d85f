#pragma once
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

/// Tiles of 8x8 pixels that a picture has, parts of tiles at its right and lower side too.
std::uint32_t tile_count(VkExtent2D picture);

/// One invocation an item of the bound program, whose work groups are 64x1x1, in rows of at most
/// kTileRow groups, which any device takes. Invocations past the last item find that themselves.
void dispatch_items(gpu::Commands& commands, std::uint32_t items);

/// kSunless: with surfaces, of which sun and moon light none; where that is looked for, kCovered is
/// the others.
/// kInWater: where kSunless is looked for, of the others those that show water or glass, or all if
/// the eye is in some; kCovered is then the rest. Its list is that of kDetailed in other frames.
/// kDetailed: open pixels that may show a star or a disc; where that is looked for, kOpen is the
/// others. kKept...: whose radiance is kept; where that is told apart, the first three are the
/// others.
/// kSmoothSky: open pixels alone, without detail and far from the horizon; where that is looked
/// for, kOpen is the others.
/// kLampLit...: as the kinds of tiles with surfaces, those that lamps reach, where that is told
/// apart; the latter are then the others.
/// kPlainSquares and kMixedSquares: squares of kSquareEdge pixels of tiles in kCovered, where they
/// are looked for, kept... such of tiles in kKeptCovered. Plain ones show one plane of one block;
/// mixed are the others with a surface.
enum class TileKind : std::uint32_t {
  kCovered = 0,
  kOpen = 1,
  kSunless = 2,
  kDetailed = 3,
  kInWater = kDetailed,
  kKeptCovered = 4,
  kKeptOpen = 5,
  kKeptDetailed = 6,
  kSmoothSky = shared::kSmoothSkyTiles,
  kKeptSmoothSky,
  kLampLit = shared::kLampTiles,
  kKeptLampLit,
  kLampLitSunless,
  kLampLitInWater,
  kPlainSquares = shared::kPlainSquares,
  kKeptPlainSquares,
  kMixedSquares = shared::kMixedSquares,
  kKeptMixedSquares
};

/// What tells apart the tiles that lamps reach, for shaders/include/light/lit_tiles.glsl.
struct LampReads {
  gpu::BufferRef grid, clusters, depths;  ///< shared::ClusterGrid, shared::Cluster[cluster] and
                                          ///< shared::TileDepths[tile]
  bool lit = false;                       ///< else nothing of it is read
  bool oracle = false;                    ///< lamps reach every tile

  /// No tile is told apart.
  static LampReads none(const SceneRefs& scene);
  std::vector<gpu::SpecConstant> with_lamps(std::vector<gpu::SpecConstant> own) const;
  void declare(gpu::PassBuilder& builder) const;
  auto bindings() const {
    return std::tuple{gpu::storage<shared::kLightGridBinding>(grid),
                      gpu::storage<shared::kClustersBinding>(clusters),
                      gpu::storage<shared::kTileDepthsBinding>(depths)};
  }
};

/// 8x8-pixel tiles by what they show, as indirect dispatches of one work group a tile. A tile may
/// be of several kinds.
struct Tiles {
  gpu::BufferRef lists;     ///< shared::TileDispatch[kind], uint[kind][tile], then
                            ///< uint[2][square], of those that keep radiance last: plain from the
                            ///< beginning, mixed from the end
  bool squares = false;     ///< whether they are looked for
  bool smooth_sky = false;  ///< whether tiles of it are

  /// What tiles.glsl declares.
  auto bindings(TileKind kind) const {
    return std::tuple{gpu::storage<shared::kTilesBinding>(lists),
                      gpu::constants(static_cast<std::uint32_t>(kind))};
  }
};

/// Where a pixel has a surface.
struct Coverage {
  gpu::ImageRef words;                 ///< R32_UINT
  gpu::ImageRef depth;                 ///< reverse-Z, 0 where there is none
  DepthStore kept = DepthStore::kD32;  ///< of `depth`; with 16 bits its words decide
  glm::uvec4 area;                     ///< from xy to before zw: pixels outside have none
  bool area_alone = false;             ///< tiles without a pixel of the area are not listed
  std::optional<LampReads> lamps{};    ///< none: tiles that lamps reach are not told apart
};

/// Before tiles or pixels are listed: a shared::TileDispatch of none, at `offset` bytes.
void clear_dispatch(gpu::Commands& commands, gpu::BufferRef dispatches, std::uint64_t offset);

/// Lists of no tiles yet, of every kind: all frames with the same settings ask for the same memory.
/// @param clear_name of the pass that empties them. @param tiles that each list has room for.
/// @param squares whether their squares are looked for.
Tiles create_tiles(gpu::FrameGraph& graph, const std::string& clear_name, std::uint32_t tiles,
                   bool squares = false);

/// Sorts tiles by whether any of their pixels has, or has not, a surface. @param name of the pass.
Tiles classify_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const char* name, const Coverage& coverage);

/// Declares what dispatch_tiles() uses.
void declare_tiles(gpu::PassBuilder& builder, const Tiles& tiles);

/// Runs the bound program, one that includes tiles.glsl, on the tiles of the kind it is bound with.
void dispatch_tiles(gpu::Commands& commands, const Tiles& tiles, TileKind kind);

}  // namespace skerry::render
