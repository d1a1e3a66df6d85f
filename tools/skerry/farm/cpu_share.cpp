#include "tools/skerry/farm/cpu_share.h"

#include <hwloc.h>

#include <climits>
#include <memory>

#include "engine/core/check.h"

namespace skerry::tools {
namespace {

struct FreeSet {
  void operator()(hwloc_bitmap_s* set) const { hwloc_bitmap_free(set); }
};
using CpuSet = std::unique_ptr<hwloc_bitmap_s, FreeSet>;

struct DestroyTopology {
  void operator()(hwloc_topology* topology) const { hwloc_topology_destroy(topology); }
};
using Topology = std::unique_ptr<hwloc_topology, DestroyTopology>;

/// The processors that this process may use; null: the system does not say.
Topology usable_topology() {
  hwloc_topology_t opened = nullptr;
  if (hwloc_topology_init(&opened) != 0) return nullptr;
  Topology topology(opened);
  const CpuSet bound(hwloc_bitmap_alloc());
  if (hwloc_topology_load(opened) != 0 || !bound) return nullptr;
  if (hwloc_get_cpubind(opened, bound.get(), HWLOC_CPUBIND_PROCESS) != 0) return nullptr;
  if (hwloc_topology_restrict(opened, bound.get(), 0) != 0) return nullptr;
  return topology;
}

}  // namespace

std::vector<std::vector<unsigned>> cpu_shares(hwloc_topology* topology, std::size_t shares) {
  SKERRY_ASSERT(shares > 0);
  hwloc_obj_t root = hwloc_get_root_obj(topology);
  const int cpus = hwloc_bitmap_weight(root->cpuset);
  if (cpus < 0 || static_cast<std::size_t>(cpus) < shares) return {};
  std::vector<hwloc_cpuset_t> sets(shares);
  if (hwloc_distrib(topology, &root, 1, sets.data(), static_cast<unsigned>(shares), INT_MAX, 0))
    return {};
  std::vector<std::vector<unsigned>> parts;
  for (const hwloc_cpuset_t set : sets) {
    const CpuSet owned(set);
    std::vector<unsigned>& part = parts.emplace_back();
    for (int cpu = hwloc_bitmap_first(set); cpu >= 0; cpu = hwloc_bitmap_next(set, cpu))
      part.push_back(static_cast<unsigned>(cpu));
  }
  return parts;
}

void stay_on_cpu_share(std::size_t share, std::size_t shares) {
  SKERRY_ASSERT(share < shares);
  if (shares == 1) return;
  const Topology topology = usable_topology();
  if (!topology) return;
  const auto parts = cpu_shares(topology.get(), shares);
  if (parts.empty()) return;
  const CpuSet set(hwloc_bitmap_alloc());
  if (!set) return;
  for (const unsigned cpu : parts[share]) hwloc_bitmap_set(set.get(), cpu);
  // What cannot be bound runs anywhere, as before.
  hwloc_set_cpubind(topology.get(), set.get(), HWLOC_CPUBIND_PROCESS);
}

}  // namespace skerry::tools
