"""Deliberate breakages of the renderer, each a change of source that the scenes must catch.

`old` stands exactly once in `file`; a text that no longer does is an error, so that the list stays
true. `scenes` are tried first; then all. No mutant may be equivalent: each changes some picture
that a player can see.
"""
from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    id: str
    breaks: str
    file: str
    old: str
    new: str
    scenes: str = ""


MUTANTS = (
    # Light
    Mutant("moon_off", "the moon gives no light", "shaders/include/lighting.glsl",
           "if ((kBodies & 2u) != 0u) light += received(s, frame.bodies[1], kMoonCascade);", "",
           "moonlit mycelium"),
    Mutant("normal_of_z_faces", "faces along z have the opposite normal", "shaders/include/common.glsl",
           "axis == 2u ? s : 0.0", "axis == 2u ? -s : 0.0", "debug_normal day"),
    Mutant("flat_shading_ignored", "flat shading shades by angle", "shaders/include/lighting.glsl",
           "frame.shading_flat != 0u ? 1.0 : n_dot_l", "n_dot_l", "flat_shading"),
    Mutant("emission_lost", "nothing glows", "shaders/include/surface.glsl",
           "unpackHalf2x16(materials[surface_block(word)].emission).x", "0.0", "lava_night cave"),
    # Shadows
    Mutant("cascade_shifted_a_texel", "the second cascade is read a texel beside", "shaders/include/shadow.glsl",
           "index == 1u) c = frame.cascades[base + 1u];",
           "index == 1u) { c = frame.cascades[base + 1u]; c.map_from_world_x.w += 1.0; }", "overhead day autumn"),
    Mutant("cascades_swapped", "the third cascade is read for the second", "shaders/include/shadow.glsl",
           "index == 1u) c = frame.cascades[base + 1u];", "index == 1u) c = frame.cascades[base + 2u];",
           "overhead day autumn"),
    Mutant("cascades_do_not_fade", "cascades end in a step", "shaders/include/shadow.glsl",
           "clamp((distance / cascade.radius - 0.8) / 0.2, 0.0, 1.0)", "0.0", "debug_shadow wide_view day"),
    Mutant("shadow_bias_removed", "no bias against rounding", "shaders/include/shadow.glsl",
           "cascade.depth_per_block * (0.004 + 0.02 * texel) + 0.016 * (abs(r.slope.x) + abs(r.slope.y))", "0.0",
           "debug_shadow underneath mesa"),
    Mutant("shadow_bias_doubled", "twice the bias and the step off the surface", "shaders/include/shadow.glsl",
           "vec3 q = p + normal * (0.5 * texel);", "vec3 q = p + normal * (1.0 * texel);",
           "debug_shadow day overhead"),
    Mutant("receiver_plane_lost", "taps compare with one depth instead of the receiver's plane",
           "shaders/include/shadow.glsl", "dot(r.slope, texel + 0.5 - r.map.xy)", "0.0", "low_sun debug_shadow"),
    Mutant("shadow_tap_lost", "two of eight taps are taken twice for others", "shaders/include/shadow.glsl",
           "PAIR(0.539, 0.265)", "PAIR(-0.265, 0.539)", "debug_shadow day closeup"),
    Mutant("penumbra_narrow", "a shadow's edge is blurred as if the sun were a point", "shaders/include/shadow.glsl",
           "kBodyRadius * distance_blocks / texel", "0.1 * kBodyRadius * distance_blocks / texel", "water"),
    Mutant("shadow_casters_lost", "what the camera does not see casts no shadow of a far sun",
           "engine/render/frame_setup.cpp", "light.planes[5] = glm::vec4(\n        0, 0, 0, 1);",
           "light.planes[5] = glm::vec4(\n        0, 0, 0, -1);", "day"),
    Mutant("haze_ignores_shadow", "haze glows in caves", "shaders/include/lighting.glsl",
           "float lit = light_in_air(0u, p);", "float lit = 1.0;", "cave cave_mouth sealed_dark"),
    # Corners
    Mutant("corners_lost", "corners are as bright as faces", "shaders/include/corners.glsl",
           "1.0 - frame.corner_darkening * (1.0 - openness)", "1.0", "mesa tropical"),
    Mutant("corners_turned", "a face's corners are taken crosswise", "shaders/include/occupancy.glsl",
           "mix(c01, c11, at.in_face.x), at.in_face.y)", "mix(c01, c11, at.in_face.x), 1.0 - at.in_face.y)",
           "mesa tropical"),
    # Sky and air
    Mutant("haze_doubled", "twice the haze", "engine/render/frame_setup.cpp", "kClearAir = 0.0005f", "kClearAir = 0.001f",
           "far_view high_altitude"),
    Mutant("sky_table_half_texel", "the sky is looked up half a texel beside", "shaders/include/sky.glsl",
           "(sky_lut_from_dir(dir) * (size - 1.0) + 0.5) / size", "(sky_lut_from_dir(dir) * (size - 1.0) + 1.0) / size",
           "empty low_sun sun_disc"),
    Mutant("star_missing", "one star in eight is missing", "shaders/include/stars.glsl",
           "bool here = on_face && float(h >> 20) < share * 4096.0;",
           "bool here = on_face && float(h >> 20) < share * 4096.0 && (k & 7u) != 3u;", "stars night"),
    Mutant("discs_too_small", "sun and moon are a tenth too small", "shaders/shared/sky.h", "kDiscRadius = 3.0f *",
           "kDiscRadius = 2.7f *", "sun_disc moon_disc"),
    Mutant("moon_lit_from_behind", "the moon's phase is mirrored", "shaders/include/discs.glsl",
           "max(0.0, dot(p, sky.moon_lit))", "max(0.0, dot(p, vec3(-sky.moon_lit.x, sky.moon_lit.yz)))", "moon_disc"),
    # Water
    Mutant("absorption_swapped", "water absorbs blue instead of red", "shaders/include/water.glsl",
           "return medium.absorption + scattering(medium);", "return medium.absorption.bgr + scattering(medium);",
           "underwater water"),
    Mutant("fresnel_inverted", "water mirrors most where it should least", "shaders/include/water.glsl",
           "r0 + (1.0 - r0) * pow(1.0 - cosine, 5.0)", "r0 + (1.0 - r0) * pow(cosine, 5.0)", "water underwater_up"),
    Mutant("no_waves", "water is flat", "shaders/include/water.glsl", "slope *= exp(-distance * 0.02);", "slope *= 0.0;",
           "underwater_up water"),
    Mutant("water_before_everything", "water shows through what is before it", "shaders/write_layer.frag",
           "if (z <= texelFetch(opaque_depth, pixel, 0).r) discard;",
           "if (z <= texelFetch(opaque_depth, pixel, 0).r - 1.0) discard;", "highland autumn marsh"),
    Mutant("water_faces_turned", "a water surface's back is taken for its front", "shaders/write_layer.frag",
           "gl_FrontFacing ? in_surface : in_surface ^ kOppositeFace", "in_surface", "underwater_up underwater"),
    # Geometry
    Mutant("chunk_culled", "one chunk is never drawn", "shaders/cull_sections.comp",
           "uint mask = visible_ranges(s, views[view]);", "uint mask = section == 5u ? 0u : visible_ranges(s, views[view]);",
           "tropical day mesa"),
    Mutant("culled_too_early", "chunks vanish before they have left the picture", "shaders/cull_sections.comp",
           "+ reach < -1e-3 * (1.0 + reach)", "+ 0.5 * reach < 0.0", "overhead closeup wide_view"),
    Mutant("quad_missing", "one quad of each draw is missing", "shaders/cull_emit.comp", "DrawCommand(6u * quads,",
           "DrawCommand(6u * quads - 6u,", "day mesa overhead"),
    Mutant("second_diagonal_missing", "plants are one quad instead of two", "shaders/draw_quads.vert",
           "plus ? u : 1.0 - u", "u", "day quality_low"),
    Mutant("growth_removed", "light shines through between merged quads", "shaders/draw_quads.vert",
           "max(distance, 0.05) * push.growth", "max(distance, 0.05) * 0.0", "underneath cave sealed_dark cave_mouth"),
    Mutant("island_transposed", "islands turn the other way", "shaders/include/common.glsl",
           "return t.axis_x * v.x + t.axis_y * v.y + t.axis_z * v.z;",
           "return vec3(dot(t.axis_x, v), dot(t.axis_y, v), dot(t.axis_z, v));", "turned_islands"),
    Mutant("depth_comparison", "the last drawn surface wins", "engine/gpu/pipeline_build.cpp",
           "VK_COMPARE_OP_GREATER_OR_EQUAL", "VK_COMPARE_OP_ALWAYS", "day"),
    Mutant("detail_ends_early", "coarser levels begin a quarter nearer", "world/stream.cpp",
           "double limit = detail_distance_blocks;", "double limit = detail_distance_blocks * 0.75;",
           "turned_islands overhead narrow_view"),
    Mutant("view_one_percent_wider", "the field of view is 1% too wide", "engine/render/camera.cpp",
           "view.tan_half_x = static_cast<float>(tan_x);", "view.tan_half_x = static_cast<float>(tan_x * 1.01);",
           "overhead day"),
    # Textures
    Mutant("alpha_threshold", "leaves and plants are thinner", "shaders/include/write_cutout.glsl",
           "alpha < 0.5", "alpha < 0.8",
           "closeup quality_low blossom"),
    Mutant("mip_off_by_one", "textures are one level too coarse", "shaders/include/surface.glsl",
           "float lod = log2(", "float lod = 1.0 + log2(", "day underwater"),
    Mutant("texture_flipped", "side textures are upside down", "shaders/include/surface.glsl",
           "vec2(lattice.z, -lattice.y)", "vec2(lattice.z, lattice.y)", "day underwater"),
    Mutant("half_a_pixel_off", "rays leave from a pixel's corner", "shaders/include/common.glsl",
           "((float((pixel).x) + 0.5) *", "((float((pixel).x) + 0.0) *", "day debug_normal"),
    # The picture
    Mutant("wrong_srgb_curve", "gamma 2.2 instead of sRGB's curve", "shaders/include/tonemap.glsl",
           "vec3(1.0 / 2.4)", "vec3(1.0 / 2.2)", "day"),
    Mutant("channels_swapped", "red and blue are swapped", "shaders/include/output.glsl",
           "srgb_encode(tone_map(exposed))", "srgb_encode(tone_map(exposed.bgr))", "day"),
    Mutant("exposure_5_percent", "the picture is 5% brighter", "shaders/include/output.glsl",
           "exp2(-exposure.ev)", "1.05 * exp2(-exposure.ev)", "day empty mesa"),
    Mutant("meter_follows_more", "nights are almost as bright as days", "shaders/shared/exposure.h",
           "kFollowed = 0.7f", "kFollowed = 0.9f", "dusk moonlit volcanic"),
    Mutant("meter_dazzled", "the brightest pixels decide the exposure", "shaders/shared/exposure.h",
           "kPassedOverDark = 429496730u", "kPassedOverDark = 3865470566u", "day autumn"),
    Mutant("meter_counts_black", "black pixels are metered as the darkest light", "shaders/meter_radiance.comp",
           "if (counts_as_light(y)) atomicAdd(here[bin_of(y)], 1u);",
           "atomicAdd(here[counts_as_light(y) ? bin_of(y) : 0u], 1u);", "cave_mouth underneath water"),
    Mutant("bloom_reaches_too_far", "more of the glow goes to the coarse levels", "shaders/shared/bloom.h",
           "kBloomShare = 0.7f", "kBloomShare = 0.9f", "bloom quality_high"),
    Mutant("bloom_takes_all", "everything glows", "shaders/shrink_bloom.comp",
           "return kFirst ? too_bright(value) : value;",
           "return kFirst ? sanitised(value) * exp2(-exposure.ev) : value;", "bloom quality_high"),
    Mutant("bloom_mirrored_weights", "glow is shifted", "shaders/include/bloom.glsl",
           "x = (local.x & 1u) == 0u ? kTent : kTent.wzyx", "x = kTent", "bloom"),
    Mutant("dither_missing", "dark gradients band", "shaders/include/tonemap.glsl", "(noise - 0.5) / 255.0", "0.0",
           "stars empty"),
    Mutant("tile_missing", "the last tile of each list is not shaded", "shaders/include/tiles.glsl",
           "bool here = slot < dispatches[push.kind].tiles;", "bool here = slot + 1u < dispatches[push.kind].tiles;",
           "day mesa"),
)
