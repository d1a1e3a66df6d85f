#pragma once
#include <cstdint>
#include <span>

#include "tools/textures/canvas.h"

/// One function a material. All are pure: the same arguments give the same texels.
namespace skerry::textures {

// ground.cpp
Canvas paint_dirt();
Canvas paint_gravel(Color pebble, Color other, std::uint32_t seed);
Canvas paint_grass_top(Color leaf, Color other, std::uint32_t seed);
/// Ragged grass, moss or snow over dirt. @param fringe mean depth of the cover [texels].
Canvas paint_covered_side(Color cover, Color other, float fringe, bool blades, std::uint32_t seed);
Canvas paint_snow();
Canvas paint_ice();
Canvas paint_sand(Color base, std::uint32_t seed);
Canvas paint_smooth_ground(Color base, std::uint32_t seed);
Canvas paint_mud();
Canvas paint_cracked_ground(Color base, std::uint32_t seed);
Canvas paint_mycelium_top();
Canvas paint_moss(Color base, std::uint32_t seed);
Canvas paint_leaf_litter();
Canvas paint_salt();
Canvas paint_water();

// rock.cpp
/// Fine grain and soft relief of a stone, tones 0..1 around 0.5.
Field stone_tone(Cells cells, float strength, std::uint32_t seed);
Canvas paint_stone(Color base, std::uint32_t seed);
Canvas paint_mossy(const Canvas& stone, std::uint32_t seed);
Canvas paint_cobble(Color base, std::uint32_t seed);
/// One layer of a layered rock.
struct Bed {
  Color color;
  int thickness;  ///< [texels]; those of all beds sum to kEdge
};
/// @param waves how far the beds bend up and down [texels].
Canvas paint_beds(std::span<const Bed> beds, float waves, std::uint32_t seed);
Canvas paint_sandstone_side();
Canvas paint_banded_rock();
Canvas paint_basalt_side();
Canvas paint_basalt_top();
Canvas paint_lava();
Canvas paint_obsidian();
Canvas paint_marble();
Canvas paint_slate();
Canvas paint_limestone();

// minerals.cpp
/// Lumps of `mineral` set into stone.
Canvas paint_ore(const Ramp& mineral, float gloss, std::uint32_t seed);
/// Crystals of the given colour set into stone.
Canvas paint_crystal_ore(Color crystal, std::uint32_t seed);
Canvas paint_crystal(Color base, std::uint32_t seed);
Canvas paint_glowstone(Color core, std::uint32_t seed);

// wood.cpp
enum class Bark { kRidged, kBirch, kPlated, kRinged, kFibrous };
Canvas paint_bark(Color base, Bark bark, std::uint32_t seed);
Canvas paint_log_top(Color wood, Color bark, std::uint32_t seed);
Canvas paint_planks(Color wood, std::uint32_t seed);
Canvas paint_parquet(Color wood, Color other, std::uint32_t seed);
Canvas paint_crate(Color wood, Color frame, std::uint32_t seed);
Canvas paint_barrel_side(Color wood, Color hoop);
Canvas paint_barrel_top(Color wood, Color hoop);
Canvas paint_bookshelf(Color wood);

// leaves.cpp
enum class Leaf { kRound, kNeedle, kFrond, kWillow, kBlossom };
/// A block of leaves, cut out, with about a quarter of holes.
Canvas paint_leaves(Color base, Color other, Leaf leaf, std::uint32_t seed);

// plants.cpp
Canvas paint_tall_grass(Color base, std::uint32_t seed);
Canvas paint_fern(Color base, Color tip, std::uint32_t seed);
enum class Flower { kPoppy, kDaisy, kBell, kTulip };
Canvas paint_flower(Color petal, Color center, Flower flower, std::uint32_t seed);
Canvas paint_reed();
Canvas paint_dead_bush();
Canvas paint_glow_shroom();
Canvas paint_heather();
Canvas paint_wheat();
Canvas paint_kelp();
Canvas paint_torch();

// fungus.cpp
Canvas paint_mushroom_cap(Color base, Color spot, std::uint32_t seed);
Canvas paint_mushroom_stem();

// built.cpp
/// @param pane_cover share of the light that the pane itself scatters, besides what it absorbs.
Canvas paint_glass(Color tint, Color frame, float pane_cover);
Canvas paint_bricks(Color brick, Color mortar, std::uint32_t seed);
enum class Masonry { kPolished, kBricks, kTiles, kCarved, kPillar };
Canvas paint_masonry(const Ramp& stone, Masonry style, std::uint32_t seed);
Canvas paint_lamp(Color glow, Color frame);
Canvas paint_shingles(Color base, std::uint32_t seed);
Canvas paint_metal_plate(Color base, std::uint32_t seed);
Canvas paint_metal_tread(Color base, std::uint32_t seed);
Canvas paint_lattice(Color base, bool diagonal);
Canvas paint_thatch(Color base, bool ends, std::uint32_t seed);
Canvas paint_basket(Color base, std::uint32_t seed);
Canvas paint_rope(Color base);

// dyed.cpp
Canvas paint_wool(Color dye, std::uint32_t seed);
Canvas paint_glazed_tile(Color dye, std::uint32_t seed);
Canvas paint_plaster(Color dye, std::uint32_t seed);
Canvas paint_terracotta(Color dye, std::uint32_t seed);
Canvas paint_sailcloth(Color dye, std::uint32_t seed);

}  // namespace skerry::textures
