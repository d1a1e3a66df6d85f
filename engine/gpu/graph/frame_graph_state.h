#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/device/access.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/graph/transient_pool.h"

namespace skerry::gpu {

/// What FrameGraph keeps to itself. Declaring fills resources and passes; compile() derives the
/// rest of them.
struct FrameGraph::State {
  static constexpr std::uint32_t kNoPass = ~0u;

  /// Who touched a layer last. `touched` is false while only a layout transition did, which the
  /// stages in `access` have seen.
  struct Layer {
    AccessState access;
    bool touched = true;
  };

  struct Resource {
    bool is_image = false;
    bool imported = false;
    ImageDesc image_desc;
    BufferDesc buffer_desc;
    Image* image = nullptr;
    Buffer* buffer = nullptr;
    std::vector<std::uint32_t> writers{
        kNoPass};  ///< pass that wrote each version; version 0 comes from outside
    std::uint32_t last_pass = kNoPass;  ///< last kept pass that touches it
    std::vector<Layer> layers;          ///< one for a buffer
    bool discard = false;  ///< contents are not wanted any more: the next transition may drop them
    const std::string& name() const { return is_image ? image_desc.name : buffer_desc.name; }
  };

  /// One use as declared.
  struct Declared {
    std::uint32_t resource = 0;
    std::uint32_t version_in = 0;
    std::uint32_t version_out = 0;  ///< of a read: the same
    Use use{};
    bool attachment = false;
    std::uint32_t layer = 0;  ///< of an attachment
    Load load;
    bool write() const { return version_out != version_in; }
  };

  /// All uses of one resource in one pass together.
  struct Merged {
    std::uint32_t resource = 0;
    std::uint32_t first_layer = 0, layer_count = 1;
    Access access;
  };

  struct Barrier {
    std::uint32_t resource = 0;
    std::uint32_t first_layer = 0, layer_count = 1;
    Scopes scopes;
    VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  };

  struct Pass {
    std::string name;
    std::function<void(Commands&)> record;
    std::vector<Declared> declared;
    std::optional<VkRect2D> area;  ///< of its attachments
    bool keep = false;
    bool alive = false;
    std::vector<Merged> merged;      ///< what the pass itself does
    std::vector<Merged> host_reads;  ///< what the CPU does afterwards
    std::vector<Barrier> before, behind;
  };

  bool time_passes = true;  // else the frame as a whole

  struct Timers {
    VkQueryPool pool{};
    std::uint32_t capacity = 0;
    std::vector<std::string> names;
  };

  explicit State(Device* used) : device(used), pool(used) {}

  [[noreturn]] void fail(const Pass& pass, const std::string& text) const;
  [[noreturn]] void fail(const Pass& pass, std::uint32_t resource, const std::string& text) const;
  void check_ref(const Pass& pass, std::uint32_t id, bool image) const;
  std::uint32_t declare(std::uint32_t pass, const Declared& declared);

  void check_versions();
  void check_pass(std::uint32_t index, std::vector<std::uint32_t>& current,
                  std::vector<bool>& written) const;
  void check_attachments(const Pass& pass) const;
  void cull();
  void allocate();
  void merge_uses(Pass& pass);
  void plan();
  void plan_access(const Merged& merged, std::vector<Barrier>& out);
  void plan_transition(Resource& resource, const Merged& merged, std::vector<Barrier>& out);
  void carry_states();

  void record_barriers(VkCommandBuffer commands, const std::vector<Barrier>& barriers) const;
  bool begin_rendering(VkCommandBuffer commands, const Pass& pass, std::uint32_t index);
  void prepare_timers(VkCommandBuffer commands, std::uint32_t slot);

  Device* device;
  TransientPool pool;
  std::vector<Resource> resources;
  std::vector<Pass> passes;
  std::vector<LeftOut> left_out;
  std::map<std::uint32_t, Timers> timers;  // by frame slot
  FrameCounts recorded;                    // what Commands and begin_rendering() count
  bool compiled = false;
};

}  // namespace skerry::gpu
