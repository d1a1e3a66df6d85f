#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "world/stream/stream.h"

namespace skerry::world {

/// A chunk at a level: a node of an island's tree of sections. Its eight children are the chunks of
/// the level below that it covers.
struct TreeNode {
  std::int32_t level = 0;  ///< a voxel's edge is 2^level blocks
  IVec3 chunk;
  auto operator<=>(const TreeNode&) const = default;
};

/// A box in an island's lattice [blocks]. The default is empty: it is infinitely far.
struct LatticeBox {
  IVec3 low{INT32_MAX, INT32_MAX, INT32_MAX}, high{INT32_MIN, INT32_MIN, INT32_MIN};
  void add(const LatticeBox& other);
  double distance(const glm::dvec3& from) const;
  bool operator==(const LatticeBox&) const = default;
};

/// An island's sections, and which of them are drawn, so that each place is drawn at one level. It
/// is kept from frame to frame: what comes, goes or is drawn at another level costs what it is
/// itself, not what the island is.
class SectionTree {
 public:
  SectionTree() = default;
  SectionTree(SectionTree&&) = default;
  SectionTree& operator=(SectionTree&&) = default;

  /// A section is drawn, without seams, until a cut says otherwise. @pre none there is equal.
  /// @param faces box about them, within the section.
  void add(const TreeNode& section, const LatticeBox& faces);
  /// @pre it is there.
  void remove(const TreeNode& section);

  /// Bit i: sections of level i are still coming, and what is there of it is not drawn, unless
  /// there is no whole level: then the finest one is drawn as far as it has come.
  void set_coming(std::uint32_t levels);

  /// What to draw from now on of a section.
  struct Change {
    TreeNode section;
    bool drawn = false;
    std::uint8_t seams = 0;  ///< bit i: at face i another level is drawn
  };
  /// Chooses anew: a node is drawn unless the faces of its sections, or of those that it covers,
  /// are nearer than its level may come; then its children are. An island whose bounding sphere is
  /// not nearer has no such node, so that none changes when its finer level comes.
  /// @param camera in lattice axes [blocks].
  /// @param nearest by level: how near a section may come that is drawn at it [blocks]; ascending,
  ///   one for each of kLevelCount levels.
  /// @param keep nodes change only 5% beyond their limits, if there has been a cut before.
  /// @return what is other than before. Valid until the next call.
  std::span<const Change> cut(const glm::dvec3& camera, std::span<const double> nearest, bool keep);

  /// Whether the last cut is out of date wherever the camera is.
  bool stale() const { return stale_; }
  /// Blocks by which the camera may move without another cut.
  double slack() const { return slack_; }
  bool empty() const { return nodes_.empty(); }

 private:
  struct Node {
    TreeNode place;
    LatticeBox own, faces;  // of its section, and about those of its children, too
    Node* parent = nullptr;
    std::array<Node*, 8> children{};
    // Rounds in which a cut last drew it, drew it finer, and looked at what is drawn of it.
    std::uint32_t leaf_in = 0, split_in = 0, looked_at_in = 0;
    std::size_t leaf = 0;  // index in leaves_
    bool section = false;
    bool drawn = true;  // as last told
    std::uint8_t seams = 0;
  };
  struct Hash {
    std::size_t operator()(const TreeNode& node) const;
  };
  Node* find(const TreeNode& node);
  void forget(Node& node);
  static void enclose(Node* node);
  void choose_levels();
  bool has(std::int32_t level) const { return (levels_ >> level & 1u) != 0; }
  bool is_split(const Node& node, const glm::dvec3& camera, std::span<const double> nearest,
                bool keep);
  void visit(Node& node, const glm::dvec3& camera, std::span<const double> nearest, bool keep);
  void reconsider(Node& node);
  void reconsider_around(const TreeNode& place);
  void reconsider_leaves(Node& node, std::uint32_t face);
  bool is_other_level(TreeNode place);

  std::unordered_map<TreeNode, Node, Hash> nodes_;   // sections, and all that holds them
  std::vector<Node*> roots_;                         // of the coarsest level
  std::array<std::size_t, kLevelCount> sections_{};  // by level
  std::uint32_t coming_ = 0;
  std::uint32_t levels_ = 0;  // that are drawn of, a bit each
  std::int32_t finest_ = 0;   // of them
  std::uint32_t round_ = 1;   // one more with each cut
  bool stale_ = true;
  double slack_ = 0.0;
  std::vector<Node*> leaves_, leaves_before_;  // null: gone since
  std::vector<TreeNode> fresh_;                // sections that have come since the last cut
  std::vector<TreeNode> changed_;              // leaves that have come or gone since
  std::vector<Change> changes_;
};

}  // namespace skerry::world
