#include "world/stream/cut.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "shaders/shared/geometry.h"

namespace skerry::world {
namespace {

constexpr double kSplitHysteresis = 1.05;

TreeNode parent_of(const TreeNode& node) {
  const auto half = [](std::int32_t v) { return static_cast<std::int32_t>(floor_div(v, 2)); };
  return {node.level + 1, {half(node.chunk.x), half(node.chunk.y), half(node.chunk.z)}};
}

TreeNode beside(const TreeNode& node, std::uint32_t face) {
  TreeNode out = node;
  std::int32_t* const axes[] = {&out.chunk.x, &out.chunk.y, &out.chunk.z};
  *axes[face / 2] += face % 2 == 0 ? 1 : -1;
  return out;
}

double distance_to(const TreeNode& node, const glm::dvec3& camera) {
  const double edge = static_cast<double>(std::int64_t{kChunkEdge} << node.level);
  const glm::dvec3 low = glm::dvec3(node.chunk.x, node.chunk.y, node.chunk.z) * edge;
  return glm::length(camera - glm::clamp(camera, low, low + edge));
}

class Cutter {
 public:
  Cutter(std::span<const TreeNode> sections, const glm::dvec3& camera,
         std::span<const double> nearest, const std::set<TreeNode>* before)
      : camera_(camera), nearest_(nearest), before_(before) {
    std::int32_t top = 0;
    finest_ = INT32_MAX;
    for (const TreeNode& section : sections) {
      top = std::max(top, section.level);
      finest_ = std::min(finest_, section.level);
    }
    levels_.resize(static_cast<std::size_t>(top) + 1);
    for (const TreeNode& section : sections) {
      levels_[static_cast<std::size_t>(section.level)] = true;
      TreeNode node = section;
      for (bool is_new = true; is_new && node.level < top;) {
        const TreeNode parent = parent_of(node);
        std::vector<TreeNode>& children = children_[parent];
        is_new = std::ranges::find(children, node) == children.end();
        if (is_new) children.push_back(node);
        node = parent;
      }
      if (node.level == top) roots_.insert(node);
    }
    slack_ = std::numeric_limits<double>::infinity();
    for (const TreeNode& root : roots_) visit(root);
  }

  SectionCut cut(std::span<const TreeNode> sections) && {
    SectionCut out;
    out.drawn.reserve(sections.size());
    out.seams.reserve(sections.size());
    for (const TreeNode& section : sections) {
      const bool drawn = leaves_.contains(section);
      std::uint8_t seams = 0;
      for (std::uint32_t face = 0; drawn && face < shared::kFaceCount; ++face)
        if (is_other_level(beside(section, face)))
          seams = static_cast<std::uint8_t>(seams | 1u << face);
      out.drawn.push_back(drawn);
      out.seams.push_back(seams);
    }
    out.split = std::move(split_);
    out.slack = slack_;
    return out;
  }

 private:
  bool has(std::int32_t level) const { return levels_[static_cast<std::size_t>(level)]; }

  bool is_split(const TreeNode& node) {
    if (node.level == finest_) return false;
    if (!has(node.level)) return true;
    const double limit = nearest_[static_cast<std::size_t>(node.level)];
    const double farther = limit * kSplitHysteresis, nearer = limit / kSplitHysteresis;
    const double distance = distance_to(node, camera_);
    const bool is_split = distance < (!before_                  ? limit
                                      : before_->contains(node) ? farther
                                                                : nearer);
    slack_ = std::min(slack_, std::abs(distance - (is_split ? farther : nearer)));
    return is_split;
  }

  void visit(const TreeNode& node) {
    if (!is_split(node)) {
      leaves_.insert(node);
      return;
    }
    split_.insert(node);
    const auto children = children_.find(node);
    if (children == children_.end()) return;  // nothing of it is left at finer levels
    for (const TreeNode& child : children->second) visit(child);
  }

  bool is_other_level(TreeNode node) const {
    if (leaves_.contains(node)) return false;
    if (split_.contains(node)) return true;
    while (node.level + 1 < static_cast<std::int32_t>(levels_.size())) {
      node = parent_of(node);
      if (leaves_.contains(node)) return true;
    }
    return false;
  }

  const glm::dvec3 camera_;
  const std::span<const double> nearest_;
  const std::set<TreeNode>* const before_;
  std::vector<bool> levels_;  // that occur
  std::int32_t finest_ = 0;   // of them
  std::map<TreeNode, std::vector<TreeNode>> children_;
  std::set<TreeNode> roots_, leaves_, split_;
  double slack_ = 0.0;
};

}  // namespace

SectionCut cut_of(std::span<const TreeNode> sections, const glm::dvec3& camera,
                  std::span<const double> nearest, const std::set<TreeNode>* before) {
  return Cutter(sections, camera, nearest, before).cut(sections);
}

}  // namespace skerry::world
