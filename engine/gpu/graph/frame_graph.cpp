// Declaring passes, checking them, and finding out which are needed.
#include "engine/gpu/graph/frame_graph.h"

#include <algorithm>
#include <set>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/graph/frame_graph_state.h"

namespace skerry::gpu {

// --- PassBuilder ---

void PassBuilder::read(ImageRef image, Use use) {
  FrameGraph::State& state = *graph_.state_;
  const auto& pass = state.passes[pass_];
  state.check_ref(pass, image.id, true);
  const UseInfo info = use_info(use);
  if (info.write || !info.image_usage) state.fail(pass, image.id, "cannot be read that way");
  state.declare(pass_, {image.id, image.version, image.version, use, false, 0, {}});
}

void PassBuilder::read(BufferRef buffer, Use use) {
  FrameGraph::State& state = *graph_.state_;
  const auto& pass = state.passes[pass_];
  state.check_ref(pass, buffer.id, false);
  const UseInfo info = use_info(use);
  if (info.write || !info.buffer) state.fail(pass, buffer.id, "cannot be read that way");
  state.declare(pass_, {buffer.id, buffer.version, buffer.version, use, false, 0, {}});
}

ImageRef PassBuilder::write(ImageRef image, Use use) {
  FrameGraph::State& state = *graph_.state_;
  const auto& pass = state.passes[pass_];
  state.check_ref(pass, image.id, true);
  const bool attachment = use == Use::kColor || use == Use::kDepth;
  if (!use_info(use).write || attachment) state.fail(pass, image.id, "cannot be written that way");
  return {image.id,
          state.declare(pass_, {image.id, image.version, image.version + 1, use, false, 0, {}})};
}

BufferRef PassBuilder::write(BufferRef buffer, Use use) {
  FrameGraph::State& state = *graph_.state_;
  const auto& pass = state.passes[pass_];
  state.check_ref(pass, buffer.id, false);
  const UseInfo info = use_info(use);
  if (!info.write || !info.buffer) state.fail(pass, buffer.id, "cannot be written that way");
  return {buffer.id,
          state.declare(pass_, {buffer.id, buffer.version, buffer.version + 1, use, false, 0, {}})};
}

ImageRef PassBuilder::attach(ImageRef image, Use use, Load load, std::uint32_t layer) {
  FrameGraph::State& state = *graph_.state_;
  const auto& pass = state.passes[pass_];
  state.check_ref(pass, image.id, true);
  if (layer >= state.resources[image.id].layers.size())
    state.fail(pass, image.id, "has no such layer");
  return {image.id, state.declare(pass_, {image.id, image.version, image.version + 1, use, true,
                                          layer, load})};
}

ImageRef PassBuilder::color(ImageRef image, Load load, std::uint32_t layer) {
  return attach(image, Use::kColor, load, layer);
}

ImageRef PassBuilder::depth(ImageRef image, Load load, std::uint32_t layer) {
  return attach(image, Use::kDepth, load, layer);
}

void PassBuilder::area(VkRect2D area) {
  graph_.state_->passes[pass_].area = area;
}

void PassBuilder::keep() {
  graph_.state_->passes[pass_].keep = true;
}

// --- FrameGraph: declaring ---

FrameGraph::FrameGraph(Device* device) : state_(std::make_unique<State>(device)) {}

FrameGraph::~FrameGraph() {
  for (const auto& [slot, timers] : state_->timers) {
    state_->device->retire(reinterpret_cast<std::uint64_t>(timers.pool), VK_OBJECT_TYPE_QUERY_POOL,
                           VK_NULL_HANDLE, 0, {});
  }
}

void FrameGraph::begin() {
  state_->resources.clear();
  state_->passes.clear();
  state_->left_out.clear();
  state_->recorded = {};
  state_->compiled = false;
  state_->pool.begin_frame();
}

ImageRef FrameGraph::create(const ImageDesc& desc) {
  State::Resource resource;
  resource.is_image = true;
  resource.image_desc = desc;
  resource.layers.resize(desc.layers);
  state_->resources.push_back(std::move(resource));
  return {static_cast<std::uint32_t>(state_->resources.size() - 1), 0};
}

BufferRef FrameGraph::create(const BufferDesc& desc) {
  State::Resource resource;
  resource.buffer_desc = desc;
  resource.layers.resize(1);
  state_->resources.push_back(std::move(resource));
  return {static_cast<std::uint32_t>(state_->resources.size() - 1), 0};
}

ImageRef FrameGraph::import(Image& image) {
  auto& all = state_->resources;
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const auto& r) { return r.image == &image; });
  if (known != all.end()) {
    return {static_cast<std::uint32_t>(known - all.begin()),
            static_cast<std::uint32_t>(known->writers.size() - 1)};
  }
  const ImageRef ref = create(image.desc());
  all[ref.id].imported = true;
  all[ref.id].image = &image;
  return ref;
}

BufferRef FrameGraph::import(Buffer& buffer) {
  auto& all = state_->resources;
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const auto& r) { return r.buffer == &buffer; });
  if (known != all.end()) {
    return {static_cast<std::uint32_t>(known - all.begin()),
            static_cast<std::uint32_t>(known->writers.size() - 1)};
  }
  const BufferRef ref = create(BufferDesc{buffer.name(), buffer.size_bytes()});
  all[ref.id].imported = true;
  all[ref.id].buffer = &buffer;
  return ref;
}

void FrameGraph::add_pass(std::string name, const std::function<void(PassBuilder&)>& setup,
                          std::function<void(Commands&)> record) {
  SKERRY_ASSERT(!state_->compiled);
  State::Pass pass;
  pass.name = std::move(name);
  pass.record = std::move(record);
  state_->passes.push_back(std::move(pass));
  PassBuilder builder(*this, static_cast<std::uint32_t>(state_->passes.size() - 1));
  setup(builder);
}

void FrameGraph::leave_out(std::string name, std::string why) {
  state_->left_out.push_back({std::move(name), std::move(why)});
}

void FrameGraph::compile() {
  state_->check_versions();
  state_->cull();
  state_->allocate();
  state_->plan();
  state_->compiled = true;
}

std::vector<std::string> FrameGraph::pass_names() const {
  std::vector<std::string> names;
  for (const auto& pass : state_->passes) {
    if (pass.alive) names.push_back(pass.name);
  }
  return names;
}

std::vector<std::string> FrameGraph::culled_names() const {
  std::vector<std::string> names;
  for (const auto& pass : state_->passes) {
    if (!pass.alive) names.push_back(pass.name);
  }
  return names;
}

const std::vector<LeftOut>& FrameGraph::left_out() const {
  return state_->left_out;
}

std::optional<Error> FrameGraph::allocation_failure() const {
  return state_->pool.failure();
}

void FrameGraph::add_needs(TransientNeeds& to) const {
  std::vector<ImageDesc> images;
  std::vector<BufferDesc> buffers;
  for (const auto& resource : state_->resources) {
    if (resource.imported || resource.last_pass == State::kNoPass) continue;
    if (!resource.is_image)
      buffers.push_back(resource.buffer_desc);
    else if (resource.image_desc.format != VK_FORMAT_UNDEFINED)
      images.push_back(resource.image_desc);
  }
  to.add(images, buffers);
}

void FrameGraph::reserve(const TransientNeeds& needs) {
  state_->pool.reserve(needs);
}

std::vector<MemoryUse> FrameGraph::transient_memory() const {
  return state_->pool.memory();
}

FrameCounts FrameGraph::counts() const {
  FrameCounts out = state_->recorded;
  for (const auto& pass : state_->passes) {
    out.passes += pass.alive ? 1 : 0;
    out.barriers += static_cast<std::uint32_t>(pass.before.size() + pass.behind.size());
  }
  for (const auto& resource : state_->resources) {
    if (resource.imported || resource.last_pass == State::kNoPass) continue;
    ++(resource.is_image ? out.images : out.buffers);
    out.transient_bytes +=
        resource.is_image ? resource.image->allocated_bytes() : resource.buffer->allocated_bytes();
  }
  return out;
}

// --- State: checks and culling ---

void FrameGraph::State::fail(const Pass& pass, const std::string& text) const {
  gpu_fatal("frame graph: the pass '" + pass.name + "' " + text);
}

void FrameGraph::State::fail(const Pass& pass, std::uint32_t resource,
                             const std::string& text) const {
  fail(pass, "uses '" + resources[resource].name() + "', which " + text);
}

void FrameGraph::State::check_ref(const Pass& pass, std::uint32_t id, bool image) const {
  if (id >= resources.size()) fail(pass, "uses an empty reference, or one of another frame");
  if (resources[id].is_image != image) fail(pass, id, "is not of that kind");
}

std::uint32_t FrameGraph::State::declare(std::uint32_t pass, const Declared& declared) {
  auto& writers = resources[declared.resource].writers;
  if (declared.write() && declared.version_out == writers.size()) writers.push_back(pass);
  passes[pass].declared.push_back(declared);
  return declared.version_out;
}

void FrameGraph::State::check_versions() {
  std::vector<std::uint32_t> current(resources.size(), 0);
  std::vector<bool> written(resources.size(), false);
  for (std::size_t i = 0; i < resources.size(); ++i) written[i] = resources[i].imported;
  for (std::uint32_t i = 0; i < passes.size(); ++i) check_pass(i, current, written);
}

void FrameGraph::State::check_pass(std::uint32_t index, std::vector<std::uint32_t>& current,
                                   std::vector<bool>& written) const {
  const Pass& pass = passes[index];
  for (const Declared& use : pass.declared) {
    const Resource& resource = resources[use.resource];
    if (use.version_in != current[use.resource]) {
      // A reference that is too new, too, can only come from an earlier frame.
      if (use.version_in > current[use.resource])
        fail(pass, use.resource, "has no such version in this frame");
      const std::uint32_t writer = resource.writers[use.version_in + 1];
      fail(pass, use.resource,
           "has been replaced: '" + passes[writer].name +
               "' wrote a newer version; use the reference it returned");
    }
    const bool keeps_contents = !use.write() || (use.attachment && use.load.keeps());
    if (keeps_contents && !written[use.resource])
      fail(pass, use.resource, "no pass has written yet");
    if (use.write()) {
      current[use.resource] = use.version_out;
      written[use.resource] = true;
    }
  }
  check_attachments(pass);
}

namespace {

bool contains(VkExtent2D image, const VkRect2D& area) {
  const auto along = [](std::int32_t from, std::uint32_t size, std::uint32_t whole) {
    return from >= 0 && size > 0 && std::uint64_t{size} + static_cast<std::uint64_t>(from) <= whole;
  };
  return along(area.offset.x, area.extent.width, image.width) &&
         along(area.offset.y, area.extent.height, image.height);
}

}  // namespace

void FrameGraph::State::check_attachments(const Pass& pass) const {
  const Resource* first = nullptr;
  bool depth = false;
  for (const Declared& use : pass.declared) {
    if (!use.attachment) continue;
    const Resource& resource = resources[use.resource];
    if (!first) first = &resource;
    const VkExtent2D a = resource.image_desc.extent, b = first->image_desc.extent;
    if (a.width != b.width || a.height != b.height) {
      fail(pass, use.resource, "has another size than its attachment '" + first->name() + "'");
    }
    if (use.use == Use::kDepth && std::exchange(depth, true))
      fail(pass, use.resource, "is a second depth attachment");
    if (pass.area && !contains(a, *pass.area))
      fail(pass, use.resource, "does not contain the area that the pass draws to");
  }
}

void FrameGraph::State::cull() {
  std::set<std::pair<std::uint32_t, std::uint32_t>>
      wanted;  // (resource, version) a kept pass depends on
  for (auto pass = passes.rbegin(); pass != passes.rend(); ++pass) {
    pass->alive = pass->keep;
    for (const Declared& use : pass->declared) {
      if (use.write() &&
          (resources[use.resource].imported || wanted.contains({use.resource, use.version_out}))) {
        pass->alive = true;
      }
    }
    if (!pass->alive) continue;
    for (const Declared& use : pass->declared) {
      // An attachment that does not keep its contents needs nothing of the version before, if it is
      // the whole image.
      const ImageDesc& desc = resources[use.resource].image_desc;
      const bool replaces_all =
          use.attachment && !use.load.keeps() && desc.layers == 1 && desc.mips == 1;
      if (!replaces_all) wanted.insert({use.resource, use.version_in});
    }
  }
  for (std::uint32_t i = 0; i < passes.size(); ++i) {
    if (!passes[i].alive) continue;
    for (const Declared& use : passes[i].declared) resources[use.resource].last_pass = i;
  }
}

void FrameGraph::State::allocate() {
  for (const Pass& pass : passes) {
    if (!pass.alive) continue;
    for (const Declared& use : pass.declared) {
      Resource& resource = resources[use.resource];
      resource.image_desc.usage |= use_info(use.use).image_usage;
      resource.buffer_desc.usage |= use_info(use.use).buffer_usage;
    }
  }
  for (Resource& resource : resources) {
    if (resource.imported || resource.last_pass == kNoPass) continue;
    if (resource.is_image) {
      resource.image = &pool.take(resource.image_desc);
    } else {
      resource.buffer = &pool.take(resource.buffer_desc);
    }
  }
}

}  // namespace skerry::gpu
