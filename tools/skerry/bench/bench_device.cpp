#include "tools/skerry/bench/bench_device.h"

#include <fmt/format.h>
#include <shader_names.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/measure.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

using gpu::Use;

constexpr int kWarmUp = 2, kRounds = 15;
constexpr std::uint32_t kInvocations = 640 * 384;
constexpr std::uint32_t kQuads = shared::kMeasuredQuadsAcross * shared::kMeasuredQuadsAcross;
constexpr std::uint32_t kPasses = 32;
constexpr VkExtent2D kPicture{1280, 720};

struct Pushed {
  std::uint32_t invocations = 0, zero = 0;
};
/// Invocations of a group along each axis.
struct Shape {
  std::uint32_t x = 8, y = 8, z = 1;
};

/// What one work reads and writes.
struct Resources {
  gpu::Buffer words, sums;
  gpu::Image image;              ///< words
  gpu::Image bytes, halves;      ///< that are filtered
  gpu::Image one, other, depth;  ///< that quads are drawn to
};

/// One thing that is timed.
struct Case {
  std::string_view group, name;
  std::function<void(gpu::FrameGraph&)> add;
  double times = 0.0;  ///< that it is done in a frame
  std::vector<double> ms{};
};

Result<Resources> make_resources(gpu::Device& device) {
  constexpr VkBufferUsageFlags kReadEveryWay = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                               VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
  constexpr VkExtent2D kSquare{shared::kMeasuredImageEdge, shared::kMeasuredImageEdge};
  constexpr VkImageUsageFlags kRead = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  constexpr VkImageUsageFlags kDrawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  Resources made;
  const auto buffer = [&](gpu::Buffer& into, const gpu::BufferDesc& desc) -> Result<void> {
    Result<gpu::Buffer> one = device.create_buffer(desc);
    if (!one) return one.error();
    into = *std::move(one);
    return {};
  };
  const auto image = [&](gpu::Image& into, const gpu::ImageDesc& desc) -> Result<void> {
    Result<gpu::Image> one = device.create_image(desc);
    if (!one) return one.error();
    into = *std::move(one);
    return {};
  };
  for (const Result<void>& done :
       {buffer(made.words,
               {"words", shared::kMeasuredWords * 4, kReadEveryWay, gpu::Memory::kMapped, true}),
        buffer(made.sums, {"sums", kInvocations * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}),
        image(made.image, {"words", VK_FORMAT_R32_UINT, kSquare, 1, 1, kRead}),
        image(made.bytes, {"bytes", VK_FORMAT_R8G8B8A8_UNORM, kSquare, 1, 1, kRead}),
        image(made.halves, {"halves", VK_FORMAT_R16G16B16A16_SFLOAT, kSquare, 1, 1, kRead}),
        image(made.one, {"one", VK_FORMAT_R32_UINT, kPicture, 1, 1, kDrawn}),
        image(made.other, {"other", VK_FORMAT_R32_UINT, kPicture, 1, 1, kDrawn}),
        image(made.depth, {"depth", VK_FORMAT_D32_SFLOAT, kPicture, 1, 1,
                           VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT})})
    if (!done) return done.error();
  std::uint32_t word = 1;
  for (std::uint32_t i = 0; i < shared::kMeasuredWords; ++i) {
    word = word * 1664525u + 1013904223u;
    std::memcpy(made.words.mapped() + std::size_t{4} * i, &word, sizeof word);
  }
  return made;
}

/// Adds passes that do what is timed.
class Works {
 public:
  static Result<std::unique_ptr<Works>> create(gpu::Device& device) {
    Result<Resources> made = make_resources(device);
    if (!made) return made.error();
    Result<VkSampler> sampler =
        device.sampler({.mag = VK_FILTER_NEAREST, .min = VK_FILTER_NEAREST});
    if (!sampler) return sampler.error();
    std::unique_ptr<Works> works(new Works(device, *std::move(made), *sampler));
    works->clear_images();
    return works;
  }

  /// @param filtered, sampler of kWorkFilter; none: any.
  void work(gpu::FrameGraph& graph, std::uint32_t what, Shape shape = {},
            gpu::Image* filtered = nullptr, VkSampler sampler = {}) {
    compute(graph, what, shape, {filtered ? filtered : &made_.bytes, sampler ? sampler : sampler_},
            kInvocations);
  }

  /// Passes of one group each whose invocations end at once.
  void empty_passes(gpu::FrameGraph& graph) {
    for (std::uint32_t i = 0; i < kPasses; ++i)
      compute(graph, shared::kWorkArithmetic, {8, 1, 1}, {&made_.bytes, sampler_}, 0);
  }

  /// @param words 0 to 2 that a pixel of a quad writes, besides its depth.
  void quads(gpu::FrameGraph& graph, int words) {
    gpu::GraphicsDesc desc;
    desc.cull = VK_CULL_MODE_NONE;
    desc.depth_format = VK_FORMAT_D32_SFLOAT;
    desc.color_formats.assign(static_cast<std::size_t>(words), VK_FORMAT_R32_UINT);
    using programs::kPlaceQuadsVert;
    const auto depth_alone = gpu::graphics(pipelines_, kPlaceQuadsVert, desc);
    if (words == 0) return draw(graph, words, depth_alone);
    if (words == 1)
      return draw(graph, words,
                  gpu::graphics(pipelines_, kPlaceQuadsVert, programs::kWriteWordFrag, desc));
    draw(graph, words,
         gpu::graphics(pipelines_, kPlaceQuadsVert, programs::kWriteTwoWordsFrag, desc));
  }

  gpu::Image& bytes() { return made_.bytes; }
  gpu::Image& halves() { return made_.halves; }

 private:
  struct Filtered {
    gpu::Image* image;
    VkSampler sampler;
  };
  Works(gpu::Device& device, Resources made, VkSampler sampler)
      : device_(device), made_(std::move(made)), pipelines_(device), sampler_(sampler) {}

  void clear_images() {
    gpu::FrameGraph graph(&device_);
    graph.begin();
    for (gpu::Image* image : {&made_.image, &made_.bytes, &made_.halves}) {
      gpu::ImageRef ref = graph.import(*image);
      graph.add_pass(
          "clear", [&](gpu::PassBuilder& b) { ref = b.write(ref, Use::kTransferWrite); },
          [ref](gpu::Commands& c) { c.clear(ref, {}); });
    }
    graph.compile();
    device_.run_now([&](VkCommandBuffer commands) { graph.execute(commands, 0); });
  }

  void compute(gpu::FrameGraph& graph, std::uint32_t what, Shape shape, Filtered filtered,
               std::uint32_t invocations) {
    const gpu::BufferRef words = graph.import(made_.words);
    const gpu::ImageRef image = graph.import(made_.image), texture = graph.import(*filtered.image);
    gpu::BufferRef sums = graph.import(made_.sums);
    const auto program = gpu::compute(pipelines_, programs::kMeasureWork,
                                      {{shared::kGroupXConstant, shape.x},
                                       {shared::kGroupYConstant, shape.y},
                                       {shared::kGroupZConstant, shape.z},
                                       {shared::kWorkConstant, what}});
    graph.add_pass(
        "work",
        [&](gpu::PassBuilder& b) {
          b.read(words, Use::kComputeRead);
          b.read(image, Use::kComputeSampled);
          b.read(texture, Use::kComputeSampled);
          sums = b.write(sums, Use::kComputeWrite);
        },
        [=, sums = sums, nearest = sampler_](gpu::Commands& c) {
          gpu::bind(c, program, gpu::storage<shared::kWordsBinding>(words),
                    gpu::storage<shared::kUniformWordsBinding>(words),
                    gpu::texels<shared::kTexelWordsBinding>(words),
                    gpu::sampled<shared::kImageWordsBinding>(image, nearest),
                    gpu::sampled<shared::kFilteredBinding>(texture, filtered.sampler),
                    gpu::storage<shared::kSumsBinding>(sums),
                    gpu::constants(Pushed{invocations, 0}));
          c.dispatch(std::max(invocations / (shape.x * shape.y * shape.z), 1u), 1, 1);
        });
  }

  template <class Program>
  void draw(gpu::FrameGraph& graph, int words, const Program& program) {
    gpu::ImageRef depth = graph.import(made_.depth);
    gpu::ImageRef colors[2] = {graph.import(made_.one), graph.import(made_.other)};
    graph.add_pass(
        "quads",
        [&](gpu::PassBuilder& b) {
          depth = b.depth(depth, gpu::Load::cleared({}));
          for (int i = 0; i < words; ++i) colors[i] = b.color(colors[i], gpu::Load::cleared({}));
        },
        [program](gpu::Commands& c) {
          gpu::bind(c, program);
          c.draw(6 * kQuads, 1);
        });
  }

  gpu::Device& device_;
  Resources made_;
  gpu::Pipelines pipelines_;
  VkSampler sampler_;
};

constexpr double kSteps = double{kInvocations} * shared::kMeasuredSteps;

void add_work_cases(Works& works, std::vector<Case>& cases) {
  struct Named {
    std::string_view group, name;
    std::uint32_t work;
  };
  constexpr Named kWorks[] = {
      {"load", "none: its address alone", shared::kWorkIndex},
      {"load", "storage buffer, own address", shared::kWorkStorage},
      {"load", "uniform buffer, own address", shared::kWorkUniform},
      {"load", "texel buffer of 128 bits, own address", shared::kWorkTexels},
      {"load", "image of 32 bits, own address", shared::kWorkImage},
      {"load", "storage buffer, one address", shared::kWorkStorageOne},
      {"load", "uniform buffer, one address", shared::kWorkUniformOne},
      {"branch", "none: one side's arithmetic", shared::kWorkArithmetic},
      {"branch", "two sides, neighbours differ", shared::kWorkBranchBoth},
      {"branch", "two sides, all take one", shared::kWorkBranchOne},
      {"branch", "both sides' arithmetic, never taken", shared::kWorkBranchNone},
      {"loop", "left after 1 to 16 rounds, neighbours differ", shared::kWorkExitOwn},
      {"loop", "left after 1 round by all", shared::kWorkExitEarly},
      {"loop", "left after 16 rounds by all", shared::kWorkExitNever},
      {"loop", "left after 1 of at most 16 known rounds", shared::kWorkExitUnrolled}};
  for (const Named& one : kWorks)
    cases.push_back({one.group, one.name,
                     [&works, work = one.work](gpu::FrameGraph& graph) { works.work(graph, work); },
                     kSteps});
}

void add_shape_cases(Works& works, std::vector<Case>& cases) {
  struct Named {
    std::string_view name;
    Shape shape;
  };
  constexpr Named kShapes[] = {{"8x8x1", {8, 8, 1}},     {"8x1x1", {8, 1, 1}},
                               {"64x1x1", {64, 1, 1}},   {"256x1x1", {256, 1, 1}},
                               {"16x16x1", {16, 16, 1}}, {"1x64x1", {1, 64, 1}},
                               {"4x4x4", {4, 4, 4}}};
  for (const Named& one : kShapes)
    cases.push_back({"group", one.name,
                     [&works, shape = one.shape](gpu::FrameGraph& graph) {
                       works.work(graph, shared::kWorkArithmetic, shape);
                     },
                     kSteps});
}

/// Errors: none but a device that is out of memory.
Result<void> add_filter_cases(gpu::Device& device, Works& works, std::vector<Case>& cases) {
  struct Named {
    std::string_view name;
    gpu::Image& image;
    VkFilter filter;
    VkSamplerAddressMode address;
  };
  const Named kFilters[] = {
      {"8 bits, nearest, clamped", works.bytes(), VK_FILTER_NEAREST,
       VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
      {"8 bits, linear, repeated", works.bytes(), VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT},
      {"8 bits, linear, clamped", works.bytes(), VK_FILTER_LINEAR,
       VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
      {"16-bit floats, linear, repeated", works.halves(), VK_FILTER_LINEAR,
       VK_SAMPLER_ADDRESS_MODE_REPEAT},
      {"16-bit floats, linear, clamped", works.halves(), VK_FILTER_LINEAR,
       VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE}};
  for (const Named& one : kFilters) {
    const Result<VkSampler> sampler =
        device.sampler({.mag = one.filter, .min = one.filter, .address = one.address});
    if (!sampler) return sampler.error();
    cases.push_back({"texture", one.name,
                     [&works, &image = one.image, sampler = *sampler](gpu::FrameGraph& graph) {
                       works.work(graph, shared::kWorkFilter, {}, &image, sampler);
                     },
                     kSteps});
  }
  return {};
}

void add_drawing_cases(Works& works, std::vector<Case>& cases) {
  constexpr std::string_view kNames[] = {"depth alone", "depth and one word",
                                         "depth and two words, two images"};
  for (int words = 0; words < 3; ++words)
    cases.push_back({"quad", kNames[words],
                     [&works, words](gpu::FrameGraph& graph) { works.quads(graph, words); },
                     kQuads});
  cases.push_back({"pass", "of one group that ends at once",
                   [&works](gpu::FrameGraph& graph) { works.empty_passes(graph); }, kPasses});
}

/// Times each case once a round.
Result<void> time_cases(gpu::Device& device, std::vector<Case>& cases) {
  gpu::FrameGraph graph(&device);
  graph.time_passes(false);
  for (int round = -kWarmUp; round < kRounds; ++round) {
    for (Case& one : cases) {
      graph.begin();
      one.add(graph);
      graph.compile();
      if (const std::optional<Error> failed = graph.allocation_failure()) return *failed;
      device.run_now([&](VkCommandBuffer commands) { graph.execute(commands, 0); });
      double ms = 0.0;
      for (const gpu::PassTime& pass : graph.times(0)) ms += pass.ms;
      if (round >= 0) one.ms.push_back(ms);
    }
  }
  return {};
}

}  // namespace

int bench_device(const BenchDeviceOptions& options) {
  game::SceneOptions scene;
  scene.device = options.device;
  scene.validate = options.validate;
  Result<std::unique_ptr<gpu::Device>> device = open_device(scene);
  if (!device) return fail(kNoDevice, device.error());
  Result<std::unique_ptr<Works>> works = Works::create(**device);
  if (!works) return fail(kFailed, works.error());
  std::vector<Case> cases;
  add_work_cases(**works, cases);
  add_shape_cases(**works, cases);
  if (const auto added = add_filter_cases(**device, **works, cases); !added)
    return fail(kFailed, added.error());
  add_drawing_cases(**works, cases);
  if (const auto timed = time_cases(**device, cases); !timed) return fail(kFailed, timed.error());
  fmt::print("{}, {}\n\n| kind | what | ms | p10 to p90 | ns |\n|---|---|---|---|---|\n",
             (*device)->info().name, (*device)->info().driver);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Case& one : cases) {
    const Spread spread = spread_of(one.ms);
    const double ns = spread.median * 1e6 / one.times;
    fmt::print("| {} | {} | {:.2f} | {:.2f} to {:.2f} | {:.3g} |\n", one.group, one.name,
               spread.median, spread.p10, spread.p90, ns);
    rows.push_back({{"device", (*device)->info().name},
                    {"group", one.group},
                    {"name", one.name},
                    {"ms_median", spread.median},
                    {"ms_p10", spread.p10},
                    {"ms_p90", spread.p90},
                    {"ns", ns}});
  }
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return status_after(**device);
}

}  // namespace skerry::tools
