// One definition serves C++ and GLSL only if both compilers lay it out alike: every struct of
// shaders/shared, as glslang laid it out in every shader that uses it, against offsetof.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <test_paths.h>
#include "engine/gpu/program/shader_table.h"
#include "shaders/shared/bloom.h"
#include "shaders/shared/clouds.h"
#include "shaders/shared/clusters.h"
#include "shaders/shared/edges.h"
#include "shaders/shared/exposure.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/geometry.h"
#include "shaders/shared/light.h"
#include "shaders/shared/marker.h"
#include "shaders/shared/occupancy.h"
#include "shaders/shared/overlay.h"
#include "shaders/shared/shafts.h"
#include "shaders/shared/sky.h"
#include "shaders/shared/temporal.h"
#include "tests/gpu/compile_glsl.h"

namespace skerry::shared {
namespace {

namespace fs = std::filesystem;

struct Member {
  std::string name;
  std::size_t offset = 0, size = 0;
  bool operator==(const Member&) const = default;
};
struct Layout {
  std::string name;
  std::size_t size = 0;
  std::vector<Member> members;
};

std::ostream& operator<<(std::ostream& out, const Member& member) {
  return out << member.name << " at " << member.offset << ", " << member.size << " bytes";
}

const std::vector<Layout>& cpp_layouts() {
#define MEMBER(type, member) \
  { #member, offsetof(type, member), sizeof(type::member) }
#define STRUCT(type, ...)  \
  Layout {                 \
#type, sizeof(type), { \
      __VA_ARGS__          \
    }                      \
  }
  static const std::vector<Layout> layouts{
      STRUCT(Quad, MEMBER(Quad, geometry), MEMBER(Quad, material)),
      STRUCT(Section, MEMBER(Section, origin), MEMBER(Section, island),
             MEMBER(Section, voxel_size_log2), MEMBER(Section, first_quad),
             MEMBER(Section, bounds_min), MEMBER(Section, bounds_max), MEMBER(Section, blend),
             MEMBER(Section, range_end)),
      STRUCT(IslandTransform, MEMBER(IslandTransform, axis_x), MEMBER(IslandTransform, axis_y),
             MEMBER(IslandTransform, axis_z), MEMBER(IslandTransform, translation)),
      STRUCT(OccupancyGrid, MEMBER(OccupancyGrid, low), MEMBER(OccupancyGrid, size),
             MEMBER(OccupancyGrid, first)),
      STRUCT(Material, MEMBER(Material, layer_side), MEMBER(Material, layer_top),
             MEMBER(Material, layer_bottom), MEMBER(Material, emission),
             MEMBER(Material, absorption), MEMBER(Material, roughness), MEMBER(Material, metalness),
             MEMBER(Material, light_class), MEMBER(Material, translucent_block),
             MEMBER(Material, scattering), MEMBER(Material, liquid)),
      STRUCT(DrawCommand, MEMBER(DrawCommand, index_count), MEMBER(DrawCommand, instance_count),
             MEMBER(DrawCommand, first_index), MEMBER(DrawCommand, vertex_offset),
             MEMBER(DrawCommand, section)),
      STRUCT(Body, MEMBER(Body, to_light), MEMBER(Body, irradiance), MEMBER(Body, first_cascade),
             MEMBER(Body, cascade_count)),
      STRUCT(Cascade, MEMBER(Cascade, map_from_world_x), MEMBER(Cascade, map_from_world_y),
             MEMBER(Cascade, map_from_world_z), MEMBER(Cascade, radius),
             MEMBER(Cascade, texel_blocks), MEMBER(Cascade, depth_per_block),
             MEMBER(Cascade, layer), MEMBER(Cascade, glass_layer), MEMBER(Cascade, glass_area)),
      STRUCT(FrameConstants, MEMBER(FrameConstants, clip_from_world),
             MEMBER(FrameConstants, ray_right), MEMBER(FrameConstants, ray_up),
             MEMBER(FrameConstants, ray_forward), MEMBER(FrameConstants, pixel_to_ndc),
             MEMBER(FrameConstants, sample_in_pixel), MEMBER(FrameConstants, size),
             MEMBER(FrameConstants, layers_area), MEMBER(FrameConstants, radiance_area),
             MEMBER(FrameConstants, picture_size), MEMBER(FrameConstants, near_plane),
             MEMBER(FrameConstants, display_peak), MEMBER(FrameConstants, display_black),
             MEMBER(FrameConstants, time_s), MEMBER(FrameConstants, shading_flat),
             MEMBER(FrameConstants, glass_body), MEMBER(FrameConstants, glass_per_texel),
             MEMBER(FrameConstants, camera_medium), MEMBER(FrameConstants, medium_surface),
             MEMBER(FrameConstants, medium_surface_place), MEMBER(FrameConstants, medium_light),
             MEMBER(FrameConstants, shadow_blur), MEMBER(FrameConstants, sky_horizon),
             MEMBER(FrameConstants, sky_yaw), MEMBER(FrameConstants, haze_per_block),
             MEMBER(FrameConstants, body_in_air), MEMBER(FrameConstants, ao_strength),
             MEMBER(FrameConstants, bodies), MEMBER(FrameConstants, cascades)),
      STRUCT(CullView, MEMBER(CullView, planes), MEMBER(CullView, eye),
             MEMBER(CullView, orthographic), MEMBER(CullView, enabled),
             MEMBER(CullView, first_section), MEMBER(CullView, section_limit),
             MEMBER(CullView, glass)),
      STRUCT(SectionTransform, MEMBER(SectionTransform, x), MEMBER(SectionTransform, y),
             MEMBER(SectionTransform, z), MEMBER(SectionTransform, blend),
             MEMBER(SectionTransform, first_cutout)),
      STRUCT(CullStats, MEMBER(CullStats, sections_in), MEMBER(CullStats, sections_passed),
             MEMBER(CullStats, draws), MEMBER(CullStats, quads), MEMBER(CullStats, quads_in_view)),
      STRUCT(TileDispatch, MEMBER(TileDispatch, groups_x), MEMBER(TileDispatch, groups_y),
             MEMBER(TileDispatch, groups_z), MEMBER(TileDispatch, tiles)),
      STRUCT(PixelStats, MEMBER(PixelStats, non_finite), MEMBER(PixelStats, black)),
      STRUCT(Metering, MEMBER(Metering, key), MEMBER(Metering, min_ev), MEMBER(Metering, max_ev),
             MEMBER(Metering, stride), MEMBER(Metering, decides)),
      STRUCT(Exposure, MEMBER(Exposure, ev), MEMBER(Exposure, metered_ev),
             MEMBER(Exposure, metered), MEMBER(Exposure, first_bin), MEMBER(Exposure, last_bin),
             MEMBER(Exposure, most)),
      STRUCT(CloudLight, MEMBER(CloudLight, to_light), MEMBER(CloudLight, irradiance)),
      STRUCT(CloudLayer, MEMBER(CloudLayer, place), MEMBER(CloudLayer, thickness),
             MEMBER(CloudLayer, extinction), MEMBER(CloudLayer, coverage)),
      STRUCT(CloudVolume, MEMBER(CloudVolume, index_x), MEMBER(CloudVolume, index_y),
             MEMBER(CloudVolume, index_z), MEMBER(CloudVolume, low), MEMBER(CloudVolume, high),
             MEMBER(CloudVolume, extinction), MEMBER(CloudVolume, emission),
             MEMBER(CloudVolume, step_blocks), MEMBER(CloudVolume, first_cell),
             MEMBER(CloudVolume, cell_count), MEMBER(CloudVolume, cell_low),
             MEMBER(CloudVolume, light_texels), MEMBER(CloudVolume, light_first)),
      STRUCT(CloudConstants, MEMBER(CloudConstants, lights),
             MEMBER(CloudConstants, sky_beside_body), MEMBER(CloudConstants, sky_above),
             MEMBER(CloudConstants, shadow_steps), MEMBER(CloudConstants, steps),
             MEMBER(CloudConstants, layer), MEMBER(CloudConstants, volumes)),
      STRUCT(CloudLightJob, MEMBER(CloudLightJob, volume), MEMBER(CloudLightJob, light)),
      STRUCT(BloomStep, MEMBER(BloomStep, fine_size), MEMBER(BloomStep, coarse_size),
             MEMBER(BloomStep, threshold), MEMBER(BloomStep, intensity)),
      STRUCT(SkyScatter, MEMBER(SkyScatter, rayleigh), MEMBER(SkyScatter, mie),
             MEMBER(SkyScatter, multiple)),
      STRUCT(SkyBody, MEMBER(SkyBody, to_body), MEMBER(SkyBody, light)),
      STRUCT(SkyConstants, MEMBER(SkyConstants, sun), MEMBER(SkyConstants, moon),
             MEMBER(SkyConstants, sun_disc), MEMBER(SkyConstants, moon_disc),
             MEMBER(SkyConstants, sun_right), MEMBER(SkyConstants, sun_up),
             MEMBER(SkyConstants, moon_right), MEMBER(SkyConstants, moon_up),
             MEMBER(SkyConstants, moon_lit), MEMBER(SkyConstants, sky_x),
             MEMBER(SkyConstants, sky_y), MEMBER(SkyConstants, sky_z),
             MEMBER(SkyConstants, height_km), MEMBER(SkyConstants, horizon),
             MEMBER(SkyConstants, horizon_sine), MEMBER(SkyConstants, stars)),
      STRUCT(OverlayVertex, MEMBER(OverlayVertex, position), MEMBER(OverlayVertex, uv),
             MEMBER(OverlayVertex, color), MEMBER(OverlayVertex, clip)),
      STRUCT(Light, MEMBER(Light, position), MEMBER(Light, range), MEMBER(Light, intensity),
             MEMBER(Light, kind), MEMBER(Light, axis), MEMBER(Light, size),
             MEMBER(Light, cos_inner), MEMBER(Light, cos_outer), MEMBER(Light, first_island),
             MEMBER(Light, island_count), MEMBER(Light, reach), MEMBER(Light, first_pane),
             MEMBER(Light, pane_count), MEMBER(Light, unused)),
      STRUCT(LightPane, MEMBER(LightPane, low), MEMBER(LightPane, block), MEMBER(LightPane, high),
             MEMBER(LightPane, island)),
      STRUCT(LightReach, MEMBER(LightReach, low), MEMBER(LightReach, size),
             MEMBER(LightReach, per_block), MEMBER(LightReach, edge_log2),
             MEMBER(LightReach, island), MEMBER(LightReach, bits)),
      STRUCT(ClusterGrid, MEMBER(ClusterGrid, right), MEMBER(ClusterGrid, up),
             MEMBER(ClusterGrid, forward), MEMBER(ClusterGrid, tan_half), MEMBER(ClusterGrid, size),
             MEMBER(ClusterGrid, near_plane), MEMBER(ClusterGrid, edge_log2),
             MEMBER(ClusterGrid, tiles_x), MEMBER(ClusterGrid, tiles_y),
             MEMBER(ClusterGrid, bins_x), MEMBER(ClusterGrid, bins_y),
             MEMBER(ClusterGrid, light_count), MEMBER(ClusterGrid, light_words),
             MEMBER(ClusterGrid, chunk_words), MEMBER(ClusterGrid, chunks),
             MEMBER(ClusterGrid, unit_log2), MEMBER(ClusterGrid, capacity),
             MEMBER(ClusterGrid, layers_area), MEMBER(ClusterGrid, marked_slices)),
      STRUCT(TileDepths, MEMBER(TileDepths, slices), MEMBER(TileDepths, nearest),
             MEMBER(TileDepths, farthest)),
      STRUCT(Cluster, MEMBER(Cluster, first), MEMBER(Cluster, count)),
      STRUCT(TileShafts, MEMBER(TileShafts, slices), MEMBER(TileShafts, asked),
             MEMBER(TileShafts, open)),
      STRUCT(ClusterWork, MEMBER(ClusterWork, groups_x), MEMBER(ClusterWork, groups_y),
             MEMBER(ClusterWork, groups_z), MEMBER(ClusterWork, clusters),
             MEMBER(ClusterWork, units)),
      STRUCT(MarkerConstants, MEMBER(MarkerConstants, eye), MEMBER(MarkerConstants, right),
             MEMBER(MarkerConstants, up), MEMBER(MarkerConstants, forward),
             MEMBER(MarkerConstants, size), MEMBER(MarkerConstants, first),
             MEMBER(MarkerConstants, end), MEMBER(MarkerConstants, half_width),
             MEMBER(MarkerConstants, dug)),
      STRUCT(EdgePixel, MEMBER(EdgePixel, place), MEMBER(EdgePixel, colour)),
      STRUCT(Motion, MEMBER(Motion, x), MEMBER(Motion, y), MEMBER(Motion, w)),
      STRUCT(TemporalStep, MEMBER(TemporalStep, changed_area),
             MEMBER(TemporalStep, exposure_ratios), MEMBER(TemporalStep, sky),
             MEMBER(TemporalStep, kept), MEMBER(TemporalStep, slot), MEMBER(TemporalStep, still)),
      STRUCT(OverlayConstants, MEMBER(OverlayConstants, ndc_from_pixel)),
  };
#undef STRUCT
#undef MEMBER
  return layouts;
}

/// Named struct types of a SPIR-V module that lie in buffers, with their layout. (SPIR-V
/// specification 2.3, 3.32.)
class SpirvLayouts {
 public:
  explicit SpirvLayouts(const std::vector<std::uint32_t>& words) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
      if (words[at] >> 16 == 0) break;
      take(words[at] & 0xffffu, &words[at + 1], (words[at] >> 16) - 1);
    }
  }

  std::vector<Layout> structs() const {
    std::vector<Layout> list;
    for (const auto& [id, members] : struct_members_) {
      if (!offsets_.contains({id, 0})) continue;  // a copy in registers has no layout
      Layout layout{names_.at(id), 0, {}};
      for (std::uint32_t i = 0; i < members.size(); ++i) {
        const auto stride = matrix_strides_.find({id, i});
        const std::size_t size =
            size_of(members[i], stride == matrix_strides_.end() ? 0 : stride->second);
        layout.members.push_back({member_names_.at({id, i}), offsets_.at({id, i}), size});
        layout.size = std::max(layout.size, layout.members.back().offset + size);
      }
      list.push_back(layout);
    }
    return list;
  }

  /// Strides of arrays whose elements are this struct.
  std::set<std::size_t> strides(const std::string& name) const {
    std::set<std::size_t> found;
    for (const auto& [id, element] : array_elements_) {
      const auto named = names_.find(element);
      if (named != names_.end() && named->second == name && array_strides_.contains(id))
        found.insert(array_strides_.at(id));
    }
    return found;
  }

 private:
  using Id = std::uint32_t;
  static std::string text(const std::uint32_t* words) {
    return reinterpret_cast<const char*>(words);
  }

  void take(std::uint32_t op, const std::uint32_t* w, std::size_t count) {
    switch (op) {
      case 5:
        names_[w[0]] = text(w + 1);
        break;  // OpName
      case 6:
        member_names_[{w[0], w[1]}] = text(w + 2);
        break;  // OpMemberName
      case 21:
      case 22:
        sizes_[w[0]] = w[1] / 8;
        break;  // OpTypeInt, OpTypeFloat
      case 23:
        sizes_[w[0]] = sizes_[w[1]] * w[2];
        break;  // OpTypeVector
      case 24:
        columns_[w[0]] = w[2];
        break;  // OpTypeMatrix
      case 28:
        array_elements_[w[0]] = w[1];
        lengths_[w[0]] = constants_[w[2]];
        break;  // OpTypeArray
      case 29:
        array_elements_[w[0]] = w[1];
        break;  // OpTypeRuntimeArray
      case 30:
        struct_members_[w[0]].assign(w + 1, w + count);
        break;  // OpTypeStruct
      case 43:
        constants_[w[1]] = w[2];
        break;  // OpConstant
      case 71:  // OpDecorate ArrayStride
        if (w[1] == 6) array_strides_[w[0]] = w[2];
        break;
      case 72:  // OpMemberDecorate Offset, MatrixStride
        if (w[2] == 35) offsets_[{w[0], w[1]}] = w[3];
        if (w[2] == 7) matrix_strides_[{w[0], w[1]}] = w[3];
        break;
      default:
        break;
    }
  }

  std::size_t size_of(Id type, std::size_t matrix_stride) const {
    if (const auto size = sizes_.find(type); size != sizes_.end()) return size->second;
    if (const auto columns = columns_.find(type); columns != columns_.end())
      return columns->second * matrix_stride;
    if (const auto length = lengths_.find(type); length != lengths_.end())
      return length->second * array_strides_.at(type);
    const auto members = struct_members_.find(type);
    if (members == struct_members_.end()) return 0;  // a runtime array
    std::size_t end = 0;
    for (std::uint32_t i = 0; i < members->second.size(); ++i) {
      const auto stride = matrix_strides_.find({type, i});
      end = std::max(end, offsets_.at({type, i}) +
                              size_of(members->second[i],
                                      stride == matrix_strides_.end() ? 0 : stride->second));
    }
    return end;
  }

  std::map<Id, std::string> names_;
  std::map<std::pair<Id, std::uint32_t>, std::string> member_names_;
  std::map<std::pair<Id, std::uint32_t>, std::size_t> offsets_, matrix_strides_;
  std::map<Id, std::size_t> sizes_, columns_, lengths_, constants_, array_strides_;
  std::map<Id, Id> array_elements_;
  std::map<Id, std::vector<Id>> struct_members_;
};

std::vector<std::uint32_t> read_words(const fs::path& path) {
  std::vector<std::uint32_t> words(fs::file_size(path) / sizeof(std::uint32_t));
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(words.data()),
            static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
  return words;
}

/// Compares every shared struct in the module. @return names seen.
std::set<std::string> compare(const std::string& shader, const std::vector<std::uint32_t>& words) {
  std::set<std::string> seen;
  const SpirvLayouts spirv(words);
  for (const Layout& found : spirv.structs()) {
    for (const Layout& expected : cpp_layouts()) {
      if (expected.name != found.name) continue;
      seen.insert(found.name);
      EXPECT_EQ(found.members, expected.members) << found.name << " in " << shader;
      EXPECT_EQ(found.size, expected.size) << found.name << " in " << shader;
      for (const std::size_t stride : spirv.strides(found.name)) {
        EXPECT_EQ(stride, expected.size) << "stride of " << found.name << " in " << shader;
      }
    }
  }
  return seen;
}

std::vector<fs::path> shared_headers() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(fs::path(SKERRY_SOURCE_DIR) / "shaders/shared")) {
    if (entry.path().extension() == ".h") paths.push_back(entry.path());
  }
  return paths;
}

TEST(SharedStructs, ThisTestKnowsAllOfThem) {
  std::set<std::string> known;
  for (const Layout& layout : cpp_layouts()) known.insert(layout.name);
  for (const fs::path& path : shared_headers()) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    const std::string source = text.str();
    const std::regex pattern("struct\\s+(\\w+)\\s*\\{");
    for (auto it = std::sregex_iterator(source.begin(), source.end(), pattern);
         it != std::sregex_iterator(); ++it) {
      EXPECT_TRUE(known.contains((*it)[1]))
          << "add " << (*it)[1] << " of " << path.filename() << " to cpp_layouts()";
    }
  }
}

TEST(SharedStructs, EveryShaderOfTheProgramLaysThemOutAsCppDoes) {
  std::set<std::string> seen;
  for (const gpu::EmbeddedShader& shader : gpu::embedded_shaders()) {
    const std::string name = std::string(shader.name) + ".full.spv";
    seen.merge(compare(name, read_words(fs::path(SKERRY_BINARY_DIR) / "shaders" / name)));
  }
  // A quad is read as one uvec2 and a body of the sky as a part of its constants; the test below
  // has them all by name.
  for (const char* used :
       {"Section", "IslandTransform", "Material", "FrameConstants", "CullView", "DrawCommand"}) {
    EXPECT_TRUE(seen.contains(used)) << used;
  }
}

TEST(SharedStructs, AShaderWithAllOfThemLaysThemOutAsCppDoes) {
  std::string glsl = "#extension GL_GOOGLE_include_directive : require\n";
  for (const fs::path& path : shared_headers())
    glsl += "#include \"" + path.filename().string() + "\"\n";
  std::string body;
  for (std::size_t i = 0; i < cpp_layouts().size(); ++i) {
    const Layout& layout = cpp_layouts()[i];
    const std::string number = std::to_string(i);
    glsl += "layout(scalar, binding = " + number + ") buffer B" + number + " { " + layout.name +
            " b" + number + "[]; };\n";
    body += "b" + number + "[0] = b" + number + "[1];\n";
  }
  const gpu::TestShader shader(
      "all.comp", glsl + "layout(local_size_x = 1) in;\nvoid main() {\n" + body + "}\n");
  const std::set<std::string> seen = compare("all.comp", shader.words_with_names());
  for (const Layout& layout : cpp_layouts()) EXPECT_TRUE(seen.contains(layout.name)) << layout.name;
}

}  // namespace
}  // namespace skerry::shared
