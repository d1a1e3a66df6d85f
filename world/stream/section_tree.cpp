#include "world/stream/section_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/core/check.h"
#include "shaders/shared/geometry.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr double kSplitHysteresis = 1.05;
constexpr std::int32_t kCoarsest = kLevelCount - 1;

TreeNode parent_of(const TreeNode& node) {
  return {node.level + 1, {node.chunk.x >> 1, node.chunk.y >> 1, node.chunk.z >> 1}};
}

/// Which of its parent's children a node is: a bit an axis.
std::size_t place_in_parent(const TreeNode& node) {
  return static_cast<std::size_t>((node.chunk.x & 1) | (node.chunk.y & 1) << 1 |
                                  (node.chunk.z & 1) << 2);
}

TreeNode beside(const TreeNode& node, std::uint32_t face) {
  TreeNode out = node;
  std::int32_t* const axes[] = {&out.chunk.x, &out.chunk.y, &out.chunk.z};
  *axes[face / 2] += face % 2 == 0 ? 1 : -1;
  return out;
}

}  // namespace

void LatticeBox::add(const LatticeBox& other) {
  low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
  high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y),
          std::max(high.z, other.high.z)};
}

double LatticeBox::distance(const glm::dvec3& from) const {
  if (low.x > high.x) return std::numeric_limits<double>::infinity();
  const glm::dvec3 nearest =
      glm::clamp(from, glm::dvec3(low.x, low.y, low.z), glm::dvec3(high.x, high.y, high.z));
  return glm::length(from - nearest);
}

std::size_t SectionTree::Hash::operator()(const TreeNode& node) const {
  return hash3(static_cast<std::uint32_t>(node.level), node.chunk.x, node.chunk.y, node.chunk.z);
}

SectionTree::Node* SectionTree::find(const TreeNode& node) {
  const auto found = nodes_.find(node);
  return found == nodes_.end() ? nullptr : &found->second;
}

/// Brings the boxes of a node and of those that hold it up to date.
void SectionTree::enclose(Node* node) {
  for (; node; node = node->parent) {
    LatticeBox faces = node->own;
    for (const Node* child : node->children)
      if (child) faces.add(child->faces);
    if (faces == node->faces) return;
    node->faces = faces;
  }
}

void SectionTree::add(const TreeNode& section, const LatticeBox& faces) {
  SKERRY_ASSERT(section.level >= 0 && section.level < kLevelCount);
  Node* below = nullptr;
  for (TreeNode place = section;; place = parent_of(place)) {
    const auto [at, is_new] = nodes_.try_emplace(place);
    Node& node = at->second;
    node.place = place;
    if (below) {
      below->parent = &node;
      node.children[place_in_parent(below->place)] = below;
    }
    below = &node;
    if (!is_new) break;
    if (place.level == kCoarsest) {
      roots_.push_back(&node);
      break;
    }
  }
  Node& node = *find(section);
  SKERRY_ASSERT(!node.section);
  node.section = node.drawn = true;
  node.seams = 0;
  node.own = faces;
  enclose(&node);
  ++sections_[static_cast<std::size_t>(section.level)];
  fresh_.push_back(section);
  stale_ = true;
}

void SectionTree::remove(const TreeNode& section) {
  Node* node = find(section);
  SKERRY_ASSERT(node && node->section);
  node->section = false;
  node->own = {};
  enclose(node);
  --sections_[static_cast<std::size_t>(section.level)];
  stale_ = true;
  const auto is_bare = [](const Node& of) {
    return !of.section && std::ranges::all_of(of.children, [](const Node* c) { return !c; });
  };
  while (node && is_bare(*node)) {
    Node* const parent = node->parent;
    if (parent)
      parent->children[place_in_parent(node->place)] = nullptr;
    else
      std::erase(roots_, node);
    forget(*node);
    node = parent;
  }
}

/// Takes a node out that nothing holds.
void SectionTree::forget(Node& node) {
  if (node.leaf_in == round_) {
    leaves_[node.leaf] = nullptr;
    changed_.push_back(node.place);
  }
  nodes_.erase(TreeNode(node.place));
}

void SectionTree::set_coming(std::uint32_t levels) {
  if (coming_ == levels) return;
  coming_ = levels;
  stale_ = true;
}

void SectionTree::choose_levels() {
  std::uint32_t there = 0;
  for (std::size_t level = 0; level < sections_.size(); ++level)
    if (sections_[level] != 0) there |= 1u << level;
  levels_ = there & ~coming_;
  if (levels_ == 0) levels_ = there & -there;
  finest_ = levels_ == 0 ? 0 : std::countr_zero(levels_);
}

bool SectionTree::is_split(const Node& node, const glm::dvec3& camera,
                           std::span<const double> nearest, bool keep) {
  if (node.place.level <= finest_) return false;
  if (!has(node.place.level)) return true;
  const double limit = nearest[static_cast<std::size_t>(node.place.level)];
  const double farther = limit * kSplitHysteresis, nearer = limit / kSplitHysteresis;
  const double distance = node.faces.distance(camera);
  const bool was_split = node.split_in + 1 == round_;
  const bool is_split = distance < (!keep ? limit : was_split ? farther : nearer);
  slack_ = std::min(slack_, std::abs(distance - (is_split ? farther : nearer)));
  return is_split;
}

void SectionTree::visit(Node& node, const glm::dvec3& camera, std::span<const double> nearest,
                        bool keep) {
  if (!is_split(node, camera, nearest, keep)) {
    if (node.leaf_in + 1 != round_) changed_.push_back(node.place);
    node.leaf_in = round_;
    node.leaf = leaves_.size();
    leaves_.push_back(&node);
    return;
  }
  node.split_in = round_;
  for (Node* child : node.children)
    if (child) visit(*child, camera, nearest, keep);
}

/// Whether at a place, or at a part of it, something is drawn at another level than the place's.
bool SectionTree::is_other_level(TreeNode place) {
  if (const Node* node = find(place)) {
    if (node->leaf_in == round_) return false;
    if (node->split_in == round_) return true;
  }
  while (place.level < kCoarsest) {
    place = parent_of(place);
    if (const Node* node = find(place); node && node->leaf_in == round_) return true;
  }
  return false;
}

/// Tells what is drawn of a section, if that has changed.
void SectionTree::reconsider(Node& node) {
  if (!node.section || node.looked_at_in == round_) return;
  node.looked_at_in = round_;
  const bool drawn = node.leaf_in == round_;
  std::uint8_t seams = 0;
  for (std::uint32_t face = 0; drawn && face < shared::kFaceCount; ++face)
    if (is_other_level(beside(node.place, face)))
      seams = static_cast<std::uint8_t>(seams | 1u << face);
  if (drawn == node.drawn && seams == node.seams) return;
  node.drawn = drawn;
  node.seams = seams;
  changes_.push_back({node.place, drawn, seams});
}

/// The leaves of a node that lie at one of its faces.
void SectionTree::reconsider_leaves(Node& node, std::uint32_t face) {
  if (node.leaf_in == round_) return reconsider(node);
  if (node.split_in != round_) return;
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const bool upper = (i >> (face / 2) & 1u) != 0;
    if (node.children[i] && upper == (face % 2 == 0)) reconsider_leaves(*node.children[i], face);
  }
}

/// Whatever is drawn beside a place, of which another part is drawn now.
void SectionTree::reconsider_around(const TreeNode& place) {
  for (std::uint32_t face = 0; face < shared::kFaceCount; ++face) {
    TreeNode next = beside(place, face);
    Node* node = find(next);
    if (node && (node->leaf_in == round_ || node->split_in == round_)) {
      reconsider_leaves(*node, face ^ 1u);
      continue;
    }
    while (next.level < kCoarsest) {
      next = parent_of(next);
      node = find(next);
      if (node && node->leaf_in == round_) reconsider(*node);
    }
  }
}

std::span<const SectionTree::Change> SectionTree::cut(const glm::dvec3& camera,
                                                      std::span<const double> nearest, bool keep) {
  SKERRY_ASSERT(nearest.size() == kLevelCount);
  choose_levels();
  const bool keeps = keep && round_ != 1;
  ++round_;
  slack_ = std::numeric_limits<double>::infinity();
  std::swap(leaves_, leaves_before_);
  leaves_.clear();
  changes_.clear();
  for (Node* root : roots_) visit(*root, camera, nearest, keeps);
  for (const Node* node : leaves_before_)
    if (node && node->leaf_in != round_) changed_.push_back(node->place);
  for (const TreeNode& place : fresh_)
    if (Node* node = find(place)) reconsider(*node);
  for (const TreeNode& place : changed_) {
    if (Node* node = find(place)) reconsider(*node);
    reconsider_around(place);
  }
  fresh_.clear();
  changed_.clear();
  stale_ = false;
  return changes_;
}

}  // namespace skerry::world
